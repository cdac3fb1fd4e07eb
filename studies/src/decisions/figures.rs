//! What a model is worth on the runs of a scene.

use std::collections::BTreeMap;

use host_sim::evaluation::{Evaluation, Shown};
use host_sim::scoring::Scored;
use tactile::score::{Interval, Statistics};

use crate::page::{Page, verdict};

/// Of `decisions.csv`: a line a model, its shares in percent; what is not there is empty.
pub(super) const HEADER: &str = "part,scene,setting,training,runs,hit_rate,hit_rate_error,\
    worst_run,stated,found,found_low,found_high,decisions,contact_ms,clock_ms,undecided,refused,\
    unknown_refused";

/// The figures of a model at a threshold; shares from 0 to 1.
pub(super) struct Figures {
    pub(super) hits: Vec<f64>,
    /// Mean over the runs of the time of a decision: of contact, and by the clock, ms.
    pub(super) contact_ms: f64,
    pub(super) wall_ms: f64,
    pub(super) all: Evaluation,
    /// What surfaces that the model does not know were decided to be.
    pub(super) taken_for: BTreeMap<String, usize>,
}

impl Figures {
    pub(super) fn of(runs: Vec<Scored>, classes: &[String], tick_hz: u32) -> Self {
        let ms = 1000.0 / f64::from(tick_hz);
        let mean = |figure: fn(&Scored) -> f64| ms * mean_of(runs.iter().map(figure)).0;
        let (contact_ms, wall_ms) = (mean(|run| run.evaluation.samples), mean(|run| run.wall));
        let hits = runs.iter().filter_map(|run| run.evaluation.hits).collect();
        let shown: Vec<Shown> = runs.into_iter().flat_map(|run| run.presentations).collect();
        let all = Evaluation::new(classes, &shown);
        let mut taken_for = BTreeMap::new();
        let strange = shown.iter().filter(|shown| !classes.contains(&shown.label));
        for decided in strange.flat_map(|shown| &shown.decided) {
            *taken_for.entry(decided.decision.clone()).or_default() += 1;
        }
        Self {
            hits,
            contact_ms,
            wall_ms,
            all,
            taken_for,
        }
    }

    /// Keeps them in the page's table: part of the page, scene and setting, and the training.
    pub(super) fn keep(&self, page: &mut Page, of: [&str; 3], seed: u64) {
        let cell = |x: f64| cell(x, 3);
        let percent = |x: f64| cell(100.0 * x);
        let found = self.all.calibration.found;
        let (hit_rate, error) = self.hits();
        let figures = [
            seed.to_string(),
            self.hits.len().to_string(),
            cell(hit_rate),
            cell(error),
            cell(self.worst()),
            percent(self.all.calibration.stated),
            percent(found.share),
            percent(found.low),
            percent(found.high),
            found.count.to_string(),
            cell(self.contact_ms),
            cell(self.wall_ms),
            percent(self.all.undecided.share),
            percent(self.all.refused.share),
            percent(self.all.strange.share),
        ];
        page.keep(&of, &figures);
    }

    /// Mean hit rate over the runs, and its error, percent.
    pub(super) fn hits(&self) -> (f64, f64) {
        let (mean, error) = mean_of(self.hits.iter().copied());
        (100.0 * mean, 100.0 * error)
    }

    /// Hit rate of the worst run, percent; infinite without one.
    pub(super) fn worst(&self) -> f64 {
        100.0 * self.hits.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Points by which stated and found lie apart; positive where too much is stated.
    pub(super) fn overstated(&self) -> f64 {
        100.0 * (self.all.calibration.stated - self.all.calibration.found.share)
    }
}

/// Decisions on textures that the model does not know that said "unknown", percent.
pub(super) fn strange(figures: &Figures) -> f64 {
    100.0 * figures.all.strange.share
}

pub(super) fn known_refused(figures: &Figures) -> f64 {
    100.0 * figures.all.refused.share
}

/// Mean of some figures and its standard error; not numbers of none.
pub(crate) fn mean_of(figures: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let figures = figures.into_iter().filter(|x| !x.is_nan());
    Statistics::of(figures).map_or((f64::NAN, f64::NAN), |s| (s.mean, s.error().unwrap_or(0.0)))
}

pub(super) fn over<'f>(
    models: impl Iterator<Item = &'f Figures>,
    figure: impl Fn(&Figures) -> f64,
) -> (f64, f64) {
    mean_of(models.map(figure))
}

pub(crate) fn plus_minus((mean, error): (f64, f64), decimals: usize) -> String {
    if mean.is_nan() {
        "–".to_owned()
    } else {
        format!("{mean:.decimals$} ± {error:.decimals$}")
    }
}

pub(crate) fn number(x: f64, decimals: usize) -> String {
    if x.is_nan() {
        "–".to_owned()
    } else {
        format!("{x:.decimals$}")
    }
}

/// A number of a table in CSV; what is none is empty.
pub(crate) fn cell(x: f64, decimals: usize) -> String {
    if x.is_finite() {
        format!("{x:.decimals$}")
    } else {
        String::new()
    }
}

/// A share with its interval, percent.
pub(crate) fn percent(of: Interval) -> String {
    if of.count == 0 {
        return "–".to_owned();
    }
    let [share, low, high] = [of.share, of.low, of.high].map(|x| 100.0 * x);
    format!("{share:.1} ({low:.1} to {high:.1})")
}

/// A bound that a figure is to keep; infinite: none is asked for.
#[derive(Debug, Clone, Copy)]
pub(super) enum Goal {
    AtLeast(f64),
    AtMost(f64),
}

impl Goal {
    pub(super) fn is_asked(self) -> bool {
        let (Self::AtLeast(bound) | Self::AtMost(bound)) = self;
        bound.is_finite()
    }

    pub(super) fn text(self) -> String {
        match self {
            _ if !self.is_asked() => "–".to_owned(),
            Self::AtLeast(bound) => format!("at least {bound}"),
            Self::AtMost(bound) => format!("at most {bound}"),
        }
    }

    pub(super) fn met(self, value: f64) -> bool {
        match self {
            Self::AtLeast(bound) => value >= bound,
            Self::AtMost(bound) => value <= bound,
        }
    }

    pub(super) fn verdict(self, value: f64) -> &'static str {
        if self.is_asked() {
            verdict(self.met(value))
        } else {
            ""
        }
    }

    pub(super) fn worse(self, a: f64, b: f64) -> f64 {
        match self {
            Self::AtLeast(_) => a.min(b),
            Self::AtMost(_) => a.max(b),
        }
    }
}
