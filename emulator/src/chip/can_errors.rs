//! The error counters of a CAN controller: fault confinement by the rules of CAN 2.0, and the
//! register in which a bxCAN shows them. Thresholds are from secondary pages: neither manual was at
//! hand.

use super::fields::{Field, field};

/// A node whose counter is beyond this no longer destroys the frames of others.
const MOST_ACTIVE: u16 = 127;
/// One whose transmit counter is beyond this is off the bus.
const MOST_ON: u16 = 255;
/// From here on a warning is shown.
const WARNING: u16 = 96;
/// It comes back after so many times eleven recessive bits.
const SILENCES: u32 = 128;

pub(super) const ESR: u32 = 0x18;
const EWGF: Field = field("ESR", ESR, "EWGF", 1 << 0);
const EPVF: Field = field("ESR", ESR, "EPVF", 1 << 1);
pub(super) const BOFF: Field = field("ESR", ESR, "BOFF", 1 << 2);
pub(super) const TEC: Field = field("ESR", ESR, "TEC", 0xFF << 16);
pub(super) const REC: Field = field("ESR", ESR, "REC", 0xFF << 24);

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
        let most = self.transmit.max(self.receive);
        EWGF.when(most >= WARNING)
            | EPVF.when(self.is_passive())
            | BOFF.when(self.is_off)
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
            let found = [EWGF, EPVF, BOFF].map(|bit| bit.is_in(counts.status()));
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
        assert!(!EPVF.is_in(counts.status()));
        (0..1_000).for_each(|_| counts.missed());
        assert_eq!((counts.receive, counts.is_off), (128, false));
        counts.heard();
        assert!((119..=127).contains(&counts.receive));
    }
}
