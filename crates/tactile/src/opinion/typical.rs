//! How far the features of a state are from those of a class.

use super::section::halves;
use super::{DEVIATION_MOST, FEATURES, STATE_BITS, STATES};

/// How far the states that have ended are from a class, each inverted: 0 where it is not known, which
/// costs no bytes of a program.
pub(super) type Ended = [u32; STATES.len()];

/// The largest deviation of a sum. Of a trained model below 2¹⁵; 2¹⁶ by 2¹⁵ is what a word holds.
const MOST: i32 = u16::MAX as i32;

/// The squared distance of the sums over so many blocks, three at most, from a class whose mean
/// and triangle these words are: below 2²⁶. Of no blocks it is 0. Features come first among the
/// sums; what else is weighed does not count.
pub(super) fn square(words: &[u32], sums: &[i16], blocks: usize) -> u32 {
    // Of a mean over blocks: by their square, in 2⁻¹⁶.
    let share = match blocks {
        1 => 65_536,
        2 => 16_384,
        3 => 7_282,
        _ => return 0,
    };
    let Some(([means @ .., shift], triangle)) = words.split_first_chunk::<{ FEATURES / 2 + 1 }>()
    else {
        return 0;
    };
    let mut from = [0_i32; FEATURES];
    for ((from, sum), mean) in from.iter_mut().zip(sums).zip(halves(means)) {
        let off = i32::from(*sum) - i32::from(*mean) * blocks as i32;
        *from = off.clamp(-MOST, MOST);
    }
    let mut triangle = halves(triangle);
    let mut squares = 0;
    for row in 0..FEATURES {
        let (weights, below) = triangle.split_at_checked(row + 1).unwrap_or_default();
        triangle = below;
        let weighed = from.iter().zip(weights);
        let sum: i64 = weighed
            .map(|(from, weight)| i64::from(from * i32::from(*weight)))
            .sum();
        let most = i64::from(DEVIATION_MOST) << STATE_BITS;
        let size = (sum >> shift.min(&63)).clamp(-most, most) as i32;
        // Ten of them are below 2²⁶.
        squares += (size * size).unsigned_abs();
    }
    ((u64::from(squares) * share) >> 16) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: one weight, in the second row and the first column, of 16 a deviation.
    #[test]
    fn a_row_weighs_the_features_before_it() {
        let mut words = [0; FEATURES / 2 + 1 + 28];
        // Means of 1 of the first feature and 2 of the second; no shift.
        words[0] = 1 | 2 << 16;
        words[FEATURES / 2 + 1] = 16 << 16;
        let of = |sums: [i16; 2], blocks| {
            let mut all = [0; FEATURES];
            all[..2].copy_from_slice(&sums);
            square(&words, &all, blocks)
        };
        // Three off, of one block, and of a mean over three: a ninth.
        assert_eq!(of([4, 2], 1), (3 * 16) * (3 * 16));
        assert_eq!(of([-2, 99], 1), (3 * 16) * (3 * 16));
        assert_eq!(of([6, 6], 3), 256);
        assert_eq!(of([1, 2], 1), 0);
        // A deviation counts 128 at most.
        assert_eq!(of([9_999, 2], 1), (128 * 16) * (128 * 16));
        assert_eq!(of([4, 2], 0), 0);
    }
}
