//! What whisking alone makes a sensor read, predicted from the phase of the whisk and subtracted.
//!
//! A shaft that is whisked bends by its own inertia: at 8 Hz a long one reads a fifth of its range
//! in free air, which RCP takes for contact. The same motor commands give the same readings, so
//! that an adaptive filter whose input is a copy of the command predicts them (BIOTACT section V
//! and its reference 39, an adaptive filter after the cerebellum). Here the copy is the phase φ of
//! the oscillator, and the filter has a weight w for each of 64 phases:
//!
//! ```text
//! p = (1 − s) w[k] + s w[k+1]             prediction; k + s = 64 φ, 0 ≤ s < 1
//! e = x − p                               what is left: contact, vibration, noise
//! w[k] += μ (1 − s) e,  w[k+1] += μ s e   least mean squares
//! ```
//!
//! A weight is a code with 8 bits below one. Nothing is learnt while something touches; in the
//! first time constant that is spent in the air learning is eight times as fast.
//!
//! # Error
//!
//! A reading that depends on the phase alone is learnt with the time constant 64/(μ f_tick),
//! whatever the frequency of whisking. What is left of it is a sixth of its curvature over a phase,
//! and half a code of rounding. What motors, noise of the oscillator and ringing add that does not
//! repeat from whisk to whisk stays.

/// Phases of a whisk that have a weight.
const PHASES: usize = 64;
/// Bits of a phase below one of [`PHASES`] that are looked at, and all of them.
const SHARE_BITS: u32 = 8;
const BELOW_BITS: u32 = 16 - PHASES.ilog2();
/// Bits of a weight below a code.
const FRACTION: u32 = 8;
/// The largest weight: half the range of 14 bits.
const MOST: i32 = 1 << (13 + FRACTION);
/// At the start learning is 2^n times as fast, and no faster than this.
const AT_START: u32 = 3;
const RATE_MOST: u16 = 1 << 15;

/// The weights of the two axes of one sensor.
#[derive(Debug, Clone)]
pub struct SelfMotion {
    weights: [[i32; 2]; PHASES],
    /// Samples of the start that have been.
    seen: u16,
}

impl Default for SelfMotion {
    fn default() -> Self {
        Self::new()
    }
}

impl SelfMotion {
    /// One that has learnt nothing.
    pub const fn new() -> Self {
        Self {
            weights: [[0; 2]; PHASES],
            seen: 0,
        }
    }

    /// The start begins again, with what was learnt.
    pub const fn restart(&mut self) {
        self.seen = 0;
    }

    /// μ in 2⁻¹⁶ by which a filter that is asked `tick_hz` times a second learns with this time
    /// constant, s; limited to 1/65536 to 1/2.
    pub fn rate(tau_s: f64, tick_hz: f64) -> u16 {
        let rate = PHASES as f64 / (tau_s * tick_hz) * 65_536.0;
        // A cast of what is beyond saturates, and that of NaN is 0.
        (rate as u16).clamp(1, RATE_MOST)
    }

    /// What whisking alone makes of a sample at `phase`, 2⁻¹⁶ of a whisk, codes from rest within
    /// ±8192; learns from the sample, whose codes lie within ±8192, by `rate` μ, 2⁻¹⁶ and at most
    /// 1/2, where it `is_in_air`.
    // Apart: a board's program, whose own code is compiled for size, has it compiled for speed.
    #[inline(never)]
    pub fn step(&mut self, codes: [i16; 2], phase: u16, rate: u16, is_in_air: bool) -> [i16; 2] {
        // As long as the time constant of 64 weights.
        let is_start = u32::from(self.seen) * u32::from(rate) < (PHASES as u32) << 16;
        let rate = if !is_in_air {
            0
        } else if is_start && self.seen < u16::MAX {
            self.seen += 1;
            (u32::from(rate) << AT_START).min(RATE_MOST.into()) as i32
        } else {
            rate.into()
        };
        let place = usize::from(phase >> BELOW_BITS);
        let share = i32::from(phase >> (BELOW_BITS - SHARE_BITS)) & ((1 << SHARE_BITS) - 1);
        let rest = (1 << SHARE_BITS) - share;
        let (mut now, mut next) = (
            self.weights[place % PHASES],
            self.weights[(place + 1) % PHASES],
        );
        let mut predicted = [0; 2];
        for axis in 0..2 {
            // A weight has 22 bits with its sign.
            let sum = now[axis] * rest + next[axis] * share;
            let code = (sum + (1 << (FRACTION + SHARE_BITS - 1))) >> (FRACTION + SHARE_BITS);
            predicted[axis] = code as i16;
            // 15 bits by 15, then 22 by 8.
            let step = ((i32::from(codes[axis]) - code) * rate) >> (16 - FRACTION);
            now[axis] = bounded(now[axis] + ((step * rest) >> SHARE_BITS));
            next[axis] = bounded(next[axis] + ((step * share) >> SHARE_BITS));
        }
        if rate > 0 {
            self.weights[place % PHASES] = now;
            self.weights[(place + 1) % PHASES] = next;
        }
        predicted
    }

