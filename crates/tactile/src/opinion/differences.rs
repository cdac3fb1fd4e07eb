//! What a block of samples says that does not care which way the whisker bends: the powers of
//! second differences along and across its mean deflection.
//!
//! With d = v\[n\] − 2 v\[n − L\] + v\[n − 2L\] of both channels at a lag L, the block's means
//! Sxx, Sxy, Syy of dx², dx dy, dy², and the mean deflection (a, b) from rest, the powers are
//!
//! u = (a² Sxx + 2ab Sxy + b² Syy) / (a² + b²), w = (a² Syy − 2ab Sxy + b² Sxx) / (a² + b²)
//!
//! and the features ½ log₂(1 + u), then ½ log₂(1 + w), of each lag. A sensor that is turned
//! about the whisker's axis turns (a, b) and the differences alike and changes neither.

use super::FEATURES;

/// Lags of the differences, samples: at 2 kHz they are largest at 500 to 31 Hz.
const LAGS: [usize; FEATURES / 2] = [2, 4, 8, 16, 32];
const KEPT: usize = 64;
/// Bits of the fraction of a feature.
pub(crate) const FEATURE_BITS: u32 = 8;
/// Bits of the fraction of the rest.
const REST_BITS: u32 = 8;
/// Least size of the deflection along x: below it its way is not known.
const LEAST: i32 = 50;

/// How codes become the numbers that differences are taken of: 14 bits with a sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Narrow {
    /// The code that becomes zero.
    pub(crate) centre: i32,
    /// Bits that are left off.
    pub(crate) shift: u32,
}

pub(crate) const NARROW_MOST: i32 = 8191;

impl Narrow {
    /// Of a code; at the end of the range beyond it.
    #[inline]
    pub(crate) fn of(self, code: i32) -> i16 {
        let code = code.wrapping_sub(self.centre) >> self.shift.min(31);
        // Within 14 bits.
        code.clamp(-NARROW_MOST - 1, NARROW_MOST) as i16
    }
}

/// The features of a block, in units of 2^−[`FEATURE_BITS`].
pub(crate) type Features = [i16; FEATURES];

/// The last samples, the sums of the open block, and where rest is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Differences {
    line: [[i16; 2]; KEPT],
    /// The place of the next sample, by its lower bits.
    next: usize,
    /// Samples since the last gap, at most [`KEPT`].
    filled: usize,
    /// Of dx², dx dy, dy², a lag each: below 2⁴⁴ of [`crate::format::MAX_BLOCK`] samples.
    sums: [[i64; 3]; LAGS.len()],
    totals: [i32; 2],
    counted: u32,
    /// Whether the line was full when the open block began.
    is_whole: bool,
    /// In units of 2^−[`REST_BITS`] narrow codes.
    pub(crate) rest: [i32; 2],
}

impl Differences {
    pub(crate) const fn new(rest: [i32; 2]) -> Self {
        Self {
            line: [[0; 2]; KEPT],
            next: 0,
            filled: 0,
            sums: [[0; 3]; LAGS.len()],
            totals: [0; 2],
            counted: 0,
            is_whole: false,
            rest,
        }
    }

    /// Takes a narrow sample. One that does not count is of the air: rest follows it by 1/256.
    pub(crate) fn push(&mut self, sample: [i16; 2], counts: bool) {
        if counts {
            self.add(sample);
        } else {
            for (rest, code) in self.rest.iter_mut().zip(sample) {
                *rest = rest.wrapping_add(i32::from(code).wrapping_sub(*rest >> REST_BITS));
            }
        }
        self.line[self.next % KEPT] = sample;
        self.next = self.next.wrapping_add(1) % KEPT;
        self.filled = (self.filled + 1).min(KEPT);
    }

    /// Samples of the open block.
    pub(crate) const fn counted(&self) -> u32 {
        self.counted
    }

    /// Whether all samples of the open block have their differences.
    pub(crate) const fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// Adds a sample that is not yet kept.
    fn add(&mut self, sample: [i16; 2]) {
        if self.counted == 0 {
            self.is_whole = self.filled == KEPT;
        }
        self.counted = self.counted.wrapping_add(1);
        for (total, code) in self.totals.iter_mut().zip(sample) {
            *total = total.wrapping_add(i32::from(code));
        }
        for (sums, lag) in self.sums.iter_mut().zip(LAGS) {
            if self.filled < 2 * lag {
                break;
            }
            let before = |lag: usize| self.line[self.next.wrapping_sub(lag) % KEPT];
            let (middle, last) = (before(lag), before(2 * lag));
            let difference = |channel: usize| {
                let ends = i32::from(sample[channel]) + i32::from(last[channel]);
                ends - 2 * i32::from(middle[channel])
            };
            // At most 2¹⁵ each.
            let (dx, dy) = (difference(0), difference(1));
            for (sum, product) in sums.iter_mut().zip([dx * dx, dx * dy, dy * dy]) {
                *sum = sum.wrapping_add(i64::from(product));
            }
        }
    }

