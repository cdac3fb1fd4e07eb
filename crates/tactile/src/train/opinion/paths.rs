//! The way of a touch: mean deflections of x and y, block after block. Of one pose, its mean and
//! deviations; of several, the mean of each, in order along the first principal direction, so
//! that a touch may lie between two neighbours, and what another sensor may make of it.

use std::vec;
use std::vec::Vec;

use super::matrix::{quantile, square};
use super::touches::Touch;
use crate::opinion::BLOCKS;
use crate::opinion::path::{EIGHTHS, ROUNDS, SCALE_BITS, TURN_BITS};
use crate::opinion::section::Bounds;
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

/// By how much the sensor may differ in use, and its rest, narrow codes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sensor {
    /// Radians.
    pub(super) turn: f64,
    pub(super) scale: f64,
    pub(super) rest: [f64; CHANNELS],
}

impl Sensor {
    /// As a model has them.
    pub(super) fn bounds(self) -> Bounds {
        let units = |value: f64, bits: u32| (256.0 * value * f64::from(1 << bits)).round() as i32;
        Bounds {
            turn: units(self.turn, TURN_BITS),
            scale: units(self.scale, SCALE_BITS),
        }
    }
}

#[derive(Debug, Clone)]
pub(super) struct Paths {
    /// Of each number; infinite where no touch reached.
    pub(super) deviations: Vec<f64>,
    /// Of each pose.
    pub(super) means: Vec<Vec<f64>>,
    /// On the mean square of deviations.
    pub(super) limit: f64,
    sensor: Sensor,
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

    pub(super) fn of_several(poses: &[Vec<&Touch>], sensor: Sensor) -> Self {
        let mut paths = Self {
            sensor,
            ..Self::pooled(poses)
        };
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
            sensor: Sensor::default(),
        }
    }

    fn whitened(&self, from: &[f64], to: impl Iterator<Item = f64>) -> Vec<f64> {
        let all = to.zip(from).zip(&self.deviations);
        all.map(|((to, from), deviation)| (to - from) / deviation)
            .collect()
    }

    /// The mean square deviation of a way from the nearest place between two poses.
    fn distance(&self, path: &[[f64; CHANNELS]], beyond: f64) -> f64 {
        let numbers = path.len() * CHANNELS;
        let last = self.means.len().max(2) - 2;
        let Sensor { turn, scale, rest } = self.sensor;
        let from = |pose: usize| {
            let own = &self.means[pose];
            let next = self.means.get(pose + 1).unwrap_or(own);
            let felt = self.whitened(own, path.iter().flatten().copied());
            let deflected = |n: usize| own[n] - rest[n % CHANNELS];
            let turned = (0..NUMBERS).map(|n| {
                let other = deflected(n ^ 1);
                if n % CHANNELS == 0 { -other } else { other }
            });
            let is_y = |n: usize| n % CHANNELS == 1;
            let scaled = (0..NUMBERS).map(|n| if is_y(n) { deflected(n) } else { 0.0 });
            let still = [0.0; NUMBERS];
            let ways = [
                self.whitened(own, next.iter().copied()),
                self.whitened(&still, turned),
                self.whitened(&still, scaled),
            ];
            let first = if pose == 0 { -beyond } else { 0.0 };
            let most = if pose == last { 1.0 + beyond } else { 1.0 };
            let bounds = [[first, most], [-turn, turn], [-scale, scale]];
            left(felt, &ways, bounds) / numbers.max(1) as f64
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

/// The square that is left of what was felt, once the ways have their best shares within bounds.
fn left<const N: usize>(mut felt: Vec<f64>, ways: &[Vec<f64>; N], bounds: [[f64; 2]; N]) -> f64 {
    let mut shares = [0.0; N];
    for _ in 0..ROUNDS {
        for ((way, [first, last]), share) in ways.iter().zip(bounds).zip(&mut shares) {
            let way = &way[..felt.len()];
            let both: f64 = way.iter().zip(&felt).map(|(a, b)| a * b).sum();
            let by = f64::from(EIGHTHS) / 8.0 * both / square(way).max(1e-9);
            let best = (*share + by).clamp(first, last);
            for (felt, way) in felt.iter_mut().zip(way) {
                *felt -= (best - *share) * way;
            }
            *share = best;
        }
    }
    square(&felt)
}

#[cfg(test)]
mod tests {
    use super::{Bounds, Sensor, left};

    #[test]
    fn a_sensor_is_bounded_in_degrees_and_shares() {
        let sensor = Sensor {
            turn: 6_f64.to_radians(),
            scale: 0.2,
            ..Sensor::default()
        };
        // 6 π/180 · 32 · 256, and 0.2 · 16 · 256.
        let expected = Bounds {
            turn: 858,
            scale: 819,
        };
        assert_eq!(sensor.bounds(), expected);
    }

    #[test]
    fn shares_take_what_they_can_within_their_bounds() {
        // Two ways at 60 degrees, and twice each of them.
        let sine = 0.75_f64.sqrt();
        let ways = [vec![1.0, 0.0], vec![0.5, sine]];
        let felt = vec![3.0, 2.0 * sine];
        assert!(left(felt.clone(), &ways, [[-3.0, 3.0]; 2]) < 1e-4);
        // With nothing of the first only what lies along the second goes: 9 + 3 − 3².
        let one = left(felt, &ways, [[0.0, 0.0], [-9.0, 9.0]]);
        assert!((one - 3.0).abs() < 1e-4, "{one}");
    }
}
