//! The studies: a workspace of its own beside the product's, with the same target directory
//! (`.cargo/config.toml`).

use std::process::Command;

use crate::run::{Fault, cargo, linted, run, target};

/// From the top.
pub(crate) const MANIFEST: &str = "studies/Cargo.toml";

fn in_workspace(command: &str) -> Command {
    cargo(&format!("{command} --locked --manifest-path {MANIFEST}"))
}

pub(crate) fn format() -> Result<(), Fault> {
    run(&mut cargo(&format!(
        "fmt --manifest-path {MANIFEST} --check"
    )))
}

/// Tests, which make pages in short; with a seed, properties are tried on the same cases in each
/// run, and what takes minutes is left out.
pub(crate) fn check(seed: Option<&str>) -> Result<(), Fault> {
    let all = ["--", "--include-ignored"];
    let mut tests = in_workspace("test");
    run(linted(match seed {
        Some(seed) => tests.env("PROPTEST_RNG_SEED", seed),
        None => tests.args(all),
    }))
}

/// All experiments, which the tests make in short.
pub(crate) fn experiments() -> Result<(), Fault> {
    let all = ["--release", "--quiet", "--", "--quiet"];
    let mut experiments = in_workspace("run");
    experiments.args(all).args(["experiment", "all", "--out"]);
    run(experiments.arg(target().join("nightly")))
}

/// Makes a page, `decisions`, `poses`, `standing` or `report`, or checks that it is up to date. They show
/// docs/measured/instructions.csv, which `cargo xtask count` writes.
pub(crate) fn page(page: &str, check: bool) -> Result<(), Fault> {
    let mut program = in_workspace("run");
    program.args(["--quiet", "--", page]);
    run(program.args(check.then_some("--check")))
}
