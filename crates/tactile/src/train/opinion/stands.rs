//! Training what estimates a pose: ridge regression of tilt and depth on the way of a touch, of
//! each class after each stage, and its error where poses are held out. See [`crate::opinion::pose`].

use std::string::String;
use std::vec;
use std::vec::Vec;

use super::matrix::{Matrix, mean};
use super::touches::Touch;
use crate::opinion::pose::{TARGETS, inputs, inputs_of};
use crate::train::joint::{Trial, Warning};

/// Values of tilt and of depth, of each class, of which at least it is trained.
const LEAST_VALUES: usize = 6;
/// The largest size of a value: hundredths have 16 bits.
const MOST: f64 = 327.0;
/// Touches of a class that reach a stage, for each input.
const LEAST_TOUCHES_AN_INPUT: usize = 3;
/// Parts in which poses are held out.
const PARTS: usize = 8;
/// What may be added to the variances of the inputs, which are one: of each fit that by which poses
/// that are held out are estimated best. Where a way says nothing, the last comes to the mean.
const RIDGES: [f64; 4] = [1e-3, 1e-2, 1e-1, 1e2];

/// Weights of the inputs, and what is added.
type Weights = (Vec<f64>, f64);

#[derive(Debug, Clone)]
pub(super) struct Fit {
    /// Of each target: weights of the inputs, and what is added.
    pub(super) weights: [Weights; TARGETS],
    /// Root mean square of the errors of touches in poses that were held out.
    pub(super) errors: [f64; TARGETS],
}

#[derive(Debug, Clone)]
pub(super) struct Stands {
    /// The least and the most of each target.
    pub(super) limits: [[f64; 2]; TARGETS],
    /// Each class after each stage.
    pub(super) classes: Vec<Vec<Fit>>,
}

struct Row<'t> {
    touch: &'t Touch,
    stands: [f64; TARGETS],
    pose: usize,
}

impl Stands {
    /// Of touches whose trials say how what they touched stood; none where no trial does. What is
    /// lacking where they do not say enough.
    pub(super) fn of(
        touches: &[Touch],
        trials: &[Trial],
        names: &[String],
        stages: usize,
    ) -> (Option<Self>, Option<Warning>) {
        let stood = |touch: &Touch| trials.get(touch.trial)?.stands;
        // Of each pose what it is called, if it is, and how it stands. What is called alike may be
        // measured twice.
        let mut known: Vec<(Option<&String>, [f64; TARGETS])> = Vec::new();
        let mut rows = Vec::new();
        for touch in touches {
            let Some(stands) = stood(touch) else { continue };
            let name = trials.get(touch.trial).and_then(|of| of.pose.as_ref());
            let is_same = |(called, at): &(Option<&String>, [f64; TARGETS])| {
                *at == stands || (name.is_some() && *called == name)
            };
            let pose = known.iter().position(is_same).unwrap_or(known.len());
            if pose == known.len() {
                known.push((name, stands));
            }
            rows.push(Row {
                touch,
                stands,
                pose,
            });
        }
        if rows.is_empty() {
            return (None, None);
        }
        let of_class = |class: usize| -> Vec<&Row<'_>> {
            rows.iter().filter(|row| row.touch.class == class).collect()
        };
        let mut values_of_all = rows.iter().flat_map(|row| row.stands);
        let wide = values_of_all.find(|value| value.abs() > MOST);
        if let Some(found) = wide {
            let most = MOST;
            return (None, Some(Warning::WidePose { found, most }));
        }
        let touches = |class: usize| {
            let long = |row: &&&Row<'_>| row.touch.len() >= stages;
            of_class(class).iter().filter(long).count()
        };
        for (class, name) in names.iter().enumerate() {
            let values = values(&of_class(class));
            for (what, found, least) in [
                ("values of tilt_deg or depth_deg", values, LEAST_VALUES),
                ("long touches", touches(class), least_touches(stages)),
            ] {
                if found < least {
                    let name = name.clone();
                    let warning = Warning::NoPose {
                        name,
                        what,
                        found,
                        least,
                    };
                    return (None, Some(warning));
                }
            }
        }
        let limits = core::array::from_fn(|target| {
            let all = rows.iter().map(|row| row.stands[target]);
            [
                all.clone().fold(f64::INFINITY, f64::min),
                all.fold(f64::NEG_INFINITY, f64::max),
            ]
        });
        let fit = |class: usize, stage: usize| Fit::of(&of_class(class), stage, &limits);
        let of_stages = |class| (1..=stages).map(|stage| fit(class, stage)).collect();
        let classes = (0..names.len()).map(of_stages).collect();
        (Some(Self { limits, classes }), None)
    }

    pub(super) fn errors(&self) -> Vec<Vec<[f64; TARGETS]>> {
        let of = |stages: &Vec<Fit>| stages.iter().map(|fit| fit.errors).collect();
        self.classes.iter().map(of).collect()
    }
}

