//! Stall detection: driven hard, not moving, for too long.

use serde::{Deserialize, Serialize};

use super::Duty;

/// When a motor counts as stalled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
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

/// Whether a motor moves when it is driven.
///
/// [`SixStep`](super::SixStep) has one inside. A motor on an [`HBridge`](super::HBridge) gives no
/// sign of motion itself: there the control loop looks at the encoder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StallGuard {
    /// Ticks in succession, driven hard and not moving.
    still: u16,
}

impl StallGuard {
    /// One tick, with the duty driven and whether the motor moved. True when
    /// stalled, from the tick that completes the configured number until
    /// the motor moves or the duty falls to the threshold.
    #[inline]
    pub fn update(&mut self, config: StallConfig, duty: Duty, moved: bool) -> bool {
        let is_still = !moved && duty.magnitude() > config.threshold.magnitude();
        self.still = if is_still {
            self.still.saturating_add(1)
        } else {
            0
        };
        self.still >= config.ticks.max(1)
    }
}
