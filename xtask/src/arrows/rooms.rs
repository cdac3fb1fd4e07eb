//! Arrows between crates, as cargo knows them.

use std::path::PathBuf;

use serde_json::Value;

use crate::run::{Fault, cargo, output};

/// The packages of the workspace: each may depend only on rows below its own.
/// `physics` depends on none and serves what simulates.
pub(super) const ROWS: [&[&str]; 9] = [
    &["acceptance", "count", "xtask"],
    &["studies"],
    &["classifiers"],
    &["emulator"],
    &["host-sim"],
    &["firmware"],
    &["plan"],
    &["scene"],
    &["mlx90333", "physics", "tactile", "whisking"],
];

/// A package of the workspace.
pub(super) struct Package {
    pub(super) name: String,
    /// The packages of the workspace it depends on, for whatever purpose.
    pub(super) uses: Vec<String>,
    /// Its library, its programs and its build script.
    pub(super) roots: Vec<Root>,
}

/// Where the compiler begins to read.
pub(super) struct Root {
    pub(super) file: PathBuf,
    pub(super) is_library: bool,
}

/// The packages of the workspace.
///
/// # Errors
/// If cargo does not say.
pub(super) fn packages() -> Result<Vec<Package>, Fault> {
    let said = output(&mut cargo(&[
        "metadata",
        "--no-deps",
        "--format-version=1",
        "--offline",
    ]))?;
    let said: Value = serde_json::from_str(&said).map_err(|error| error.to_string())?;
    Ok(list(&said["packages"]).map(package).collect())
}

fn package(said: &Value) -> Package {
    let here = |dependency: &&Value| !dependency["path"].is_null();
    let is = |target: &Value, kinds: &[&str]| {
        list(&target["kind"]).any(|kind| kinds.contains(&text(kind).as_str()))
    };
    Package {
        name: text(&said["name"]),
        uses: list(&said["dependencies"])
            .filter(here)
            .map(|dependency| text(&dependency["name"]))
            .collect(),
        roots: list(&said["targets"])
            .filter(|target| !is(target, &["test", "bench"]))
            .map(|target| Root {
                file: text(&target["src_path"]).into(),
                is_library: is(target, &["lib"]),
            })
            .collect(),
    }
}

fn list(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

/// What in the dependencies of `packages` [`ROWS`] does not allow.
pub(super) fn against_the_order(packages: &[Package]) -> Vec<String> {
    let row = |name: &str| ROWS.iter().position(|row| row.contains(&name));
    let mut found = Vec::new();
    for Package { name, uses, .. } in packages {
        let Some(here) = row(name) else {
            found.push(format!("{name} has no row in xtask/src/arrows/rooms.rs"));
            continue;
        };
        for used in uses {
            if row(used).is_some_and(|there| there <= here) {
                found.push(format!("{name} -> {used} does not point down"));
            }
        }
    }
    found
}
