//! Elementary functions in 32-bit fixed point, Q28: piecewise quadratics with
//! 16-bit slopes whose tables are made at compile time.

use super::constant;
use super::product::{high, scaled};

/// One, Q28.
const ONE: i32 = 1 << 28;

/// One segment of a function in powers of the position t about its middle,
/// −1/2 to 1/2: c_0 + (c_1 + c_2 t) t.
#[derive(Clone, Copy)]
struct Segment {
    /// c_0, Q28.
    middle: i32,
    /// c_1 and c_2, Q21.
    slopes: [i16; 2],
}

/// Segments of equal width, 2^`BITS`, from zero on.
struct Quadratics<const N: usize, const BITS: u32>([Segment; N]);

impl<const N: usize, const BITS: u32> Quadratics<N, BITS> {
    const LAST: u32 = ((N as u32) << BITS) - 1;

    /// The value at `x` ≥ 0, or that at the end of the table; Q28.
    #[inline]
    fn at(&self, x: i32) -> i32 {
        // Limited so that the index is in the table for any `x`.
        let x = x.cast_unsigned().min(Self::LAST);
        let segment = self.0[(x >> BITS) as usize];
        // The position about the middle in Q16: its top bit is inverted.
        let t = ((x << (32 - BITS)).cast_signed() ^ i32::MIN) >> 16;
        let [c1, c2] = segment.slopes.map(i32::from);
        segment.middle + (((c1 + ((c2 * t) >> 16)) * t) >> 9)
    }
}

/// Expands to the quadratics through `f` at the three Chebyshev nodes of each
/// of `$n` segments of 2^`$bits` in Q`$q`: within h³ max|f‴|/192 of it.
macro_rules! quadratics {
    ($f:path, $n:literal segments of $bits:literal bits of Q $q:literal) => {{
        // Chebyshev's nodes on [−1/2, 1/2] are 0 and ± this.
        const T: f64 = 0.433_012_701_892_219_3;
        const fn nearest(x: f64) -> i32 {
            (if x < 0.0 { x - 0.5 } else { x + 0.5 }) as i32
        }
        let width = (1_u64 << $bits) as f64 / (1_u64 << $q) as f64;
        let mut table = [Segment {
            middle: 0,
            slopes: [0; 2],
        }; $n];
        let mut n = 0;
        while n < $n {
            let middle = width * (n as f64 + 0.5);
            let y = [$f(middle - width * T), $f(middle), $f(middle + width * T)];
            let q21 = (1 << 21) as f64;
            let slope = nearest((y[2] - y[0]) / (2.0 * T) * q21);
            let bend = nearest((y[2] - 2.0 * y[1] + y[0]) / (2.0 * T * T) * q21);
            assert!(slope.abs() < 1 << 15 && bend.abs() < 1 << 15);
            table[n] = Segment {
                middle: nearest(y[1] * ONE as f64),
                slopes: [slope as i16, bend as i16],
            };
            n += 1;
        }
        Quadratics::<$n, $bits>(table)
    }};
}

const fn half_tanh_f64(x: f64) -> f64 {
    constant::tanh(2.0 * x) / 2.0
}

const fn exp_neg(x: f64) -> f64 {
    constant::exp(-x)
}

/// 1/(4 √(x + 1/4)).
const fn inv_sqrt_quarter(x: f64) -> f64 {
    constant::inv_sqrt(x + 0.25) / 4.0
}

static HALF_TANH: Quadratics<96, 22> = quadratics!(half_tanh_f64, 96 segments of 22 bits of Q 28);
static EXP_NEG: Quadratics<144, 18> = quadratics!(exp_neg, 144 segments of 18 bits of Q 24);
static INV_SQRT: Quadratics<48, 22> = quadratics!(inv_sqrt_quarter, 48 segments of 22 bits of Q 28);

/// tanh(2x)/2 for |x| ≤ 1.5, the value at ±1.5 beyond; largest error 6e-7.
#[inline]
pub(crate) fn half_tanh(x: i32) -> i32 {
    let half = HALF_TANH.at(x.saturating_abs());
    if x < 0 { -half } else { half }
}

/// exp(−x²) for |x| ≤ 1.5, the value at 1.5 beyond; largest error 6e-7.
#[inline]
pub(crate) fn exp_neg_square(x: i32) -> i32 {
    EXP_NEG.at(high(x, x))
}

