//! The bytes that every scene writes, in every number format, are what they were.
//!
//! `tests/data/scenes.sha256` holds the SHA-256 of trace, decisions and recording of each. A
//! change that means to change them writes the file again, and says why:
//! `WHISKER_RENEW=1 cargo test -p acceptance unchanged`.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use crate::common::project;
use host_sim::commands::choice::SceneChoice;
use host_sim::commands::record::record;
use host_sim::commands::run::{Arguments, run};
use host_sim::progress::Verbosity;
use rayon::prelude::*;
use sha2::{Digest, Sha256};

fn sum_of(path: &Path) -> String {
    let sum = Sha256::digest(fs::read(path).unwrap());
    let hex = sum.iter().map(|byte| format!("{byte:02x}"));
    hex.collect()
}

/// The lines of one scene in one number format; a passive scene has one format alone.
fn lines(scene: &Path, format: Option<&str>) -> String {
    let name = scene.file_stem().unwrap().to_str().unwrap();
    let out = tempfile::tempdir().unwrap();
    let set = format.map(|format| format!("whisking.numbers={format}").parse().unwrap());
    let choice = SceneChoice {
        file: scene.to_owned(),
        set: set.into_iter().collect(),
    };
    let arguments = Arguments {
        scene: choice.clone(),
        ..Arguments::of(scene, out.path())
    };
    run(&arguments, Verbosity::Quiet).unwrap();
    let recording = out.path().join("recording.csv");
    record(&choice, &recording, None, Verbosity::Quiet).unwrap();
    let mut text = String::new();
    for file in ["trace.csv", "decisions.csv", "recording.csv"] {
        let path = out.path().join(file);
        if path.exists() {
            let format = format.unwrap_or("-");
            writeln!(text, "{}  {name} {format} {file}", sum_of(&path)).unwrap();
        }
    }
    text
}

#[test]
fn every_scene_writes_what_it_wrote() {
    let scenes = fs::read_dir(project("scenes")).unwrap();
    let scenes = scenes.map(|entry| entry.unwrap().path());
    let mut scenes: Vec<PathBuf> = scenes
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    scenes.sort();
    let mut runs: Vec<(PathBuf, Option<&str>)> = Vec::new();
    for path in scenes {
        let text = fs::read_to_string(&path).unwrap();
        let formats = if text.contains("[whisking]") {
            &[Some("f32"), Some("f64"), Some("fixed")][..]
        } else {
            &[None]
        };
        runs.extend(formats.iter().map(|format| (path.clone(), *format)));
    }
    let found = runs.par_iter().map(|(path, format)| lines(path, *format));
    let found: String = found.collect();
    let file = project("tests/data/scenes.sha256");
    if std::env::var_os("WHISKER_RENEW").is_some() {
        fs::write(&file, &found).unwrap();
    }
    let expected = fs::read_to_string(&file).unwrap();
    let differs = expected.lines().zip(found.lines()).find(|(a, b)| a != b);
    assert_eq!(differs, None);
    assert_eq!(found.lines().count(), expected.lines().count());
}
