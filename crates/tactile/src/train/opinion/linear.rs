//! The linear opinion of a stage: one Gaussian a class over the means of the states that have
//! begun, with one covariance S = W + αB, W within recordings and B between recordings of one
//! class, all classes together; its correlations times 1 − s. Where it objects, S has as well what no
//! copy of a recording shows: each feature may differ by a quarter of an octave, and all together as
//! another [friction](FRICTION) moves them. Where it names, what a sensor that is turned or scaled in
//! x does to the deflections.
//!
//! Scores are T (w_c f + b_c), w_c = S⁻¹ μ_c, b_c = −½ μ_c S⁻¹ μ_c. T minimises the log
//! loss of touches that were held out: where it objects, with their recording, or copy of one, and
//! each stage has its T; where it names, with their pose and its copies, and one T is that of all
//! stages that decide, by the touches that [would be named](super::Felt::named) and what [other
//! trainings](SPREAD) had.

use std::vec;
use std::vec::Vec;

use super::matrix::{Matrix, less, mean, pooled, square};
use super::touches::Touch;
use crate::opinion::{FEATURES, STATES};

/// Least variance of a feature: that of its rounding and of its logarithm, octaves².
pub(super) const LEAST_VARIANCE: f64 = 1e-3;

#[derive(Debug, Clone, Copy)]
pub(super) struct Covariance<'a> {
    /// Of each class the first one from which it cannot be distinguished, itself if from none:
    /// these have one mean.
    pub(super) alike: &'a [usize],
    /// α.
    pub(super) between: f64,
    /// s.
    pub(super) shrink: f64,
    /// Whether features may differ by more than recordings and their copies show.
    pub(super) has_unseen: bool,
    /// What is weighed of each state.
    pub(super) weighed: usize,
    /// By how much it may be turned and scaled in use, if deflections are weighed.
    pub(super) sensor: [f64; 2],
}

impl Covariance<'_> {
    /// By what another sensor moves the deflections, whose mean is that of these: turned, and
    /// scaled in x. What is scaled in y is among the copies.
    fn nuisances(&self, means: &[f64]) -> Vec<Vec<f64>> {
        if self.weighed == FEATURES {
            return Vec::new();
        }
        let [turn, scale] = self.sensor;
        let moved = |by: &dyn Fn([f64; 2]) -> [f64; 2]| -> Vec<f64> {
            let states = means.chunks(self.weighed);
            let of_state = states.flat_map(|state| {
                let moved = by([state[FEATURES], state[FEATURES + 1]]);
                core::iter::repeat_n(0.0, FEATURES).chain(moved)
            });
            of_state.collect()
        };
        vec![
            moved(&|[x, y]| [-turn * y, turn * x]),
            moved(&|[x, _]| [scale * x, 0.0]),
        ]
    }
}

/// What each feature may differ by from what was felt, octaves².
const UNSEEN: f64 = 0.06;
/// By how much a third more of friction moves the features along and across the mean deflection in
/// each state, octaves: there is less across while the whisker bends, as it is held in y, and more
/// along while it slides back.
const FRICTION: [[f64; 2]; STATES.len()] = [[0.0, -0.4], [0.0, -0.4], [0.25, -0.4], [0.25, 0.0]];

#[derive(Debug, Clone)]
pub(super) struct Linear {
    /// T w_c of each class, an octave.
    pub(super) weights: Vec<Vec<f64>>,
    /// T b_c.
    pub(super) biases: Vec<f64>,
}

/// A touch after so many blocks, and its scores by a fit without its recording.
#[derive(Debug, Clone)]
pub(super) struct HeldOut<'t> {
    pub(super) touch: &'t Touch,
    pub(super) blocks: usize,
    scores: Vec<f64>,
}

impl HeldOut<'_> {
    pub(super) fn leader(&self) -> usize {
        let scores = self.scores.iter().enumerate();
        let best = scores.max_by(|(_, a), (_, b)| a.total_cmp(b));
        best.map_or(0, |(class, _)| class)
    }
}

struct Row<'t> {
    touch: &'t Touch,
    means: Vec<f64>,
}

