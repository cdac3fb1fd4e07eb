//! What decisions are worth: hit rate, time, calibration, refused, undecided, and the
//! threshold that a wanted error rate or decision time asks for.

use scene::Rule;
use tactile::ModelBuf;
use tactile::score::{Calibration, Interval, Statistics};

use crate::classifier::{self, Fault};
use crate::decisions::{Decided, Reasons, Score, UNKNOWN};
use crate::recording::{GATE, Stream};
use crate::replay::Replay;

/// One presentation of a surface: a stream of a recording, or a texture's turn in a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// The surface.
    pub label: String,
    /// What was decided meanwhile.
    pub decided: Vec<Decided>,
}

/// The figures of one class; intervals are of 95 %.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassFigures {
    /// Its name.
    pub name: String,
    /// Presentations of it.
    pub presented: usize,
    /// Of its decisions that named a class the share that was right.
    pub hits: Interval,
    /// Mean samples of these decisions; none without one.
    pub samples: Option<Statistics>,
    /// Share of its decisions that said "unknown".
    pub refused: Interval,
    /// Share of its presentations in which no class was named.
    pub undecided: Interval,
}

impl ClassFigures {
    fn new(name: &str, presentations: &[Shown]) -> Self {
        let own = || presentations.iter().filter(|p| p.label == name);
        let decided = || own().flat_map(|p| &p.decided);
        let named = || decided().filter(|d| d.decision != UNKNOWN);
        let right = named().filter(|d| d.is_right()).count();
        Self {
            name: name.to_owned(),
            presented: own().count(),
            hits: Interval::of(right, named().count()),
            samples: Statistics::of(named().map(|d| f64::from(d.samples))),
            refused: unknown(decided()),
            undecided: undecided(own()),
        }
    }
}

/// The figures. But for [`Evaluation::strange`] they are of surfaces that the model
/// knows; hits, time and calibration are of decisions that named a class.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// The confusion matrix, labels that the model does not know below.
    pub score: Score,
    /// Share of right decisions, mean over the classes presented but those that are
    /// [left out](Self::left_out).
    pub hits: Option<f64>,
    /// Of decisions that named a class such as `p80@20mm` the shares that are right in what stands
    /// before the `@`, and after it; none unless all classes have such names.
    pub parts: Option<[Interval; 2]>,
    /// Of each class of the model that was presented.
    pub classes: Vec<ClassFigures>,
    /// Mean samples of a decision; not a number without one.
    pub samples: f64,
    /// The standard error of that, as if decisions were independent; not a number without two.
    pub samples_error: f64,
    /// Stated against found.
    pub calibration: Calibration,
    /// The share of these that were right, whose interval counts those of one presentation as far
    /// as they differ.
    pub by_presentation: Interval,
    /// Share of decisions that said "unknown".
    pub refused: Interval,
    /// Why these named no class.
    pub reasons: Reasons,
    /// The same share on surfaces that the model does not know.
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
        let of_class = classes.iter().map(|n| ClassFigures::new(n, presentations));
        let of_class: Vec<_> = of_class.filter(|class| class.presented > 0).collect();
        let rates = of_class.iter().filter(|class| class.hits.count > 0);
        let hits = Statistics::of(rates.map(|class| class.hits.share));
        let samples = Statistics::of(named().map(|d| f64::from(d.samples)));
        Self {
            score: Score::new(classes, presentations.iter().flat_map(|p| &p.decided)),
            hits: hits.map(|hits| hits.mean),
            parts: classes
                .iter()
                .all(|name| name.contains('@'))
                .then(|| [0, 1].map(|part| right_in(part, named().copied()))),
            classes: of_class,
            samples: samples.map_or(f64::NAN, |samples| samples.mean),
            samples_error: samples.and_then(|s| s.error()).unwrap_or(f64::NAN),
            calibration: Calibration::of(named().map(|d| (d.posterior, d.is_right()))),
            by_presentation: by_presentation(known()),
            refused: unknown(decided.iter().copied()),
            reasons: Reasons::of(decided.iter().copied()),
            strange: unknown(strange.flat_map(|p| &p.decided)),
            undecided: undecided(known()),
        }
    }

    /// Whether what decisions state is not above the 95 % interval of those that were right.
    pub fn keeps_what_it_states(&self) -> bool {
        let stated = self.calibration.stated;
        // Of none there is neither.
        stated.is_nan() || stated <= self.by_presentation.high
    }

    /// The classes that were presented and of which no decision named a class: there is no share
    /// of right ones.
    pub fn left_out(&self) -> Vec<&str> {
        let classes = self.classes.iter().filter(|class| class.hits.count == 0);
        classes.map(|class| class.name.as_str()).collect()
    }
}

