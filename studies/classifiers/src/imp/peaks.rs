//! The peaks of one vibrissa's deflection, and their A/T.

/// √(x² + y²) in units of 2⁻¹⁶ code, rounded down: at most 2⁻¹⁵ of itself low.
#[inline]
pub fn deflection(x: i16, y: i16) -> u32 {
    root(square(x, y))
}

/// x² + y², at most 2³¹.
#[inline]
fn square(x: i16, y: i16) -> u32 {
    let [x, y] = [x, y].map(|v| u32::from(v.unsigned_abs()));
    x * x + y * y
}

/// The square root of at most 2³¹, in units of 2⁻¹⁶. Shifted up by an even
/// number of places first, so that the integer root has 16 bits.
#[inline]
fn root(square: u32) -> u32 {
    // 16 for nought alone, whose root is nought however shifted.
    let places = (square.leading_zeros() / 2).min(15);
    (square << (2 * places)).isqrt() << (16 - places)
}

/// How far the deflection must turn back for a peak or a trough to count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Band {
    /// b², of 16 bits squared.
    square: u32,
}

impl Band {
    /// A band in codes; nought is the paper's rule, each sign change.
    pub const fn new(codes: u16) -> Self {
        let codes = codes as u32;
        Self {
            square: codes * codes,
        }
    }

    /// Whether √high > √low + b, without a root: high − low − b² > 2 b √low,
    /// and both sides squared.
    #[inline]
    fn beyond(self, high: u32, low: u32) -> bool {
        if self.square == 0 {
            return high > low;
        }
        let Some(left) = high
            .checked_sub(low)
            .and_then(|d| d.checked_sub(self.square))
        else {
            return false;
        };
        // Below 2⁶²; so it does not matter where the right side saturates.
        let left = u64::from(left) * u64::from(left);
        left > u64::from(self.square).saturating_mul(4 * u64::from(low))
    }
}

/// The peaks so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Peaks {
    /// The square of the largest deflection of a rise, or the smallest of a fall.
    extreme: u32,
    /// Samples since the largest of this rise.
    age: u32,
    /// Samples since the last peak.
    since: u32,
    rising: bool,
    /// Whether there was a peak: the first has no period.
    any: bool,
    /// Of A/T, in units of 2⁻¹⁶ code a sample.
    sum: u64,
    count: u32,
}

impl Default for Peaks {
    /// Before the first sample.
    fn default() -> Self {
        Self {
            // As if falling from above all squares: what the first sample
            // begins with is no peak.
            extreme: u32::MAX,
            age: 0,
            since: 0,
            rising: false,
            any: false,
            sum: 0,
            count: 0,
        }
    }
}

impl Peaks {
    /// Takes a sample in codes. Costs a few comparisons, and at a peak a square
    /// root and a division.
    #[inline]
    pub fn push(&mut self, band: Band, x: i16, y: i16) {
        let r = square(x, y);
        self.since = self.since.saturating_add(1);
        if self.rising {
            self.age = self.age.saturating_add(1);
            if r > self.extreme {
                self.extreme = r;
                self.age = 0;
            } else if band.beyond(self.extreme, r) {
                self.peak();
                self.rising = false;
                self.extreme = r;
            }
        } else if r <= self.extreme {
            self.extreme = r;
        } else if band.beyond(r, self.extreme) {
            self.rising = true;
            self.extreme = r;
            self.age = 0;
        }
    }

    #[inline(never)]
    fn peak(&mut self) {
        if self.any {
            // Two peaks are two samples apart at least; where the counters have
            // run to their ends, one keeps the division whole.
            let period = self.since.saturating_sub(self.age).max(1);
            self.sum += u64::from(root(self.extreme) / period);
            self.count += 1;
        }
        self.any = true;
        self.since = self.age;
    }

    /// Peaks with a period since the last [`take`](Self::take).
    pub fn count(&self) -> u32 {
        self.count
    }

    /// The mean of A/T over the peaks since the last call, in units of 2⁻¹⁶
    /// code a sample; nought if there were none. A peak counts where it is
    /// noticed, and its period may begin before.
    #[inline]
    pub fn take(&mut self) -> u32 {
        // Each term is below 2³¹, and so is their mean.
        let mean = self.sum.checked_div(u64::from(self.count)).unwrap_or(0) as u32;
        self.sum = 0;
        self.count = 0;
        mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_within_their_bound_and_never_high() {
        let squares = (0..100_000).chain((0..31).flat_map(|e| [(1 << e) - 1, (1 << e) + 1]));
        for square in squares.chain([1 << 31]) {
            let exact = f64::from(square).sqrt();
            let found = f64::from(root(square)) / 65536.0;
            assert!(found <= exact, "{square}");
            assert!(found >= exact * (1.0 - 1.0 / 32768.0), "{square}: {found}");
        }
        assert_eq!(deflection(3, -4), 5 << 16);
        assert_eq!(deflection(i16::MIN, i16::MIN), root(1 << 31));
    }

    #[test]
    fn a_band_is_compared_exactly() {
        // √ of 100² and of (100 − b)² are b apart, to the last digit.
        for b in 1..100 {
            let band = Band::new(b);
            let low = u32::from(100 - b) * u32::from(100 - b);
            assert!(!band.beyond(10_000, low));
            assert!(band.beyond(10_001, low));
        }
        // 46340² is the last square below 2³¹, and no deflection is 65535 high.
        assert!(Band::new(46_340).beyond(1 << 31, 0));
        assert!(!Band::new(46_341).beyond(1 << 31, 0));
        assert!(!Band::new(u16::MAX).beyond(1 << 31, 0));
        assert!(!Band::default().beyond(7, 7) && Band::default().beyond(8, 7));
    }
}