    /// Samples are missing: there is no difference until the line is full again.
    pub(crate) const fn interrupt(&mut self) {
        self.filled = 0;
    }

    /// Drops the open block.
    pub(crate) fn clear(&mut self) {
        self.sums = [[0; 3]; LAGS.len()];
        self.totals = [0; 2];
        self.counted = 0;
    }

    /// Ends the block: its features, and its mean deflection from rest.
    // Once a block, likewise.
    #[inline(never)]
    pub(crate) fn end_of_block(&mut self) -> (Features, [i16; 2]) {
        let counted = self.counted.max(1);
        let deflection: [i32; 2] = core::array::from_fn(|channel| {
            let [total, rest] = [self.totals[channel], self.rest[channel]];
            let code = total
                .wrapping_div(counted.cast_signed())
                .wrapping_sub(rest >> REST_BITS);
            code.clamp(-2 * NARROW_MOST, 2 * NARROW_MOST)
        });
        let [x, y] = deflection;
        let frame = Frame::of(if x.abs() < LEAST { LEAST } else { x }, y);
        let mut features = [0; FEATURES];
        let (along, across) = features.split_at_mut(LAGS.len());
        let of_one = log2(counted.into());
        for ((along, across), sums) in along.iter_mut().zip(across).zip(&self.sums) {
            [*along, *across] = frame.powers(*sums).map(|power| {
                // ½ log₂(1 + power / counted), of 2^10 units an octave; below 2¹³ of 64 bits.
                let octaves = log2(power.saturating_add(counted.into())) - of_one;
                (octaves >> (10 + 1 - FEATURE_BITS)) as i16
            });
        }
        self.clear();
        // Within 15 bits.
        (features, deflection.map(|code| code as i16))
    }
}

/// The way of a deflection (a, b), as the square of the cosine of its angle and the product of that
/// with its sine, in units of 2⁻²⁴.
struct Frame {
    cos2: i64,
    cos_sin: i64,
}

impl Frame {
    /// Each below 2¹⁵ in size.
    fn of(a: i32, b: i32) -> Self {
        let length2 = (a * a + b * b).unsigned_abs().max(1);
        let product = a * b;
        let cos_sin = i64::from(share(product.unsigned_abs(), length2));
        Self {
            cos2: share((a * a).unsigned_abs(), length2).into(),
            cos_sin: if product < 0 { -cos_sin } else { cos_sin },
        }
    }

    /// Sums of the squares along and across, of the sums of dx², dx dy, dy².
    fn powers(&self, [xx, xy, yy]: [i64; 3]) -> [u64; 2] {
        // Sums are below 2³⁷ in blocks of 128 samples; of longer ones bits are lost.
        let beyond = (xx | yy).unsigned_abs() >> 37;
        let lost = beyond.checked_ilog2().map_or(0, |bits| bits + 1);
        let [xx, xy, yy] = [xx >> lost, xy >> lost, yy >> lost];
        // The square of the sine is what the cosine's leaves of one.
        let turned = self.cos2.wrapping_mul(xx - yy);
        let turned = turned.wrapping_add(self.cos_sin.wrapping_mul(2 * xy));
        let along = (yy << 24).wrapping_add(turned);
        let across = (xx << 24).wrapping_sub(turned);
        [along, across].map(|power| ((power >> 24).max(0).unsigned_abs()) << lost)
    }
}

/// ⌊2²⁴ `part` / `whole`⌋ of a part up to the whole, which is below 2³¹. Bit by bit: a core
/// without a division takes longer for one of 64 bits.
fn share(part: u32, whole: u32) -> u32 {
    let (mut rest, mut share) = (part, 0);
    for _ in 0..25 {
        share *= 2;
        if rest >= whole {
            rest -= whole;
            share += 1;
        }
        rest *= 2;
    }
    share
}

