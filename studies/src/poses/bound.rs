//! How far others get where the product falls short: a linear discriminant and a forest of trees
//! on features of a whole touch, which no board has to compute. Where they err as well, what was
//! recorded does not say more; where they do not, the rule loses it.

use anyhow::{Context, Result, anyhow};
use host_sim::recording::Stream;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use smartcore::ensemble::random_forest_regressor::{
    RandomForestRegressor, RandomForestRegressorParameters,
};
use smartcore::linalg::basic::matrix::DenseMatrix;
use tactile::ModelBuf;

use super::{Change, Extent, Output, SURFACES, THRESHOLD, Tally, Trained, judge};
use crate::decisions::figures::{number, percent};
use crate::page::row;

/// Seeds of the presentations, some for each condition.
const FRESH: u64 = 8801;
/// Samples of a block, and the first and the last block, from 0 and excluded, of each part of a
/// touch. A touch without the third part says too little.
const BLOCK: usize = 40;
const PARTS: [[usize; 2]; 4] = [[0, 1], [1, 3], [3, 6], [6, 9]];
const LEAST_BLOCKS: usize = 4;
/// Samples between readings that are held against each other.
const LAGS: [usize; 5] = [2, 4, 8, 16, 32];
/// Changes of y's scale of which copies are trained as well.
const GAINS: [f64; 3] = [1.0, 0.8, 1.25];
/// What correlations lose.
const SHRINK: f64 = 0.03;
const TREES: u16 = 100;
const LEAVES: usize = 2;

/// What is tested: its name, the trainings and the product's models, what differs from them, and
/// the share of presentations that its goal asks to be decided.
pub(super) struct Case<'c> {
    pub(super) name: &'static str,
    pub(super) trained: &'c Trained<'static>,
    pub(super) models: &'c [ModelBuf],
    pub(super) change: Option<Change>,
    pub(super) asked: f64,
}

struct Touch {
    class: usize,
    presentation: usize,
    features: Vec<f64>,
}

/// The answer to a touch.
#[derive(Clone, Copy)]
struct Answer {
    presentation: usize,
    sure: f64,
    is_right: bool,
}

pub(super) fn section(output: &mut Output, cases: &[Case<'_>], extent: &Extent) -> Result<()> {
    output.page.heading(2, "How far others get");
    output.page.say(format_args!(
        "A linear discriminant and {TREES} trees a class (`smartcore`) on the same trainings, with \
         copies of y × 0.8 and 1.25, tested on presentations of their own. They have the mean \
         deflections and the logarithms of five mean square differences of x and y in the four \
         parts of a touch of at least {LEAST_BLOCKS} blocks, as far as it goes. *All*: right of \
         all touches, where each must be answered. *As many*: right of the surest presentations, \
         as many as the product decides; then as many as the goal asks for."
    ));
    let mut rows = Vec::new();
    for (n, case) in cases.iter().enumerate() {
        let trainings: Vec<usize> = (0..case.models.len()).collect();
        let cores = extent.cores;
        let found = cores.each("how far others get", &trainings, |&training| {
            let seed = FRESH + (n * trainings.len() + training) as u64;
            case.of_training(training, seed)
        })?;
        let product = Tally::sum(found.iter().map(|(tally, _)| tally));
        let decided = product.decided_share();
        let mut cells = vec![percent(product.right_share()), percent(decided)];
        for kind in [0, 1] {
            let all: Vec<_> = found.iter().flat_map(|(_, of)| of[kind].clone()).collect();
            let mut surest: Vec<_> = found.iter().flat_map(|(_, of)| surest(&of[kind])).collect();
            surest.sort_by(|a, b| b.sure.total_cmp(&a.sure));
            let right_of = |share: f64| {
                // `as` saturates.
                let count = (share * surest.len() as f64).round() as usize;
                right(&surest[..count.min(surest.len())])
            };
            let of_goal = right_of(case.asked / 100.0);
            cells.extend([right(&all), right_of(decided.share), of_goal]);
        }
        rows.push(row(format!("{} ({} %)", case.name, case.asked), cells));
    }
    output.page.table(
        "condition (asked to decide) | product: right | decided | discriminant: all | as many | as \
         asked | trees: all | as many | as asked",
        rows,
    );
    Ok(())
}

impl Case<'_> {
    fn of_training(&self, training: usize, seed: u64) -> Result<(Tally, [Vec<Answer>; 2])> {
        let tested = self.trained.presentations(self.change.as_slice(), seed)?;
        let product = judge(&self.models[training], THRESHOLD, &tested)?;
        let recordings = &self.trained.recordings[training];
        let streams = recordings.iter().flat_map(|(_, streams)| streams);
        let streams: Vec<&Stream> = streams.collect();
        let known = GAINS.map(|gain| touches(streams.iter().copied(), gain));
        let known: Vec<Touch> = known.into_iter().flatten().collect();
        let felt = touches(&tested, 1.0);
        let linear = Discriminant::new(&known)?;
        let by_line: Vec<Vec<f64>> = felt.iter().map(|of| linear.posteriors(of)).collect();
        let by_trees = forest(&known, &felt)?;
        let answers = [by_line, by_trees].map(|of| answers(&felt, &of));
        Ok((product, answers))
    }
}

