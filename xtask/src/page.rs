//! The page for a browser, one HTML file, and its tests in one.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::run::{Fault, cargo, cargo_apart, run, target, top};
use crate::{python, traces};

pub(crate) fn path() -> PathBuf {
    target().join("page/whisker.html")
}

pub(crate) fn build() -> Result<(), Fault> {
    let web = ["--profile", "page", "--target", "wasm32-unknown-unknown"];
    run(cargo("build --locked -p page --lib").args(web))?;
    let mut pack = cargo_apart("run", "web/pack", "packer");
    pack.arg("--");
    pack.arg(target().join("wasm32-unknown-unknown/page/page.wasm"));
    run(pack.arg(top().join("web/page")).arg(path()))
}

/// Opens it in headless Chromium and uses it as a person would, on a desk and on a phone, with axe
/// for its accessibility.
pub(crate) fn test() -> Result<(), Fault> {
    // Most of the time a browser waits: two at once.
    run(tests()?.args(["-n2", "-mnot alone"]))
}

/// Counts its frames, for which nothing else may run; `picture` is where the one of the README
/// goes.
pub(crate) fn count_frames(picture: Option<&Path>) -> Result<(), Fault> {
    let mut tests = tests()?;
    if let Some(picture) = picture {
        tests.env("WHISKER_PICTURE", picture);
    }
    run(tests.args(["-n0", "-malone"]))
}

fn tests() -> Result<Command, Fault> {
    let python = python::with_browser()?;
    let mut axe = python::pip(&python);
    axe.args(["--no-deps", "--require-hashes", "--requirement"]);
    run(axe.arg(top().join("web/tests/axe.txt")))?;
    let mut tests = Command::new(&python);
    tests.args(["-m", "pytest", "--quiet", "-p", "no:cacheprovider"]);
    tests.arg(top().join("web/tests"));
    tests.env("WHISKER_PAGE", path());
    tests.env("WHISKER_TRACES", traces::written()?);
    tests.env("WHISKER_FIGURES", python::place("page.json"));
    Ok(tests)
}
