//! Levels of signs: quantiles that follow slowly.

/// Bits of a level, and of the rest, below one code.
pub(super) const FRACTION: u32 = 12;
/// A level moves by 2^−n of itself a sample, up and down: quick signs to their lower
/// fifth, deflection to its upper ninth. In a touch slowly: enough to let go of what does
/// not end.
pub(super) const QUICK_RATES: Rates = Rates {
    start: [8, 6],
    air: [10, 8],
    touch: [13, 11],
};
pub(super) const DEFLECTION_RATES: Rates = Rates {
    start: [6, 8],
    air: [8, 11],
    touch: [13, 16],
};

pub(super) struct Rates {
    start: [u32; 2],
    air: [u32; 2],
    touch: [u32; 2],
}

impl Rates {
    #[inline]
    pub(super) const fn at(&self, in_touch: bool, is_start: bool) -> [u32; 2] {
        match (in_touch, is_start) {
            (_, true) => self.start,
            (true, false) => self.touch,
            (false, false) => self.air,
        }
    }
}

/// Steps up and down of a share each, by which a level becomes a quantile.
#[inline]
pub(super) fn follow(level: &mut u32, sign: u32, [up, down]: [u32; 2]) {
    if sign > *level >> FRACTION {
        // Below 2^31: signs are below 2^18.
        *level = level.wrapping_add(*level >> up);
    } else {
        *level = (*level - (*level >> down)).max(1 << FRACTION);
    }
}

/// A level within what it can be: from one code, where a quantile can still rise, to all that
/// a sign can be.
pub(super) fn bounded(level: u32) -> u32 {
    level.clamp(1 << FRACTION, 1 << 30)
}
