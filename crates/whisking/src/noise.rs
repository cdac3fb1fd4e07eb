//! The oscillators' noise (BIOTACT eq. 5): seeded white Gaussian numbers through H50.
//!
//! Gaussian numbers come from the inverse of the normal distribution function,
//! tabulated at a constant number of points per octave of probability and
//! interpolated linearly. Each takes one random word, a count of leading zeros
//! and a multiplication, in integers: the numbers are the same on every machine.

use heapless::Vec;
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;
use serde::{Deserialize, Serialize};

use crate::filter::{self, CORNER_HZ};
use crate::list::listed;
use crate::math::constant::exp;
use crate::oscillator::Psi;
use crate::{Error, MAX_SIDES, Real};

/// The tick rate at which σ_η is defined (BIOTACT: T = 500 µs), Hz. White noise
/// of one variance per tick has a spectral density that falls with the tick rate;
/// the amplitude is scaled so that the noise below 50 Hz is the papers' at any rate.
pub const REFERENCE_TICK_HZ: f64 = 2000.0;

const SEGMENTS: usize = 8;
const OCTAVES: usize = 20;
const POINTS: usize = (OCTAVES + 1) * SEGMENTS + 1;
const Q24: f64 = 16_777_216.0;

/// −Φ⁻¹(u) in Q24 at u = 2^-(k+1) (1 − j/16), k octaves of eight points, from
/// u = ½ down to 2^-21 (4.9 standard deviations); the octave beyond is level.
static QUANTILES: [i32; POINTS] = quantiles();

/// d(−Φ⁻¹)/d(−u) = √(2π) exp(x²/2), the inverse of the normal density.
const fn slope(x: f64) -> f64 {
    2.506_628_274_631_000_5 * exp(x * x / 2.0)
}

/// Integrates the quantile function down from the median with classical
/// Runge-Kutta steps; error at most 1e-6 everywhere in the table.
const fn quantiles() -> [i32; POINTS] {
    let mut table = [0; POINTS];
    let mut x = 0.0;
    let mut top = 0.5;
    let mut i = 0;
    while i < OCTAVES * SEGMENTS {
        let h = top / 16.0 / 16.0;
        let mut n = 0;
        while n < 16 {
            let k1 = slope(x);
            let k2 = slope(x + h / 2.0 * k1);
            let k3 = slope(x + h / 2.0 * k2);
            let k4 = slope(x + h * k3);
            x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            n += 1;
        }
        i += 1;
        table[i] = (x * Q24 + 0.5) as i32;
        if i % SEGMENTS == 0 {
            top /= 2.0;
        }
    }
    while i < POINTS - 1 {
        table[i + 1] = table[i];
        i += 1;
    }
    table
}

/// A standard normal number in Q24 from a uniformly distributed word; largest
/// error of the quantile 2e-3 standard deviations, largest magnitude 4.9.
fn normal_q24(word: u32) -> i32 {
    let uniform = word & !1;
    let octave = (uniform.leading_zeros() as usize).min(OCTAVES);
    // The bits below the leading one, from the top of the octave down.
    let fraction = !(uniform << octave);
    let segment = (fraction >> 28) as usize % SEGMENTS;
    // Its next 24 bits, a fraction of 2³².
    let within = u64::from((fraction << 4) & !0xFF);
    let lo = QUANTILES[octave * SEGMENTS + segment];
    let hi = QUANTILES[octave * SEGMENTS + segment + 1];
    let magnitude = lo + ((u64::from((hi - lo) as u32) * within) >> 32) as i32;
    if word & 1 == 0 { magnitude } else { -magnitude }
}

/// Amplitude and filter of the noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Config<R: Real> {
    /// 4 T σ_η √(tick rate/2 kHz): the filter's input is a quarter of η, because
    /// fixed point cannot hold 4.9.
    pub amplitude: R::Fine,
    /// H50 at this tick rate.
    pub filter: filter::Config<R>,
}

/// The random generator, and a filter for each state of the oscillators.
#[derive(Debug, Clone)]
pub struct State<R> {
    pub(crate) random: Xoshiro128PlusPlus,
    pub(crate) filters: Vec<[filter::State<R>; 2], MAX_SIDES>,
}

impl<R: Real> Config<R> {
    /// `sigma` is σ_η, per second; the tick rate must leave room for 50 Hz.
    pub(crate) fn new(sigma: f64, tick_hz: f64) -> Result<Self, Error> {
        let amplitude = 4.0 * sigma / tick_hz * libm::sqrt(tick_hz / REFERENCE_TICK_HZ);
        Ok(Self {
            amplitude: R::fine(amplitude),
            filter: filter::Config::new(CORNER_HZ, tick_hz)?,
        })
    }

