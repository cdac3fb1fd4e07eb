//! Which numbers a constant of the tick can be, for a check of configurations that come from
//! outside. It looks at bits alone, so that it costs little on any processor.

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

    pub(crate) const fn holds(self, is_negative: bool, is_small: bool) -> bool {
        is_small && (self.signed || !is_negative)
    }

    /// Of a mantissa that is below 2^`scale`; its own bits are not looked at, so that up to four
    /// times the largest is allowed.
    #[inline(never)]
    pub(crate) fn holds_scaled(self, mantissa: i32, scale: i32) -> bool {
        let is_small = mantissa == 0 || scale <= i32::from(self.power) + 1;
        self.holds(mantissa < 0, is_small)
    }
}

/// A constant of the tick, or some that are used together.
pub trait Bounded {
    /// Whether it lies within `bound`; of some constants, whether each does. What is no number
    /// never does, nor bits that its type has for none.
    fn lies_within(&self, bound: Bound) -> bool;
}

impl Bounded for f32 {
    fn lies_within(&self, bound: Bound) -> bool {
        // By their bits sizes of floats are in order, NaN and infinity beyond all.
        let most = (127 + i32::from(bound.power)).cast_unsigned() << 23;
        let bits = self.to_bits();
        bound.holds(bits >> 31 != 0, bits & (u32::MAX >> 1) <= most)
    }
}

impl Bounded for f64 {
    fn lies_within(&self, bound: Bound) -> bool {
        let most = u64::from((1023 + i32::from(bound.power)).cast_unsigned()) << 52;
        let bits = self.to_bits();
        bound.holds(bits >> 63 != 0, bits & (u64::MAX >> 1) <= most)
    }
}

impl<T: Bounded, const K: usize> Bounded for [T; K] {
    fn lies_within(&self, bound: Bound) -> bool {
        self.iter().all(|entry| entry.lies_within(bound))
    }
}

fn integer(is_negative: bool, size: u32, bound: Bound) -> bool {
    let is_small = match u8::try_from(bound.power) {
        Ok(power) if power < 32 => size <= 1 << power,
        Ok(_) => true,
        Err(_) => size == 0,
    };
    bound.holds(is_negative, is_small)
}

macro_rules! unsigned {
    ($($integer:ty)*) => {
        $(impl Bounded for $integer {
            fn lies_within(&self, bound: Bound) -> bool {
                integer(false, u32::from(*self), bound)
            }
        })*
    };
}

macro_rules! signed {
    ($($integer:ty)*) => {
        $(impl Bounded for $integer {
            fn lies_within(&self, bound: Bound) -> bool {
                integer(*self < 0, i32::from(*self).unsigned_abs(), bound)
            }
        })*
    };
}

unsigned! { u8 u16 u32 }
signed! { i16 i32 }

/// Every duty is small: only its sign counts.
impl Bounded for Duty {
    fn lies_within(&self, bound: Bound) -> bool {
        bound.holds(self.q15() < 0, true)
    }
}
