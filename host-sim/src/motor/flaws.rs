//! What can be wrong with an encoder that still counts.

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Flaws of an encoder, from the moment on at which they are set: its count does not jump then.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EncoderFlaws {
    /// It counts so many times what it should.
    pub scale: f64,
    /// Share of the counts of protraction that it loses, 0 to 1; it keeps those of retraction, so
    /// the whisker creeps towards protraction.
    pub slip: f64,
    /// Its count is off by so much at most, anew in each tick.
    pub jitter: u16,
}

impl EncoderFlaws {
    /// None.
    pub const NONE: Self = Self {
        scale: 1.0,
        slip: 0.0,
        jitter: 0,
    };

    /// What it counts of an angle.
    pub(super) fn seen(self, turned: f64) -> f64 {
        let seen = self.scale * turned;
        if turned > 0.0 {
            seen * (1.0 - self.slip)
        } else {
            seen
        }
    }
}

/// Where jitter comes from.
#[derive(Debug, Clone)]
pub(super) struct Jitter(Xoshiro256PlusPlus);

impl Default for Jitter {
    fn default() -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(0))
    }
}

impl Jitter {
    /// The next, within `most` counts either way.
    pub(super) fn next(&mut self, most: u16) -> i32 {
        let values = 2 * u64::from(most) + 1;
        (self.0.next_u64() % values) as i32 - i32::from(most)
    }
}
