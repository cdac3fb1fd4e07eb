//! What whisking alone makes a sensor read, predicted from the phase of the whisk.
//!
//! A shaft that is whisked bends by its own inertia: at 8 Hz BIOTACT's middle one reads a fifth of
//! its range in free air, which RCP takes for contact. The same motor commands give the same
//! readings, so that an adaptive filter whose input is a copy of the command predicts them (BIOTACT
//! section V and its reference 39, a filter after the cerebellum). Here the copy is the phase φ of
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
//! whatever the frequency of whisking. What is left of it is an eighth of its curvature over a
//! phase, and a code of rounding. What motors, noise of the oscillator and ringing add that does
//! not repeat from whisk to whisk stays. Phases that are always spent in contact are not learnt,
//! and nothing is predicted there.

/// Phases of a whisk that have a weight.
const PHASES: usize = 64;
/// Bits of a phase below one of [`PHASES`], and those of them that are looked at.
const BELOW_BITS: u32 = 16 - PHASES.ilog2();
const SHARE_BITS: u32 = 8;
/// Bits of a weight below a code.
const FRACTION: u32 = 8;
/// The largest weight: half the range of 14 bits.
const MOST: i32 = 1 << (13 + FRACTION);
/// At the start learning is 2^n times as fast, and no faster than this.
const AT_START: u32 = 3;
const RATE_MOST: u16 = 1 << 15;

/// The weights of one axis of a sensor.
#[derive(Debug, Clone)]
pub struct SelfMotion {
    weights: [i32; PHASES],
    /// Samples of the start that are left.
    start: u16,
}

impl SelfMotion {
    /// One that has learnt nothing, and will by `rate` μ, 2⁻¹⁶.
    pub const fn new(rate: u16) -> Self {
        // As many samples as the time constant of all weights.
        let start = ((PHASES as u32) << 16).checked_div(rate as u32);
        Self {
            weights: [0; PHASES],
            start: match start {
                Some(start) if start < u16::MAX as u32 => start as u16,
                _ => u16::MAX,
            },
        }
    }

    /// μ in 2⁻¹⁶ by which a filter that is asked `tick_hz` times a second learns with this time
    /// constant, s; limited to 1/65536 to 1/2.
    pub fn rate(tau_s: f64, tick_hz: f64) -> u16 {
        let rate = PHASES as f64 / (tau_s * tick_hz) * 65_536.0;
        // A cast of what is beyond saturates, and that of NaN is 0.
        (rate as u16).clamp(1, RATE_MOST)
    }

    /// What whisking alone makes of a sample at `phase`, 2⁻¹⁶ of a whisk: codes from rest, within
    /// ±8192. Learns from the sample, whose code lies within ±8192, by `rate` μ, 2⁻¹⁶ and at most
    /// 1/2, where it `is_in_air`.
    // Apart: a board's program, whose own code is compiled for size, has it compiled for speed.
    #[inline(never)]
    pub fn step(&mut self, code: i16, phase: u16, rate: u16, is_in_air: bool) -> i16 {
        let place = usize::from(phase >> BELOW_BITS);
        let (place, after) = (place % PHASES, (place + 1) % PHASES);
        let share = i32::from(phase >> (BELOW_BITS - SHARE_BITS)) & ((1 << SHARE_BITS) - 1);
        let rest = (1 << SHARE_BITS) - share;
        let (now, next) = (self.weights[place], self.weights[after]);
        // A weight has 22 bits with its sign.
        let sum = now * rest + next * share;
        let predicted = (sum + (1 << (FRACTION + SHARE_BITS - 1))) >> (FRACTION + SHARE_BITS);
        if is_in_air {
            let mut rate = i32::from(rate);
            if self.start > 0 {
                self.start -= 1;
                rate = (rate << AT_START).min(RATE_MOST.into());
            }
            // 15 bits by 15, then 22 by 8.
            let step = ((i32::from(code) - predicted) * rate) >> (16 - FRACTION);
            self.weights[place] = bounded(now + ((step * rest) >> SHARE_BITS));
            self.weights[after] = bounded(next + ((step * share) >> SHARE_BITS));
        }
        predicted as i16
    }

    /// The zero of the sensor has moved by so many codes.
    #[cold]
    pub fn shift(&mut self, by: i16) {
        for weight in &mut self.weights {
            *weight = bounded(*weight - (i32::from(by) << FRACTION));
        }
    }
}

/// A weight within its range: bits may have been flipped.
fn bounded(weight: i32) -> i32 {
    weight.clamp(-MOST, MOST - 1)
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use proptest::prelude::*;

    use super::SelfMotion;

    const HZ: f64 = 2000.0;
    const TAU_S: f64 = 2.0;

    fn new() -> SelfMotion {
        SelfMotion::new(SelfMotion::rate(TAU_S, HZ))
    }

    /// Whisks for so long; what is left of the last second, rms.
    fn left(filter: &mut SelfMotion, whisk_hz: f64, seconds: f64, is_in_air: bool) -> f64 {
        let rate = SelfMotion::rate(TAU_S, HZ);
        let ticks = (seconds * HZ) as u32;
        let mut squares = 0.0;
        for tick in 0..ticks {
            let whisks = f64::from(tick) * whisk_hz / HZ;
            let x = 1500.0 * (TAU * whisks).sin() + 400.0 * (2.0 * TAU * whisks + 0.7).cos();
            let phase = (whisks.fract() * 65_536.0) as u16;
            let predicted = filter.step(x.round() as i16, phase, rate, is_in_air);
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
            let mut filter = SelfMotion { start: 0, ..new() };
            // Of the second that ends after two time constants, the middle is at 1.75.
            let found = left(&mut filter, whisk_hz, 2.0 * TAU_S, true) / all;
            let expected = (-1.75_f64).exp();
            assert!((found / expected - 1.0).abs() < 0.15, "{whisk_hz}: {found}");
            // Between phases, (2 π n/64)²/8 of each harmonic: 1.8 codes of each.
            let last = left(&mut filter, whisk_hz, 30.0 * TAU_S, true);
            assert!(last < 3.0, "{whisk_hz}: {last}");
            // At the start eight times as fast: after one whisk of 1 Hz.
            let start = left(&mut new(), whisk_hz, TAU_S, true) / all;
            assert!(start < 0.15, "{whisk_hz}: {start}");
        }
    }

    #[test]
    fn what_touches_is_not_learnt_and_a_shift_of_the_zero_is_followed() {
        let mut filter = new();
        left(&mut filter, 4.0, 20.0, true);
        let phases = [0, 9_000, 40_000, 65_535];
        let predicts = |filter: &SelfMotion| {
            let predicts = |phase| filter.clone().step(0, phase, 1, false);
            phases.map(predicts)
        };
        let before = predicts(&filter);
        assert!(before.iter().any(|code| code.abs() > 1000), "{before:?}");
        left(&mut filter, 3.0, 5.0, false);
        filter.shift(-100);
        assert_eq!(predicts(&filter), before.map(|code| code + 100));
    }

    proptest! {
        /// Weights between which samples are divided may lie beyond what was felt, but not beyond
        /// what can be.
        #[test]
        fn what_it_predicts_is_a_code(
            samples in prop::collection::vec((-8192_i16..=8191, any::<(u16, bool)>()), 1..500),
            rate in 1_u16..=1 << 15,
        ) {
            let mut filter = SelfMotion::new(rate);
            for (code, (phase, is_in_air)) in samples {
                let predicted = filter.step(code, phase, rate, is_in_air);
                prop_assert!(predicted.abs() <= 8192, "{predicted}");
            }
        }
    }
}
