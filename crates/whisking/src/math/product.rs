//! The high part of products of 32-bit integers.
//!
//! The Cortex-M3 and larger have instructions for it. The Cortex-M0+ computes
//! only the low 32 bits of a product, and for more the compiler calls a function
//! of some forty instructions; there the same numbers, to the last bit, are
//! composed from products of halves. A tick has more than twenty such products.

/// Whether the processor is a Cortex-M0+: the only supported one without atomic exchange.
const IS_SMALL: bool = cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));

/// ⌊x y / 2^16⌋.
#[inline]
pub(crate) const fn by_half(x: i32, y: i16) -> i32 {
    scaled::<16>(x, y)
}

/// ⌊x y / 2^`DOWN`⌋, `DOWN` from 1 to 16, for |x| < 2^(15 + `DOWN`).
#[inline]
pub(crate) const fn scaled<const DOWN: u32>(x: i32, y: i16) -> i32 {
    if IS_SMALL {
        scaled_in_parts::<DOWN>(x, y)
    } else {
        // The form that becomes a Cortex-M4's SMULWB.
        (((x << (16 - DOWN)) as i64 * y as i64) >> 16) as i32
    }
}

/// ⌊x y / 2^32⌋.
#[inline]
pub(crate) const fn high(x: i32, y: i32) -> i32 {
    if IS_SMALL {
        sum_of_parts(x, y, 0)
    } else {
        ((x as i64 * y as i64) >> 32) as i32
    }
}

/// x y / 2^32 for `y` without its lower half, to the nearest, halves upwards.
#[inline]
pub(crate) const fn by_top(x: i32, y: i32) -> i32 {
    high_rounded(x, y & !0xFFFF)
}

/// x y / 2^32, to the nearest, halves upwards, for |y| ≤ 2^30, or without its lower half.
#[inline]
pub(crate) const fn high_rounded(x: i32, y: i32) -> i32 {
    if IS_SMALL {
        sum_of_parts(x, y, 1 << 15)
    } else {
        ((x as i64 * y as i64 + (1 << 31)) >> 32) as i32
    }
}

#[inline]
const fn scaled_in_parts<const DOWN: u32>(x: i32, y: i16) -> i32 {
    let y = y as i32;
    (((x >> 16) * y) << (16 - DOWN)).wrapping_add(((x & 0xFFFF) * y) >> DOWN)
}

/// ⌊x y / 2^32 + `more` / 2^16⌋.
#[inline]
const fn sum_of_parts(x: i32, y: i32, more: i32) -> i32 {
    let (xh, xl) = (x >> 16, x as u32 & 0xFFFF);
    let (yh, yl) = (y >> 16, y as u32 & 0xFFFF);
    // Each sum fits 32 bits: a product of halves leaves room for one more half.
    let low = xh * yl as i32 + ((xl * yl) >> 16) as i32;
    let middle = xl as i32 * yh + (low & 0xFFFF) + more;
    xh * yh + (low >> 16) + (middle >> 16)
}

#[cfg(test)]
mod tests {
    use super::{by_half, by_top, high, high_rounded, scaled, scaled_in_parts, sum_of_parts};
    use proptest::prelude::*;

    const EDGES: [i32; 9] = [
        i32::MIN,
        i32::MIN + 1,
        -65_537,
        -1,
        0,
        1,
        65_535,
        65_536,
        i32::MAX,
    ];

    fn same(x: i32, y: i32) {
        let rounded_in_parts = |y| sum_of_parts(x, y, 1 << 15);
        assert_eq!(sum_of_parts(x, y, 0), high(x, y), "{x} {y}");
        let few = y.clamp(-(1 << 30), 1 << 30);
        let rounded = high_rounded(x, few);
        assert_eq!(rounded_in_parts(few), rounded, "{x} {few}");
        assert!(
            (f64::from(x) * f64::from(few) / 4_294_967_296.0 - f64::from(rounded)).abs() <= 0.5
        );
        let top = y & !0xFFFF;
        assert_eq!(rounded_in_parts(top), by_top(x, y), "{x} {y}");
        let y = y as i16;
        assert_eq!(scaled_in_parts::<16>(x, y), by_half(x, y), "{x} {y}");
        let x = x >> 3;
        assert_eq!(scaled_in_parts::<13>(x, y), scaled::<13>(x, y), "{x} {y}");
        assert_eq!(
            i64::from(scaled::<13>(x, y)),
            (i64::from(x) * i64::from(y)) >> 13
        );
    }

    #[test]
    fn parts_give_the_same_at_the_edges() {
        for x in EDGES {
            for y in EDGES {
                same(x, y);
            }
        }
    }

    proptest! {
        #[test]
        fn parts_give_the_same(x in any::<i32>(), y in any::<i32>()) {
            same(x, y);
        }
    }
}