/// Share of decisions that are right in the first or second part of a name such as `p80@20mm`.
fn right_in<'d>(part: usize, named: impl Iterator<Item = &'d Decided> + Clone) -> Interval {
    let of = |name: &'d str| name.splitn(2, '@').nth(part);
    let right = named.clone().filter(|d| of(&d.decision) == of(&d.label));
    Interval::of(right.count(), named.count())
}

fn unknown<'d>(decided: impl Iterator<Item = &'d Decided> + Clone) -> Interval {
    let unknown = decided.clone().filter(|d| d.decision == UNKNOWN);
    Interval::of(unknown.count(), decided.count())
}

fn undecided<'p>(presentations: impl Iterator<Item = &'p Shown> + Clone) -> Interval {
    let named = |p: &&Shown| p.decided.iter().any(|d| d.decision != UNKNOWN);
    let all = presentations.clone().count();
    Interval::of(all - presentations.filter(named).count(), all)
}

/// The share of decisions that were right. Those of one presentation may be right or wrong together:
/// it counts as so many as the variance of the share between presentations is that of; where all or
/// none are right, as one a presentation.
fn by_presentation<'p>(presentations: impl Iterator<Item = &'p Shown>) -> Interval {
    let counts = presentations.filter_map(|shown| {
        let named = shown.decided.iter().filter(|d| d.decision != UNKNOWN);
        let count = named.clone().count() as f64;
        let right = named.filter(|d| d.is_right()).count() as f64;
        (count > 0.0).then_some([right, count])
    });
    let counts: Vec<[f64; 2]> = counts.collect();
    let presented = counts.len() as f64;
    let all: f64 = counts.iter().map(|[_, count]| count).sum();
    let share = counts.iter().map(|[right, _]| right).sum::<f64>() / all;
    let apart = counts.iter().map(|[right, count]| right - share * count);
    let squares: f64 = apart.map(|of| of * of).sum();
    let variance = squares / (all * all) * presented / (presented - 1.0);
    let worth = if presented < 2.0 || share <= 0.0 || share >= 1.0 {
        presented
    } else {
        (share * (1.0 - share) / variance).clamp(1.0, all)
    };
    Interval::of_share(share, worth as usize)
}

/// What a model does with a recording by the sequential rule, a presentation a stream.
///
/// # Errors
/// As [`Replay::new`] and [`Replay::stream`].
pub fn presentations(
    model: &ModelBuf,
    threshold: f64,
    streams: &[Stream],
) -> Result<Vec<Shown>, Fault> {
    let mut replay = Replay::new(model.clone(), Rule::Sequential { threshold })?;
    let presentation = |stream: &Stream| {
        let (label, decided) = (stream.label.clone(), replay.stream(stream)?);
        Ok(Shown { label, decided })
    };
    streams.iter().map(presentation).collect()
}

/// Of the samples that count the share that lies outside of the model's range in one of the
/// channels. And the first of them, counted from 0 over all streams, its channel, and the model's
/// channel, which may be of its whisker.
pub fn outside(model: &ModelBuf, streams: &[Stream]) -> (f64, Option<(usize, [usize; 2])>) {
    let gate = model.touch_rule().map_or(GATE, |touch| touch.gate.into());
    // Two channels of all whiskers, or two of each.
    let has_own = model.channels() > 2;
    let samples = streams.iter().flat_map(|stream| {
        let whisker = if has_own { stream.whisker() } else { 1 };
        let samples = stream.samples.iter();
        let samples = samples.map(move |sample| (2 * (whisker - 1), sample));
        samples.zip(stream.counts(gate))
    });
    let (mut first, mut count, mut all) = (None, 0_u64, 0_u64);
    for (n, ((of_whisker, sample), _)) in samples.enumerate().filter(|(_, (_, counts))| *counts) {
        let channel = sample.iter().enumerate().position(|(channel, x)| {
            let quantiser = model.quantiser(of_whisker + channel);
            quantiser
                .is_some_and(|q| q.low < q.high && !(q.low..=q.high).contains(&q.code_from_f64(*x)))
        });
        first = first.or(channel.map(|channel| (n, [channel, of_whisker + channel])));
        count += u64::from(channel.is_some());
        all += 1;
    }
    (count as f64 / all.max(1) as f64, first)
}

