//! The pages are the same on one core and on several, and say what they measured.

use std::path::Path;

use super::{Folders, decisions, poses};
use crate::page::Files;
use host_sim::progress::Verbosity;

/// Makes a page on one core and on three.
fn check(page: impl Fn() -> anyhow::Result<Files> + Sync, expected: &[&str]) {
    let made = |cores| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(cores).build();
        pool.unwrap().install(&page).unwrap()
    };
    let files = made(1);
    assert_eq!(files, made(3));
    let names: Vec<_> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, expected);
    let figures = &files[1].1;
    let columns = |line: &str| line.matches(',').count();
    let header = figures.lines().next().map(columns);
    let lines = figures.lines().map(|line| Some(columns(line)));
    assert!(lines.clone().count() > 10, "{figures}");
    assert!({ lines }.all(|columns| columns == header), "{figures}");
    assert!(!figures.contains("NaN"));
}

#[test]
fn the_page_of_decisions_is_the_same_on_one_core_or_several() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let [docs, terrain] = ["docs/measured", "tests/data/terrain"].map(|folder| top.join(folder));
    let folders = Folders {
        docs: &docs,
        terrain: &terrain,
    };
    let extent = decisions::Extent::new(true);
    let names = [
        "decisions.md",
        "decisions.csv",
        "decisions/calibration.svg",
        "decisions/run-time.svg",
    ];
    check(
        || decisions::page(folders, &extent, Verbosity::Quiet),
        &names,
    );
}

#[test]
fn the_page_of_poses_is_the_same_on_one_core_or_several() {
    let extent = poses::Extent::new(true);
    check(
        || poses::page(&extent, Verbosity::Quiet),
        &["poses.md", "poses.csv"],
    );
}
