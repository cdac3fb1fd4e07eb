//! The commands of the command line, one file for each.

mod ahead;
pub mod choice;
pub mod classify;
mod columns;
mod evaluate;
pub mod main_job;
mod press;
pub mod program;
pub mod record;
pub mod run;
mod score;
mod sweep;
pub mod train;

use std::path::{Path, PathBuf};

use scene::Scene;

/// The names of two columns, A,B, as an option has them.
fn channels(text: &str) -> Result<[String; 2], String> {
    match text.split_once(',') {
        Some((a, b)) if !a.is_empty() && !b.is_empty() && !b.contains(',') => {
            Ok([a.to_owned(), b.to_owned()])
        }
        _ => Err("allowed: two names, such as x,y".to_owned()),
    }
}

/// Samples a second, as an option has them.
fn rate(text: &str) -> Result<u32, String> {
    let rate = text.parse().ok().filter(|rate| *rate > 0);
    rate.ok_or_else(|| "allowed: a whole number above 0".to_owned())
}

/// The path of a picture, as an option has it.
fn picture(text: &str) -> Result<PathBuf, String> {
    ending(text, &["svg"])
}

/// The same of one that may be of pixels.
fn any_picture(text: &str) -> Result<PathBuf, String> {
    ending(text, &["svg", "png"])
}

fn with_seed(scene: &Scene, seed: u64) -> Scene {
    let mut scene = scene.clone();
    scene.seed = seed;
    scene
}

fn ending(text: &str, endings: &[&str]) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if endings.iter().any(|ending| ends_in(&path, ending)) {
        return Ok(path);
    }
    let endings = endings.join(" or .");
    Err(format!("allowed: a name that ends in .{endings}"))
}

fn ends_in(path: &Path, extension: &str) -> bool {
    let found = path.extension();
    found.is_some_and(|found| found.eq_ignore_ascii_case(extension))
}
