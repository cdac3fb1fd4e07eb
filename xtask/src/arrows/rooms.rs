//! Arrows between crates, as cargo knows them.

use std::path::PathBuf;

use serde::Deserialize;

use crate::run::{Fault, cargo, output};

/// The packages of the workspace: each may depend only on rows below its own.
/// `physics` depends on none and serves what simulates.
pub(super) const ROWS: [&[&str]; 10] = [
    &[
        "acceptance",
        "count",
        "fuzz",
        "page",
        "whisker-python",
        "xtask",
    ],
    &["studies"],
    &["classifiers"],
    &["whisker"],
    &["emulator"],
    &["host-sim"],
    &["firmware"],
    &["plan"],
    &["scene"],
    &[
        "mlx90333", "physics", "rtt", "tactile", "tmag5170", "whisking", "wire",
    ],
];

/// A package of the workspace, as cargo describes it.
#[derive(Deserialize)]
pub(super) struct Package {
    pub(super) name: String,
    /// What it depends on, for whatever purpose.
    pub(super) dependencies: Vec<Dependency>,
    /// Its library, its programs and its build script.
    pub(super) targets: Vec<Target>,
}

/// A package that another one uses; [`ROWS`] says which are of the workspace.
#[derive(Deserialize)]
pub(super) struct Dependency {
    pub(super) name: String,
}

/// Where the compiler begins to read.
#[derive(Deserialize)]
pub(super) struct Target {
    pub(super) src_path: PathBuf,
    pub(super) kind: Vec<String>,
}

/// The packages of the workspace, without their tests.
///
/// # Errors
/// If cargo does not say.
pub(super) fn packages() -> Result<Vec<Package>, Fault> {
    #[derive(Deserialize)]
    struct Metadata {
        packages: Vec<Package>,
    }
    let ask = ["metadata", "--no-deps", "--format-version=1", "--offline"];
    let said = output(&mut cargo(&ask))?;
    let said: Metadata = serde_json::from_str(&said).map_err(|error| error.to_string())?;
    let mut packages = said.packages;
    for package in &mut packages {
        let is_test = |kind: &String| kind == "test" || kind == "bench";
        package
            .targets
            .retain(|target| !target.kind.iter().any(is_test));
    }
    Ok(packages)
}

/// What in the dependencies of `packages` [`ROWS`] does not allow.
pub(super) fn against_the_order(packages: &[Package]) -> Vec<String> {
    let row = |name: &str| ROWS.iter().position(|row| row.contains(&name));
    let mut found = Vec::new();
    for package in packages {
        let name = &package.name;
        let Some(here) = row(name) else {
            found.push(format!("{name} has no row in xtask/src/arrows/rooms.rs"));
            continue;
        };
        for Dependency { name: used } in &package.dependencies {
            if row(used).is_some_and(|there| there <= here) {
                found.push(format!("{name} -> {used} does not point down"));
            }
        }
    }
    found
}
