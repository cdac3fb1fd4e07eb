//! Hardware that is always the same.

use firmware::{BusError, Clock, FrameSource};
use mlx90333::{FRAME_LEN, Faults, SumRule, Word, encode};

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
