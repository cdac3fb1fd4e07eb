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

/// What Figs. 6 to 9 set: forward Euler, 2 kHz, 2 Hz, no noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Figure {
    pub(crate) gain: f64,
    /// RCP: σ_z, and τ_z as a share of the whisk period.
    pub(crate) rcp: Option<(f64, f64)>,
    /// CIA: σ_g, and τ_g as a share of the whisk period.
    pub(crate) cia: Option<(f64, f64)>,
    /// Whether there are obstacles at [`OBSTACLES_DEG`].
    pub(crate) obstacles: bool,
}

/// Free whisking; the paper's gains are [`FIG6_GAINS`].
pub(crate) const FIG6: Figure = Figure {
    gain: 2.0,
    rcp: None,
    cia: None,
    obstacles: false,
};
pub(crate) const FIG7: Figure = Figure {
    gain: 1.0,
    rcp: Some((0.7, 0.25)),
    cia: None,
    obstacles: true,
};
/// Strong and fast RCP.
pub(crate) const FIG8: Figure = Figure {
    rcp: Some(STRONG),
    ..FIG7
};
pub(crate) const FIG9: Figure = Figure {
    cia: Some((0.5, 0.25)),
    ..FIG7
};
pub(crate) const FIG6_GAINS: [f64; 4] = [0.5, 1.0, 1.5, 2.0];
/// σ_z and τ_z, as a share of the whisk period, of strong and fast RCP (Fig. 8).
pub(crate) const STRONG: (f64, f64) = (2.0, 0.1);
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
