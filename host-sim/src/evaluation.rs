//! What decisions are worth: hit rate, time, calibration, refused, undecided, and the
//! threshold that a wanted error rate or decision time asks for.

use scene::Rule;
use tactile::ModelBuf;
use tactile::score::{Calibration, Interval, Statistics};

use crate::classifier::{self, Fault};
use crate::decisions::{Decided, Score, UNKNOWN};
use crate::recording::Stream;
use crate::replay::Replay;

/// One presentation of a surface: a stream of a recording, or a texture's turn in a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// The surface.
    pub label: String,
    /// What was decided meanwhile.
    pub decided: Vec<Decided>,
}

/// The figures. But for [`Evaluation::strange`] they are of surfaces that the model
/// knows; hits, time and calibration are of decisions that named a class.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// The confusion matrix, labels that the model does not know below.
    pub score: Score,
    /// Share of right decisions, mean over the classes presented.
    pub hits: Option<f64>,
    /// Mean samples of a decision; not a number without one.
    pub samples: f64,
    /// Stated against found.
    pub calibration: Calibration,
    /// Share of decisions that said "unknown".
    pub refused: Interval,
    /// The same on surfaces that the model does not know.
    pub strange: Interval,
    /// Share of presentations in which no class was named.
    pub undecided: Interval,
}

impl Evaluation {
    /// Of presentations to a model of these classes.
    pub fn new(classes: &[String], presentations: &[Shown]) -> Self {
        let is_known = |p: &&Shown| classes.contains(&p.label);
        let known = || presentations.iter().filter(is_known);
        let strange = presentations.iter().filter(|p| !is_known(p));
        let decided: Vec<&Decided> = known().flat_map(|p| &p.decided).collect();
        let named = || decided.iter().filter(|d| d.decision != UNKNOWN);
        let silent = known().filter(|p| p.decided.iter().all(|d| d.decision == UNKNOWN));
        let rates = classes.iter().filter_map(|class| {
            let own = named().filter(|d| d.label == *class);
            let hits = own.clone().map(|d| f64::from(u8::from(d.is_right())));
            Some(Statistics::of(hits)?.mean)
        });
        let samples = Statistics::of(named().map(|d| f64::from(d.samples)));
        Self {
            score: Score::new(classes, presentations.iter().flat_map(|p| &p.decided)),
            hits: Statistics::of(rates).map(|rates| rates.mean),
            samples: samples.map_or(f64::NAN, |samples| samples.mean),
            calibration: Calibration::of(named().map(|d| (d.posterior, d.is_right()))),
            refused: unknown(decided.iter().copied()),
            strange: unknown(strange.flat_map(|p| &p.decided)),
            undecided: Interval::of(silent.count(), known().count()),
        }
    }
}

fn unknown<'d>(decided: impl Iterator<Item = &'d Decided> + Clone) -> Interval {
    let unknown = decided.clone().filter(|d| d.decision == UNKNOWN);
    Interval::of(unknown.count(), decided.count())
}

/// What a model does with a recording by the sequential rule, a presentation a stream.
///
/// # Errors
/// As [`Replay::new`].
pub fn presentations(
    model: &ModelBuf,
    threshold: f64,
    streams: &[Stream],
) -> Result<Vec<Shown>, Fault> {
    let mut replay = Replay::new(model.clone(), Rule::Sequential { threshold })?;
    let presentation = |stream: &Stream| {
        let decided = replay.stream(stream);
        Ok(Shown {
            label: stream.label.clone(),
            decided: decided.map_err(|fault| Fault::Model(fault.to_string()))?,
        })
    };
    streams.iter().map(presentation).collect()
}

/// Thresholds among which one is suggested, rising.
pub const THRESHOLDS: [f64; 19] = [
    0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.93, 0.95, 0.97, 0.98, 0.985, 0.99, 0.993, 0.995, 0.998, 0.999,
    0.9995, 0.9999, 0.99999,
];

/// What a threshold gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The threshold.
    pub threshold: f64,
    /// Its figures.
    pub evaluation: Evaluation,
}

impl Candidate {
    /// Share of wrong decisions among those that named a class; not a number without one.
    pub fn wrong(&self) -> f64 {
        1.0 - self.evaluation.calibration.found.share
    }
}

/// A model and a recording at each of [`THRESHOLDS`]; `done` hears how many are.
///
/// # Errors
/// As [`presentations`].
pub fn scan(
    model: &ModelBuf,
    streams: &[Stream],
    mut done: impl FnMut(u64),
) -> Result<Vec<Candidate>, Fault> {
    let classes = classifier::names(model);
    let at = |(n, threshold)| {
        let presented = presentations(model, threshold, streams)?;
        done(n);
        Ok(Candidate {
            threshold,
            evaluation: Evaluation::new(&classes, &presented),
        })
    };
    (1..).zip(THRESHOLDS).map(at).collect()
}

/// The lowest threshold from which on no more than a share of decisions is wrong, as
/// far up as there are decisions.
pub fn for_error(scan: &[Candidate], rate: f64) -> Option<&Candidate> {
    let mut decided = scan.iter().rev().skip_while(|at| at.wrong().is_nan());
    let mut lowest = None;
    while let Some(at) = decided.next().filter(|at| at.wrong() <= rate) {
        lowest = Some(at);
    }
    lowest
}

/// The highest threshold up to which decisions take no more samples in the mean.
pub fn for_samples(scan: &[Candidate], samples: f64) -> Option<&Candidate> {
    let fast = |at: &&Candidate| at.evaluation.samples <= samples;
    scan.iter().take_while(fast).last()
}
