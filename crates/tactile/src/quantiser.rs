//! From a sample to its bin, exactly and without a division.
//!
//! A real sample x becomes a code = round((x − origin) · 2^exponent), which on
//! the module is the sensor's own integer code (origin 0, exponent 0). The bin
//! is floor((code − low) · B / (high − low)); the upper edge belongs to the last
//! bin, and what lies outside goes to the edge bin.

use crate::binner::Binner;
use crate::divide::divide;
use crate::error::QuantiserError;

const MAX_EXPONENT: i32 = 1000;

/// The range of one channel and the scale of its codes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantiser {
    /// What code zero stands for, in the units of the samples.
    pub origin: f64,
    /// Codes a unit, as a power of two: −1000 to 1000.
    pub exponent: i32,
    /// Code of the lower edge of the first bin.
    pub low: i32,
    /// Code of the upper edge of the last bin. Equal to `low` for a channel
    /// that never changed in training: then every sample lands in bin 0 and
    /// the channel tells no classes apart.
    pub high: i32,
}

impl Quantiser {
    /// Of whole codes as they come, from `low` to `high`.
    pub const fn of_codes(low: i32, high: i32) -> Self {
        Self {
            origin: 0.0,
            exponent: 0,
            low,
            high,
        }
    }

    /// Checks the ranges for a number of bins.
    ///
    /// # Errors
    /// [`QuantiserError`] names the bad one. The range must be one code (a
    /// constant channel), or from above two codes a bin to below 2³¹ codes.
    pub fn check(&self, bins: usize) -> Result<(), QuantiserError> {
        if !self.origin.is_finite() {
            return Err(QuantiserError::Origin);
        }
        if self.exponent.unsigned_abs() > MAX_EXPONENT as u32 {
            return Err(QuantiserError::Exponent(self.exponent));
        }
        if self.high < self.low {
            return Err(QuantiserError::Reversed);
        }
        let span = self.high.abs_diff(self.low);
        if span != 0 && (span as usize <= 2 * bins || span > i32::MAX as u32) {
            return Err(QuantiserError::Span(span));
        }
        Ok(())
    }

    /// The code of a sample: rounded to nearest, halves away from zero,
    /// saturated to 32 bits (so infinities go to the edge bins). Not a number
    /// goes to the lower edge, bin 0: refuse it before where it can occur.
    ///
    /// For PCs and set-up; the streaming step takes integers.
    pub fn code_from_f64(&self, x: f64) -> i32 {
        if x.is_nan() {
            return self.low;
        }
        let scaled = (x - self.origin) * exp2_i(self.exponent);
        // `as` truncates towards zero and saturates; the fraction decides the rest.
        let whole = scaled as i64;
        let fraction = scaled - whole as f64;
        let carry = i64::from(fraction >= 0.5) - i64::from(fraction <= -0.5);
        let code = whole.saturating_add(carry);
        code.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
    }

    /// Whether the code of a raw integer is raw · 2^exponent: always so for a model trained on
    /// integers of 31 bits, unless they are huge beside their range. The exponent is zero unless
    /// the training data had two raw steps a bin or fewer.
    pub fn takes_raw(&self) -> bool {
        // Zero of either sign, without a comparison in double precision.
        self.origin.to_bits() << 1 == 0 && self.exponent >= 0
    }

    /// The division-free form for the streaming step; see [`Binner`].
    ///
    /// # Errors
    /// As [`Self::check`].
    pub fn binner(&self, bins: usize) -> Result<Binner, QuantiserError> {
        self.check(bins)?;
        // More than two a bin, which keeps the slope below 2³¹; none of a constant channel, whose
        // slope of zero sends every code to bin 0.
        let slope = match self.high.abs_diff(self.low) {
            0 => 0,
            // Rounded up.
            span => divide(bins as u32, span - 1, span.into()),
        };
        Ok(Binner::new(self.low, slope))
    }
}

