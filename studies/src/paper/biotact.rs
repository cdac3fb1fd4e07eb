//! BIOTACT (Sullivan et al. 2011): six whisking whiskers, three textures at
//! three distances, with and without RCP.

/// Lowest natural frequencies of the whiskers of 80, 112 and 158 mm (section II-C).
pub(crate) const WHISKERS: [(f64, f64); 3] = [(80.0, 86.0), (112.0, 50.0), (158.0, 21.0)];

/// Textures (Table I and section IV-B), with the mean particle diameter in
/// micrometres; the third is smooth plastic.
pub(crate) const TEXTURES: [(&str, f64); 3] = [("P240", 58.5), ("P600", 25.8), ("smooth", 0.0)];

/// Axial distances, mm (section IV-B).
pub(crate) const DISTANCES_MM: [f64; 3] = [5.0, 10.0, 15.0];

/// Whisking strategies and their RCP gain σ_z (section IV-B).
pub(crate) const STRATEGIES: [(&str, f64); 3] =
    [("unmodulated", 0.0), ("RCP7", 0.7), ("RCP9", 0.9)];

/// A gate's σ, and its τ as a share of the whisk period. Figs. 6 to 9 have forward Euler, 2 kHz, 2 Hz
/// and no noise.
pub(crate) type Gate = (f64, f64);

/// RCP of Figs. 7 and 9, strong and fast RCP (Fig. 8), and CIA of Fig. 9; the gain is 1.
pub(crate) const GENTLE: Gate = (0.7, 0.25);
pub(crate) const STRONG: Gate = (2.0, 0.1);
pub(crate) const FIG9_CIA: Gate = (0.5, 0.25);
/// Free whisking.
pub(crate) const FIG6_GAINS: [f64; 4] = [0.5, 1.0, 1.5, 2.0];
/// Obstacles of Figs. 7 to 9 beside the head, left and right, θ' in degrees.
pub(crate) const OBSTACLES_DEG: [f64; 2] = [100.0, 125.0];
/// σ_x of the obstacles: deflection a degree of overlap (eq. 11).
pub(crate) const OVERLAP_GAIN: f64 = 0.1;

/// τ_z of the experiments as a share of the whisk period (section III-C).
pub(crate) const TAU_Z_PERIODS: f64 = 0.25;

pub(crate) const MOST_TRAINING: usize = 8;

/// What the text says of Figs. 10 and 11.
pub(crate) const SAID: [&str; 6] = [
    "both classifiers reach their best after 4 or 5 training whisks (unmodulated)",
    "both forms of RCP give higher hit rates than unmodulated after one or two training whisks, \
     RCP7 the highest",
    "naive Bayes with RCP7 reaches 100 % after seven training whisks",
    "the joint hit rate is about the product of those of texture and of distance",
    "the template reaches only 75 % on texture alone",
    "with the template, RCP is worse than unmodulated on distance after more than three training \
     whisks",
];

/// Fig. 10 (a): naive Bayes, RCP7, both properties, after seven whisks, percent.
pub(crate) const FIG10_RCP7_SEVEN: f64 = 100.0;
/// Fig. 11 (b): the template's best on texture, unmodulated, percent.
pub(crate) const FIG11_TEXTURE: f64 = 75.0;
