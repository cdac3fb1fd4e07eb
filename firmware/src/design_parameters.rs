//! Every duration the module is built on, each with its derivation.
//!
//! Durations are given in seconds or microseconds and become ticks at the
//! scene's tick rate.

use crate::{ButtonLimits, HoldLimits, Retry};

/// How long the last good reading stands in for a missing or faulty one, s.
///
/// The sensor may recompute only every 1.5 ms (its slow mode), and a disturbed
/// frame costs one tick; contact changes within 7 ms (a quarter of the period
/// of 35 Hz, the lowest resonance of a 100 mm whisker: BIOTACT section II-C).
pub const HOLD_S: f64 = 0.005;

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

/// How long a button's level must last, s: contacts bounce for a few milliseconds.
pub const BUTTON_SETTLE_S: f64 = 0.02;

/// How long a button may be held, s: whoever leans on it holds it for longer.
pub const BUTTON_LONGEST_S: f64 = 1.0;

/// What is a press of a button that is asked `tick_hz` times a second.
pub const fn button(tick_hz: u32) -> ButtonLimits {
    ButtonLimits {
        settle: ticks(BUTTON_SETTLE_S, tick_hz),
        longest: ticks(BUTTON_LONGEST_S, tick_hz),
    }
}

/// For how long readings are held at `tick_hz` ticks a second.
pub const fn hold_limits(tick_hz: u32) -> HoldLimits {
    HoldLimits {
        hold: ticks(HOLD_S, tick_hz),
        recover: ticks(RECOVER_S, tick_hz),
    }
}

/// What is done after a fault of a motor at `tick_hz` ticks a second.
pub const fn retry(tick_hz: u32) -> Retry {
    Retry {
        rest: ticks(RETRY_S, tick_hz),
        window: WINDOW_S.saturating_mul(tick_hz),
    }
}

/// `seconds` in ticks of a module that runs `tick_hz` times a second; at least
/// one, at most `u16::MAX`.
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

#[cfg(test)]
mod tests {
    use super::{HOLD_S, RETRY_S, ticks};

    #[test]
    fn durations_become_ticks_at_any_rate() {
        assert_eq!(ticks(HOLD_S, 2_000), 10);
        assert_eq!(ticks(HOLD_S, 200), 1);
        assert_eq!(ticks(RETRY_S, 20_000), 20_000);
        assert_eq!(ticks(1e-9, 200), 1);
        assert_eq!(ticks(1e9, 200), u16::MAX);
    }
}