    /// The zero of the sensor has moved by so many codes.
    #[cold]
    pub fn shift(&mut self, by: [i16; 2]) {
        for weight in &mut self.weights {
            for (weight, by) in weight.iter_mut().zip(by) {
                *weight = bounded(*weight - (i32::from(by) << FRACTION));
            }
        }
    }
}

/// A weight within its range: bits may have been flipped.
const fn bounded(weight: i32) -> i32 {
    if weight < -MOST {
        -MOST
    } else if weight >= MOST {
        MOST - 1
    } else {
        weight
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use proptest::prelude::*;

    use super::SelfMotion;

    const HZ: f64 = 2000.0;
    const TAU_S: f64 = 2.0;

    /// Whisks for so long; what is left of the last second, rms of x.
    fn left(filter: &mut SelfMotion, whisk_hz: f64, seconds: f64, is_in_air: bool) -> f64 {
        let rate = SelfMotion::rate(TAU_S, HZ);
        let ticks = (seconds * HZ) as u32;
        let mut squares = 0.0;
        for tick in 0..ticks {
            let whisks = f64::from(tick) * whisk_hz / HZ;
            let x = 1500.0 * (TAU * whisks).sin() + 400.0 * (2.0 * TAU * whisks + 0.7).cos();
            let codes = [x.round() as i16, (x / -3.0).round() as i16];
            let phase = (whisks.fract() * 65_536.0) as u16;
            let [predicted, _] = filter.step(codes, phase, rate, is_in_air);
            if tick + HZ as u32 >= ticks {
                squares += (x - f64::from(predicted)).powi(2);
            }
        }
        (squares / HZ).sqrt()
    }

    #[test]
    fn what_repeats_is_learnt_with_its_time_constant_at_any_frequency() {
        // The reading before anything is learnt.
        let all = (1500_f64.powi(2) / 2.0 + 400_f64.powi(2) / 2.0).sqrt();
        for whisk_hz in [1.0, 2.0, 4.0, 8.0, 14.0] {
            let mut filter = SelfMotion {
                seen: u16::MAX,
                ..SelfMotion::new()
            };
            // Of the second that ends after two time constants, the middle is at 1.75.
            let found = left(&mut filter, whisk_hz, 2.0 * TAU_S, true) / all;
            let expected = (-1.75_f64).exp();
            assert!((found / expected - 1.0).abs() < 0.15, "{whisk_hz}: {found}");
            // Between phases, (2 π n/64)²/12 of each harmonic: 1.2 codes of the first.
            let last = left(&mut filter, whisk_hz, 30.0 * TAU_S, true);
            assert!(last < 3.0, "{whisk_hz}: {last}");
            // At the start eight times as fast: after one whisk of 1 Hz.
            let start = left(&mut SelfMotion::new(), whisk_hz, TAU_S, true) / all;
            assert!(start < 0.15, "{whisk_hz}: {start}");
        }
    }

    #[test]
    fn what_touches_is_not_learnt_and_a_shift_of_the_zero_is_followed() {
        let mut filter = SelfMotion::new();
        left(&mut filter, 4.0, 20.0, true);
        let predicts = |filter: &SelfMotion, phase| filter.clone().step([0, 0], phase, 1, false);
        let phases = [0, 9_000, 40_000, 65_535];
        let before = phases.map(|phase| predicts(&filter, phase));
        left(&mut filter, 3.0, 5.0, false);
        filter.shift([100, -30]);
        let after = phases.map(|phase| predicts(&filter, phase));
        for ([x, y], later) in before.into_iter().zip(after) {
            assert_eq!(later, [x - 100, y + 30]);
        }
    }

    proptest! {
        #[test]
        fn whatever_comes_it_predicts_within_the_range(
            samples in prop::collection::vec((any::<[i16; 2]>(), any::<u16>(), any::<bool>()), 1..500),
            rate in 1_u16..=1 << 15,
        ) {
            let mut filter = SelfMotion::new();
            for (codes, phase, is_in_air) in samples {
                let codes = codes.map(|code| code.clamp(-8192, 8191));
                let predicted = filter.step(codes, phase, rate, is_in_air);
                prop_assert!(predicted.iter().all(|code| code.abs() <= 8192), "{predicted:?}");
            }
        }

        #[test]
        fn what_it_predicts_lies_within_what_it_was_given(
            samples in prop::collection::vec((-3000_i16..3000, any::<u16>()), 1..500),
            rate in 1_u16..=1 << 15,
        ) {
            let mut filter = SelfMotion::new();
            for (code, phase) in samples {
                let [predicted, _] = filter.step([code, 0], phase, rate, true);
                prop_assert!(predicted.abs() <= 3001, "{predicted}");
            }
        }
    }
}
