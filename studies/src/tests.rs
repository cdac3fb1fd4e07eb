//! The pages are the same on one core and on several, and say what they measured.

use std::fs;
use std::path::Path;

use clap::Parser;
use tempfile::TempDir;

use super::{Arguments, work};

/// The names of all files of a page in short, as the command line makes it on so many cores, and
/// what they say.
fn made(cores: usize, page: &str, options: &[&str]) -> (Vec<String>, Vec<String>) {
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
    let texts = names.iter().map(text).collect();
    (names, texts)
}

fn is_the_same_on_one_core(page: &str, options: &[&str]) {
    assert_eq!(made(1, page, options), made(3, page, options));
}

fn says_what_it_measured(page: &str, options: &[&str], expected: &[&str]) {
    let (names, texts) = made(3, page, options);
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

fn terrain() -> [&'static str; 2] {
    [
        "--terrain",
        concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/terrain"),
    ]
}

#[test]
fn pages_say_what_they_measured() {
    let pictures = ["decisions/calibration.svg", "decisions/run-time.svg"];
    let names = [["decisions.csv", "decisions.md"], pictures].concat();
    says_what_it_measured("decisions", &terrain(), &names);
    let names = ["standing.csv", "standing.md", "standing/errors.svg"];
    says_what_it_measured("standing", &[], &names);
    is_the_same_on_one_core("standing", &[]);
    says_what_it_measured("poses", &[], &["poses.csv", "poses.md"]);
}

#[test]
fn the_accuracy_report_is_made_of_what_boards_cost() {
    let (names, texts) = made(3, "report", &[]);
    assert!(names.contains(&"accuracy.md".to_owned()), "{names:?}");
    // Every goal of the integrators is met.
    let is_good = |text: &String| !text.contains("NaN") && !text.contains("**missed**");
    assert!(texts.iter().all(|text| text.len() > 100 && is_good(text)));
}

/// The nightly run has it: minutes.
#[test]
#[ignore = "takes minutes"]
fn pages_are_the_same_on_one_core_or_several() {
    is_the_same_on_one_core("decisions", &terrain());
    is_the_same_on_one_core("poses", &[]);
}
