//! LEP12 (Lepora et al. 2012): sequential Bayes against fixed windows, the
//! spectral template and a neural network, four floors.

/// Rows of Tables 1 to 4: motions of the robot.
pub const MOTIONS: [&str; 4] = ["anticlockwise", "clockwise", "rotating", "autonomous"];

/// Mean decision time of Tables 1 and 2, s.
pub const TIME_S: f64 = 0.2;
/// Segment of the spectral methods, s.
pub const SEGMENT_S: f64 = 0.4;

/// One of Tables 1 to 4.
#[derive(Debug, Clone, Copy)]
pub struct Table {
    /// Its number in the paper.
    pub number: u8,
    /// The classifier.
    pub what: &'static str,
    /// Percent, `[motion][floor]`.
    pub percent: [[f64; 4]; 4],
    /// Mean hit rate of each motion, percent, as printed.
    pub mean: [f64; 4],
}

/// Tables 1 to 4. The mean of Table 3's row for rotating motion is printed as
/// 48 %; its four floors give 59.5 %.
pub const TABLES: [Table; 4] = [
    Table {
        number: 1,
        what: "maximum likelihood over 200 ms",
        percent: [
            [80.0, 94.0, 91.0, 100.0],
            [74.0, 84.0, 84.0, 97.0],
            [82.0, 87.0, 88.0, 99.0],
            [57.0, 90.0, 93.0, 68.0],
        ],
        mean: [91.0, 85.0, 89.0, 77.0],
    },
    Table {
        number: 2,
        what: "sequential Bayes, close to 200 ms on average",
        percent: [
            [99.0, 98.0, 99.0, 100.0],
            [91.0, 84.0, 94.0, 98.0],
            [96.0, 89.0, 97.0, 99.0],
            [85.0, 97.0, 99.0, 91.0],
        ],
        mean: [99.0, 92.0, 95.0, 93.0],
    },
    Table {
        number: 3,
        what: "template of the power spectrum over 400 ms",
        percent: [
            [65.0, 64.0, 54.0, 100.0],
            [36.0, 53.0, 3.0, 96.0],
            [32.0, 60.0, 49.0, 97.0],
            [6.0, 43.0, 83.0, 79.0],
        ],
        mean: [71.0, 47.0, 48.0, 53.0],
    },
    Table {
        number: 4,
        what: "neural network on the power spectrum over 400 ms",
        percent: [
            [68.0, 84.0, 84.0, 99.0],
            [48.0, 56.0, 72.0, 94.0],
            [68.0, 81.0, 79.0, 97.0],
            [62.0, 57.0, 91.0, 96.0],
        ],
        mean: [84.0, 68.0, 81.0, 76.0],
    },
];

/// Section 4.3: by how much sequential exceeds the window at equal mean time,
/// percentage points.
pub const SEQUENTIAL_GAIN: (f64, f64) = (6.0, 16.0);
/// Section 4.2 and discussion: most of the gain comes up to this time, s.
pub const KNEE_S: f64 = 0.1;
/// Fig. 7: decision times at thresholds 0.5, 0.7 and 0.9 in its example, s.
pub const FIG7: [(f64, f64); 3] = [(0.5, 0.01), (0.7, 0.02), (0.9, 0.03)];
/// Fig. 8: the thresholds of its histograms.
pub const FIG8_THRESHOLDS: [f64; 3] = [0.5, 0.9, 0.999];
/// Fig. 9 (section 5.1): where the power spectra peak, Hz.
pub const FIG9_PEAK_HZ: (f64, f64) = (30.0, 40.0);
