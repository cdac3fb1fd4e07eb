//! 2^−x in integers: a table of 2^(−i/128), and straight lines between its
//! entries. One multiplication of 32 bits, which the smallest cores have too.
//!
//! Largest relative error 3.7e-6 (the chord of a convex curve lies above it by
//! at most (ln 2 / 128)² / 8), 6.6e-7 from the 13 bits that a place in a cell
//! has, and the rounding of 2⁻²⁶: below 4.1e-6 together, for they are not
//! largest in one place. Never rises with x, and exactly one at x = 0, so that
//! perfect ties stay perfect.

/// Fraction bits of the result: the sum of 32 terms of at most one, and a
/// bound as large beside it, still fit a word.
pub(crate) const TERM_BITS: u32 = 26;
/// One, as a result.
pub(crate) const ONE: u32 = 1 << TERM_BITS;
/// Fraction bits of the high word of the argument: the index into the table.
pub(crate) const INDEX_BITS: u32 = 7;

const CELLS: usize = 1 << INDEX_BITS;

/// Bits of the place in a cell: beside the 19 bits by which the first and
/// steepest cell falls, what a word holds.
const PLACE_BITS: u32 = 13;

/// 2^(−i/128), rounded: the ends of the cells.
static TABLE: [u32; CELLS + 1] = table();

const fn table() -> [u32; CELLS + 1] {
    let mut table = [0; CELLS + 1];
    let mut i = 0;
    while i <= CELLS {
        table[i] = (exp2_neg_f64(i as f64 / CELLS as f64) * ONE as f64 + 0.5) as u32;
        i += 1;
    }
    table
}

/// 2^−x for 0 ≤ x ≤ 1, for the compiler to make the table with.
const fn exp2_neg_f64(x: f64) -> f64 {
    // The series of exp(−y), y < 0.7: twenty terms leave less than 1e-20.
    let y = core::f64::consts::LN_2 * x;
    let mut sum = 1.0;
    let mut n = 20.0;
    while n >= 1.0 {
        sum = 1.0 - sum * y / n;
        n -= 1.0;
    }
    sum
}

/// 2^(gain − x), x in units of 2⁻³⁹ (seven bits of index and a word of
/// fraction below the integer part), in units of 2⁻²⁶.
///
/// Where x < gain the integer part counts as zero: the result then lies in
/// (2²⁵, 2²⁶], which is all that a caller with a bound below it needs.
/// `gain` ≤ 63. Truncated, so up to one unit low besides the relative error.
#[inline]
pub(crate) fn exp2_neg(x: u64, gain: i32) -> u32 {
    let high = (x >> 32) as u32;
    let place = (x as u32) >> (u32::BITS - PLACE_BITS);
    // Always in range: seven bits, and one more, index 129 entries.
    let cell = (high % (1 << INDEX_BITS)) as usize;
    let (start, end) = (TABLE[cell], TABLE[cell + 1]);
    let mantissa = start - (((start - end) * place) >> PLACE_BITS);
    // x < 2⁶² in all uses, so the integer part is a positive i32.
    let shift = ((high >> INDEX_BITS) as i32 - gain).clamp(0, 31);
    mantissa >> shift
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relative_error_is_as_stated() {
        let mut worst = 0.0_f64;
        for cell in 0..CELLS as u64 {
            // Beginning and end of every place.
            for part in 0..=16384_u64 {
                let low = (part << 18).min(u64::from(u32::MAX));
                let x = (cell << 32) | low;
                let exact = (-(x as f64) / 2.0_f64.powi(39)).exp2();
                let found = f64::from(exp2_neg(x, 0)) / f64::from(ONE);
                worst = worst.max((found / exact - 1.0).abs());
            }
        }
        // Bounded on both sides: the table can neither decay nor be mismeasured.
        assert!((4.0e-6..4.1e-6).contains(&worst), "{worst:e}");
    }

    #[test]
    fn zero_is_one_and_halving_is_exact() {
        for n in 0..27 {
            assert_eq!(exp2_neg(n << 39, 0), ONE >> n);
        }
        assert_eq!(exp2_neg(40 << 39, 0), 0);
        assert_eq!(exp2_neg(u64::MAX >> 2, 0), 0);
    }

    #[test]
    fn gain_lifts_small_terms_and_saturates_large_ones() {
        assert_eq!(exp2_neg(40 << 39, 40), ONE);
        assert_eq!(exp2_neg(43 << 39, 40), ONE >> 3);
        let above_bound = exp2_neg((39 << 39) | 0x7f_ffff_ffff, 40);
        assert!(above_bound >= ONE / 2);
    }
}
