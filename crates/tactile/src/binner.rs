//! From a code to its bin, without a division.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// Finds a bin by one multiplication: floor((code − low) · slope / 2³²) with
/// slope = ⌈B · 2³² / span⌉.
///
/// Equal to the exact floor for spans up to 2¹⁶ codes: the slope is too large
/// by less than one unit, which adds less than d / 2³² ≤ 1 / span to the
/// quotient, and its fraction is at most 1 − 1 / span. For wider spans an edge
/// may come early by at most span / 2³² of a bin.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable,
)]
#[repr(C)]
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

    /// The code of the lower edge of the first bin.
    pub const fn low(&self) -> i32 {
        self.low
    }

    /// The bin, 0 to `last`: codes outside the range go to its edges.
    #[inline]
    pub fn bin(&self, code: i32, last: usize) -> usize {
        if code < self.low {
            return 0;
        }
        let d = code.abs_diff(self.low);
        let bin = (u64::from(d) * u64::from(self.slope)) >> 32;
        (bin as usize).min(last)
    }
}
