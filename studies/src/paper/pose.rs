//! POSE (Evans et al.): one brief contact at an unknown angle and speed.

/// Angles of the surface, degrees (section II-B).
pub const ANGLES_DEG: [f64; 8] = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0];
/// Speeds: from, to and how many, mm/s. The text's step of 7 mm/s does not
/// divide them; eleven even steps are of 10 mm/s.
pub const SPEEDS_MM_S: (f64, f64, usize) = (6.0, 106.0, 11);
/// Surfaces, from rough to smooth.
pub const TEXTURES: [&str; 4] = ["P80", "P180", "P600", "aluminium"];

/// One classifier on one property.
#[derive(Debug, Clone, Copy)]
pub struct Figure {
    /// Cohen's κ, all three properties classified at once.
    pub kappa: f64,
    /// Mean error, in the property's unit (degrees, mm/s, classes).
    pub mean: f64,
    /// Its spread; the text calls it the standard error, Table I's caption the
    /// standard deviation.
    pub spread: f64,
}

const fn figure(kappa: f64, mean: f64, spread: f64) -> Figure {
    Figure {
        kappa,
        mean,
        spread,
    }
}

/// A classifier's row: angle, speed, texture.
#[derive(Debug, Clone, Copy)]
pub struct ClassifierRow {
    /// The classifier.
    pub what: &'static str,
    /// Angle, speed, texture.
    pub figures: [Figure; 3],
}

/// Sections III-A to III-C and Table I (features: f2 for angle, f1 for speed,
/// f5 for texture, as in Figs. 7 and 8).
pub const ROWS: [ClassifierRow; 3] = [
    ClassifierRow {
        what: "template",
        figures: [
            figure(0.27, 0.71, 15.6),
            figure(0.25, -2.7, 14.22),
            figure(0.24, -0.02, 1.23),
        ],
    },
    ClassifierRow {
        what: "spectral template",
        figures: [
            figure(0.44, -1.08, 13.8),
            figure(0.14, -2.78, 22.4),
            figure(0.46, 0.14, 1.00),
        ],
    },
    ClassifierRow {
        what: "features",
        figures: [
            figure(0.11, 0.17, 18.6),
            figure(0.43, 1.80, 12.12),
            figure(0.15, 0.05, 1.09),
        ],
    },
];

/// κ of texture alone, whatever the pose: template, spectral template.
pub const TEXTURE_ALONE: [f64; 2] = [0.24, 0.42];

/// A feature of texture.
#[derive(Debug, Clone, Copy)]
pub struct TextureFeature {
    /// Its name.
    pub name: &'static str,
    /// κ, classified with angle and speed.
    pub together: f64,
    /// κ, classified alone; none is printed for the combination.
    pub alone: Option<f64>,
    /// Table I: mean error and its spread, classes.
    pub error: (f64, f64),
}

/// Section III-C and Table I.
pub const TEXTURE_FEATURES: [TextureFeature; 4] = [
    TextureFeature {
        name: "f3",
        together: 0.06,
        alone: Some(0.08),
        error: (0.43, 1.10),
    },
    TextureFeature {
        name: "f4",
        together: 0.03,
        alone: Some(0.21),
        error: (-0.07, 1.22),
    },
    TextureFeature {
        name: "f5",
        together: 0.15,
        alone: Some(0.27),
        error: (0.05, 1.09),
    },
    TextureFeature {
        name: "f3, f4 and f5",
        together: 0.12,
        alone: None,
        error: (-0.09, 0.97),
    },
];
