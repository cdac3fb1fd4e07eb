//! Evidence of whiskers on other boards, which one board of a head adds to that of its own.

use crate::format::{ENTRIES_PER_BIT, MAX_CLASSES};
use crate::sequential::SequentialEvidence;

/// Most other boards.
const MOST: usize = if cfg!(feature = "elsewhere") { 24 } else { 0 };
/// Whether there can be any: 1 or 0.
const ANY: usize = if cfg!(feature = "elsewhere") { 1 } else { 0 };

/// By how much each class lies behind the likeliest by what a board has felt, 2⁻¹⁰ bits,
/// saturated at 64; the likeliest by 0.
pub type Behind = [u16; MAX_CLASSES];

const _: () = assert!(ENTRIES_PER_BIT == 1 << 10);

/// The evidence of other boards, and whether this one adds it up.
#[derive(Debug, Clone)]
pub(crate) struct Elsewhere {
    all: [Option<SequentialEvidence>; MOST],
    /// Nothing at all, where there are no others.
    is_led: [bool; ANY],
}

impl Elsewhere {
    pub(crate) const fn new() -> Self {
        Self {
            all: [const { None }; MOST],
            is_led: [false; _],
        }
    }

    #[inline]
    pub(crate) fn is_led(&self) -> bool {
        self.is_led.contains(&true)
    }

    pub(crate) fn set_led(&mut self, is_led: bool) {
        self.is_led.fill(is_led);
    }

    /// That of a board by now, by sums of so many samples; none any more.
    pub(crate) fn hear(&mut self, board: usize, behind: Option<&Behind>, block: u32) {
        let Some(place) = self.all.get_mut(board) else {
            return;
        };
        let before = place.as_ref().map_or(0, SequentialEvidence::blocks);
        *place = behind.map(|behind| {
            SequentialEvidence::heard(behind.map(|bits| u32::from(bits) * block), before + 1)
        });
    }

    pub(crate) fn forget(&mut self) {
        self.all.fill(None);
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &SequentialEvidence> {
        self.all.iter().flatten()
    }
}
