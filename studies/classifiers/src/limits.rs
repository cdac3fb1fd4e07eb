//! The largest classifiers that there can be.

/// Most points of a spectrum's transform.
pub const MAX_POINTS: u32 = 1 << 24;
/// Most inputs of a network.
pub const MAX_INPUTS: usize = 4096;
/// Most hidden units.
pub const MAX_HIDDEN: usize = 1024;
/// Most outputs, that is classes.
pub const MAX_OUTPUTS: usize = 256;
/// Largest weight or bias: with [`MAX_SCALED`] and [`MAX_INPUTS`], a drive
/// stays below 2⁴³, far from what an f32 can hold.
pub const MAX_WEIGHT: f32 = 1_048_576.0;
/// Largest scaled input, standard deviations; what lies beyond counts as this.
pub const MAX_SCALED: f32 = 1024.0;
