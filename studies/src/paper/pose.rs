//! POSE (Evans et al.): one brief contact at an unknown angle and speed.

use std::sync::LazyLock;

use serde::Deserialize;

use super::printed;

/// Angles of the surface, degrees (section II-B).
pub(crate) const ANGLES_DEG: [f64; 8] = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0];
/// Speeds: from, to and how many, mm/s. The text's step of 7 mm/s does not
/// divide them; eleven even steps are of 10 mm/s.
pub(crate) const SPEEDS_MM_S: (f64, f64, usize) = (6.0, 106.0, 11);
/// Surfaces, from rough to smooth.
pub(crate) const TEXTURES: [&str; 4] = ["P80", "P180", "P600", "aluminium"];

#[derive(Debug, Clone, Copy, Deserialize)]
pub(crate) struct Figure {
    /// Cohen's κ, all three properties classified at once.
    pub(crate) kappa: f64,
    /// Mean error, in the property's unit (degrees, mm/s, classes).
    pub(crate) mean: f64,
    /// Its spread; the text calls it the standard error, Table I's caption the standard deviation.
    pub(crate) spread: f64,
}

#[derive(Debug, Clone, Deserialize)]
pub(crate) struct ClassifierRow {
    pub(crate) what: String,
    /// Angle, speed, texture.
    pub(crate) figures: [Figure; 3],
}

/// Sections III-A to III-C and Table I (features: f2 for angle, f1 for speed,
/// f5 for texture, as in Figs. 7 and 8).
pub(crate) static ROWS: LazyLock<[ClassifierRow; 3]> =
    LazyLock::new(|| printed(include_str!("pose.toml"), "rows"));

/// κ of texture alone, whatever the pose: template, spectral template.
pub(crate) const TEXTURE_ALONE: [f64; 2] = [0.24, 0.42];

#[derive(Debug, Clone, Deserialize)]
pub(crate) struct TextureFeature {
    pub(crate) name: String,
    /// κ, classified with angle and speed.
    pub(crate) together: f64,
    /// κ, classified alone; none is printed for the combination.
    pub(crate) alone: Option<f64>,
    /// Table I: mean error and its spread, classes.
    pub(crate) error: (f64, f64),
}

/// Section III-C and Table I.
pub(crate) static TEXTURE_FEATURES: LazyLock<[TextureFeature; 4]> =
    LazyLock::new(|| printed(include_str!("pose.toml"), "features"));
