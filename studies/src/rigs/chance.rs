//! Chance in a rig, from a seed: the same seed gives the same trial anywhere.

use physics::box_muller;
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

#[derive(Debug, Clone)]
pub(crate) struct Chance(Xoshiro256PlusPlus);

/// The seed of a part: `parts` name it within what `seed` belongs to. Two different lists of parts
/// give unrelated seeds (splitmix64's finaliser after each part).
pub(crate) fn seed_of(seed: u64, parts: &[u64]) -> u64 {
    let parts = parts.iter().map(|part| mix(*part));
    parts.fold(mix(seed), |state, part| mix(state ^ part))
}

fn mix(x: u64) -> u64 {
    let mut z = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Chance {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    pub(crate) fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// One of `count`; 0 if there is none.
    pub(crate) fn among(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count.saturating_sub(1))
    }

    pub(crate) fn normal(&mut self) -> f64 {
        let [normal, _] = box_muller([1.0 - self.unit(), self.unit()]);
        normal
    }

    /// The numbers from 0 to `count` − 1 in any order.
    pub(crate) fn order(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        self.shuffle(&mut order);
        order
    }

    /// Puts `all` in any order (Fisher and Yates).
    pub(crate) fn shuffle<T>(&mut self, all: &mut [T]) {
        for last in (1..all.len()).rev() {
            all.swap(last, self.among(last + 1));
        }
    }
}

/// A smooth random value about zero: white noise through two first-order lags,
/// so that it has a velocity.
#[derive(Debug, Clone)]
pub(crate) struct Wander {
    keep: f64,
    drive: f64,
    lags: [f64; 2],
}

impl Wander {
    /// Of standard deviation `sd` and time constant `tau_s` of each lag, stepped by `dt_s`.
    ///
    /// Two equal discrete lags a of unit white noise leave the variance
    /// (1 − a)⁴ (1 + a²)/(1 − a²)³.
    pub(crate) fn new(sd: f64, tau_s: f64, dt_s: f64) -> Self {
        let keep = libm::exp(-dt_s / tau_s.max(1e-9));
        let give = 1.0 - keep;
        let left = give.powi(4) * (1.0 + keep * keep) / (1.0 - keep * keep).powi(3);
        Self {
            keep,
            drive: sd / left.sqrt(),
            lags: [0.0; 2],
        }
    }

    pub(crate) fn step(&mut self, chance: &mut Chance) -> f64 {
        let [first, second] = &mut self.lags;
        let noise = self.drive * chance.normal();
        *first = self.keep * *first + (1.0 - self.keep) * noise;
        *second = self.keep * *second + (1.0 - self.keep) * *first;
        *second
    }
}

#[cfg(test)]
mod tests {
    use super::{Chance, Wander};

    #[test]
    fn the_wander_has_the_stated_spread() {
        let mut chance = Chance::new(3);
        let mut wander = Wander::new(2.0, 0.02, 0.001);
        let mut squares = 0.0;
        for _ in 0..200 {
            wander.step(&mut chance);
        }
        let count = 400_000;
        for _ in 0..count {
            squares += wander.step(&mut chance).powi(2);
        }
        // Some 7000 independent values: the spread is known to 1 %.
        let sd = (squares / f64::from(count)).sqrt();
        assert!((sd - 2.0).abs() < 0.06, "{sd}");
    }
}
