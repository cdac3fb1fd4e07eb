//! Evidence of whiskers on other boards, which one board of a head adds to that of its own.

use crate::format::{ENTRIES_PER_BIT, MAX_CLASSES};
use crate::sequential::SequentialEvidence;

/// Most other boards. Those of a program whose whiskers decide by none but the first are not asked.
const MOST: usize = if cfg!(all(feature = "elsewhere", feature = "several")) {
    24
} else {
    0
};
/// Whether there can be any: 1 or 0.
const ANY: usize = if cfg!(feature = "elsewhere") { 1 } else { 0 };

/// What the whiskers of a board have felt since the last decision, as it says so to the board that
/// adds up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Felt {
    /// By how much each class lies behind the likeliest, the *leader*, 2⁻⁶ bits, rounded down, at
    /// most [`MOST_BEHIND`](Self::MOST_BEHIND).
    pub behind: [u16; MAX_CLASSES],
    /// By how much the leader exceeds its floors since the touches began, of samples and of
    /// roughness: bits, rounded, within [`EXCESS`](Self::EXCESS).
    pub excess: [i8; 2],
}

/// Table units in a unit of [`Felt::behind`].
const UNIT: u32 = ENTRIES_PER_BIT >> 6;

impl Felt {
    /// Of [`behind`](Self::behind): almost 64 bits.
    pub const MOST_BEHIND: u16 = 4095;
    /// Least and most of [`excess`](Self::excess), bits.
    pub const EXCESS: [i8; 2] = [-32, 31];
    /// Nothing: all classes are alike.
    pub const NOTHING: Self = Self {
        behind: [0; MAX_CLASSES],
        excess: [0; 2],
    };

    /// Of the evidence of a board's whiskers and of their excess together, by sums of so many
    /// samples.
    pub(crate) fn of(evidence: &SequentialEvidence, excess: [i32; 2], block: u32) -> Self {
        let share = |sum: u32| sum.checked_div(block).unwrap_or(0) / UNIT;
        let [of_samples, of_roughness] = excess;
        let a_sample = of_samples.checked_div(block.cast_signed());
        let bits = |units: i32| {
            let whole = units.saturating_add(ENTRIES_PER_BIT.cast_signed() / 2);
            let whole = whole.div_euclid(ENTRIES_PER_BIT.cast_signed());
            let [least, most] = Self::EXCESS.map(i32::from);
            whole.clamp(least, most) as i8
        };
        Self {
            behind: evidence
                .deficits()
                .map(|deficit| share(deficit).min(Self::MOST_BEHIND.into()) as u16),
            excess: [a_sample.unwrap_or(0), of_roughness].map(bits),
        }
    }
}

#[derive(Debug, Clone)]
struct Board {
    evidence: SequentialEvidence,
    excess: [i8; 2],
}

/// The evidence of other boards, and whether this one adds it up.
#[derive(Debug, Clone)]
pub(crate) struct Elsewhere {
    all: [Option<Board>; MOST],
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
    pub(crate) fn hear(&mut self, board: usize, felt: Option<&Felt>, block: u32) {
        let Some(place) = self.all.get_mut(board) else {
            return;
        };
        let before = place.as_ref().map_or(0, |board| board.evidence.blocks());
        *place = felt.map(|Felt { behind, excess }| {
            let deficits =
                behind.map(|units| u32::from(units.min(Felt::MOST_BEHIND)) * UNIT * block);
            Board {
                evidence: SequentialEvidence::heard(deficits, before + 1),
                excess: *excess,
            }
        });
    }

    /// By how much the leaders of all exceed their floors, by sums of so many samples.
    pub(crate) fn excess(&self, block: u32) -> [i32; 2] {
        let bits = self.all.iter().flatten().fold([0_i32; 2], |sum, board| {
            let [a, b] = board.excess.map(i32::from);
            [sum[0] + a, sum[1] + b]
        });
        let unit = ENTRIES_PER_BIT.cast_signed();
        let [of_samples, of_roughness] = bits.map(|bits| bits * unit);
        [of_samples.saturating_mul(block.cast_signed()), of_roughness]
    }

    pub(crate) fn forget(&mut self) {
        self.all.fill(None);
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &SequentialEvidence> {
        self.all.iter().flatten().map(|board| &board.evidence)
    }
}

#[cfg(all(test, feature = "elsewhere"))]
mod tests {
    use super::*;

    /// Half a bit above and below, beyond what can be said, and again as sums of twenty samples.
    #[test]
    fn what_others_exceed_their_floors_by_is_added_in_bits() {
        let none = SequentialEvidence::heard([0; MAX_CLASSES], 1);
        let of = |bits: [f64; 2]| {
            let [of_samples, of_roughness] = bits.map(|bits| 1024.0 * bits);
            Felt::of(
                &none,
                [20.0 * of_samples, of_roughness].map(|x| x as i32),
                20,
            )
            .excess
        };
        assert_eq!(of([1.6, -1.6]), [2, -2]);
        assert_eq!(of([1.4, -1.4]), [1, -1]);
        assert_eq!(of([1e3, -1e3]), [31, -32]);
        let mut elsewhere = Elsewhere::new();
        for (board, excess) in [[3, -7], [-32, 31], [4, 4]].into_iter().enumerate() {
            let behind = [0; MAX_CLASSES];
            elsewhere.hear(board, Some(&Felt { behind, excess }), 20);
        }
        elsewhere.hear(2, None, 20);
        assert_eq!(elsewhere.excess(20), [20 * 1024 * -29, 1024 * 24]);
    }

    /// Rounded down, so that no class is further behind than it was felt to be.
    #[test]
    fn deficits_come_as_they_were_said() {
        let mut deficits = [0; MAX_CLASSES];
        (deficits[1], deficits[2]) = (20 * 1023, 1 << 28);
        let felt = Felt::of(&SequentialEvidence::heard(deficits, 1), [0; 2], 20);
        assert_eq!(felt.behind[..4], [0, 63, 4095, 0]);
        let mut elsewhere = Elsewhere::new();
        elsewhere.hear(5, Some(&felt), 20);
        let heard = elsewhere.iter().next().map(SequentialEvidence::deficits);
        assert_eq!(heard.unwrap()[..3], [0, 20 * 1008, 20 * 4095 * 16]);
    }
}
