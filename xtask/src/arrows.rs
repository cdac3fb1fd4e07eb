//! Keeps the dependencies between the crates of the workspace pointing one way: those of build
//! scripts and of tests included, each points from a row of [`ROWS`] to a row below it.

use serde::Deserialize;

use crate::run::{Fault, cargo, no_faults, output};

/// The packages of the workspace: each may depend only on rows below its own.
/// `physics` depends on none and serves what simulates; `studies` is no member, and none may
/// depend on it.
const ROWS: [&[&str]; 7] = [
    &[
        "acceptance",
        "count",
        "fuzz",
        "page",
        "studies",
        "whisker-python",
        "xtask",
    ],
    &["whisker"],
    &["emulator"],
    &["host-sim"],
    &["config"],
    &["firmware", "scene"],
    &[
        "mlx90333", "physics", "rtt", "tactile", "tmag5170", "whisking", "wire",
    ],
];

/// What cargo says of a workspace.
#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    /// What it depends on, for whatever purpose.
    dependencies: Vec<Dependency>,
}

#[derive(Deserialize)]
struct Dependency {
    name: String,
}

/// Checks the workspace.
pub(crate) fn all() -> Result<(), Fault> {
    let ask = ["metadata", "--no-deps", "--format-version=1", "--offline"];
    let said = output(&mut cargo(&ask))?;
    let said: Metadata = serde_json::from_str(&said).map_err(|error| error.to_string())?;
    no_faults(&against_the_order(&said.packages))
}

fn against_the_order(packages: &[Package]) -> Vec<String> {
    let row = |name: &str| ROWS.iter().position(|row| row.contains(&name));
    let mut faults = Vec::new();
    for Package { name, dependencies } in packages {
        let Some(here) = row(name) else {
            faults.push(format!("{name} has no row in xtask/src/arrows.rs"));
            continue;
        };
        for Dependency { name: used } in dependencies {
            if row(used).is_some_and(|there| there <= here) {
                faults.push(format!("{name} -> {used} does not point down"));
            }
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::{Dependency, Package, against_the_order};

    #[test]
    fn a_dependency_may_point_down_only() {
        let uses = |name: &str, used: &str| {
            let (name, used) = (name.to_owned(), used.to_owned());
            let dependencies = vec![Dependency { name: used }];
            against_the_order(&[Package { name, dependencies }]).len()
        };
        assert_eq!(uses("host-sim", "firmware"), 0);
        assert_eq!(uses("host-sim", "serde"), 0);
        assert_eq!(uses("firmware", "host-sim"), 1);
        assert_eq!(uses("firmware", "scene"), 1);
        assert_eq!(uses("unheard-of", "serde"), 1);
    }
}
