//! From a code to its bin, without a division.

/// Whether the processor computes only the low half of a product: a Cortex-M0+, the
/// only supported one without atomic exchange. For more the compiler calls a function
/// of some forty instructions.
const IS_SMALL: bool = cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));

/// Finds a bin by one multiplication: floor((code − low) · slope / 2³²) with
/// slope = ⌈B · 2³² / span⌉.
///
/// Equal to the exact floor for spans up to 2¹⁶ codes: the slope is too large
/// by less than one unit, which adds less than d / 2³² ≤ 1 / span to the
/// quotient, and its fraction is at most 1 − 1 / span. For wider spans an edge
/// may come early by at most span / 2³² of a bin.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Binner {
    low: i32,
    /// Below 2³¹.
    slope: u32,
}

impl Binner {
    /// From the code of the lower edge and the slope, below 2³¹.
    pub(crate) const fn new(low: i32, slope: u32) -> Self {
        Self { low, slope }
    }

    #[cfg(feature = "std")]
    pub(crate) const fn slope(self) -> u32 {
        self.slope
    }

    /// The code of the lower edge of the first bin.
    pub const fn low(&self) -> i32 {
        self.low
    }

    /// The bin, 0 to `last`: codes outside the range go to its edges.
    #[inline]
    pub fn bin(&self, code: i32, last: usize) -> usize {
        // Below 2³² where the code is above the lower edge.
        let above = code.wrapping_sub(self.low).cast_unsigned();
        let d = if code < self.low { 0 } else { above };
        (high(d, self.slope) as usize).min(last)
    }
}

/// ⌊x y / 2³²⌋.
#[inline]
const fn high(x: u32, y: u32) -> u32 {
    if IS_SMALL && x >> 16 == 0 {
        high_of_half(x, y)
    } else {
        ((x as u64 * y as u64) >> 32) as u32
    }
}

/// The same for x below 2¹⁶, as the codes of a sensor are: of two products that fit.
#[inline]
const fn high_of_half(x: u32, y: u32) -> u32 {
    (x * (y >> 16) + ((x * (y & 0xffff)) >> 16)) >> 16
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::high_of_half;

    proptest! {
        #[test]
        fn half_products_make_the_whole(x: u16, y: u32) {
            for (x, y) in [(x, y), (x, u32::MAX), (u16::MAX, y), (u16::MAX, u32::MAX)] {
                let exact = (u64::from(x) * u64::from(y)) >> 32;
                prop_assert_eq!(u64::from(high_of_half(x.into(), y)), exact);
            }
        }
    }
}
