//! Made-up rows of inputs of known classes, from one seed.

/// Random numbers enough for a test: SplitMix64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Even in (0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// Normal of mean nought and variance one: Box and Muller.
    pub(crate) fn normal(&mut self) -> f64 {
        (-2.0 * self.unit().ln()).sqrt() * (std::f64::consts::TAU * self.unit()).cos()
    }
}

/// A power spectrum of `bands`: a resonance whose place and width depend on
/// the class, each band exponentially distributed, as a spectrum's are; whole
/// numbers up to some millions.
pub(crate) fn spectrum(class: usize, bands: usize, random: &mut Random) -> Vec<f64> {
    let centre = bands as f64 * (0.25 + 0.05 * class as f64);
    let width = bands as f64 * (0.04 + 0.01 * class as f64);
    (0..bands)
        .map(|band| {
            let x = (band as f64 - centre) / width;
            let mean = 50.0 + 200_000.0 / (1.0 + x * x);
            (-mean * random.unit().ln()).round()
        })
        .collect()
}

/// The IMP of `count` vibrissae, each with its own liking for a class, and 20 %
/// of noise; whole numbers.
pub(crate) fn imp(class: usize, count: usize, random: &mut Random) -> Vec<f64> {
    (0..count)
        .map(|i| {
            let liking = 1.0 + 0.3 * (1.7 * i as f64 + 2.3 * class as f64).sin();
            (40_000.0 * liking * (1.0 + 0.2 * random.normal())).round()
        })
        .collect()
}
