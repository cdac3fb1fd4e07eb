//! An opinion's parts as words of a model file: see `opinion/section.rs`.

use std::vec::Vec;

use super::linear::Linear;
use super::paths::{Paths, Sensor};
use super::stands::{Fit, Stands};
use super::typical::Typical;
use crate::format::ENTRIES_PER_BIT;
use crate::opinion::differences::FEATURE_BITS;
use crate::opinion::section::{Bounds, MEANS, Section, begun};
use crate::opinion::{PATH_BITS, STATE_BITS, STATES, blocks_of};

/// Two halves a word, the first below; a zero after an odd one.
fn write_halves(words: &mut Vec<u32>, halves: &[i16]) {
    let half = |half: Option<&i16>| u32::from(half.copied().unwrap_or(0).cast_unsigned());
    let pairs = halves.chunks(2);
    words.extend(pairs.map(|pair| half(pair.first()) | half(pair.get(1)) << 16));
}

/// How often numbers can be doubled so that all fit 16 bits, at most 40 times; and they.
fn scaled(numbers: &[f64]) -> (u32, Vec<i16>) {
    let most = numbers.iter().fold(0.0_f64, |most, n| most.max(n.abs()));
    let fits = |shift: &u32| most * f64::from(*shift).exp2() <= f64::from(i16::MAX);
    let shift = (0..=40).rev().find(fits).unwrap_or(0);
    let unit = f64::from(shift).exp2();
    // `as` saturates: only what is beyond 16 bits without a shift.
    (
        shift,
        numbers.iter().map(|n| (n * unit).round() as i16).collect(),
    )
}

/// Weights of means of states, so much a mean; written for their sums. What all classes have
/// in common is left off.
pub(super) fn stage(words: &mut Vec<u32>, (stage, weighed): (usize, usize), linear: &Linear) {
    let classes = linear.weights.len();
    let numbers = begun(stage) * weighed;
    let mean = |of: &dyn Fn(usize) -> f64| (0..classes).map(of).sum::<f64>() / classes as f64;
    let weight = |class: usize, n: usize| linear.weights[class].get(n).copied().unwrap_or(0.0);
    let mut all = Vec::with_capacity(classes * numbers);
    for class in 0..classes {
        for n in 0..numbers {
            let own = weight(class, n) - mean(&|class| weight(class, n));
            let blocks = blocks_of(STATES[n / weighed], stage).max(1);
            let unit = f64::from(ENTRIES_PER_BIT) / f64::from(1 << FEATURE_BITS);
            all.push(own * unit / blocks as f64);
        }
    }
    let (shift, all) = scaled(&all);
    words.push(shift);
    let common = mean(&|class| linear.biases[class]);
    let bias = |bias: &f64| ((bias - common) * f64::from(ENTRIES_PER_BIT)).round() as i32;
    words.extend(linear.biases.iter().map(|of| bias(of).cast_unsigned()));
    write_halves(words, &all);
}

/// Sets a bit of the kind.
fn mark(words: &mut [u32], kind: u8) {
    if let Some(head) = words.first_mut() {
        *head |= u32::from(kind);
    }
}

/// Bit 6 of the kind, and of each class what is typical of means.
pub(super) fn means<'t>(words: &mut Vec<u32>, typical: impl Iterator<Item = &'t Typical>) {
    mark(words, MEANS);
    let of_means = typical.flat_map(|typical| typical.of_means.concat());
    words.extend(of_means.map(squared));
}

/// A squared distance in deviations, as it is compared.
fn squared(square: f64) -> u32 {
    (square * f64::from(1 << (2 * STATE_BITS))).round() as u32
}

/// Bit 2 of the kind, and what poses are estimated by, of the stages in which a decision may fall.
pub(super) fn stands(words: &mut Vec<u32>, stands: &Stands) {
    mark(words, 4);
    let first = *Section::new(words, 0).pose_stages().start();
    // `as` saturates: what a target cannot be is the nearest that it can.
    let hundredths = |value: f64| (100.0 * value).round();
    let halves = |[low, high]: [u16; 2]| u32::from(low) | u32::from(high) << 16;
    let limits = |limits: &[f64; 2]| limits.map(|of| (hundredths(of) as i16).cast_unsigned());
    words.extend(stands.limits.iter().map(limits).map(halves));
    let fits = stands
        .classes
        .iter()
        .flat_map(|of| of.iter().skip(first - 1));
    for Fit { weights, errors } in fits {
        words.push(halves(
            errors.map(|error| hundredths(error).max(1.0) as u16),
        ));
        let scaled = weights.each_ref().map(|(weights, _)| scaled_words(weights));
        words.push(halves(scaled.each_ref().map(|(shift, _)| *shift as u16)));
        for ((_, weights), (_, bias)) in scaled.iter().zip(weights) {
            words.push((hundredths(*bias) as i32).cast_unsigned());
            words.extend(weights);
        }
    }
}

/// Bit 3 of the kind, and by how much a sensor may differ, if at all.
pub(super) fn bounds(words: &mut Vec<u32>, sensor: Sensor) {
    let bounds = sensor.bounds();
    if bounds == Bounds::default() {
        return;
    }
    mark(words, 8);
    // Each is 4,096 at most: half of the scale, and half a radian.
    let [turn, scale] = [bounds.turn, bounds.scale].map(i32::cast_unsigned);
    words.push(turn | scale << 16);
}

/// As [`scaled`], of numbers that have a word each, in hundredths.
fn scaled_words(numbers: &[f64]) -> (u32, Vec<u32>) {
    let most = numbers.iter().fold(0.0_f64, |most, n| most.max(n.abs()));
    let fits = |shift: &u32| 100.0 * most * f64::from(*shift).exp2() <= f64::from(i32::MAX);
    let shift = (0..=60).rev().find(fits).unwrap_or(0);
    let unit = 100.0 * f64::from(shift).exp2();
    let word = |n: &f64| ((n * unit).round() as i32).cast_unsigned();
    (shift, numbers.iter().map(word).collect())
}

pub(super) fn typical(words: &mut Vec<u32>, typical: &Typical) {
    for state in &typical.states {
        let unit = f64::from(1 << FEATURE_BITS);
        let means = state.mean.iter().map(|m| (m * unit).round() as i16);
        write_halves(words, &means.collect::<Vec<_>>());
        let unit = f64::from(1 << STATE_BITS) / unit;
        let rows = state.whitening.triangle().flatten();
        let (shift, triangle) = scaled(&rows.map(|value| value * unit).collect::<Vec<_>>());
        words.push(shift);
        write_halves(words, &triangle);
    }
    words.extend(typical.limits.map(squared));
}

pub(super) fn paths(words: &mut Vec<u32>, paths: &Paths) {
    // Deviations are at least four.
    let inverse = |deviation: &f64| (65_536.0 / deviation).round() as i16;
    write_halves(
        words,
        &paths.deviations.iter().map(inverse).collect::<Vec<_>>(),
    );
    for mean in &paths.means {
        let codes: Vec<i16> = mean.iter().map(|code| code.round() as i16).collect();
        write_halves(words, &codes);
    }
    let square = f64::from(1 << (2 * PATH_BITS));
    words.push((paths.limit * square).round() as u32);
}
