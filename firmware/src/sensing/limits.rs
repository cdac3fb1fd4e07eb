//! What is tolerated of a sensor.

use serde::{Deserialize, Serialize};

use super::swing::SwingLimits;
use crate::zero::ZeroLimits;

/// In ticks but for `jump`; `u16::MAX` is no limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SensorLimits {
    /// Ticks without a good frame for which the last reading is held.
    pub hold: u16,
    /// Good frames in succession before a faulty sensor is trusted again.
    pub recover: u16,
    /// Ticks in which no frame is begun after one that was refused or broke off.
    pub resync: u16,
    /// Ticks for which the words may repeat to the bit and still be evidence.
    pub stale: u16,
    /// Ticks for which they may repeat.
    pub frozen: u16,
    /// Largest change of a word in a tick, of its 65,536 steps.
    pub jump: u16,
    /// Most bad ticks: each counts [`BAD_WEIGHT`], each with a good frame takes 1 away.
    pub burst: u16,
    /// When its zero is found; `None`: it is mid-scale.
    pub zero: Option<ZeroLimits>,
    /// What whisking must do to it, where that is known.
    pub swing: Option<SwingLimits>,
}

impl SensorLimits {
    /// Anything is tolerated for as long as it lasts; one good frame ends a fault.
    pub const ANY: Self = Self {
        hold: u16::MAX,
        recover: 1,
        resync: 0,
        stale: u16::MAX,
        frozen: u16::MAX,
        jump: u16::MAX,
        burst: u16::MAX,
        zero: None,
        swing: None,
    };
}

/// More than one bad tick in `BAD_WEIGHT + 1` are too many in the long run.
pub const BAD_WEIGHT: u16 = 4;
