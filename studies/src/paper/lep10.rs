//! LEP10 (Lepora et al. 2010): naive Bayes over fixed windows, four floors.

use std::sync::LazyLock;

use serde::Deserialize;

use super::printed;

/// The four floors, in the order of every table (section II-B).
pub(crate) const FLOORS: [&str; 4] = ["rough carpet", "smooth carpet", "tarmac", "vinyl"];

/// Window of Tables I to V, s.
pub(crate) const WINDOW_S: f64 = 0.5;

#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Table {
    pub(crate) number: String,
    pub(crate) what: String,
    /// The mean hit rate of its caption, percent.
    pub(crate) mean: f64,
    /// Percent, `[decided][true]`: the columns are the true class.
    pub(crate) percent: [[f64; 4]; 4],
}

/// Tables I to V.
pub(crate) static TABLES: LazyLock<[Table; 5]> =
    LazyLock::new(|| printed(include_str!("lep10.toml"), "tables"));

/// Fig. 4 as the text tells it (sections III-B and III-C): mean hit rates of x
/// alone, y alone, and both at windows of half a second or more, percent.
pub(crate) const FIG4_LONG: [f64; 3] = [80.0, 80.0, 90.0];
/// Fig. 4: most of the gain comes up to this window, s.
pub(crate) const FIG4_KNEE_S: f64 = 0.1;
