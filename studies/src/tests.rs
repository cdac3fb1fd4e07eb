//! The pages are the same on one core and on several, and say what they measured.

use std::fs;
use std::path::Path;

use clap::Parser;
use tempfile::TempDir;

use super::{Arguments, work};

/// Has the command line make a page in short, on one core and on three.
fn check(page: &str, options: &[&str], expected: &[&str]) {
    let made = |cores| {
        let folder = TempDir::new().unwrap();
        let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/measured");
        let counted = "instructions.csv";
        fs::copy(docs.join(counted), folder.path().join(counted)).unwrap();
        let out = folder.path().to_str().unwrap();
        let line = ["studies", "--quiet", page, "--quick", "--out", out];
        let arguments = Arguments::try_parse_from(line.iter().chain(options)).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(cores).build();
        pool.unwrap().install(|| work(arguments)).unwrap();
        let mut names = written(folder.path(), "");
        names.retain(|name| name != counted);
        let text = |name: &String| fs::read_to_string(folder.path().join(name)).unwrap();
        let texts: Vec<String> = names.iter().map(text).collect();
        (names, texts)
    };
    let on_one = made(1);
    assert_eq!(on_one, made(3));
    let (names, texts) = on_one;
    assert_eq!(names, expected);
    let figures = &texts[0];
    let columns = |line: &str| line.matches(',').count();
    let header = figures.lines().next().map(columns);
    let lines = figures.lines().map(|line| Some(columns(line)));
    assert!(lines.clone().count() > 10, "{figures}");
    assert!({ lines }.all(|columns| columns == header), "{figures}");
    assert!(!figures.contains("NaN"));
}

/// The names of all files in `folder`, sorted, each after `before`.
fn written(folder: &Path, before: &str) -> Vec<String> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{before}{}", entry.file_name().to_str().unwrap());
        if entry.file_type().unwrap().is_dir() {
            names.extend(written(&entry.path(), &format!("{name}/")));
        } else {
            names.push(name);
        }
    }
    names.sort();
    names
}

#[test]
fn the_page_of_decisions_is_the_same_on_one_core_or_several() {
    let terrain = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/terrain");
    check(
        "decisions",
        &["--terrain", terrain.to_str().unwrap()],
        &[
            "decisions.csv",
            "decisions.md",
            "decisions/calibration.svg",
            "decisions/run-time.svg",
        ],
    );
}

#[test]
fn the_page_of_estimated_poses_is_the_same_on_one_core_or_several() {
    let names = ["standing.csv", "standing.md", "standing/errors.svg"];
    check("standing", &[], &names);
}

#[test]
fn the_page_of_poses_is_the_same_on_one_core_or_several() {
    check("poses", &[], &["poses.csv", "poses.md"]);
}
