//! Every duration the module is built on, each with its derivation.
//!
//! Durations are given in seconds or microseconds and become ticks at the scene's tick rate.

use mlx90333::timing::SS_HIGH_US;

use crate::{ButtonLimits, Retry, SensorLimits, SwingLimits, ZeroLimits};

/// How long the last good reading stands in for a missing or faulty one, s.
///
/// Three bad frames in succession at 2 kHz, each with the 2 ms after it in which the sensor
/// is left alone ([`sensor_limits`]); the sensor itself may recompute only every 1.5 ms (its
/// slow mode). Contact changes within 7 ms (a quarter of the period of 35 Hz, the lowest
/// resonance of a 100 mm whisker: BIOTACT section II-C).
pub const HOLD_S: f64 = 0.0075;

/// How far bad ticks may outweigh good ones, s: [`crate::BAD_WEIGHT`] ticks for each of them.
///
/// More than three times the weight of the longest gap that is bridged, so that one alone is
/// none too many; where every second tick is bad, two thirds of this time pass.
pub const BURST_S: f64 = 0.1;

/// How much later in a tick than in another something may happen, us; far more than was ever
/// measured (`docs/measured/deadlines.csv`).
pub const JITTER_US: u32 = 100;

/// How long readings must be good before a whisker with a sensor fault moves again, s.
///
/// 40 ms, two periods of the mains: a line that what hums disturbs only at the
/// peaks is not taken for sound between them.
pub const RECOVER_S: f64 = 0.04;

/// How long a motor rests after a fault before it is tried again, s.
///
/// A stalled winding heats for 0.2 s before it is noticed; with a rest five
/// times as long the mean power stays below a sixth of the stall power.
pub const RETRY_S: f64 = 1.0;

/// Within how long too many faults give a motor up, s.
pub const WINDOW_S: u32 = 60;

/// How long a button's level must last, ms: contacts bounce for a few of them.
pub const BUTTON_SETTLE_MS: u32 = 20;

/// How long a button may be held, ms: whoever leans on it holds it for longer.
pub const BUTTON_LONGEST_MS: u32 = 1_000;

/// What is a press of a button that is asked `tick_hz` times a second.
pub const fn button(tick_hz: u32) -> ButtonLimits {
    ButtonLimits {
        settle: whole_ticks(BUTTON_SETTLE_MS, tick_hz),
        longest: whole_ticks(BUTTON_LONGEST_MS, tick_hz),
    }
}

/// What a sensor's readings cannot do, as the scene has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plausible {
    /// Repeat to the bit for longer than this, s; infinite: no limit.
    pub frozen_s: f64,
    /// Change faster than by this in a second, of the deflection from mid-scale to full
    /// scale; infinite: no limit.
    pub jump_per_s: f64,
}

impl Plausible {
    /// Anything can be: for sensors that are not real.
    pub const ANY: Self = Self {
        frozen_s: f64::INFINITY,
        jump_per_s: f64::INFINITY,
    };
}

/// What is tolerated of a sensor at `tick_hz` ticks a second.
///
/// After a bad frame /SS is high for [`SS_HIGH_US`] and [`JITTER_US`] at least, in whole ticks.
pub const fn sensor_limits(tick_hz: u32, plausible: Plausible) -> SensorLimits {
    // Half of the 65,536 steps of a word are full scale.
    let jump = plausible.jump_per_s * 32_768.0 / tick_hz as f64;
    let (hold, frozen) = (ticks(HOLD_S, tick_hz), ticks(plausible.frozen_s, tick_hz));
    SensorLimits {
        hold,
        // What is held for want of a frame, and what is read again and again, is as good.
        stale: if frozen == u16::MAX { frozen } else { hold },
        recover: ticks(RECOVER_S, tick_hz),
        // At most 33 ticks at the highest rate of a scene.
        resync: ((SS_HIGH_US + JITTER_US) as u64 * tick_hz as u64).div_ceil(1_000_000) as u16,
        frozen,
        // A number too large becomes the largest.
        jump: jump as u16,
        burst: ticks(BURST_S, tick_hz),
        zero: None,
        swing: None,
    }
}

/// When a sensor's zero is found at `tick_hz` ticks a second: in a silence of `after_s`
/// seconds, in which contact π stays below `calm`, as far as `most` codes from mid-scale.
pub const fn zero_limits(tick_hz: u32, after_s: f64, calm: f64, most: u16) -> ZeroLimits {
    ZeroLimits {
        ticks: ticks(after_s, tick_hz),
        most: most.saturating_mul(4),
        calm: (calm * 16_777_216.0) as i32,
    }
}

