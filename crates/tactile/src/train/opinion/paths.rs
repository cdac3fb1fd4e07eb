//! The way of a touch: mean deflections of x and y, block after block. Of one pose, its mean and
//! deviations; of several, the mean of each, in order along the first principal direction, so
//! that a touch may lie between two neighbours.

use std::vec;
use std::vec::Vec;

use super::matrix::{quantile, square};
use super::touches::Touch;
use crate::opinion::BLOCKS;
use crate::train::joint::CHANNELS;

/// Numbers of a path: x and y of each block.
const NUMBERS: usize = BLOCKS * CHANNELS;
/// Added to each deviation, narrow codes: whiskers slip by more than training has seen.
const LEAST_DEVIATION: f64 = 4.0;
/// The share of held-out touches that lie near: of one pose, of several.
const SHARE: [f64; 2] = [0.98, 0.95];
/// How far beyond the outermost poses a path may lie, in steps to the next: as it is used, and
/// where a pose is held out.
const BEYOND: [f64; 2] = [0.5, 1.0];

#[derive(Debug, Clone)]
pub(super) struct Paths {
    /// Of each number; infinite where no touch reached.
    pub(super) deviations: Vec<f64>,
    /// Of each pose.
    pub(super) means: Vec<Vec<f64>>,
    /// On the mean square of deviations.
    pub(super) limit: f64,
}

impl Paths {
    /// Of the touches of one class in one pose, with the part that each is held out with.
    pub(super) fn of_one(touches: &[&Touch], parts: &[usize]) -> Self {
        let last = parts.iter().copied().max().unwrap_or(0);
        let mut distances = Vec::new();
        for part in 0..=last {
            let pick = |is_held_out: bool| -> Vec<&Touch> {
                let of = touches.iter().zip(parts);
                of.filter(|(_, of)| last == 0 || (**of == part) == is_held_out)
                    .map(|(touch, _)| *touch)
                    .collect()
            };
            let others = Self::pooled(&[pick(false)]);
            distances.extend(
                pick(true)
                    .iter()
                    .map(|touch| others.distance(&touch.path, BEYOND[0])),
            );
        }
        let mut paths = Self::pooled(&[touches.to_vec()]);
        paths.limit = quantile(&mut distances, SHARE[0]).unwrap_or(0.0);
        paths
    }

    /// Of the touches of one class in several poses.
    pub(super) fn of_several(poses: &[Vec<&Touch>]) -> Self {
        let mut paths = Self::pooled(poses);
        let order = paths.order();
        let poses: Vec<Vec<&Touch>> = order.iter().map(|at| poses[*at].clone()).collect();
        paths.means = order.iter().map(|at| paths.means[*at].clone()).collect();
        // The outermost have no neighbour on one side: of two there are no others.
        let inner = if poses.len() > 2 {
            1..poses.len() - 1
        } else {
            0..poses.len()
        };
        let mut distances = Vec::new();
        for held_out in inner {
            let mut others = paths.clone();
            others.means.remove(held_out);
            let of = poses[held_out].iter();
            distances.extend(of.map(|touch| others.distance(&touch.path, BEYOND[1])));
        }
        paths.limit = quantile(&mut distances, SHARE[1]).unwrap_or(0.0);
        paths
    }

    /// Whether a touch lies near after so many blocks, which it has.
    pub(super) fn has(&self, touch: &Touch, blocks: usize) -> bool {
        self.distance(&touch.path[..blocks], BEYOND[0]) <= self.limit
    }

    /// Means of poses, and deviations within them.
    fn pooled(poses: &[Vec<&Touch>]) -> Self {
        let mut variances = [0.0; NUMBERS];
        let mut reached = [0_u32; NUMBERS];
        let mut means = Vec::new();
        for touches in poses {
            let mut mean: Vec<f64> = Vec::with_capacity(NUMBERS);
            for number in 0..NUMBERS {
                let (block, channel) = (number / CHANNELS, number % CHANNELS);
                let of = || {
                    touches
                        .iter()
                        .filter_map(move |t| Some(t.path.get(block)?[channel]))
                };
                let count = of().count();
                if count == 0 {
                    // As the block before, which nothing is compared with.
                    mean.push(
                        number
                            .checked_sub(CHANNELS)
                            .map_or(0.0, |before| mean[before]),
                    );
                    continue;
                }
                let centre = of().sum::<f64>() / count as f64;
                let variance = of().map(|x| (x - centre).powi(2)).sum::<f64>() / count as f64;
                variances[number] += variance;
                reached[number] += 1;
                mean.push(centre);
            }
            means.push(mean);
        }
        let deviation = |(variance, reached): (&f64, &u32)| match reached {
            0 => f64::INFINITY,
            count => (variance / f64::from(*count)).sqrt() + LEAST_DEVIATION,
        };
        Self {
            deviations: variances.iter().zip(&reached).map(deviation).collect(),
            means,
            limit: 0.0,
        }
    }

    /// In deviations.
    fn whitened(&self, from: &[f64], to: impl Iterator<Item = f64>) -> Vec<f64> {
        let all = to.zip(from).zip(&self.deviations);
        all.map(|((to, from), deviation)| (to - from) / deviation)
            .collect()
    }

    /// The mean square deviation of a way from the nearest place between two poses.
    fn distance(&self, path: &[[f64; CHANNELS]], beyond: f64) -> f64 {
        let numbers = path.len() * CHANNELS;
        let last = self.means.len().max(2) - 2;
        let from = |pose: usize| {
            let own = &self.means[pose];
            let next = self.means.get(pose + 1).unwrap_or(own);
            let felt = self.whitened(own, path.iter().flatten().copied());
            let step = self.whitened(own, next.iter().copied());
            let step = &step[..numbers];
            let both: f64 = felt.iter().zip(step).map(|(a, b)| a * b).sum();
            let first = if pose == 0 { -beyond } else { 0.0 };
            let most = if pose == last { 1.0 + beyond } else { 1.0 };
            let along = (both / square(step).max(1e-9)).clamp(first, most);
            let rest = square(&felt) - 2.0 * along * both + along * along * square(step);
            rest / numbers.max(1) as f64
        };
        (0..=last).map(from).fold(f64::INFINITY, f64::min)
    }

    /// The poses in order along the direction in which they differ most: its iteration by
    /// powers, begun where the first pose lies.
    fn order(&self) -> Vec<usize> {
        let poses = self.means.len();
        let centre: Vec<f64> = (0..NUMBERS)
            .map(|n| self.means.iter().map(|mean| mean[n]).sum::<f64>() / poses as f64)
            .collect();
        let apart: Vec<Vec<f64>> = self
            .means
            .iter()
            .map(|mean| self.whitened(&centre, mean.iter().copied()))
            .collect();
        let along =
            |way: &[f64], pose: &[f64]| -> f64 { way.iter().zip(pose).map(|(a, b)| a * b).sum() };
        let mut way = apart.first().cloned().unwrap_or_default();
        for _ in 0..100 {
            let mut next = vec![0.0; NUMBERS];
            for pose in &apart {
                let share = along(&way, pose);
                for (sum, value) in next.iter_mut().zip(pose) {
                    *sum += share * value;
                }
            }
            let length = square(&next).sqrt();
            if length == 0.0 {
                break;
            }
            way = next.iter().map(|value| value / length).collect();
        }
        let mut order: Vec<usize> = (0..poses).collect();
        let place: Vec<f64> = apart.iter().map(|pose| along(&way, pose)).collect();
        order.sort_by(|a, b| place[*a].total_cmp(&place[*b]));
        order
    }
}
