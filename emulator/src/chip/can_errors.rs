//! The error counters of a CAN controller: fault confinement by the rules of CAN 2.0, and the
//! register in which a bxCAN shows them. Thresholds are from secondary pages: neither manual was at
//! hand.

/// A node whose counter is beyond this no longer destroys the frames of others.
const MOST_ACTIVE: u16 = 127;
/// One whose transmit counter is beyond this is off the bus.
const MOST_ON: u16 = 255;
/// From here on a warning is shown.
const WARNING: u16 = 96;
/// It comes back after so many times eleven recessive bits.
const SILENCES: u32 = 128;

const EWGF: u32 = 1 << 0;
const EPVF: u32 = 1 << 1;
pub(super) const BOFF: u32 = 1 << 2;
pub(super) const TEC: u32 = 0xFF << 16;
pub(super) const REC: u32 = 0xFF << 24;

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct ErrorCounts {
    pub(crate) transmit: u16,
    pub(crate) receive: u16,
    pub(crate) is_off: bool,
    /// Silences that it still waits for, since the program has let it.
    left: Option<u32>,
}

impl ErrorCounts {
    const fn is_passive(&self) -> bool {
        self.transmit > MOST_ACTIVE || self.receive > MOST_ACTIVE
    }

    /// A frame of its own was destroyed, or acknowledged by none: rule 3, with its first exception:
    /// one that is passive, and alone, goes no further.
    pub(super) const fn failed(&mut self, is_unheard: bool) {
        if is_unheard && self.is_passive() {
            return;
        }
        self.transmit += 8;
        if self.transmit > MOST_ON {
            self.is_off = true;
            self.left = None;
        }
    }

    /// A frame of its own has come through: rule 7.
    pub(super) const fn sent(&mut self) {
        self.transmit = self.transmit.saturating_sub(1);
    }

    /// A frame of another was destroyed: rule 1. Who caused that is not asked (rule 2).
    pub(super) const fn missed(&mut self) {
        if self.receive <= MOST_ACTIVE {
            self.receive += 1;
        }
    }

    /// A frame of another has come: rule 8.
    pub(super) const fn heard(&mut self) {
        self.receive = if self.receive > MOST_ACTIVE {
            MOST_ACTIVE
        } else {
            self.receive.saturating_sub(1)
        };
    }

    /// The program has had it begin again, and lets it.
    pub(super) const fn restart(&mut self) {
        if self.is_off {
            self.left = Some(SILENCES);
        }
    }

    /// The bus was silent so often for eleven bits: rule 12.
    pub(super) fn silent(&mut self, times: u32) {
        let Some(left) = self.left else { return };
        self.left = Some(left.saturating_sub(times));
        if left <= times {
            *self = Self::default();
        }
    }

    /// ESR.
    pub(super) fn status(&self) -> u32 {
        let flag = |on: bool, bit: u32| if on { bit } else { 0 };
        let most = self.transmit.max(self.receive);
        flag(most >= WARNING, EWGF)
            | flag(self.is_passive(), EPVF)
            | flag(self.is_off, BOFF)
            | u32::from(self.transmit & 0xFF) << 16
            | u32::from(self.receive) << 24
    }
}

#[cfg(test)]
mod tests {
    use super::{BOFF, EPVF, EWGF, ErrorCounts};

    /// 32 errors in a row and not 31, as 8 times 32 is the first beyond 255. The way back is in
    /// `chip/tests/bus.rs`.
    #[test]
    fn errors_are_warned_of_and_switch_it_off() {
        let mut counts = ErrorCounts::default();
        for n in 1..=32_u32 {
            counts.failed(false);
            let found = [EWGF, EPVF, BOFF].map(|bit| counts.status() & bit != 0);
            assert_eq!(found, [n >= 12, n >= 16, n >= 32], "{n}");
        }
    }

    /// One that nobody hears is passive for ever, and never off.
    #[test]
    fn a_node_alone_is_passive() {
        let mut counts = ErrorCounts::default();
        (0..1_000).for_each(|_| counts.failed(true));
        assert_eq!((counts.transmit, counts.is_off), (128, false));
        counts.sent();
        assert_eq!(counts.status() & EPVF, 0);
        (0..1_000).for_each(|_| counts.missed());
        assert_eq!((counts.receive, counts.is_off), (128, false));
        counts.heard();
        assert!((119..=127).contains(&counts.receive));
    }
}
