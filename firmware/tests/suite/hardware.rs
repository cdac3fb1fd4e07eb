//! Hardware that is always the same.

use firmware::{BusError, Clock, Config, FrameSource, SensorLimits, ZeroLimits};
use mlx90333::{Decoder, FRAME_LEN, Faults, SumRule, Word, encode};

/// A bad frame is bridged, and a good one ends the fault.
pub(crate) const AT_ONCE: SensorLimits = SensorLimits {
    hold: 1,
    recover: 1,
    resync: 0,
    stale: u16::MAX,
    frozen: u16::MAX,
    jump: u16::MAX,
    burst: u16::MAX,
    zero: ZeroLimits::NONE,
};

/// A module that does nothing but feel.
pub(crate) const fn feeling<C>(contact: C) -> Config<(), (), C> {
    Config {
        decoder: Decoder::new(),
        sensor_limits: AT_ONCE,
        contact,
        motion: (),
        perception: (),
        period: 0,
    }
}

/// A sensor that always sends the same word.
pub(crate) struct Bent(pub(crate) u16);

impl FrameSource for Bent {
    fn take(&mut self) -> Result<Option<[u8; FRAME_LEN]>, BusError> {
        let x = Word::new(self.0);
        Ok(Some(encode::alpha_beta(
            x,
            Word::MID,
            Faults::NONE,
            SumRule::SumB1B6,
        )))
    }
}

/// Time does not pass.
pub(crate) struct NoClock;

impl Clock for NoClock {
    fn now(&mut self) -> u32 {
        0
    }
}
