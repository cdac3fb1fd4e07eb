//! PSIK (Psikharpax): 33 vibrissae, the IMP feature and a small network.

use std::sync::LazyLock;

use super::printed;

/// Table 1: vibrissae of each arc and their length on the robot, mm.
pub(crate) const ARCS: [(usize, f64); 8] = [
    (5, 250.0),
    (5, 200.0),
    (5, 150.0),
    (5, 120.0),
    (5, 100.0),
    (3, 90.0),
    (3, 70.0),
    (2, 55.0),
];

pub(crate) const VIBRISSAE: usize = 33;
/// Sampling rate, Hz, of two 8-bit numbers a vibrissa.
pub(crate) const RATE_HZ: f64 = 1157.0;

/// Table 2: percent, `[true][decided]`.
pub(crate) static TABLE_2: LazyLock<[[f64; 8]; 8]> =
    LazyLock::new(|| printed(include_str!("psik.toml"), "table_2"));

/// Table 3: corridor and direction, percent, `[true][decided]`.
pub(crate) static TABLE_3: LazyLock<[[f64; 4]; 4]> =
    LazyLock::new(|| printed(include_str!("psik.toml"), "table_3"));

/// Rows and columns of Table 3.
pub(crate) const CORRIDORS: [&str; 4] = ["1-1", "1-2", "2-1", "2-2"];

/// Fig. 6 as the text tells it: the hit rate with three arcs or more, percent.
pub(crate) const FIG6_THREE_ARCS: (f64, f64) = (90.0, 95.0);
