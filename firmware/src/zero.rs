//! The zero of a sensor, found in every long silence.
//!
//! Temperature and a magnet that settles move what a sensor reads at rest by a per cent or two
//! of its range, which a model of deflections takes for a push. While a whisker touches nothing
//! for long, its reading swings about the zero, which is the mean then. A mean too far from
//! mid-scale is none: the whisker leans against something, or its magnet is not in its place.

use mlx90333::Word;
use serde::{Deserialize, Serialize};
use whisking::Voted;

/// Steps of a word in a code of 14 bits.
const CODE: i32 = 4;

/// By how much a mean must differ from the zero to take its place: eight codes, twice the noise
/// of a sample, and what part of a whisk at the end of a silence may add.
const STEP: u32 = 8 * CODE as u32;

/// When the zero of a sensor is found, and how far it may lie from mid-scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ZeroLimits {
    /// Ticks of a silence.
    pub ticks: u16,
    /// Most by which the mean of its words differs from mid-scale, of a word's 65,536 steps.
    pub most: u16,
    /// Contact π from which a whisker touches something, Q24.
    pub calm: i32,
}

/// The zero that is found, and the silence that goes on. Nothing of it is a fault: words are
/// judged as the sensor sends them.
#[derive(Debug, Clone, Copy, Default)]
pub struct Zero {
    codes: Voted<[i16; 2]>,
    /// Words since the last touch, of which there are at most `u16::MAX`.
    ticks: u16,
    sums: [u32; 2],
}

impl Zero {
    /// Codes by which the sensor lies above mid-scale at rest, x and y.
    pub fn codes(&self) -> [i16; 2] {
        self.codes.get().unwrap_or_default()
    }

    /// Takes words that [`out_of`](Self::out_of) has given into the silence, which begins again
    /// where the whisker is not calm. Gives the zero where they end it, and have moved it.
    #[inline]
    pub(crate) fn follow(
        &mut self,
        words: [Word; 2],
        is_calm: bool,
        limits: ZeroLimits,
    ) -> Option<[i16; 2]> {
        if !is_calm {
            (self.ticks, self.sums) = (0, [0; 2]);
            return None;
        }
        for (sum, word) in self.sums.iter_mut().zip(words) {
            *sum = sum.wrapping_add(word.raw().into());
        }
        self.ticks = self.ticks.saturating_add(1);
        if self.ticks < limits.ticks {
            return None;
        }
        self.end(limits.most)
    }

    /// The zero of the silence that has ended now, if that is another.
    #[cold]
    #[inline(never)]
    fn end(&mut self, most: u16) -> Option<[i16; 2]> {
        let mean = |sum: u32| sum.checked_div(self.ticks.into()).unwrap_or(0);
        let moved = self
            .sums
            .map(|sum| mean(sum) as i32 - i32::from(Word::MID.raw()));
        (self.ticks, self.sums) = (0, [0; 2]);
        if moved.iter().all(|by| by.unsigned_abs() < STEP) {
            return None;
        }
        let [x, y] = self.codes();
        let [by_x, by_y] = moved;
        let words = [(x, by_x), (y, by_y)].map(|(old, by)| i32::from(old) * CODE + by);
        if words.iter().any(|word| word.unsigned_abs() > most.into()) {
            return None;
        }
        // To the nearest code; of a word's range, thus within an i16.
        let codes = words.map(|word| (word + CODE / 2).div_euclid(CODE) as i16);
        self.codes = Voted::new(codes);
        Some(codes)
    }

    /// Words with the zero taken out of them, limited to the range.
    #[inline]
    pub(crate) fn out_of(&self, words: [Word; 2]) -> [Word; 2] {
        let [x, y] = self.codes();
        let [of_x, of_y] = words;
        [(of_x, x), (of_y, y)].map(|(word, zero)| {
            let raw = i32::from(word.raw()) - i32::from(zero) * CODE;
            Word::new(raw.clamp(0, u16::MAX.into()) as u16)
        })
    }
}

#[cfg(test)]
mod tests {
    use mlx90333::Word;
    use proptest::prelude::*;

    use super::{Zero, ZeroLimits};

    /// A silence of 100 ticks, zeros up to 160 codes.
    const LIMITS: ZeroLimits = ZeroLimits {
        ticks: 100,
        calm: 0,
        most: 640,
    };

    fn at(codes: [i32; 2]) -> [Word; 2] {
        codes.map(|code| Word::new(((8192 + code) * 4) as u16))
    }

    /// Lets `ticks` pass in free air, about so many codes from mid-scale.
    fn pass(zero: &mut Zero, codes: [i32; 2], ticks: i32) -> Vec<[i16; 2]> {
        let swing = |tick: i32| [0, 400, 0, -400][tick as usize % 4];
        (0..ticks)
            .filter_map(|tick| {
                let words = zero.out_of(at(codes.map(|code| code + swing(tick))));
                zero.follow(words, true, LIMITS)
            })
            .collect()
    }

    #[test]
    fn a_silence_of_its_length_moves_the_zero_and_a_shorter_one_does_not() {
        let mut zero = Zero::default();
        assert_eq!(pass(&mut zero, [60, -35], 99), [[0; 2]; 0]);
        assert_eq!(zero.codes(), [0, 0]);
        // The 100th ends a swing.
        let last = zero.follow(at([-340, -435]), true, LIMITS);
        assert_eq!(last, Some([60, -35]));
        assert_eq!(zero.out_of(at([60, -35])), at([0, 0]));
        assert_eq!(zero.out_of(at([-100, 100])), at([-160, 135]));
        let ends = zero.out_of([3, u16::MAX].map(Word::new));
        assert_eq!(ends.map(Word::raw), [0, u16::MAX]);
        for near in [[60, -35], [67, -42], [53, -28]] {
            let moved = pass(&mut zero, near, 1000);
            assert_eq!(moved, [[0; 2]; 0], "{near:?}: it stays");
        }
        let moved = pass(&mut zero, [60, -43], 100);
        assert_eq!(moved, [[60, -43]], "by eight codes");
    }

    #[test]
    fn a_touch_restarts_the_silence() {
        let mut zero = Zero::default();
        for _ in 0..20 {
            assert_eq!(pass(&mut zero, [20, 20], 99), [[0; 2]; 0]);
            assert_eq!(zero.follow(at([4000, 4000]), false, LIMITS), None);
        }
        assert_eq!(pass(&mut zero, [20, 20], 100), [[20, 20]]);
    }

    #[test]
    fn a_whisker_that_leans_has_no_zero() {
        let mut zero = Zero::default();
        pass(&mut zero, [30, 5], 100);
        for codes in [[161, 0], [0, -161], [4000, 4000]] {
            assert_eq!(pass(&mut zero, codes, 1000), [[0; 2]; 0], "{codes:?}");
            assert_eq!(zero.codes(), [30, 5]);
        }
        assert_eq!(pass(&mut zero, [160, -160], 100), [[160, -160]]);
    }

    proptest! {
        #[test]
        fn whatever_comes_the_zero_is_within_its_bound(
            words in prop::collection::vec(any::<([u16; 2], bool)>(), 1..2000),
            ticks in 1_u16..50,
            most: u16,
        ) {
            let mut zero = Zero::default();
            let limits = ZeroLimits { ticks, calm: 0, most };
            for (words, is_calm) in words {
                zero.follow(words.map(Word::new), is_calm, limits);
                let codes = zero.codes();
                let bound = i32::from(most) / 4 + 1;
                prop_assert!(codes.iter().all(|code| i32::from(*code).abs() <= bound), "{codes:?}");
                zero.out_of(words.map(Word::new));
            }
        }
    }
}
