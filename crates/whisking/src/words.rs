//! Constants of the tick as words of 32 bits, in which a PC reads and writes them.
//!
//! | format | a number | a factor | a fine factor | a row |
//! |---|---|---|---|---|
//! | f32 | its bits | alike | alike | alike, each |
//! | f64 | its bits, the lower half first | alike | alike | alike, each |
//! | [`Fix`](crate::Fix) | n/2^28 | mantissa, shift | mantissa, shift | mantissa, shift that all share |

use crate::motor::Duty;

/// Which numbers a constant can be: no NaN, no infinity, and none that is larger than a power
/// of two or, where it must not be, negative. Coarser than a scene's ranges, and quick to look
/// at in every format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bound {
    /// −2 to 30: the largest is this power of two.
    pub power: i8,
    /// Whether it may be negative.
    pub signed: bool,
}

impl Bound {
    /// From 0 to 2^`power`.
    pub const fn positive(power: i8) -> Self {
        Self {
            power,
            signed: false,
        }
    }

    /// From −2^`power` to 2^`power`.
    pub const fn signed(power: i8) -> Self {
        Self {
            power,
            signed: true,
        }
    }

    /// Whether the sign of `value` is allowed, and its size by `is_small`.
    pub(crate) fn holds(self, is_negative: bool, is_small: bool) -> bool {
        is_small && (self.signed || !is_negative)
    }

    /// The same of a mantissa that is below 2^`scale`; its own bits are not looked at, so that
    /// up to four times the largest is allowed.
    pub(crate) fn holds_scaled(self, mantissa: i32, scale: i32) -> bool {
        let is_small = mantissa == 0 || scale <= i32::from(self.power) + 1;
        self.holds(mantissa < 0, is_small)
    }
}

/// A constant of the tick as two words; those that need one have 0 as the second.
pub trait AsWords: Copy {
    /// Its words.
    fn words(self) -> [u32; 2];

    /// The constant of these words; none if they are none, or out of bounds.
    fn from_words(words: [u32; 2], bound: Bound) -> Option<Self>;

    /// Its value. For reports, not for the tick.
    fn value(self) -> f64;
}

/// Some constants that are used together.
pub trait WordRow: Copy {
    /// The words of the `n`-th.
    fn words(&self, n: usize) -> [u32; 2];

    /// Puts these words in the place of the `n`-th; whether they are a constant within bounds.
    fn set_words(&mut self, n: usize, words: [u32; 2], bound: Bound) -> bool;

    /// The value of the `n`-th. For reports, not for the tick.
    fn value(&self, n: usize) -> f64;
}

impl AsWords for f32 {
    fn words(self) -> [u32; 2] {
        [self.to_bits(), 0]
    }

    fn from_words([bits, _]: [u32; 2], bound: Bound) -> Option<Self> {
        // By their bits sizes of floats are in order, NaN and infinity beyond all.
        let most = (127 + i32::from(bound.power)).cast_unsigned() << 23;
        let is_small = bits & 0x7FFF_FFFF <= most;
        let found = Self::from_bits(bits);
        bound.holds(bits >> 31 != 0, is_small).then_some(found)
    }

    fn value(self) -> f64 {
        f64::from(self)
    }
}

impl AsWords for f64 {
    fn words(self) -> [u32; 2] {
        let bits = self.to_bits();
        [bits as u32, (bits >> 32) as u32]
    }

    fn from_words([low, high]: [u32; 2], bound: Bound) -> Option<Self> {
        let bits = u64::from(high) << 32 | u64::from(low);
        let most = u64::from((1023 + i32::from(bound.power)).cast_unsigned()) << 52;
        let is_small = bits & (u64::MAX >> 1) <= most;
        let found = Self::from_bits(bits);
        bound.holds(bits >> 63 != 0, is_small).then_some(found)
    }

    fn value(self) -> f64 {
        self
    }
}

impl<T: AsWords, const K: usize> WordRow for [T; K] {
    fn words(&self, n: usize) -> [u32; 2] {
        self.get(n).map_or([0; 2], |entry| entry.words())
    }

    fn set_words(&mut self, n: usize, words: [u32; 2], bound: Bound) -> bool {
        match (self.get_mut(n), T::from_words(words, bound)) {
            (Some(place), Some(found)) => {
                *place = found;
                true
            }
            _ => false,
        }
    }

    fn value(&self, n: usize) -> f64 {
        self.get(n).map_or(f64::NAN, |entry| entry.value())
    }
}

/// An integer: that it is one of its type, and not negative where it must not be, is all that
/// is looked at.
macro_rules! integers {
    ($($integer:ty)*) => {
        $(impl AsWords for $integer {
            fn words(self) -> [u32; 2] {
                [self as u32, 0]
            }

            fn from_words([word, _]: [u32; 2], bound: Bound) -> Option<Self> {
                let found = word as Self;
                // A wide word must be what the narrow one says again.
                let is_whole = found as u32 == word;
                let size = i64::from(found).unsigned_abs();
                let is_small = is_whole && size <= 1 << bound.power.clamp(0, 62);
                bound.holds(i64::from(found) < 0, is_small).then_some(found)
            }

            fn value(self) -> f64 {
                f64::from(self)
            }
        })*
    };
}

#[allow(
    clippy::cast_lossless,
    reason = "one macro serves integers of every width and sign"
)]
mod integers {
    use super::{AsWords, Bound};

    integers! { u16 i32 u32 }
}

impl AsWords for bool {
    fn words(self) -> [u32; 2] {
        [self.into(), 0]
    }

    fn from_words([word, _]: [u32; 2], _: Bound) -> Option<Self> {
        (word < 2).then_some(word == 1)
    }

    fn value(self) -> f64 {
        self.into()
    }
}

/// Q15.
impl AsWords for Duty {
    fn words(self) -> [u32; 2] {
        [i32::from(self.q15()).cast_unsigned(), 0]
    }

    fn from_words([word, _]: [u32; 2], bound: Bound) -> Option<Self> {
        let q15 = i16::try_from(word.cast_signed()).ok();
        let q15 = q15.filter(|q15| *q15 != i16::MIN)?;
        bound.holds(q15 < 0, true).then_some(Self::from_q15(q15))
    }

    fn value(self) -> f64 {
        f64::from(self.q15()) / 32_767.0
    }
}
