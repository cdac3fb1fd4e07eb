//! Numbers and factors in fixed point as words.

use super::{Factor, Factors, FineFactor, Fix};
use crate::{AsWords, Bound, WordRow};

impl AsWords for Fix {
    fn words(self) -> [u32; 2] {
        [self.0.cast_unsigned(), 0]
    }

    fn from_words([bits, _]: [u32; 2], bound: Bound) -> Option<Self> {
        let found = bits.cast_signed();
        let power = bound.power.clamp(-28, 3) + 28;
        let is_small = found.unsigned_abs() <= 1_u32 << power;
        bound.holds(found < 0, is_small).then_some(Self(found))
    }

    fn value(self) -> f64 {
        f64::from(self.0) / f64::from(1 << 28)
    }
}

/// A mantissa of 16 bits, its largest magnitudes 2^14 to 2^15 − 1.
fn mantissa(word: u32) -> Option<i16> {
    i16::try_from(word.cast_signed()).ok()
}

impl AsWords for Factor {
    fn words(self) -> [u32; 2] {
        [i32::from(self.mantissa), self.shift].map(i32::cast_unsigned)
    }

    fn from_words([word, shift]: [u32; 2], bound: Bound) -> Option<Self> {
        let (mantissa, shift) = (mantissa(word)?, shift.cast_signed());
        let is_normal = mantissa == 0 || mantissa.unsigned_abs() >= 1 << 14;
        let is_sound = is_normal && mantissa != i16::MIN && (-30..=30).contains(&shift);
        // Below 2^15 times 2^-(16 + shift).
        let holds = is_sound && bound.holds_scaled(mantissa.into(), -1 - shift);
        holds.then_some(Self { mantissa, shift })
    }

    fn value(self) -> f64 {
        f64::from(self.mantissa) * libm::exp2(f64::from(-16 - self.shift))
    }
}

impl AsWords for FineFactor {
    fn words(self) -> [u32; 2] {
        [self.mantissa, self.shift].map(i32::cast_unsigned)
    }

    fn from_words(words: [u32; 2], bound: Bound) -> Option<Self> {
        let [mantissa, shift] = words.map(u32::cast_signed);
        let is_normal = mantissa == 0 || mantissa.unsigned_abs() >= 1 << 30;
        let is_sound = is_normal && mantissa != i32::MIN && (-1..=30).contains(&shift);
        let holds = is_sound && bound.holds_scaled(mantissa, -1 - shift);
        holds.then_some(Self { mantissa, shift })
    }

    fn value(self) -> f64 {
        f64::from(self.mantissa) * libm::exp2(f64::from(-32 - self.shift))
    }
}

impl<const K: usize> WordRow for Factors<K> {
    fn words(&self, n: usize) -> [u32; 2] {
        let mantissa = self
            .mantissas
            .get(n)
            .map_or(0, |mantissa| i32::from(*mantissa));
        [mantissa, self.shift].map(i32::cast_unsigned)
    }

    fn set_words(&mut self, n: usize, [word, shift]: [u32; 2], bound: Bound) -> bool {
        let shift = shift.cast_signed();
        let (Some(place), Some(mantissa)) = (self.mantissas.get_mut(n), mantissa(word)) else {
            return false;
        };
        let is_sound = mantissa != i16::MIN && (-1..=30).contains(&shift);
        let holds = is_sound && bound.holds_scaled(mantissa.into(), -1 - shift);
        if holds {
            (*place, self.shift) = (mantissa, shift);
        }
        holds
    }

    fn value(&self, n: usize) -> f64 {
        let mantissa = self
            .mantissas
            .get(n)
            .map_or(0.0, |mantissa| f64::from(*mantissa));
        mantissa * libm::exp2(f64::from(-16 - self.shift))
    }
}