impl Linear {
    /// After so many blocks, of so many classes, T being 1; and what comes of the first `apart`
    /// recordings, each held out with those that are a multiple of so many behind it: its copies.
    pub(super) fn of<'t>(
        touches: &'t [Touch],
        (blocks, classes, apart): (usize, usize, usize),
        how: Covariance<'_>,
    ) -> (Self, Vec<HeldOut<'t>>) {
        let long = touches.iter().filter(|touch| touch.len() >= blocks);
        let rows: Vec<Row<'t>> = long
            .map(|touch| Row {
                touch,
                means: touch.stage(blocks, how.weighed),
            })
            .collect();
        let recordings = touches.iter().map(|touch| touch.recording + 1).max();
        let recordings = recordings.unwrap_or(0);
        let mut held_out = Vec::new();
        for recording in 0..apart {
            let kept: Vec<&Row<'_>> = rows
                .iter()
                .filter(|row| recordings == 1 || row.touch.recording % apart != recording)
                .collect();
            let Some(fit) = Self::fit(&kept, recordings, classes, how) else {
                continue;
            };
            let left_out = rows.iter().filter(|row| row.touch.recording == recording);
            held_out.extend(left_out.map(|row| HeldOut {
                touch: row.touch,
                blocks,
                scores: fit.scores(&row.means),
            }));
        }
        let all: Vec<&Row<'_>> = rows.iter().collect();
        let linear = Self::fit(&all, recordings, classes, how).unwrap_or_else(|| Self {
            weights: vec![Vec::new(); classes],
            biases: vec![0.0; classes],
        });
        (linear, held_out)
    }

    /// With this T, in bits.
    pub(super) fn at(mut self, temperature: f64) -> Self {
        let unit = temperature / core::f64::consts::LN_2;
        self.weights.iter_mut().flatten().for_each(|w| *w *= unit);
        self.biases.iter_mut().for_each(|b| *b *= unit);
        self
    }

    /// None where a class is missing.
    fn fit(
        rows: &[&Row<'_>],
        recordings: usize,
        classes: usize,
        how: Covariance<'_>,
    ) -> Option<Self> {
        let size = rows.first()?.means.len();
        let mut within = Matrix::zero(size);
        let mut between = Matrix::zero(size);
        let (mut freedom_within, mut freedom_between) = (0, 0);
        let mut centres = Vec::new();
        for class in 0..classes {
            let of_recording = |recording: usize| -> Vec<&[f64]> {
                let own = |row: &Row<'_>| (row.touch.class, row.touch.recording);
                let of = rows.iter().filter(|row| own(row) == (class, recording));
                of.map(|row| row.means.as_slice()).collect()
            };
            let of_recordings = (0..recordings).map(of_recording);
            let (means, freedom) = pooled(size, of_recordings, &mut within);
            freedom_within += freedom;
            if means.is_empty() {
                return None;
            }
            let centre = mean(size, means.iter().map(Vec::as_slice));
            for mean in &means {
                between.add_square(&less(mean, &centre), 1.0);
            }
            freedom_between += means.len() - 1;
            centres.push(centre);
        }
        let centres: Vec<Vec<f64>> = how
            .alike
            .iter()
            .map(|first| {
                let same = centres.iter().zip(how.alike);
                let same = same.filter(|(_, of)| *of == first);
                mean(size, same.map(|(centre, _)| centre.as_slice()))
            })
            .collect();
        within.scale(1.0 / freedom_within.max(1) as f64);
        within.add(&between, how.between / freedom_between.max(1) as f64);
        within.shrink(how.shrink, LEAST_VARIANCE);
        if how.has_unseen {
            within.raise(UNSEEN);
            let of_friction = FRICTION.iter().flatten();
            let moved = of_friction.flat_map(|by| [*by; FEATURES / 2]);
            within.add_square(&moved.take(size).collect::<Vec<_>>(), 1.0);
        }
        let all = mean(size, centres.iter().map(Vec::as_slice));
        for by in how.nuisances(&all) {
            within.add_square(&by, 1.0);
        }
        let whitening = within.whitening();
        let bias = |centre: &Vec<f64>| -0.5 * square(&whitening.of(centre));
        Some(Self {
            weights: centres
                .iter()
                .map(|centre| whitening.twice(centre))
                .collect(),
            biases: centres.iter().map(bias).collect(),
        })
    }

    fn scores(&self, means: &[f64]) -> Vec<f64> {
        let of = |weights: &Vec<f64>| weights.iter().zip(means).map(|(w, x)| w * x).sum::<f64>();
        let classes = self.weights.iter().zip(&self.biases);
        classes.map(|(weights, bias)| of(weights) + bias).collect()
    }
}

/// By how much ln T differs from one training to another, where an opinion names: beforehand it
/// is normal about 0. Chosen by six trainings of `bench-textures`.
pub(super) const SPREAD: f64 = 0.3;

