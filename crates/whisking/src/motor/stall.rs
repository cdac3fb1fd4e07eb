//! Stall detection: driven hard, not moving, for too long.

use super::Duty;

/// When a motor counts as stalled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "bake", derive(databake::Bake), databake(path = whisking::motor))]
pub struct StallConfig {
    /// Ticks in succession, driven and not moving, after which it is a stall;
    /// 0 is taken as 1. 400 is 0.2 s at 2000 Hz.
    pub ticks: u16,
    /// Only a duty of larger magnitude counts (the sign is ignored):
    /// [`Duty::ZERO`] counts any drive, [`Duty::FULL`] switches the guard off.
    pub threshold: Duty,
}

impl StallConfig {
    /// Half of full drive for 0.2 s at 2000 Hz: longer than the pause at a
    /// whisk's turning point, shorter than a small winding takes to overheat.
    /// A choice to be checked on the motor used, not a data-sheet figure.
    pub const DEFAULT: Self = Self {
        ticks: 400,
        threshold: Duty::from_q15(16_384),
    };
}

impl Default for StallConfig {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Counts the ticks for which a motor has been driven without moving.
///
/// [`SixStep`](super::SixStep) has one inside. A motor on an
/// [`HBridge`](super::HBridge) gives no sign of motion itself: there the
/// control loop owns the guard and feeds it from the encoder, with `moved`
/// meaning *further than the count or two by which a rotor standing on an
/// encoder edge flickers*.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StallGuard {
    config: StallConfig,
    still: u16,
}

impl StallGuard {
    /// A guard that has seen nothing yet.
    pub const fn new(config: StallConfig) -> Self {
        Self { config, still: 0 }
    }

    /// Takes in one tick: the duty driven and whether the motor moved. True
    /// when stalled, from the tick that completes the configured number until
    /// the motor moves or the duty falls to the threshold.
    #[inline]
    pub fn update(&mut self, duty: Duty, moved: bool) -> bool {
        self.still = if moved || duty.magnitude() <= self.config.threshold.magnitude() {
            0
        } else {
            self.still.saturating_add(1)
        };
        self.still >= self.config.ticks.max(1)
    }

    /// Forgets what it has seen.
    pub fn reset(&mut self) {
        self.still = 0;
    }
}
