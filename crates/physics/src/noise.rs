//! Seeded Gaussian numbers.

use core::f64::consts::TAU;

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// A source of independent standard normal numbers. The same seed gives the
/// same numbers on every machine.
#[derive(Debug, Clone)]
pub struct Noise {
    random: Xoshiro256PlusPlus,
    spare: Option<f64>,
}

impl Noise {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        Self {
            random: Xoshiro256PlusPlus::seed_from_u64(seed),
            spare: None,
        }
    }

    /// A number that is uniform in (0, 1]: the upper 53 bits, plus one.
    pub fn uniform(&mut self) -> f64 {
        ((self.random.next_u64() >> 11) + 1) as f64 / (1_u64 << 53) as f64
    }

    /// The next number, at most 8.6 in size.
    #[expect(clippy::should_implement_trait, reason = "the stream has no end")]
    pub fn next(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let [number, spare] = box_muller([self.uniform(), self.uniform()]);
        self.spare = Some(spare);
        number
    }
}

/// Two independent standard normal numbers from two uniform ones, the first in
/// (0, 1], the second in \[0, 1\]: √(−2 ln u₁) times cosine and sine of 2π u₂
/// (Box and Muller 1958).
pub fn box_muller([first, second]: [f64; 2]) -> [f64; 2] {
    let radius = (-2.0 * libm::log(first)).sqrt();
    let (sine, cosine) = libm::sincos(TAU * second);
    [radius * cosine, radius * sine]
}

#[cfg(test)]
mod tests {
    use super::Noise;

    #[test]
    fn moments_are_those_of_a_standard_normal_and_successors_independent() {
        let mut noise = Noise::new(5);
        let count = 1_000_000;
        let (mut moments, mut product, mut last) = ([0.0; 4], 0.0, 0.0);
        for _ in 0..count {
            let x = noise.next();
            for (k, moment) in (1..).zip(&mut moments) {
                *moment += x.powi(k) / f64::from(count);
            }
            product += x * last / f64::from(count);
            last = x;
        }
        // Four standard errors of the fourth moment, √96/1000, are 0.04.
        for (found, expected) in moments.into_iter().zip([0.0, 1.0, 0.0, 3.0]) {
            assert!((found - expected).abs() < 0.04, "{moments:?}");
        }
        assert!(product.abs() < 0.004, "{product}");
    }
}
