//! Whether a touch goes the way of a class.
//!
//! The way f, mean deflections (x, y) of each block, is held against that of the class in one
//! pose of training, p, the step s from there to the next pose, and what another sensor makes of
//! p: r = (−y, x), turned about the shaft, and q = (0, y), of another scale in y. In deviations of
//! training, the touch is near where
//!
//! min over a, b, c of |f − p − a s − b r − c q|² / (2 blocks) ≤ limit
//!
//! for one pair of neighbours, a between the two and up to [`BEYOND`] past the outermost, b and c
//! within the [bounds](Bounds) of the model. The shares are set one after another, by successive
//! over-relaxation.

use super::section::Bounds;
use super::{BLOCKS, DEVIATION_MOST, PATH_BITS};

/// How far beyond the outermost poses a path may lie, in steps to the next pose; 1/256.
const BEYOND: i32 = 128;
/// Of a turn of 1/32 and of 1/16 more of y, as shifts: so much of a model's largest deflection by
/// its least deviation is 2¹² at most, as [`deviation`] is.
pub(crate) const TURN_BITS: u32 = 5;
pub(crate) const SCALE_BITS: u32 = 4;

/// Ways in which a path may differ from that of a pose.
const WAYS: usize = 3;
/// Rounds in which shares are set, in training as well, and how much further than to the least square
/// each goes, in eighths: ways that are nearly along one another take hundreds of rounds without.
pub(crate) const ROUNDS: usize = 16;
pub(crate) const EIGHTHS: i32 = 13;

/// The paths of a class: inverse deviations, means of each pose, limit.
pub(crate) type Paths<'m> = (&'m [u32], &'m [u32], u32);

/// Squares and products over a path, in deviations, 2^−(2 [`PATH_BITS`]). A factor is at most
/// 2¹² in size and there are 18, so that sums stay below 2²⁹.
#[derive(Default)]
struct Products {
    felt2: i32,
    /// Of what was felt, from the pose, with each way.
    felt: [i32; WAYS],
    ways: [[i32; WAYS]; WAYS],
}

/// Whether the path of a touch is near one of a class; `rest` is that of training, narrow codes.
pub(crate) fn is_near(
    path: &[[i16; 2]],
    (inverse, means, limit): Paths<'_>,
    rest: [i32; 2],
    bounds: Bounds,
) -> bool {
    let poses = means.len() / BLOCKS;
    let most = i64::from(limit) * 2 * path.len() as i64;
    if poses == 1 && bounds == Bounds::default() {
        // There is no way in which to differ.
        return i64::from(square(path, inverse, means)) <= most;
    }
    for pose in 0..poses.max(2) - 1 {
        let own = means.get(pose * BLOCKS..).unwrap_or_default();
        let next = means.get((pose + 1) * BLOCKS..).unwrap_or_default();
        let first = if pose == 0 { -BEYOND } else { 0 };
        let last = if pose + 2 >= poses { 256 + BEYOND } else { 256 };
        let bounds = [
            [first, last],
            [-bounds.turn, bounds.turn],
            [-bounds.scale, bounds.scale],
        ];
        let products = Products::of(path, inverse, [own, next], rest);
        if products.least(bounds) <= most {
            return true;
        }
    }
    false
}

/// That of a way from that of a pose.
fn square(path: &[[i16; 2]], inverse: &[u32], means: &[u32]) -> i32 {
    let blocks = path.iter().zip(inverse).zip(means);
    let squares = blocks.map(|((felt, scales), mean)| {
        let [x, y] = [0, 1].map(|n| {
            let [scale, mean] = [*scales, *mean].map(|word| (word >> (16 * n)) as u16);
            let off = i32::from(felt[n]) - i32::from(mean.cast_signed());
            deviation(off, scale.into(), 0)
        });
        x * x + y * y
    });
    squares.sum()
}

impl Products {
    fn of(path: &[[i16; 2]], inverse: &[u32], poses: [&[u32]; 2], rest: [i32; 2]) -> Self {
        let mut products = Self::default();
        for (block, felt) in path.iter().enumerate() {
            let word = |words: &[u32]| words.get(block).copied();
            let scales = word(inverse).unwrap_or(0);
            let [own, next] = poses;
            let own = word(own).unwrap_or(0);
            // There is no next of one pose: then it is the same.
            let next = word(next).unwrap_or(own);
            let codes = |word: u32| [word as u16, (word >> 16) as u16].map(u16::cast_signed);
            let [own, next] = [own, next].map(|word| codes(word).map(i32::from));
            let [x, y] = [0, 1].map(|n| own[n] - rest[n]);
            let sensor = [[-y, 0], [x, y]];
            for (n, [turned, scaled]) in sensor.into_iter().enumerate() {
                let scale = i32::from((scales >> (16 * n)) as u16);
                let felt = deviation(i32::from(felt[n]) - own[n], scale, 0);
                let ways = [
                    deviation(next[n] - own[n], scale, 0),
                    deviation(turned, scale, TURN_BITS),
                    deviation(scaled, scale, SCALE_BITS),
                ];
                products.add(felt, ways);
            }
        }
        products
    }

    fn add(&mut self, felt: i32, ways: [i32; WAYS]) {
        self.felt2 += felt * felt;
        for ((with_felt, with), way) in self.felt.iter_mut().zip(&mut self.ways).zip(ways) {
            *with_felt += felt * way;
            for (with, other) in with.iter_mut().zip(ways) {
                *with += other * way;
            }
        }
    }