/// The T of e⁻⁴ to 1 of least log loss. With a [`SPREAD`] up to 2, and each trial counts for one:
/// its touches and their stages are alike, and a strange one would weigh all of them.
pub(super) fn temperature(held_out: &[HeldOut<'_>], spread: Option<f64>) -> f64 {
    let trials = held_out.iter().map(|of| of.touch.trial + 1).max();
    let mut counts = vec![0_u32; trials.unwrap_or(0)];
    for HeldOut { touch, .. } in held_out {
        counts[touch.trial] += 1;
    }
    let share = |trial: usize| match spread {
        Some(_) => 1.0 / f64::from(counts[trial]),
        None => 1.0,
    };
    let loss = |log: f64| -> f64 {
        let temperature = log.exp();
        let of = |HeldOut { touch, scores, .. }: &HeldOut<'_>| {
            let most = scores.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let sum: f64 = scores
                .iter()
                .map(|z| (temperature * (z - most)).exp())
                .sum();
            // As an outlier weighs at most.
            let right = (temperature * (scores[touch.class] - most)).exp() / sum;
            -(right + 1e-12).ln() * share(touch.trial)
        };
        let before = spread.map_or(0.0, |spread| 0.5 * (log / spread).powi(2));
        before + held_out.iter().map(of).sum::<f64>()
    };
    let (mut low, mut high) = (-4.0, spread.map_or(0.0, |_| core::f64::consts::LN_2));
    // The golden section: the loss is convex but for that outlier.
    let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
    for _ in 0..40 {
        let span: f64 = high - low;
        let (a, b) = (high - golden * span, low + golden * span);
        if loss(a) < loss(b) {
            high = b;
        } else {
            low = a;
        }
    }
    f64::midpoint(low, high).exp()
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    fn touch(trial: usize, class: usize) -> Touch {
        Touch {
            class,
            recording: 0,
            goes_on: false,
            trial,
            features: Vec::new(),
            path: vec![[0.0; 2]],
        }
    }

    #[test]
    fn posteriors_are_the_share_that_is_right() {
        // One of ten trials is of another class.
        let touches: Vec<Touch> = (0..10).map(|n| touch(n, usize::from(n == 0))).collect();
        let held_out = |touch| HeldOut {
            touch,
            blocks: 1,
            scores: vec![4.0, 0.0],
        };
        // A lead of 4 T is odds of 9.
        let all: Vec<_> = touches.iter().map(held_out).collect();
        let exact = 9_f64.ln() / 4.0;
        assert_relative_eq!(temperature(&all, None), exact, epsilon = 1e-6);
        // Without other trainings never surer than Gaussians are.
        assert_relative_eq!(temperature(&all[1..], None), 1.0, epsilon = 1e-6);

        // What other trainings had fades where it differs by any amount, and decides alone of none.
        assert_relative_eq!(temperature(&all, Some(1e6)), exact, epsilon = 1e-6);
        assert_relative_eq!(temperature(&[], Some(SPREAD)), 1.0, epsilon = 1e-6);
        assert!(temperature(&all[1..], Some(SPREAD)) > 1.0);
        // A trial counts for one, however often it was touched.
        let often = [&all[..], &all[..1], &all[..1]].concat();
        let [once, often] = [&all, &often].map(|of| temperature(of, Some(SPREAD)));
        assert_relative_eq!(once, often, epsilon = 1e-6);
    }

    /// However their touches differ, classes that are alike score as one, and another is set apart
    /// from both.
    #[test]
    fn what_is_alike_has_one_score() {
        let touches: Vec<Touch> = (0..60_u32)
            .map(|n| {
                let (class, differs) = (n as usize % 3, f64::from(n * n % 7));
                let across = [0.0, 1.0, 40.0][class];
                Touch {
                    features: vec![core::array::from_fn(|k| across + differs * k as f64)],
                    ..touch(n as usize, class)
                }
            })
            .collect();
        let how = |alike| Covariance {
            alike,
            between: 1.0,
            shrink: 0.0,
            has_unseen: false,
            weighed: FEATURES,
            sensor: [0.0; 2],
        };
        let of = |alike| Linear::of(&touches, (1, 3, 1), how(alike)).0;
        let apart = of(&[0, 1, 2]);
        assert!(apart.weights[0] != apart.weights[1]);
        let alike = of(&[0, 0, 2]);
        assert_eq!(alike.weights[0], alike.weights[1]);
        assert_relative_eq!(alike.biases[0], alike.biases[1]);
        for touch in &touches {
            let scores = alike.scores(&touch.stage(1, FEATURES));
            assert_eq!(scores[2] > scores[0], touch.class == 2);
        }
    }
}
