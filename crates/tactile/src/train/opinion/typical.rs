//! What features are typical of a class: per state their mean and the class's own covariance,
//! within recordings and between them; and per stage the squared distance, over the states
//! begun, within which a share of touches lay that were held out.

use std::vec::Vec;

use super::linear::LEAST_VARIANCE;
use super::matrix::{Matrix, less, mean, pooled, quantile, square};
use super::touches::Touch;
use crate::opinion::{BLOCKS, FEATURES, OUTLIER, PARTS, STAGES, STATES};

/// Off the diagonal a covariance counts so much less.
const SHRINK: f64 = 0.3;
/// The share of held-out touches of a class that are typical of it: of one pose, of several.
pub(super) const SHARE: [f64; 2] = [0.98, 0.95];

/// The share of means over parts of touches that last which are near, and which are typical.
const SHARE_OF_MEANS: [f64; 2] = [0.5, 0.95];

#[derive(Debug, Clone)]
pub(super) struct State {
    pub(super) mean: Vec<f64>,
    pub(super) whitening: Matrix,
}

#[derive(Debug, Clone)]
pub(super) struct Typical {
    pub(super) states: Vec<State>,
    /// After one block, two, …
    pub(super) limits: [f64; STAGES],
    /// Within which half of the means over two parts of a long touch, three, … lay, and nearly all.
    pub(super) of_means: [[f64; PARTS - 1]; 2],
}

impl Typical {
    /// Of the touches of one class, with the part that each is held out with; of so many stages,
    /// and with the share that is to be typical.
    pub(super) fn of(touches: &[&Touch], parts: &[usize], (stages, share): (usize, f64)) -> Self {
        let states = |kept: &dyn Fn(usize) -> bool| -> Vec<State> {
            let of = touches.iter().zip(parts);
            let kept: Vec<&Touch> = of
                .filter(|(_, part)| kept(**part))
                .map(|(touch, _)| *touch)
                .collect();
            (0..STATES.len())
                .map(|state| State::of(&kept, state, stages))
                .collect()
        };
        let mut distances: [Vec<f64>; STAGES] = core::array::from_fn(|_| Vec::new());
        // Of whole parts, and whether they go on.
        let mut of_parts = Vec::new();
        let most = parts.iter().copied().max().unwrap_or(0);
        for part in 0..=most {
            let others = states(&|of| of != part || most == 0);
            let held_out = touches.iter().zip(parts).filter(|(_, of)| **of == part);
            for (touch, _) in held_out {
                for (stage, distances) in (1..=touch.len()).zip(&mut distances) {
                    distances.push(distance(touch, &others, stage));
                }
                if touch.len() == BLOCKS {
                    of_parts.push((touch.goes_on, distance(touch, &others, BLOCKS)));
                }
            }
        }
        let mut limits = [0.0; STAGES];
        let mut last = 0.0;
        for (limit, distances) in limits.iter_mut().zip(&mut distances) {
            last = quantile(distances, share).unwrap_or(last);
            *limit = last;
        }
        Self {
            states: states(&|_| true),
            limits,
            of_means: of_means(&of_parts, last),
        }
    }

    /// Whether a touch is typical after so many blocks, at most as many as there are stages.
    pub(super) fn has(&self, touch: &Touch, blocks: usize) -> bool {
        distance(touch, &self.states, blocks) <= self.limits[blocks - 1]
    }
}

/// Of distances of parts, with whether they go on with a touch, and the limit of one of them: means
/// as [`Opinion::begin_again`](crate::opinion::Opinion::begin_again) forms them.
fn of_means(distances: &[(bool, f64)], limit: f64) -> [[f64; PARTS - 1]; 2] {
    let mut means: [Vec<f64>; PARTS] = core::array::from_fn(|_| Vec::new());
    let (mut parts, mut mean) = (0, 0.0);
    for (goes_on, distance) in distances {
        if !goes_on {
            parts = 0;
        }
        let share = [1.0, 0.5, 0.25][parts.min(PARTS - 1)];
        mean += share * (distance.min(limit * f64::from(OUTLIER)) - mean);
        parts = (parts + 1).min(PARTS);
        means[parts - 1].push(mean);
    }
    SHARE_OF_MEANS.map(|share| {
        let mut last = limit;
        core::array::from_fn(|n| {
            last = quantile(&mut means[n + 1], share).unwrap_or(last);
            last
        })
    })
}

impl State {
    /// Of whole states, as far as touches reach.
    fn of(touches: &[&Touch], state: usize, stages: usize) -> Self {
        let [_, end] = STATES[state];
        let blocks = end.min(stages);
        let means: Vec<(usize, [f64; FEATURES])> = touches
            .iter()
            .filter(|touch| touch.len() >= blocks)
            .filter_map(|touch| Some((touch.recording, touch.state(state, blocks)?)))
            .collect();
        let mut within = Matrix::zero(FEATURES);
        let recordings = means.iter().map(|(recording, _)| recording + 1).max();
        let of_recordings = (0..recordings.unwrap_or(0)).map(|recording| -> Vec<&[f64]> {
            let of = means.iter().filter(|(of, _)| *of == recording);
            of.map(|(_, mean)| mean.as_slice()).collect()
        });
        let (centres, freedom) = pooled(FEATURES, of_recordings, &mut within);
        let centre = mean(FEATURES, centres.iter().map(Vec::as_slice));
        within.scale(1.0 / freedom.max(1) as f64);
        within.shrink(SHRINK, LEAST_VARIANCE);
        for of_recording in &centres {
            let share = 1.0 / (centres.len() - 1).max(1) as f64;
            within.add_square(&less(of_recording, &centre), share);
        }
        Self {
            mean: centre,
            whitening: within.whitening(),
        }
    }
}

/// The squared distance of a touch after so many blocks.
fn distance(touch: &Touch, states: &[State], blocks: usize) -> f64 {
    let of = |(n, state): (usize, &State)| {
        let means = touch.state(n, blocks)?;
        Some(square(&state.whitening.of(&less(&means, &state.mean))))
    };
    states.iter().enumerate().filter_map(of).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: all of the first, half of the second, a quarter of each that follows.
    #[test]
    fn means_begin_with_each_touch_and_forget_slowly() {
        let touch = [2.0, 4.0, 7.0, 8.0].map(|distance| (distance > 2.0, distance));
        // Of one touch 3 of two parts, and 4 and 5 of more.
        let [near, most] = of_means(&touch, 10.0);
        assert_eq!([near[0], most[0]], [3.0, 3.0]);
        assert!(4.0 <= near[1] && near[1] < most[1] && most[1] <= 5.0);
        // Another touch begins for itself.
        assert_eq!(of_means(&[touch, touch].concat(), 10.0)[0][0], 3.0);
        // A part counts as four times the limit, which is that of means where there are none.
        let knock = [(false, 0.0), (true, 1e9)];
        assert_eq!(of_means(&knock, 10.0), [[20.0; 2]; 2]);
        assert_eq!(of_means(&knock[..1], 10.0), [[10.0; 2]; 2]);
    }
}