/// 1024 log₂ x for x ≥ 1, with the fraction of x's leading bit taken as its logarithm: at most
/// 0.086 octaves too low, and rising.
fn log2(x: u64) -> i32 {
    let upper = (x >> 32) as u32;
    // Of the half that has it: a core may have to count.
    let (half, below) = if upper == 0 {
        (x as u32, 0)
    } else {
        (upper, 32)
    };
    let whole = below + half.max(1).ilog2();
    let below = (x << (u64::BITS - 1 - whole)) << 1;
    ((whole << 10) | (below >> (u64::BITS - 10)) as u32) as i32
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A block of samples after as many that fill the line, with rest at zero.
    fn features(samples: &[[f64; 2]]) -> (Features, [i16; 2]) {
        let mut differences = Differences::new([0; 2]);
        for (n, sample) in samples.iter().enumerate() {
            let sample = sample.map(|code| code.round() as i16);
            differences.push(sample, true);
            if n < KEPT {
                differences.clear();
            }
        }
        differences.end_of_block()
    }

    fn mean(samples: &[[f64; 2]], channel: usize) -> f64 {
        let block = (samples.len() - KEPT) as f64;
        let of = samples[KEPT..].iter().map(|s| s[channel].round());
        of.sum::<f64>() / block
    }

    /// The same by the definition, in double precision, along and across a deflection.
    fn exactly(samples: &[[f64; 2]], [a, b]: [f64; 2]) -> [f64; FEATURES] {
        let block = samples.len() - KEPT;
        let mut features = [0.0; FEATURES];
        for (at, lag) in LAGS.into_iter().enumerate() {
            let mut sums = [0.0; 3];
            for n in KEPT..samples.len() {
                let d = |channel: usize| {
                    let v = |n: usize| samples[n][channel].round();
                    v(n) - 2.0 * v(n - lag) + v(n - 2 * lag)
                };
                sums[0] += d(0) * d(0) / block as f64;
                sums[1] += d(0) * d(1) / block as f64;
                sums[2] += d(1) * d(1) / block as f64;
            }
            let [xx, xy, yy] = sums;
            let (c, s, m) = (a * a, b * b, 2.0 * a * b);
            features[at] = 0.5 * (1.0 + (c * xx + m * xy + s * yy) / (c + s)).log2();
            features[at + LAGS.len()] = 0.5 * (1.0 + (c * yy - m * xy + s * xx) / (c + s)).log2();
        }
        features
    }

    /// Two noisy channels about a deflection, from a seed.
    fn noise(seed: u64, deflection: [f64; 2], size: [f64; 2]) -> Vec<[f64; 2]> {
        let mut state = seed | 1;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        let samples = 0..KEPT + 40;
        samples
            .map(|_| [0, 1].map(|k| deflection[k] + size[k] * next()))
            .collect()
    }

    proptest! {
        #[test]
        fn features_are_the_powers_of_the_definition(
            seed: u64,
            a in 100.0..3000.0_f64,
            b in -3000.0..3000.0_f64,
            sizes in prop::array::uniform2(1.0..1000.0_f64),
        ) {
            let samples = noise(seed, [a, b], sizes);
            let (found, deflection) = features(&samples);
            // In whole codes: of a weak deflection these turn what is along and across.
            let deflection = deflection.map(f64::from);
            for channel in [0, 1] {
                prop_assert!((deflection[channel] - mean(&samples, channel)).abs() <= 1.0);
            }
            for (found, exact) in found.into_iter().zip(exactly(&samples, deflection)) {
                let found = f64::from(found) / f64::from(1 << FEATURE_BITS);
                // Two logarithms, each up to 0.086 low, halved.
                prop_assert!((found - exact).abs() < 0.06, "{found} {exact}");
            }
        }

        /// A sensor turned about its axis: the same features but for the rounding of codes.
        #[test]
        fn a_turned_sensor_feels_the_same(seed: u64, angle in -1.0..1.0_f64) {
            let samples = noise(seed, [2000.0, 300.0], [900.0, 300.0]);
            let (sin, cos) = angle.sin_cos();
            let turned = samples.iter().map(|[x, y]| [x * cos - y * sin, x * sin + y * cos]);
            let turned: Vec<_> = turned.collect();
            let (before, after) = (features(&samples).0, features(&turned).0);
            for (before, after) in before.into_iter().zip(after) {
                prop_assert!((before - after).abs() <= 20, "{before} {after}");
            }
        }
    }

    #[test]
    fn extremes_do_not_overflow() {
        for lag in [1_usize, 2, 4, 8, 16, 32] {
            let mut differences = Differences::new([i32::MAX, i32::MIN]);
            for n in 0..10_000 {
                let code = if (n / lag) % 2 == 0 { -8192 } else { 8191 };
                differences.push([code, code], true);
            }
            let (features, _) = differences.end_of_block();
            let range = 0..=18 << FEATURE_BITS;
            assert!(features.iter().all(|feature| range.contains(feature)));
        }
    }

    #[test]
    fn across_a_gap_there_is_no_difference() {
        let mut differences = Differences::new([0; 2]);
        for n in 0..100 {
            if n == 90 {
                differences.interrupt();
                differences.clear();
            }
            differences.push([if n < 90 { 0 } else { 1000 }, 0], true);
        }
        assert_eq!(differences.end_of_block().0, [0; FEATURES]);
    }

    #[test]
    fn a_block_is_whole_if_all_its_samples_have_differences() {
        let mut differences = Differences::new([0; 2]);
        let mut block = || {
            (0..KEPT / 2).for_each(|n| differences.push([n as i16, 0], true));
            let is_whole = differences.is_whole();
            differences.end_of_block();
            is_whole
        };
        assert_eq!([block(), block(), block()], [false, false, true]);
    }

    #[test]
    fn rest_follows_the_air_and_not_the_touch() {
        let mut differences = Differences::new([0; 2]);
        for _ in 0..3000 {
            differences.push([400, -300], false);
        }
        for _ in 0..40 {
            differences.push([900, 0], true);
        }
        let (_, [x, y]) = differences.end_of_block();
        assert!((x - 500).abs() <= 1 && (y - 300).abs() <= 1, "{x} {y}");
    }
}
