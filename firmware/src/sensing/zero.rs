//! The zero of a sensor, found anew by itself in every long silence.
//!
//! Temperature and a magnet that settles move what a sensor reads at rest by a per cent or two
//! of its range, which a model of deflections takes for a push. While nothing moves a reading
//! for long, its mean is the zero; what lies too far from mid-scale is none, but a whisker that
//! leans against something, or a magnet that is not where it should be.

use mlx90333::Word;
use whisking::Voted;

use crate::io::WordSource;
use crate::{SensorFault, ZeroLimits};

/// Steps of a word in a code of 14 bits.
const CODE: i32 = 4;

/// The zero that is found, and the silence that goes on. Nothing of it is a fault: words are
/// judged as the sensor sends them.
#[derive(Debug, Clone, Copy, Default)]
pub struct Zero {
    /// Codes from mid-scale, x and y.
    codes: Voted<[i16; 2]>,
    silence: Silence,
}

/// Words since the last that was too far from another.
#[derive(Debug, Clone, Copy, Default)]
struct Silence {
    ticks: u16,
    lowest: [u16; 2],
    highest: [u16; 2],
    /// Of at most `u16::MAX` words each.
    sums: [u32; 2],
}

impl Zero {
    /// Codes by which the sensor lies above mid-scale at rest, x and y.
    pub fn codes(&self) -> [i16; 2] {
        self.codes.get().unwrap_or_default()
    }

    /// Takes words into the silence. Returns the zero where this one ends it, and has moved the
    /// zero by a code at least.
    #[inline]
    pub(super) fn follow(&mut self, words: [Word; 2], limits: ZeroLimits) -> Option<[i16; 2]> {
        if self.silence.add(words.map(Word::raw), limits.calm) < limits.ticks {
            return None;
        }
        self.move_to(limits.most)
    }

    /// The zero of the silence that has ended now, if that is another.
    #[cold]
    #[inline(never)]
    fn move_to(&mut self, most: u16) -> Option<[i16; 2]> {
        let silence = core::mem::take(&mut self.silence);
        let means = silence.sums.map(|sum| {
            let mean = sum.checked_div(silence.ticks.into()).unwrap_or(0);
            mean as i32 - i32::from(Word::MID.raw())
        });
        let old = self.codes();
        let has_moved = means
            .iter()
            .zip(old)
            .any(|(mean, old)| mean.abs_diff(i32::from(old) * CODE) >= CODE.unsigned_abs());
        let is_zero = means.iter().all(|mean| mean.unsigned_abs() <= most.into());
        if !(has_moved && is_zero) {
            return None;
        }
        // To the nearest code; within `most`, thus within an i16.
        let codes = means.map(|mean| ((mean + CODE / 2).div_euclid(CODE)) as i16);
        self.codes = Voted::new(codes);
        Some(codes)
    }

    /// Words with the zero taken out of them, limited to the range.
    #[inline]
    pub(super) fn out_of(&self, words: [Word; 2]) -> [Word; 2] {
        let [x, y] = self.codes();
        let [of_x, of_y] = words;
        [(of_x, x), (of_y, y)].map(|(word, zero)| {
            let raw = i32::from(word.raw()) - i32::from(zero) * CODE;
            Word::new(raw.clamp(0, u16::MAX.into()) as u16)
        })
    }
}

impl Silence {
    /// Adds words, or begins anew with them where they end it. Returns how long it is now.
    #[inline]
    fn add(&mut self, words: [u16; 2], calm: u16) -> u16 {
        let mut next = *self;
        let mut is_calm = self.ticks > 0;
        for axis in 0..2 {
            next.lowest[axis] = self.lowest[axis].min(words[axis]);
            next.highest[axis] = self.highest[axis].max(words[axis]);
            next.sums[axis] = self.sums[axis].wrapping_add(words[axis].into());
            is_calm &= next.highest[axis].wrapping_sub(next.lowest[axis]) <= calm;
        }
        next.ticks = self.ticks.saturating_add(1);
        *self = if is_calm {
            next
        } else {
            Self {
                ticks: 1,
                lowest: words,
                highest: words,
                sums: words.map(u32::from),
            }
        };
        self.ticks
    }
}

/// A source whose zero is found by itself.
#[derive(Debug)]
pub struct Zeroed<F> {
    source: F,
    zero: Zero,
}

