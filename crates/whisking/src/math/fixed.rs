//! Elementary functions in 32-bit fixed point: piecewise cubics whose tables
//! are made at compile time, and one Newton step for the root.

use super::constant;

/// Cubics on `N` segments of equal width: coefficients in Q30 of the position
/// within the segment, 0 to 1, constant first.
struct Cubics<const N: usize>([[i32; 4]; N]);

impl<const N: usize> Cubics<N> {
    /// The value at `segment + fraction`, the fraction in Q31; Q30. Beyond the
    /// table its last segment's.
    #[inline]
    fn at(&self, segment: usize, fraction: u32) -> i32 {
        let [c0, c1, c2, c3] = self.0[if segment < N { segment } else { N - 1 }];
        let t = i64::from(fraction);
        let step = |sum: i32, c: i32| ((i64::from(sum) * t) >> 31) as i32 + c;
        step(step(step(c3, c2), c1), c0)
    }
}

/// Expands to the cubics through `f` at the four Chebyshev nodes of each of
/// `$n` segments of `$width` from `$from` on: within h⁴ max|f⁗|/3072 of it.
macro_rules! cubics {
    ($f:path, $n:literal segments of $width:expr, from $from:expr) => {{
        // Chebyshev's nodes on [0, 1].
        const T: [f64; 4] = [
            0.038_060_233_744_356_62,
            0.308_658_283_817_455_1,
            0.691_341_716_182_544_9,
            0.961_939_766_255_643_4,
        ];
        const fn nearest(x: f64) -> i32 {
            (if x < 0.0 { x - 0.5 } else { x + 0.5 }) as i32
        }
        let mut table = [[0; 4]; $n];
        let mut n = 0;
        while n < $n {
            let low = $from + $width * n as f64;
            let y = [
                $f(low + $width * T[0]),
                $f(low + $width * T[1]),
                $f(low + $width * T[2]),
                $f(low + $width * T[3]),
            ];
            // Newton's divided differences, then Horner's scheme into powers.
            let d01 = (y[1] - y[0]) / (T[1] - T[0]);
            let d12 = (y[2] - y[1]) / (T[2] - T[1]);
            let d23 = (y[3] - y[2]) / (T[3] - T[2]);
            let d012 = (d12 - d01) / (T[2] - T[0]);
            let d123 = (d23 - d12) / (T[3] - T[1]);
            let c3 = (d123 - d012) / (T[3] - T[0]);
            let c2 = d012 - c3 * (T[0] + T[1] + T[2]);
            let c1 = d01 - d012 * (T[0] + T[1]) + c3 * (T[0] * T[1] + T[0] * T[2] + T[1] * T[2]);
            let c0 = y[0] - T[0] * (c1 + T[0] * (c2 + T[0] * c3));
            let q30 = (1_i64 << 30) as f64;
            table[n] = [
                nearest(c0 * q30),
                nearest(c1 * q30),
                nearest(c2 * q30),
                nearest(c3 * q30),
            ];
            n += 1;
        }
        Cubics::<$n>(table)
    }};
}

const fn half_tanh(x: f64) -> f64 {
    constant::tanh(2.0 * x) / 2.0
}

const fn exp_neg(x: f64) -> f64 {
    constant::exp(-x)
}

const fn inv_sqrt_halved(x: f64) -> f64 {
    constant::inv_sqrt(x) / 2.0
}

static HALF_TANH: Cubics<24> = cubics!(half_tanh, 24 segments of 1.0 / 16.0, from 0.0);
static EXP_NEG: Cubics<18> = cubics!(exp_neg, 18 segments of 1.0 / 8.0, from 0.0);
static INV_SQRT: Cubics<24> = cubics!(inv_sqrt_halved, 24 segments of 1.0 / 32.0, from 0.25);

/// Muscle drive (tanh 2x + 1)/2 of `x` in Q29, |x| ≤ 1.5, in Q29; largest error 1.7e-7.
#[inline]
pub(crate) fn drive(x: i32) -> i32 {
    let size = x.unsigned_abs().min((3 << 28) - 1);
    let half = HALF_TANH.at((size >> 25) as usize, (size << 7) >> 1) >> 1;
    let one_half = 1 << 28;
    if x < 0 {
        one_half - half
    } else {
        one_half + half
    }
}

/// exp(−x²) of `x` in Q29, |x| ≤ 1.5, in Q29; the value at 1.5 beyond; largest
/// error 9e-8.
#[inline]
pub(crate) fn exp_neg_square(x: i32) -> i32 {
    // The square stays below 2.25, the end of the table.
    let size = u64::from(x.unsigned_abs().min((3 << 28) - 1));
    let u = ((size * size) >> 29) as u32;
    EXP_NEG.at((u >> 26) as usize, (u << 6) >> 1) >> 1
}

/// 1/√(1 + x) − 1 of `x` in Q29, |x| ≤ 1/16, in Q29; largest error 8e-7.
#[inline]
pub(crate) fn lack(x: i32) -> i32 {
    // Σ c_k x^(k+1), c in Q30.
    const LACK: [i32; 3] = [-536_869_237, 403_606_996, -337_009_796];
    let times_x = |c: i32| ((i64::from(c) * i64::from(x)) >> 29) as i32;
    times_x(times_x(times_x(LACK[2]) + LACK[1]) + LACK[0]) >> 1
}

/// The direction of (`a`, `b`) as a vector of length one in Q29, from two
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
    let guess = i64::from(INV_SQRT.at((offset >> 26) as usize, (offset << 6) >> 1));
    // Newton on y = 2 guess, Q30 and Q31: y (3 − x y²)/2, in halves of y.
    let w = (((guess * guess) >> 30) * i64::from(x)) >> 31;
    let y = (guess * ((3 << 30) - (w << 2))) >> 30;
    let shift = if above_one { 32 } else { 31 };
    Some([a, b].map(|side| ((side * y) >> shift) as i32))
}

#[cfg(test)]
mod tests {
    use super::{drive, exp_neg_square, unit};

    const ONE: f64 = 536_870_912.0;

    fn points() -> impl Iterator<Item = i32> {
        (-300_000..=300_000).map(|n| (f64::from(n) * 5e-6 * ONE) as i32)
    }

    #[test]
    fn drive_is_within_its_stated_error() {
        let error = |x: i32| {
            let exact = f64::midpoint((2.0 * f64::from(x) / ONE).tanh(), 1.0);
            (f64::from(drive(x)) / ONE - exact).abs()
        };
        let worst = points().map(error).fold(0.0, f64::max);
        assert!(worst < 1.7e-7, "{worst:e}");
    }

    #[test]
    fn exponential_is_within_its_stated_error() {
        let error = |x: i32| {
            let exact = (-(f64::from(x) / ONE).powi(2)).exp();
            (f64::from(exp_neg_square(x)) / ONE - exact).abs()
        };
        let worst = points().map(error).fold(0.0, f64::max);
        assert!(worst < 9e-8, "{worst:e}");
        assert_eq!(exp_neg_square(i32::MIN), exp_neg_square(3 << 28));
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
        assert!(worst < 6e-9, "{worst:e}");
        assert_eq!(unit(0, 0), None);
        for corner in [
            (i32::MIN, i32::MAX),
            (i32::MAX, 1),
            (0, i32::MIN),
            (1, 0),
            (0, -1),
        ] {
            let [x, y] = unit(corner.0, corner.1).unwrap();
            let length = f64::from(x).hypot(f64::from(y)) / ONE;
            assert!((length - 1.0).abs() < 1e-8, "{corner:?}: {length}");
        }
    }
}