fn answers(felt: &[Touch], posteriors: &[Vec<f64>]) -> Vec<Answer> {
    let answer = |(touch, posteriors): (&Touch, &Vec<f64>)| {
        let best = posteriors.iter().copied().enumerate();
        let (leader, sure) = best.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0));
        Answer {
            presentation: touch.presentation,
            sure,
            is_right: leader == touch.class,
        }
    };
    felt.iter().zip(posteriors).map(answer).collect()
}

/// The surest answer to each presentation, the first of equals.
fn surest(answers: &[Answer]) -> Vec<Answer> {
    let of_each = answers.chunk_by(|a, b| a.presentation == b.presentation);
    let surer = |a: Answer, b: Answer| if a.sure < b.sure { b } else { a };
    let surest = of_each.filter_map(|of| of.iter().copied().reduce(surer));
    surest.collect()
}

fn right(answers: &[Answer]) -> String {
    let right = answers.iter().filter(|answer| answer.is_right).count();
    number(100.0 * right as f64 / answers.len() as f64, 1)
}

/// The touches of presentations whose deflection in y is `gain` times what it was.
fn touches<'s>(streams: impl IntoIterator<Item = &'s Stream>, gain: f64) -> Vec<Touch> {
    let mut all = Vec::new();
    for (presentation, stream) in streams.into_iter().enumerate() {
        let class = SURFACES.iter().position(|(name, _)| *name == stream.label);
        let numbers = stream.touch.as_deref().unwrap_or_default();
        let samples = stream.samples.iter();
        let samples = samples.map(|[x, y]| [x - 8192.0, gain * (y - 8192.0)]);
        let samples: Vec<[f64; 2]> = samples.collect();
        let mut start = 0;
        for touch in numbers.chunk_by(|a, b| a == b) {
            let end = start + touch.len();
            if touch.first().is_some_and(|number| *number > 0)
                && let Some(class) = class
                && let Some(features) = features(&samples, start, end)
            {
                all.push(Touch {
                    class,
                    presentation,
                    features,
                });
            }
            start = end;
        }
    }
    all
}

fn features(samples: &[[f64; 2]], start: usize, end: usize) -> Option<Vec<f64>> {
    let blocks = (end - start) / BLOCK;
    if blocks < LEAST_BLOCKS {
        return None;
    }
    let mut all: Vec<f64> = Vec::new();
    for [first, last] in PARTS {
        let part: Vec<usize> = (start + first * BLOCK..start + last.min(blocks) * BLOCK).collect();
        // What is not there any more is as the part before.
        let Some(count) = std::num::NonZeroUsize::new(part.len()) else {
            all.extend_from_within(all.len() - 2 * (1 + LAGS.len())..);
            continue;
        };
        let mean = |of: &dyn Fn(usize) -> f64| {
            part.iter().map(|at| of(*at)).sum::<f64>() / count.get() as f64
        };
        for code in [0, 1].map(|channel| move |at: usize| samples[at][channel]) {
            all.push(mean(&code));
            for lag in LAGS {
                let bend = |at: usize| {
                    let [before, first] = [1, 2].map(|n| at.saturating_sub(n * lag));
                    (code(at) - 2.0 * code(before) + code(first)).powi(2)
                };
                all.push((1.0 + mean(&bend)).log2());
            }
        }
    }
    Some(all)
}

struct Discriminant {
    means: Vec<DVector<f64>>,
    covariance: Cholesky<f64, Dyn>,
}

impl Discriminant {
    fn new(known: &[Touch]) -> Result<Self> {
        let size = known.first().context("no touch")?.features.len();
        let vector = |touch: &Touch| DVector::from_column_slice(&touch.features);
        let mut means = vec![DVector::zeros(size); SURFACES.len()];
        let mut counts = vec![0.0; SURFACES.len()];
        for touch in known {
            means[touch.class] += vector(touch);
            counts[touch.class] += 1.0;
        }
        for (mean, count) in means.iter_mut().zip(&counts) {
            *mean /= *count;
        }
        let mut covariance = DMatrix::zeros(size, size);
        for touch in known {
            let from = vector(touch) - &means[touch.class];
            covariance.ger(1.0 / known.len() as f64, &from, &from, 1.0);
        }
        let diagonal = DMatrix::from_diagonal(&covariance.diagonal().add_scalar(1e-6));
        let covariance = covariance * (1.0 - SHRINK) + diagonal * SHRINK;
        let covariance = covariance.cholesky().context("features that are alike")?;
        Ok(Self { means, covariance })
    }