    /// The square that is left with the best shares within their bounds, 1/256.
    fn least(&self, bounds: [[i32; 2]; WAYS]) -> i64 {
        let mut shares = [0_i32; WAYS];
        for _ in 0..ROUNDS {
            let mut has_moved = false;
            for (n, [first, last]) in bounds.into_iter().enumerate() {
                let own = self.ways[n][n];
                // All others as they are: what is left of the product with this one.
                let left = i64::from(self.felt[n]) - self.of_others(shares, n);
                let left = left.clamp(-PRODUCT_MOST, PRODUCT_MOST) as i32;
                let best = (left * 4) / (own >> 6).max(1);
                let by = (best.clamp(-SHARE_MOST, SHARE_MOST) - shares[n]) * EIGHTHS / 8;
                let share = (shares[n] + by).clamp(first, last);
                has_moved |= share != shares[n];
                shares[n] = share;
            }
            if !has_moved {
                break;
            }
        }
        let mut taken = 0;
        for (n, share) in shares.into_iter().enumerate() {
            let own = (i64::from(share) * i64::from(self.ways[n][n])) >> 8;
            let all = own + self.of_others(shares, n);
            taken += i64::from(share) * (2 * i64::from(self.felt[n]) - all);
        }
        i64::from(self.felt2) - (taken >> 8)
    }

    /// The product of a way with what the others take.
    fn of_others(&self, shares: [i32; WAYS], way: usize) -> i64 {
        let others = self.ways[way].iter().zip(shares).enumerate();
        let others = others.filter(|(n, _)| *n != way);
        let sum: i64 = others
            .map(|(_, (product, share))| i64::from(*product) * i64::from(share))
            .sum();
        sum >> 8
    }
}

/// What a share can be before it is held within its bounds, which are 16 bits.
const SHARE_MOST: i32 = 1 << 20;
/// The most that is left of a product: four times it is below 2³¹.
const PRODUCT_MOST: i64 = (1 << 29) - 1;

/// A difference of codes in deviations, 2^−[`PATH_BITS`], over 2^`bits`; `scale` is 2¹⁶ over the
/// deviation.
#[inline]
fn deviation(difference: i32, scale: i32, bits: u32) -> i32 {
    // 17 bits by 16: wraps only of a scale that no trainer writes.
    let size = difference.wrapping_mul(scale) >> (16 - PATH_BITS + bits);
    let most = (DEVIATION_MOST << PATH_BITS) - 1;
    size.clamp(-most, most)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The least square over shares within their bounds: where both are free, or on an edge.
    fn least_of(felt: [f64; 2], ways: [[f64; 2]; 2], bounds: [f64; 2]) -> f64 {
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let left = |[a, b]: [f64; 2]| {
            let off = [0, 1].map(|n| felt[n] - a * ways[0][n] - b * ways[1][n]);
            dot(off, off)
        };
        let on_edge = |fixed: usize, at: f64| {
            let (free, way) = (1 - fixed, ways[1 - fixed]);
            let off = [0, 1].map(|n| felt[n] - at * ways[fixed][n]);
            let best = dot(off, way) / dot(way, way).max(1e-9);
            let mut shares = [at; 2];
            shares[free] = best.clamp(-bounds[free], bounds[free]);
            left(shares)
        };
        let edges = [0, 1].map(|n| on_edge(n, bounds[n]).min(on_edge(n, -bounds[n])));
        let det = ways[0][0] * ways[1][1] - ways[0][1] * ways[1][0];
        let free = [
            (felt[0] * ways[1][1] - felt[1] * ways[1][0]) / det,
            (ways[0][0] * felt[1] - ways[0][1] * felt[0]) / det,
        ];
        let is_within = [0, 1].iter().all(|n| free[*n].abs() <= bounds[*n]);
        let inner = if is_within { 0.0 } else { f64::INFINITY };
        edges[0].min(edges[1]).min(inner)
    }

    proptest! {
        /// A way of one block in one pose, x and y in deviations of 16 codes.
        #[test]
        fn what_another_sensor_explains_is_taken_off(
            own in [-4000..4000_i32, -4000..4000],
            off in [-600..600_i32, -600..600],
            bounds in [0..1500_i32, 0..1500],
        ) {
            let most = bounds.map(|bound| f64::from(bound) / 256.0);
            let bounds = bounds.map(|bound| [-bound, bound]);
            let word = |codes: [i32; 2]| {
                let [x, y] = codes.map(|code| u32::from((code as i16).cast_unsigned()));
                x | y << 16
            };
            let felt = [0, 1].map(|n| (own[n] + off[n]) as i16);
            let products = Products::of(&[felt], &[4096 | 4096 << 16], [&[word(own)]; 2], [0; 2]);
            let found = products.least([[0, 0], bounds[0], bounds[1]]) as f64 / 1024.0;
            let [x, y] = own.map(|code| f64::from(code) / 16.0);
            let ways = [[-y / 32.0, x / 32.0], [0.0, y / 16.0]];
            let expected = least_of(off.map(|code| f64::from(code) / 16.0), ways, most);
            // In deviations, less than one of which whole codes and shares of 1/256 leave.
            let size = |square: f64| (1.0 + square.max(0.0)).sqrt();
            let (found, expected) = (size(found), size(expected));
            prop_assert!((found - expected).abs() < 0.6, "{found}, not {expected}");
        }
    }
}
