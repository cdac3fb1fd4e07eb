//! That the bench's program takes what was built for host-sim: cargo compiles a dependency again
//! where its features are others.

use std::collections::BTreeSet;

use crate::run::{cargo, output};

/// What a package depends on, each with its features.
fn dependencies(package: &str) -> BTreeSet<String> {
    let what = [
        "tree",
        "--locked",
        "--offline",
        "-e",
        "normal,build",
        "-p",
        package,
    ];
    let how = ["--no-dedupe", "--prefix", "none", "-f", "{p} {f}"];
    let said = output(cargo(&what).args(how)).unwrap();
    said.lines().map(|line| line.trim().to_owned()).collect()
}

#[test]
fn the_bench_takes_what_was_built_for_the_simulator() {
    let (simulator, bench) = (dependencies("host-sim"), dependencies("whisker"));
    let of_others = |line: &&String| !line.starts_with("host-sim ");
    let again: Vec<&String> = simulator.difference(&bench).filter(of_others).collect();
    assert!(simulator.len() > 50, "{}", simulator.len());
    assert!(
        again.is_empty(),
        "compiled twice: {again:#?}\nname their features in crates/united"
    );
}