/// 2^e for |e| ≤ 1000 (clamped), exactly.
const fn exp2_i(e: i32) -> f64 {
    let e = if e > MAX_EXPONENT {
        MAX_EXPONENT
    } else if e < -MAX_EXPONENT {
        -MAX_EXPONENT
    } else {
        e
    };
    f64::from_bits(((e + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn raw(low: i32, high: i32) -> Quantiser {
        Quantiser::of_codes(low, high)
    }

    #[test]
    fn a_constant_channel_has_one_bin() {
        let b = raw(7, 7).binner(100).unwrap();
        for code in [i32::MIN, -1, 7, 8, i32::MAX] {
            assert_eq!(b.bin(code, 99), 0);
        }
    }

    #[test]
    fn ranges_are_checked() {
        assert_eq!(raw(1, 0).check(2), Err(QuantiserError::Reversed));
        assert_eq!(raw(0, 4).check(2), Err(QuantiserError::Span(4)));
        assert_eq!(raw(0, 5).check(2), Ok(()));
        let widest = QuantiserError::Span(0x8000_0000);
        assert_eq!(raw(i32::MIN, 0).check(2), Err(widest));
        let mut q = raw(0, 100);
        q.exponent = -1001;
        assert_eq!(q.check(2), Err(QuantiserError::Exponent(-1001)));
        q.exponent = i32::MIN;
        assert!(q.check(2).is_err());
        q = raw(0, 100);
        q.origin = f64::NAN;
        assert_eq!(q.check(2), Err(QuantiserError::Origin));
    }

    #[test]
    fn codes_round_and_saturate() {
        let q = Quantiser {
            origin: 1.0,
            exponent: 2,
            low: -8,
            high: 100,
        };
        assert_eq!(q.code_from_f64(1.0), 0);
        assert_eq!(q.code_from_f64(2.124), 4);
        assert_eq!(q.code_from_f64(2.125), 5);
        assert_eq!(q.code_from_f64(-0.124), -4);
        assert_eq!(q.code_from_f64(-0.125), -5);
        assert_eq!(q.code_from_f64(f64::INFINITY), i32::MAX);
        assert_eq!(q.code_from_f64(f64::NEG_INFINITY), i32::MIN);
        assert_eq!(q.code_from_f64(f64::NAN), -8);
        let shifted = Quantiser { origin: 0.0, ..q };
        assert!(shifted.takes_raw() && !q.takes_raw());
        assert_eq!(shifted.code_from_f64(-3.0), -12);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        #[test]
        fn integers_match_the_f64_floor_exactly(
            low in -100_000_000_i32..100_000_000,
            span in 3_i32..=65_536,
            bins in 1_usize..=4096,
            place in 0.0_f64..=1.0,
            outside in -100_000_i32..100_000,
        ) {
            prop_assume!(span as usize > 2 * bins);
            let high = low + span;
            let b = raw(low, high).binner(bins).unwrap();
            // Near every edge, inside at random, and outside. The upper edge is in the last bin.
            let inside = low + (place * f64::from(span)) as i32;
            let edge = low + ((place * bins as f64).floor() * f64::from(span) / bins as f64).ceil() as i32;
            let far = [low + outside, i32::MIN, i32::MAX];
            for code in [low, high, inside, edge - 1, edge, edge + 1].into_iter().chain(far) {
                let above = f64::from(code) - f64::from(low);
                let exact = (above * bins as f64 / f64::from(span)).floor();
                let expected = exact.clamp(0.0, bins as f64 - 1.0) as usize;
                prop_assert_eq!(b.bin(code, bins - 1), expected);
            }
        }

        #[test]
        fn wide_spans_are_off_by_no_more_than_stated(
            span in 65_537_i32..i32::MAX,
            bins in 1_usize..=4096,
            place in 0.0_f64..=1.0,
        ) {
            let code = (place * f64::from(span)) as i32;
            let exact = f64::from(code) * bins as f64 / f64::from(span);
            let found = raw(0, span).binner(bins).unwrap().bin(code, bins - 1);
            let top = bins - 1;
            let least = (exact.floor() as usize).min(top);
            let most = ((exact + f64::from(span) / 4_294_967_296.0).floor() as usize).min(top);
            prop_assert!((least..=most).contains(&found));
        }
    }
}