/// How long whisking is looked at for what it does to a reading, s: two and a half of the slowest
/// whisks for which that is known.
pub const SWING_S: f64 = 2.0;

/// From how wide a whisk on a look tells anything, degrees; its reading moves by two thirds of
/// what a full whisk moves it by.
pub const SWING_DEG: f64 = 30.0;

/// What whisking must do to a reading at `tick_hz` ticks a second: move x by `codes`, where it is
/// [`SWING_DEG`] wide by an encoder of so many degrees a count.
pub fn swing_limits(tick_hz: u32, codes: u16, degrees_per_count: f64) -> SwingLimits {
    SwingLimits {
        ticks: ticks(SWING_S, tick_hz),
        counts: (SWING_DEG / degrees_per_count) as u32,
        least: codes.saturating_mul(4),
    }
}

/// What is done after a fault of a motor at `tick_hz` ticks a second.
pub const fn retry(tick_hz: u32) -> Retry {
    Retry {
        rest: ticks(RETRY_S, tick_hz),
        window: WINDOW_S.saturating_mul(tick_hz),
    }
}

/// How long the pin of decisions is high after one, ms: long enough for who looks a hundred times a
/// second. Of a level that changed with each decision one could be missed.
pub const DECIDED_MS: u32 = 10;

/// `seconds` in ticks, at `tick_hz` of them a second; at least one, at most `u16::MAX`.
pub const fn ticks(seconds: f64, tick_hz: u32) -> u16 {
    let ticks = seconds * tick_hz as f64 + 0.5;
    if ticks < 1.0 {
        1
    } else if ticks > u16::MAX as f64 {
        u16::MAX
    } else {
        ticks as u16
    }
}

/// As [`ticks`], of milliseconds: for a board, which has no time for numbers of 64 bits.
pub const fn whole_ticks(milliseconds: u32, tick_hz: u32) -> u16 {
    let ticks = milliseconds.saturating_mul(tick_hz).saturating_add(500) / 1_000;
    if ticks == 0 {
        1
    } else if ticks > u16::MAX as u32 {
        u16::MAX
    } else {
        ticks as u16
    }
}

#[cfg(test)]
mod tests {
    use super::{BURST_S, HOLD_S, Plausible, RETRY_S, sensor_limits, ticks, whole_ticks};
    use crate::BAD_WEIGHT;
    use mlx90333::timing::SS_HIGH_US;

    #[test]
    fn durations_become_ticks_at_any_rate() {
        assert_eq!(ticks(HOLD_S, 2_000), 15);
        assert_eq!(ticks(HOLD_S, 200), 2);
        assert_eq!(ticks(RETRY_S, 20_000), 20_000);
        assert_eq!(ticks(1e-9, 200), 1);
        assert_eq!(ticks(1e9, 200), u16::MAX);
        for tick_hz in [200, 333, 2_000, 20_000] {
            for milliseconds in [0, 1, 10, 20, 1_000, 10_000] {
                let same = ticks(f64::from(milliseconds) / 1e3, tick_hz);
                assert_eq!(whole_ticks(milliseconds, tick_hz), same);
            }
        }
        assert_eq!(whole_ticks(u32::MAX, u32::MAX), u16::MAX);
    }

    #[test]
    fn a_sensor_is_left_alone_for_long_enough_and_bridged_for_longer() {
        for tick_hz in 200..=2_100 {
            let limits = sensor_limits(tick_hz, Plausible::ANY);
            // From the tick that finds the frame bad to the one that starts the next.
            let rest_us = u32::from(limits.resync) * 1_000_000 / tick_hz;
            assert!(rest_us > SS_HIGH_US, "{tick_hz} Hz: {rest_us} us");
            assert!(limits.hold > limits.resync, "{tick_hz} Hz");
            assert!(limits.burst > limits.hold * BAD_WEIGHT, "{tick_hz} Hz");
            assert_eq!([limits.frozen, limits.jump], [u16::MAX; 2]);
        }
        assert_eq!(ticks(BURST_S, 2_000), 200);
        let plausible = Plausible {
            frozen_s: 0.25,
            jump_per_s: 1_500.0,
        };
        let limits = sensor_limits(2_000, plausible);
        let found = [limits.frozen, limits.jump, limits.resync];
        assert_eq!(found, [500, 24_576, 4]);
    }
}