/// 1 − 1/√(1 + x) for |x| ≤ 1/16; largest error 1.4e-4 of itself plus 1e-8.
#[inline]
pub(crate) fn one_minus_inv_sqrt(x: i32) -> i32 {
    // x (c_0 − x (c_1 − x c_2)), c in Q15.
    const C: [i32; 3] = [16_384, 12_317, 10_285];
    let t = x >> 13;
    let ratio = C[0] - ((t * (C[1] - ((t * C[2]) >> 15))) >> 15);
    scaled::<15>(x, ratio as i16)
}

/// The direction of (`a`, `b`) as a vector of length one in Q28, from two
/// numbers of the same scale; `None` at the origin. Relative error of the
/// length 4e-9 where the larger number has all its bits.
#[inline]
pub(crate) fn unit(a: i32, b: i32) -> Option<[i32; 2]> {
    let top = a.unsigned_abs() | b.unsigned_abs();
    if top == 0 {
        return None;
    }
    // To Q30 with the larger of the two in 1/2..1.
    let spare = top.leading_zeros() as i32 - 2;
    let scale = |x: i32| if spare >= 0 { x << spare } else { x >> -spare };
    let (a, b) = (i64::from(scale(a)), i64::from(scale(b)));
    // Q60, 1/4 to 2; as x in Q31.
    let square = ((a * a + b * b) >> 29) as u32;
    // 1/√x = (1/√(x/4))/2: the table covers 1/4 to 1.
    let above_one = square >= 1 << 31;
    let x = if above_one { square >> 2 } else { square };
    let offset = x - (1 << 29);
    let guess = i64::from(INV_SQRT.at((offset >> 3) as i32)) << 3;
    // Newton on y = 2 guess, Q30 and Q31: y (3 − x y²)/2, in halves of y.
    let w = (((guess * guess) >> 30) * i64::from(x)) >> 31;
    let y = (guess * ((3 << 30) - (w << 2))) >> 30;
    let shift = if above_one { 33 } else { 32 };
    Some([a, b].map(|side| ((side * y) >> shift) as i32))
}

#[cfg(test)]
mod tests {
    use super::{exp_neg_square, half_tanh, one_minus_inv_sqrt, unit};

    const ONE: f64 = 268_435_456.0;

    #[test]
    fn functions_end_in_the_values_at_their_ends() {
        for beyond in [3 << 27, i32::MAX, i32::MIN, -(2 << 28), 5 << 28] {
            assert!((f64::from(exp_neg_square(beyond)) / ONE - (-2.25_f64).exp()).abs() < 5e-7);
            let end = 3.0_f64.tanh().copysign(f64::from(beyond)) / 2.0;
            assert!((f64::from(half_tanh(beyond)) / ONE - end).abs() < 5e-7);
            assert_eq!(exp_neg_square(beyond), exp_neg_square(3 << 27));
        }
    }

    #[test]
    fn one_minus_inv_sqrt_is_within_its_stated_error() {
        for n in -62_500..=62_500 {
            let x = (f64::from(n) * 1e-6 * ONE) as i32;
            let exact = 1.0 - 1.0 / (1.0 + f64::from(x) / ONE).sqrt();
            let error = (f64::from(one_minus_inv_sqrt(x)) / ONE - exact).abs();
            assert!(error < 1.4e-4 * exact.abs() + 1e-8, "{n}: {error:e}");
        }
    }

    #[test]
    fn unit_vectors_have_length_one_at_every_radius() {
        let mut worst = 0.0_f64;
        for n in 0..200_000 {
            let angle = f64::from(n) * 0.37;
            let radius = ONE * 1.49 * 0.999_9_f64.powi(n % 60_000);
            let (a, b) = ((radius * angle.cos()) as i32, (radius * angle.sin()) as i32);
            let Some([x, y]) = unit(a, b) else { continue };
            let r = f64::from(a).hypot(f64::from(b));
            worst = worst.max((f64::from(x) / ONE - f64::from(a) / r).abs());
            worst = worst.max((f64::from(y) / ONE - f64::from(b) / r).abs());
        }
        assert!(worst < 1.2e-8, "{worst:e}");
        assert_eq!(unit(0, 0), None);
        let (low, high) = (i32::MIN, i32::MAX);
        for (a, b) in [(low, high), (high, 1), (0, low), (1, 0), (0, -1)] {
            let [x, y] = unit(a, b).unwrap();
            let length = f64::from(x).hypot(f64::from(y)) / ONE;
            assert!((length - 1.0).abs() < 2e-8, "{a} {b}: {length}");
        }
    }
}
