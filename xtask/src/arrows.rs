//! That the dependencies between the crates of the workspace point one way: cargo refuses circles,
//! and here those of build scripts and of tests, too, point from a row to one below it.

use serde_json::Value;

use crate::run::{cargo, output};

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
        "can", "mlx90333", "physics", "rtt", "tactile", "tmag5170", "united", "whisking", "wire",
    ],
];

fn row(name: &Value) -> Option<usize> {
    let name = name.as_str()?;
    ROWS.iter().position(|row| row.contains(&name))
}

#[test]
fn dependencies_point_down() {
    let ask = "metadata --no-deps --format-version=1 --offline";
    let said = output(&mut cargo(ask)).unwrap();
    let said: Value = serde_json::from_str(&said).unwrap();
    for package in said["packages"].as_array().unwrap() {
        let name = &package["name"];
        let here = row(name).unwrap_or_else(|| panic!("{name} has no row"));
        for used in package["dependencies"].as_array().unwrap() {
            let used = &used["name"];
            let is_below = row(used).is_none_or(|there| there > here);
            assert!(is_below, "{name} -> {used} does not point down");
        }
    }
}
