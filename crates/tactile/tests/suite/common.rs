//! Shared by the tests: models made to measure, and chance.

use tactile::{
    Axis, ENTRIES_PER_BIT, ENTRY_OFFSET_BITS, ModelBuf, ModelParts, Quantiser, TableParts,
    Threshold, TouchRule,
};

pub(crate) const TOUCHES: TouchRule = TouchRule {
    limit: 2048,
    gate: 0.05,
    gap: 200,
};

/// Uniform in 0 to 1.
pub(crate) fn roll(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

/// Normal to four decimals of its variance: twelve uniform numbers.
pub(crate) fn normal(state: &mut u64) -> f64 {
    (0..12).map(|_| roll(state)).sum::<f64>() - 6.0
}

pub(crate) fn threshold(theta: f64) -> Threshold {
    Threshold::new(theta).unwrap()
}

pub(crate) fn entry(log2_p: f64) -> u16 {
    ((log2_p + f64::from(ENTRY_OFFSET_BITS)) * f64::from(ENTRIES_PER_BIT)).round() as u16
}

/// A model whose channels all have codes 0 to 1000, and log2-likelihoods by a
/// function of bin, channel and class.
pub(crate) fn model(
    classes: usize,
    channels: usize,
    bins: usize,
    block: u32,
    log2_p: impl Fn(usize, usize, usize) -> f64,
) -> ModelBuf {
    let names: Vec<String> = (0..classes).map(|k| format!("class {k}")).collect();
    let axis = |channel| Axis::new(channel, bins, [0, 1000]);
    let axes: Vec<Axis> = (0..channels).map(axis).collect();
    let entries: Vec<Vec<u16>> = (0..channels)
        .map(|channel| {
            let classes = |bin| (0..classes).map(move |class| (bin, class));
            let cells = (0..bins).flat_map(classes);
            cells
                .map(|(bin, class)| entry(log2_p(bin, channel, class)))
                .collect()
        })
        .collect();
    let tables: Vec<TableParts<'_>> = axes
        .iter()
        .zip(&entries)
        .map(|(axis, entries)| TableParts::of_channel(axis, entries))
        .collect();
    let channels = vec![Quantiser::of_codes(0, 1000); channels];
    ModelBuf::new(&ModelParts {
        names: &names,
        block,
        channels: &channels,
        tables: &tables,
        ..ModelParts::default()
    })
    .unwrap()
}

/// A model of two channels of codes 0 to 1000.
pub(crate) fn of_two(names: &[&str], rest: ModelParts<'_>) -> ModelBuf {
    let names: Vec<String> = names.iter().copied().map(str::to_owned).collect();
    ModelBuf::new(&ModelParts {
        names: &names,
        channels: &[Quantiser::of_codes(0, 1000); 2],
        ..rest
    })
    .unwrap()
}

/// The middle code of a bin of such a model.
pub(crate) fn code(bin: usize, bins: usize) -> i32 {
    ((bin * 1000 + 500) / bins) as i32
}

/// Two classes of normal codes, means 400 and 600, sd 150, in 100 bins. The
/// likelihood ratio of code x in sd units is closed: (x − 500) · 200 / 150².
pub(crate) fn two_normals(block: u32) -> ModelBuf {
    model(2, 1, 100, block, |bin, _, class| {
        let x = 10.0 * bin as f64 + 5.0;
        let mean = [400.0, 600.0][class];
        let z = (x - mean) / 150.0;
        // Bin width over sd times the density.
        (10.0 / 150.0 / (2.0 * std::f64::consts::PI).sqrt()).log2()
            - 0.5 * z * z * std::f64::consts::LOG2_E
    })
}

/// The logarithm of the likelihood ratio of a code under them.
pub(crate) fn ln_ratio(code: i32) -> f64 {
    let middle = 10.0 * f64::from(code / 10) + 5.0;
    (middle - 500.0) * 200.0 / (150.0 * 150.0)
}
