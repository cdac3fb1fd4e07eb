//! POSE (Evans et al.): one brief contact at an unknown angle and speed.

use std::sync::LazyLock;

use serde::Deserialize;

use super::printed;

/// Angles of the surface, degrees (section II-B).
pub const ANGLES_DEG: [f64; 8] = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0];
/// Speeds: from, to and how many, mm/s. The text's step of 7 mm/s does not
/// divide them; eleven even steps are of 10 mm/s.
pub const SPEEDS_MM_S: (f64, f64, usize) = (6.0, 106.0, 11);
/// Surfaces, from rough to smooth.
pub const TEXTURES: [&str; 4] = ["P80", "P180", "P600", "aluminium"];

/// One classifier on one property.
#[derive(Debug, Clone, Copy, Deserialize)]
pub struct Figure {
    /// Cohen's κ, all three properties classified at once.
    pub kappa: f64,
    /// Mean error, in the property's unit (degrees, mm/s, classes).
    pub mean: f64,
    /// Its spread; the text calls it the standard error, Table I's caption the
    /// standard deviation.
    pub spread: f64,
}

/// A classifier's row: angle, speed, texture.
#[derive(Debug, Clone, Deserialize)]
pub struct ClassifierRow {
    /// The classifier.
    pub what: String,
    /// Angle, speed, texture.
    pub figures: [Figure; 3],
}

/// Sections III-A to III-C and Table I (features: f2 for angle, f1 for speed,
/// f5 for texture, as in Figs. 7 and 8).
pub static ROWS: LazyLock<[ClassifierRow; 3]> =
    LazyLock::new(|| printed(include_str!("pose.toml"), "rows"));

/// κ of texture alone, whatever the pose: template, spectral template.
pub const TEXTURE_ALONE: [f64; 2] = [0.24, 0.42];

/// A feature of texture.
#[derive(Debug, Clone, Deserialize)]
pub struct TextureFeature {
    /// Its name.
    pub name: String,
    /// κ, classified with angle and speed.
    pub together: f64,
    /// κ, classified alone; none is printed for the combination.
    pub alone: Option<f64>,
    /// Table I: mean error and its spread, classes.
    pub error: (f64, f64),
}

/// Section III-C and Table I.
pub static TEXTURE_FEATURES: LazyLock<[TextureFeature; 4]> =
    LazyLock::new(|| printed(include_str!("pose.toml"), "features"));
