//! Bounds of numbers and factors in fixed point.

use super::factor::SHIFT_MAX;
use super::{Factor, Factors, FineFactor, Fix};
use crate::{Bound, Bounded};

impl Bounded for Fix {
    fn lies_within(&self, bound: Bound) -> bool {
        let power = bound.power.clamp(-28, 3) + 28;
        bound.holds(self.0 < 0, self.0.unsigned_abs() <= 1_u32 << power)
    }
}

/// One whose mantissa is that of no factor, or whose shift is none, is no number.
impl Bounded for Factor {
    fn lies_within(&self, bound: Bound) -> bool {
        let Self { mantissa, shift } = *self;
        let is_normal = mantissa == 0 || mantissa.unsigned_abs() >= 1 << 14;
        let is_sound = is_normal && mantissa != i16::MIN;
        // Below 2^15 times 2^-(16 + shift).
        is_sound
            && (-SHIFT_MAX..=SHIFT_MAX).contains(&shift)
            && bound.holds_scaled(mantissa.into(), -1 - shift)
    }
}

impl Bounded for FineFactor {
    fn lies_within(&self, bound: Bound) -> bool {
        let Self { mantissa, shift } = *self;
        let is_normal = mantissa == 0 || mantissa.unsigned_abs() >= 1 << 30;
        let is_sound = is_normal && mantissa != i32::MIN;
        is_sound && (-1..=SHIFT_MAX).contains(&shift) && bound.holds_scaled(mantissa, -1 - shift)
    }
}

impl<const K: usize> Bounded for Factors<K> {
    fn lies_within(&self, bound: Bound) -> bool {
        let shift = self.shift;
        let holds = |mantissa: &i16| {
            *mantissa != i16::MIN && bound.holds_scaled((*mantissa).into(), -1 - shift)
        };
        (-1..=SHIFT_MAX).contains(&shift) && self.mantissas.iter().all(holds)
    }
}
