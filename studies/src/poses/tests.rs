//! The page is the same on one core and on several, and says what it measured.

use super::{Extent, page};
use host_sim::progress::Verbosity;

#[test]
fn the_page_is_the_same_on_one_core_or_several() {
    let made = |cores| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(cores).build();
        let quick = || page(&Extent::quick(), Verbosity::Quiet);
        pool.unwrap().install(quick).unwrap()
    };
    let files = made(1);
    assert_eq!(files, made(3));
    let names: Vec<_> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["poses.md", "poses.csv"]);
    let figures = &files[1].1;
    let columns = |line: &str| line.matches(',').count();
    let header = figures.lines().next().map(columns);
    let lines = figures.lines().map(|line| Some(columns(line)));
    assert!(lines.clone().count() > 10, "{figures}");
    assert!({ lines }.all(|columns| columns == header), "{figures}");
    assert!(!figures.contains("NaN") && !files[0].1.contains("NaN"));
}
