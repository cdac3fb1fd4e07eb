//! Groups of trials that are trained on and validated by themselves, and their
//! curves of hit rate against time.

use anyhow::Result;
use tactile::{ModelBuf, SequentialRule, Threshold};

use crate::classifiers::recogniser::Bayes;
use crate::experiment::floors::{Floors, Stream, Tally, train};
use crate::paper::lep12::{MOTIONS, TIME_S};
use crate::rigs::RobotMotion;

/// Samples of a block of evidence (m of eq. 6).
pub(super) const BLOCK: u32 = 20;
pub(super) const BOTH: [usize; 2] = [0, 1];

/// 1 − θ of the thresholds of Fig. 6, from θ = 0.5 to 0.99999999.
const DOUBTS: [f64; 22] = [
    0.5, 0.4, 0.3, 0.2, 0.15, 0.1, 0.07, 0.05, 0.03, 0.02, 0.01, 5e-3, 2e-3, 1e-3, 3e-4, 1e-4,
    3e-5, 1e-5, 1e-6, 1e-7, 3e-8, 1e-8,
];

/// Windows of Fig. 5, samples: 10 ms to 1 s.
const WINDOWS: [u32; 10] = [20, 40, 60, 100, 140, 200, 300, 400, 1000, 2000];

pub(super) struct Group {
    pub(super) name: &'static str,
    pub(super) training: Vec<Stream>,
    pub(super) validation: Vec<Stream>,
    pub(super) model: ModelBuf,
}

/// A point of a curve: what was varied, decision time in s, score.
pub(super) struct Point {
    pub(super) parameter: f64,
    pub(super) time_s: f64,
    pub(super) tally: Tally,
}

impl Group {
    pub(super) fn all(floors: &Floors<'_>) -> Result<Vec<Self>> {
        let motions: [&[RobotMotion]; 4] = [
            &[RobotMotion::Anticlockwise],
            &[RobotMotion::Clockwise],
            &[RobotMotion::Anticlockwise, RobotMotion::Clockwise],
            &[RobotMotion::Autonomous],
        ];
        let group = |(name, motions): (&&'static str, &[RobotMotion])| {
            let [training, validation] = floors.halves(motions);
            Ok(Self {
                name,
                validation,
                model: train(&training, &BOTH, BLOCK)?,
                training,
            })
        };
        MOTIONS.iter().zip(motions).map(group).collect()
    }

    pub(super) fn sequential(&self, doubt: f64, rate_hz: f64) -> Result<Point> {
        let model = self.model.view();
        let threshold = Threshold::new(1.0 - doubt)?;
        let tally = Tally::of(&self.validation, &BOTH, || {
            Ok(Bayes::<SequentialRule>::new(model, threshold)?)
        })?;
        Ok(Point {
            parameter: 1.0 - doubt,
            time_s: tally.mean_samples() / rate_hz,
            tally,
        })
    }

    pub(super) fn window(&self, window: u32, rate_hz: f64) -> Result<Point> {
        Ok(Point {
            parameter: f64::from(window),
            time_s: f64::from(window) / rate_hz,
            tally: Tally::of_windows(&self.validation, &BOTH, &self.model, window)?,
        })
    }
}

pub(super) struct Curves {
    pub(super) window: Vec<Point>,
    pub(super) sequential: Vec<Point>,
}

impl Curves {
    pub(super) fn of(group: &Group, rate_hz: f64) -> Result<Self> {
        let window = WINDOWS.iter().map(|window| group.window(*window, rate_hz));
        let sequential = DOUBTS.iter().map(|doubt| group.sequential(*doubt, rate_hz));
        Ok(Self {
            window: window.collect::<Result<_, _>>()?,
            sequential: sequential.collect::<Result<_, _>>()?,
        })
    }

    /// The sequential point whose mean time is nearest to Table 2's.
    pub(super) fn nearest(&self) -> Option<&Point> {
        let off = |point: &&Point| (point.time_s / TIME_S).ln().abs();
        let points = self.sequential.iter();
        points.min_by(|a, b| off(a).total_cmp(&off(b)))
    }
}

/// Mean hit rate at a time, linear between points in order of time.
pub(super) fn interpolate(points: &[Point], time_s: f64) -> f64 {
    let value = |point: &Point| point.tally.mean_hit();
    for [a, b] in points.array_windows() {
        if (a.time_s..=b.time_s).contains(&time_s) {
            let share = (time_s - a.time_s) / (b.time_s - a.time_s).max(1e-12);
            return value(a) + share * (value(b) - value(a));
        }
    }
    let is_before = time_s < points[0].time_s;
    value(&points[if is_before { 0 } else { points.len() - 1 }])
}