impl<F> Zeroed<F> {
    /// A source at mid-scale until its first silence.
    pub fn new(source: F) -> Self {
        Self {
            source,
            zero: Zero::default(),
        }
    }

    /// The source itself.
    pub const fn source_mut(&mut self) -> &mut F {
        &mut self.source
    }
}

impl<F: WordSource> WordSource for Zeroed<F> {
    #[inline]
    fn words(&mut self, decoder: mlx90333::Decoder) -> Result<[Word; 2], SensorFault> {
        self.source.words(decoder)
    }

    #[inline]
    fn begin(&mut self) {
        self.source.begin();
    }

    #[inline]
    fn zero(&mut self) -> Option<&mut Zero> {
        Some(&mut self.zero)
    }
}

#[cfg(test)]
mod tests {
    use mlx90333::Word;
    use proptest::prelude::*;

    use super::Zero;
    use crate::ZeroLimits;

    /// A silence of 100 ticks, words within 40 codes, zeros up to 160 codes.
    const LIMITS: ZeroLimits = ZeroLimits {
        ticks: 100,
        calm: 160,
        most: 640,
    };

    fn at(codes: [i32; 2]) -> [Word; 2] {
        codes.map(|code| Word::new(((8192 + code) * 4) as u16))
    }

    /// Lets `ticks` pass at codes from mid-scale, with noise of ten codes to either side.
    fn pass(zero: &mut Zero, codes: [i32; 2], ticks: i32) -> Vec<[i16; 2]> {
        let noise = |tick: i32| [0, 10, 0, -10][tick as usize % 4];
        (0..ticks)
            .filter_map(|tick| zero.follow(at(codes.map(|code| code + noise(tick))), LIMITS))
            .collect()
    }

    #[test]
    fn a_silence_of_its_length_moves_the_zero_and_a_shorter_one_does_not() {
        let mut zero = Zero::default();
        assert_eq!(pass(&mut zero, [60, -35], 99), [[0; 2]; 0]);
        assert_eq!(zero.codes(), [0, 0]);
        assert_eq!(pass(&mut zero, [60, -35], 1), [[60, -35]]);
        assert_eq!(zero.out_of(at([60, -35])), at([0, 0]));
        assert_eq!(zero.out_of(at([-100, 100])), at([-160, 135]));
        assert_eq!(pass(&mut zero, [60, -35], 1000), [[0; 2]; 0], "it stays");
        assert_eq!(pass(&mut zero, [60, -36], 100), [[60, -36]], "by a code");
    }

    #[test]
    fn contact_on_either_axis_begins_the_silence_anew() {
        for touch in [[45, 0], [0, -45]] {
            let mut zero = Zero::default();
            for _ in 0..20 {
                assert_eq!(pass(&mut zero, [20, 20], 50), [[0; 2]; 0]);
                pass(&mut zero, [20 + touch[0], 20 + touch[1]], 2);
            }
            assert_eq!(zero.codes(), [0, 0]);
            assert_eq!(pass(&mut zero, [20, 20], 101), [[20, 20]]);
        }
    }

    #[test]
    fn a_whisker_that_leans_has_no_zero() {
        let mut zero = Zero::default();
        pass(&mut zero, [30, 5], 100);
        for codes in [[161, 0], [0, -161], [4000, 4000]] {
            assert_eq!(pass(&mut zero, codes, 1000), [[0; 2]; 0], "{codes:?}");
            assert_eq!(zero.codes(), [30, 5]);
        }
        assert_eq!(pass(&mut zero, [160, -160], 200), [[160, -160]]);
    }

    proptest! {
        #[test]
        fn whatever_comes_the_zero_is_within_its_bound(
            words in prop::collection::vec(any::<[u16; 2]>(), 1..2000),
            ticks in 1_u16..50,
            calm: u16,
            most: u16,
        ) {
            let mut zero = Zero::default();
            let limits = ZeroLimits { ticks, calm, most };
            for words in words {
                zero.follow(words.map(Word::new), limits);
                let codes = zero.codes();
                let bound = i32::from(most) / 4 + 1;
                prop_assert!(codes.iter().all(|code| i32::from(*code).abs() <= bound), "{codes:?}");
                zero.out_of(words.map(Word::new));
            }
        }
    }
}