/// Thresholds among which one is suggested, rising.
pub const THRESHOLDS: [f64; 19] = [
    0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.93, 0.95, 0.97, 0.98, 0.985, 0.99, 0.993, 0.995, 0.998, 0.999,
    0.9995, 0.9999, 0.99999,
];

/// What a threshold gives.
#[derive(Debug)]
pub struct Candidate {
    /// The threshold.
    pub threshold: f64,
    /// Its figures.
    pub evaluation: Evaluation,
}

/// Width of the interval of a share, from which on it says too little to choose by.
const WIDEST: f64 = 0.3;

/// The normal quantile of 97.5 %, for the 95 % interval of a mean.
const Z: f64 = 1.96;

impl Candidate {
    /// Share of wrong decisions among those that named a class; not a number without one.
    pub fn wrong(&self) -> f64 {
        1.0 - self.evaluation.calibration.found.share
    }

    /// The 95 % interval of that share, 0 to 1, by presentations.
    pub fn wrong_interval(&self) -> [f64; 2] {
        let found = self.evaluation.by_presentation;
        [1.0 - found.high, 1.0 - found.low]
    }
}

/// A model and a recording at each of [`THRESHOLDS`]; `done` hears how many are.
pub(crate) fn scan(
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

/// A threshold that is wanted.
#[derive(Debug, Clone, Copy)]
pub enum Suggestion<'s> {
    /// Its figures are as wanted, and so are the ends of their 95 % intervals.
    Backed(&'s Candidate),
    /// Its figures are as wanted, but of so few decisions that this may be chance.
    Chance(&'s Candidate),
    /// There is none of [`THRESHOLDS`].
    None,
}

impl<'s> Suggestion<'s> {
    /// The first that is backed, or else the first.
    fn of(
        mut wanted: impl Iterator<Item = &'s Candidate>,
        backed: impl Fn(&Candidate) -> bool,
    ) -> Self {
        let Some(first) = wanted.next() else {
            return Self::None;
        };
        let found = std::iter::once(first).chain(wanted).find(|at| backed(at));
        found.map_or(Self::Chance(first), Self::Backed)
    }
}

/// The lowest threshold from which on no more than a share of decisions is wrong, as far up as
/// there are decisions; backed where the upper end of the share's interval is no more than that.
pub fn for_error(scan: &[Candidate], rate: f64) -> Suggestion<'_> {
    let decided = scan.iter().rev().skip_while(|at| at.wrong().is_nan());
    let as_wanted: Vec<_> = decided.take_while(|at| at.wrong() <= rate).collect();
    let backed = |at: &Candidate| at.wrong_interval().into_iter().all(|end| end <= rate);
    Suggestion::of(as_wanted.into_iter().rev(), backed)
}

/// The highest threshold up to which decisions take no more samples in the mean; backed where the
/// upper end of the mean's interval is no more than that, and the share of wrong decisions is known
/// better than to [`WIDEST`].
pub fn for_samples(scan: &[Candidate], samples: f64) -> Suggestion<'_> {
    let fast = |at: &&Candidate| at.evaluation.samples <= samples;
    let as_wanted: Vec<_> = scan.iter().take_while(fast).collect();
    Suggestion::of(as_wanted.into_iter().rev(), |at| {
        let [low, high] = at.wrong_interval();
        let at_most = at.evaluation.samples + Z * at.evaluation.samples_error;
        at_most <= samples && high - low < WIDEST
    })
}
