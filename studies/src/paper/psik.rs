//! PSIK (Psikharpax): 33 vibrissae, the IMP feature and a small network.

/// Table 1: vibrissae of each arc and their length on the robot, mm.
pub const ARCS: [(usize, f64); 8] = [
    (5, 250.0),
    (5, 200.0),
    (5, 150.0),
    (5, 120.0),
    (5, 100.0),
    (3, 90.0),
    (3, 70.0),
    (2, 55.0),
];

/// Vibrissae in all.
pub const VIBRISSAE: usize = 33;
/// Sampling rate, Hz, of two 8-bit numbers a vibrissa.
pub const RATE_HZ: f64 = 1157.0;

/// Table 2: percent, `[true][decided]`.
pub const TABLE_2: [[f64; 8]; 8] = [
    [100.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 99.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 2.0, 95.0, 0.0, 3.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 96.0, 4.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0, 99.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.0, 1.0, 93.0, 6.0, 0.0],
    [2.0, 0.0, 6.0, 0.0, 3.0, 9.0, 80.0, 0.0],
    [2.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 97.0],
];

/// Table 3: corridor and direction, percent, `[true][decided]`.
pub const TABLE_3: [[f64; 4]; 4] = [
    [75.0, 15.0, 10.0, 0.0],
    [0.0, 100.0, 0.0, 0.0],
    [15.0, 0.0, 85.0, 0.0],
    [0.0, 15.0, 0.0, 85.0],
];

/// Rows and columns of Table 3.
pub const CORRIDORS: [&str; 4] = ["1-1", "1-2", "2-1", "2-2"];

/// Fig. 6 as the text tells it: the hit rate with three arcs or more, percent.
pub const FIG6_THREE_ARCS: (f64, f64) = (90.0, 95.0);