    /// T P_i of this tick for each state of the oscillators, by sides, into `out`; a side that
    /// there is not stays as it was.
    #[inline]
    pub fn step(&self, state: &mut State<R>, out: &mut [Psi<R>; MAX_SIDES]) {
        let State { random, filters } = state;
        // All are drawn first: beside a filter there are not registers enough for the generator.
        let mut white = [[0; 2]; MAX_SIDES];
        let mut drawn = 0;
        for white in white.iter_mut().take(filters.len()) {
            for white in white {
                let word = random.next_u32();
                drawn |= word;
                *white = normal_q24(word) >> 2;
            }
        }
        for ((out, filters), white) in out.iter_mut().zip(filters).zip(&white) {
            for ((out, filter), white) in out.iter_mut().zip(filters).zip(white) {
                let coloured = self.filter.process(filter, R::from_q24(*white));
                *out = coloured.times_fine(self.amplitude);
            }
        }
        if drawn == 0 {
            // Its only state that it never leaves; otherwise once in 2^64 draws of two words.
            *random = Xoshiro128PlusPlus::seed_from_u64(0);
        }
    }
}

impl<R: Real> State<R> {
    /// For so many sides, 0 to 2; a larger number is taken as 2. The same seed gives the same
    /// noise.
    pub fn new(sides: usize, seed: u64) -> Self {
        // A constant where no noise is computed, so that its seeding is not linked.
        let seed = if cfg!(feature = "noise") { seed } else { 0 };
        let both = [[filter::State::default(); 2]; MAX_SIDES];
        Self {
            random: Xoshiro128PlusPlus::seed_from_u64(seed),
            filters: listed(both.into_iter().take(sides)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Config, OCTAVES, Q24, QUANTILES, SEGMENTS, State, normal_q24};
    use rand_core::Rng;

    /// Φ(x) = erfc(−x/√2)/2.
    fn distribution(x: f64) -> f64 {
        libm::erfc(-x / core::f64::consts::SQRT_2) / 2.0
    }

    #[test]
    fn the_table_inverts_the_normal_distribution() {
        for (i, &q) in QUANTILES.iter().enumerate().take(OCTAVES * SEGMENTS + 1) {
            let (octave, segment) = (i / SEGMENTS, i % SEGMENTS);
            let u = 0.5_f64.powi(octave as i32 + 1) * (1.0 - segment as f64 / 16.0);
            let back = distribution(-f64::from(q) / Q24);
            assert!((back / u - 1.0).abs() < 1e-5, "{i}: {back} {u}");
        }
    }

    #[test]
    fn words_map_monotonically_to_quantiles() {
        for i in 1..100_000_u32 {
            let word = i.wrapping_mul(42_949) | 1;
            let u = (f64::from(word >> 1) + 0.5) / 2.0_f64.powi(32);
            let x = f64::from(normal_q24(word & !1)) / Q24;
            if u > 1e-5 {
                // The quantile's error of 2e-3 as one of probability.
                let density = (-x * x / 2.0).exp() / 2.506_628;
                let error = (distribution(-x) - u).abs();
                assert!(error < 2e-3 * density + 1e-9, "{word}: {x} {u}");
            }
        }
        assert_eq!(normal_q24(0), *QUANTILES.last().unwrap());
        assert_eq!(normal_q24(7), -normal_q24(6));
    }

    /// All zeros is the only state that the generator never leaves.
    #[test]
    fn a_generator_that_stands_still_begins_again() {
        let config = Config::<f32>::new(0.05, 2_000.0).unwrap();
        let mut state = State::<f32>::new(1, 1);
        state.random = serde_json::from_str(r#"{"s":[0,0,0,0]}"#).unwrap();
        config.step(&mut state, &mut Default::default());
        let words: Vec<u32> = (0..1_000).map(|_| state.random.next_u32()).collect();
        let ones = words.iter().map(|word| word.count_ones()).sum::<u32>();
        // 32,000 bits, whose number of ones has a standard deviation of 89.
        assert!(ones.abs_diff(16_000) < 450, "{ones}");
    }

    #[test]
    fn the_noise_below_the_corner_does_not_depend_on_the_tick_rate() {
        // Variance of the random walk it causes in one second, σ² T_ref: (σ_η)² / 2000 Hz.
        for tick_hz in [500.0, 2_000.0, 8_000.0] {
            let config = Config::<f64>::new(0.005, tick_hz).unwrap();
            let mut state = State::<f64>::new(1, 11);
            let mut squares = 0.0;
            let mut out = Default::default();
            let seconds = 2_000;
            for _ in 0..seconds {
                let mut sum = 0.0;
                for _ in 0..tick_hz as usize {
                    config.step(&mut state, &mut out);
                    sum += out[0][0];
                }
                squares += sum * sum / f64::from(seconds);
            }
            let share = squares / (0.005 * 0.005 / 2_000.0);
            assert!((share - 1.0).abs() < 0.12, "{tick_hz}: {share}");
        }
    }
}
