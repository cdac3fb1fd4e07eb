//! LEP12 (Lepora et al. 2012): sequential Bayes against fixed windows, the
//! spectral template and a neural network, four floors.

use std::sync::LazyLock;

use serde::Deserialize;

use super::printed;

/// Rows of Tables 1 to 4: motions of the robot.
pub(crate) const MOTIONS: [&str; 4] = ["anticlockwise", "clockwise", "rotating", "autonomous"];

/// Mean decision time of Tables 1 and 2, s.
pub(crate) const TIME_S: f64 = 0.2;
/// Segment of the spectral methods, s.
pub(crate) const SEGMENT_S: f64 = 0.4;

#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Table {
    pub(crate) number: u8,
    pub(crate) what: String,
    /// Percent, `[motion][floor]`.
    pub(crate) percent: [[f64; 4]; 4],
    /// Mean hit rate of each motion, percent, as printed.
    pub(crate) mean: [f64; 4],
}

/// Tables 1 to 4.
pub(crate) static TABLES: LazyLock<[Table; 4]> =
    LazyLock::new(|| printed(include_str!("lep12.toml"), "tables"));

/// Section 4.3: by how much sequential exceeds the window at equal mean time, percentage points.
pub(crate) const SEQUENTIAL_GAIN: (f64, f64) = (6.0, 16.0);
/// Section 4.2 and discussion: most of the gain comes up to this time, s.
pub(crate) const KNEE_S: f64 = 0.1;
/// Fig. 7: decision times at thresholds 0.5, 0.7 and 0.9 in its example, s.
pub(crate) const FIG7: [(f64, f64); 3] = [(0.5, 0.01), (0.7, 0.02), (0.9, 0.03)];
/// Fig. 8: the thresholds of its histograms.
pub(crate) const FIG8_THRESHOLDS: [f64; 3] = [0.5, 0.9, 0.999];
/// Fig. 9 (section 5.1): where the power spectra peak, Hz.
pub(crate) const FIG9_PEAK_HZ: (f64, f64) = (30.0, 40.0);