    fn posteriors(&self, touch: &Touch) -> Vec<f64> {
        let felt = DVector::from_column_slice(&touch.features);
        let away = self.means.iter().map(|mean| {
            let from = &felt - mean;
            from.dot(&self.covariance.solve(&from))
        });
        let away: Vec<f64> = away.collect();
        let least = away.iter().copied().fold(f64::INFINITY, f64::min);
        let terms: Vec<f64> = away.iter().map(|d| (0.5 * (least - d)).exp()).collect();
        let sum: f64 = terms.iter().sum();
        terms.iter().map(|term| term / sum).collect()
    }
}

/// Of each class the share of trees that are for it.
fn forest(known: &[Touch], felt: &[Touch]) -> Result<Vec<Vec<f64>>> {
    let matrix = |touches: &[Touch]| {
        let rows: Vec<Vec<f64>> = touches.iter().map(|touch| touch.features.clone()).collect();
        DenseMatrix::from_2d_vec(&rows).map_err(|error| anyhow!("{error}"))
    };
    let [known_rows, felt_rows] = [matrix(known)?, matrix(felt)?];
    let tried = known.first().map_or(1, |of| of.features.len().isqrt());
    let parameters = RandomForestRegressorParameters::default()
        .with_n_trees(TREES.into())
        .with_min_samples_leaf(LEAVES)
        .with_m(tried)
        .with_seed(1);
    let mut all = vec![Vec::new(); felt.len()];
    for class in 0..SURFACES.len() {
        let is_class = |touch: &Touch| f64::from(u8::from(touch.class == class));
        let wanted: Vec<f64> = known.iter().map(is_class).collect();
        let trees = RandomForestRegressor::fit(&known_rows, &wanted, parameters.clone());
        let shares = trees.and_then(|trees| trees.predict(&felt_rows));
        let shares = shares.map_err(|error| anyhow!("{error}"))?;
        for (of, share) in all.iter_mut().zip(shares) {
            of.push(share);
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two classes that lie apart in one feature only, among three of noise.
    fn cloud(count: usize, phase: f64) -> Vec<Touch> {
        let noise = |n: usize, k: f64| ((n as f64 + phase) * k).sin();
        let touch = |n: usize| Touch {
            class: n % 2,
            presentation: n / 4,
            features: vec![
                noise(n, 1.3),
                3.0 * (n % 2) as f64 + noise(n, 2.7),
                noise(n, 7.1),
                noise(n, 0.9),
            ],
        };
        (0..count).map(touch).collect()
    }

    #[test]
    fn what_can_be_told_apart_is_and_labels_of_chance_are_not() {
        let (mut known, felt) = (cloud(400, 0.0), cloud(200, 5000.3));
        // The other classes are far away.
        known.extend((0..8).map(|n| Touch {
            class: 2 + n % 2,
            presentation: 0,
            features: vec![90.0 + n as f64, 50.0, (n * n) as f64, 0.5 * n as f64],
        }));
        let both = |known: &[Touch]| {
            let linear = Discriminant::new(known).unwrap();
            let by_line: Vec<Vec<f64>> = felt.iter().map(|of| linear.posteriors(of)).collect();
            let by_trees = forest(known, &felt).unwrap();
            [by_line, by_trees].map(|of| answers(&felt, &of))
        };
        let count = |of: &[Answer]| of.iter().filter(|answer| answer.is_right).count();
        for answers in both(&known) {
            assert!(count(&answers) > 190, "{}", count(&answers));
            let mut surest = surest(&answers);
            assert_eq!((answers.len(), surest.len()), (200, 50));
            surest.sort_by(|a, b| b.sure.total_cmp(&a.sure));
            assert_eq!(right(&surest[..25]), "100.0");
        }
        for (n, touch) in known.iter_mut().take(400).enumerate() {
            touch.class = n / 2 % 2;
        }
        for answers in both(&known) {
            assert!((60..140).contains(&count(&answers)), "{}", count(&answers));
        }
    }

    #[test]
    fn a_touch_is_felt_in_four_parts() {
        let mut stream = Stream {
            label: "p240".to_owned(),
            trial: String::new(),
            samples: vec![[8192.0; 2]; 500],
            contact: None,
            touch: Some(vec![0; 500]),
            pose: None,
            stands: None,
        };
        for n in 100..340 {
            stream.samples[n] = [8292.0, 8172.0];
            if let Some(touch) = &mut stream.touch {
                touch[n] = 3;
            }
        }
        let [touch] = &touches([&stream], 2.0)[..] else {
            panic!("one touch");
        };
        assert_eq!((touch.class, touch.presentation), (2, 0));
        let [_, _, third, last] = touch.features.as_chunks::<12>().0 else {
            panic!("four parts");
        };
        // Nothing trembles in the middle; the last part is as the one before.
        assert_eq!(third, last);
        assert_eq!((third[0], third[6]), (100.0, -40.0));
        assert!(third[1..6].iter().all(|feature| *feature == 0.0));
        assert!(touch.features[5] > 9.0);
    }
}