fn least_touches(stage: usize) -> usize {
    LEAST_TOUCHES_AN_INPUT * inputs_of(stage)
}

/// How many poses there are, or values of that target which has fewer.
fn values(rows: &[&Row<'_>]) -> usize {
    let mut poses: Vec<usize> = rows.iter().map(|row| row.pose).collect();
    poses.sort_unstable();
    poses.dedup();
    let of = |target: usize| {
        let mut values: Vec<f64> = rows.iter().map(|row| row.stands[target]).collect();
        values.sort_unstable_by(f64::total_cmp);
        values.dedup();
        values.len()
    };
    (0..TARGETS).map(of).fold(poses.len(), usize::min)
}

/// What a way says, as a board weighs it.
fn weighed(touch: &Touch, stage: usize) -> Vec<f64> {
    // Whole codes within 16 bits.
    let path: Vec<[i16; 2]> = touch.path[..stage]
        .iter()
        .map(|of| of.map(|code| code as i16))
        .collect();
    let inputs = inputs(&path).into_iter().take(inputs_of(stage));
    inputs.map(f64::from).collect()
}

impl Fit {
    fn of(rows: &[&Row<'_>], stage: usize, limits: &[[f64; 2]; TARGETS]) -> Self {
        let long = rows.iter().filter(|row| row.touch.len() >= stage);
        let long: Vec<(&Row<'_>, Vec<f64>)> =
            long.map(|row| (*row, weighed(row.touch, stage))).collect();
        let errors = RIDGES.map(|ridge| held_out(&long, ridge, limits));
        let all: Vec<_> = long.iter().collect();
        let mut fit = Self {
            weights: fitted(&all, RIDGES[0]),
            errors: errors[0],
        };
        for (ridge, errors) in RIDGES.into_iter().zip(errors).skip(1) {
            for (n, weights) in fitted(&all, ridge).into_iter().enumerate() {
                if errors[n] < fit.errors[n] {
                    fit.errors[n] = errors[n];
                    fit.weights[n] = weights;
                }
            }
        }
        fit
    }
}

/// Root mean square of errors where the poses of each part are held out.
fn held_out(
    rows: &[(&Row<'_>, Vec<f64>)],
    ridge: f64,
    limits: &[[f64; 2]; TARGETS],
) -> [f64; TARGETS] {
    let mut squares = [0.0; TARGETS];
    for part in 0..PARTS {
        let (held_out, kept): (Vec<_>, Vec<_>) =
            rows.iter().partition(|(row, _)| row.pose % PARTS == part);
        if held_out.is_empty() {
            continue;
        }
        let weights = fitted(&kept, ridge);
        for (row, inputs) in held_out {
            for (target, (weights, bias)) in weights.iter().enumerate() {
                let [least, most] = limits[target];
                let found = bias + dot(weights, inputs);
                let error = found.clamp(least, most) - row.stands[target];
                squares[target] += error * error;
            }
        }
    }
    squares.map(|sum| (sum / rows.len() as f64).sqrt())
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Weights and what is added, of inputs with a mean of zero and a deviation of one.
fn fitted(rows: &[&(&Row<'_>, Vec<f64>)], ridge: f64) -> [Weights; TARGETS] {
    let size = rows.first().map_or(0, |(_, inputs)| inputs.len());
    let count = rows.len().max(1) as f64;
    let centre = mean(size, rows.iter().map(|(_, inputs)| inputs.as_slice()));
    let mut scale = vec![0.0; size];
    for (_, inputs) in rows {
        for ((scale, input), centre) in scale.iter_mut().zip(inputs).zip(&centre) {
            *scale += (input - centre).powi(2) / count;
        }
    }
    // Codes are whole.
    for of in &mut scale {
        *of = of.sqrt().max(1.0);
    }
    let whole = |inputs: &[f64]| -> Vec<f64> {
        let from = inputs.iter().zip(&centre).zip(&scale);
        from.map(|((input, centre), scale)| (input - centre) / scale)
            .collect()
    };
    let of_target =
        |target: usize| rows.iter().map(|(row, _)| row.stands[target]).sum::<f64>() / count;
    let means: [f64; TARGETS] = core::array::from_fn(of_target);
    let mut squares = Matrix::zero(size);
    let mut products: [Vec<f64>; TARGETS] = core::array::from_fn(|_| vec![0.0; size]);
    for (row, inputs) in rows {
        let inputs = whole(inputs);
        squares.add_square(&inputs, 1.0 / count);
        for (target, products) in products.iter_mut().enumerate() {
            let off = (row.stands[target] - means[target]) / count;
            for (product, input) in products.iter_mut().zip(&inputs) {
                *product += off * input;
            }
        }
    }
    squares.raise(ridge);
    let whitening = squares.whitening();
    core::array::from_fn(|target| {
        let weights = whitening.twice(&products[target]);
        let weights: Vec<f64> = weights.iter().zip(&scale).map(|(w, s)| w / s).collect();
        let bias = means[target] - dot(&weights, &centre);
        (weights, bias)
    })
}
