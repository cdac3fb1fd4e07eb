//! What came of some presentations, added up, and what is asked of it: a goal is missed where the
//! interval of the figure excludes it.

use host_sim::decisions::{Decided, UNKNOWN};
use host_sim::evaluation::Shown;
use tactile::Reason;
use tactile::score::Interval;

use super::TICK_HZ;
use crate::decisions::figures::mean_of;
use crate::moments::{SURE, quantile};
use crate::page::verdict;

/// The reasons in the order in which they are counted.
pub(super) const REASONS: [&str; 3] = ["unknown", "pose", "between"];

#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Tally {
    pub(super) presentations: usize,
    /// Those in which a class was named.
    pub(super) decided: usize,
    /// Decisions that named a class, and those of them that were right.
    pub(super) named: usize,
    pub(super) right: usize,
    /// Sums over those that named one: posterior and samples.
    stated: f64,
    samples: f64,
    /// Decisions that named none, by [`REASONS`].
    pub(super) silent: [usize; REASONS.len()],
}

impl Tally {
    pub(super) fn of<'s>(shown: impl IntoIterator<Item = &'s Shown>) -> Self {
        let mut tally = Self::default();
        for shown in shown {
            tally.presentations += 1;
            let named = |decided: &Decided| decided.decision != UNKNOWN;
            tally.decided += usize::from(shown.decided.iter().any(named));
            for decided in &shown.decided {
                tally.count(decided);
            }
        }
        tally
    }

    fn count(&mut self, decided: &Decided) {
        if let Some(reason) = decided.reason.map(Reason::name) {
            let counts = REASONS.iter().zip(&mut self.silent);
            for (_, count) in counts.filter(|(name, _)| **name == reason) {
                *count += 1;
            }
            return;
        }
        self.named += 1;
        self.right += usize::from(decided.is_right());
        self.stated += decided.posterior;
        self.samples += f64::from(decided.samples);
    }

    pub(super) fn sum<'t>(tallies: impl IntoIterator<Item = &'t Self>) -> Self {
        tallies.into_iter().fold(Self::default(), |a, b| Self {
            presentations: a.presentations + b.presentations,
            decided: a.decided + b.decided,
            named: a.named + b.named,
            right: a.right + b.right,
            stated: a.stated + b.stated,
            samples: a.samples + b.samples,
            silent: [0, 1, 2].map(|n| a.silent[n] + b.silent[n]),
        })
    }

    /// Right of those named. Decisions of one presentation are alike: each presentation with a
    /// name counts as one observation.
    pub(super) fn right_share(&self) -> Interval {
        Interval::of_share(self.right as f64 / self.named as f64, self.decided)
    }

    pub(super) fn decided_share(&self) -> Interval {
        Interval::of(self.decided, self.presentations)
    }

    /// Decisions that named none, of all; its interval of presentations.
    pub(super) fn refused_share(&self) -> Interval {
        let refused: usize = self.silent.iter().sum();
        let all = refused + self.named;
        let share = refused as f64 / all as f64;
        Interval::of_share(share, if all == 0 { 0 } else { self.presentations })
    }

    pub(super) fn undecided_share(&self) -> Interval {
        Interval::of(self.presentations - self.decided, self.presentations)
    }

    /// Mean stated, percent.
    pub(super) fn stated(&self) -> f64 {
        100.0 * self.stated / self.named as f64
    }

    /// Points by which right lies below stated; not a number without a name.
    pub(super) fn short(&self) -> f64 {
        self.stated() - 100.0 * self.right as f64 / self.named as f64
    }

    /// The same at the upper and the lower end of the interval of right.
    pub(super) fn short_within(&self) -> [f64; 2] {
        let right = self.right_share();
        [right.high, right.low].map(|right| self.stated() - 100.0 * right)
    }

    /// Contact to a name, ms.
    pub(super) fn contact_ms(&self, tick_hz: u32) -> f64 {
        1000.0 * self.samples / self.named as f64 / f64::from(tick_hz)
    }
}

/// The most presentations with a name where nothing is asked of the names, percent.
const SILENT: f64 = 5.0;
/// The least of names that is to be right, percent, and how far stated may lie from it, points.
const RIGHT: f64 = 98.5;
const APART: f64 = 1.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Asked {
    /// Right and stated rightly, and so much decided, percent, within so many ms of contact.
    Known(f64, Option<f64>),
    /// Right is no more points below stated than this, or next to nothing is decided.
    Honest(f64),
}

impl Asked {
    pub(super) fn text(self) -> String {
        match self {
            Self::Known(decided, ms) => {
                let ms = ms.map_or_else(String::new, |ms| format!(", within {ms} ms"));
                format!("right ≥ {RIGHT}, gap ≤ {APART}, decided ≥ {decided}{ms}")
            }
            Self::Honest(short) => format!("right ≥ stated − {short}, or decided ≤ {SILENT}"),
        }
    }

    pub(super) fn missed(self, tally: &Tally) -> Vec<&'static str> {
        let [least, most] = tally.short_within();
        let [right, decided] = [tally.right_share(), tally.decided_share()];
        match self {
            Self::Known(goal, ms) => missed([
                ("right", 100.0 * right.high < RIGHT),
                ("gap", least > APART || most < -APART),
                ("decided", 100.0 * decided.high < goal),
                ("time", ms.is_some_and(|ms| tally.contact_ms(TICK_HZ) > ms)),
            ]),
            Self::Honest(short) => {
                let is_loud = 100.0 * decided.low > SILENT;
                missed([("right", is_loud && least > short)])
            }
        }
    }

    pub(super) fn verdict(self, tally: &Tally) -> String {
        said(&self.missed(tally))
    }
}

/// The names of what is missed.
pub(super) fn missed(all: impl IntoIterator<Item = (&'static str, bool)>) -> Vec<&'static str> {
    let missed = all.into_iter().filter(|(_, is_missed)| *is_missed);
    missed.map(|(name, _)| name).collect()
}

pub(super) fn said(missed: &[&str]) -> String {
    let met = verdict(missed.is_empty());
    if missed.is_empty() {
        met.to_owned()
    } else {
        format!("{met}: {}", missed.join(", "))
    }
}

/// A mean with its 95 % interval by Student: low, mean, high; all the mean if there is one value.
pub(super) fn mean_within(values: impl Iterator<Item = f64> + Clone) -> [f64; 3] {
    let count = values.clone().filter(|x| !x.is_nan()).count();
    let (mean, error) = mean_of(values);
    let half = quantile(&SURE, count) * error;
    [mean - half, mean, mean + half]
}

#[cfg(test)]
mod tests {
    use host_sim::decisions::Decided;
    use host_sim::evaluation::Shown;
    use tactile::Decision;

    use super::Tally;

    /// A presentation of ice to a model of ice and snow, whose decisions have these bits of why
    /// none is named, and are for the first class.
    fn shown(label: &str, bits: &[u32]) -> Shown {
        let classes = ["ice", "snow"].map(str::to_owned);
        let decided = |bits: &u32| {
            let decision = Decision::from_memory(40, 0, bits << 16).unwrap();
            Decided::new(decision, &classes, label, "1")
        };
        Shown {
            label: label.to_owned(),
            decided: bits.iter().map(decided).collect(),
        }
    }

    #[test]
    fn names_and_reasons_are_counted_apart() {
        let shown = [
            shown("ice", &[0, 0, 3]),
            shown("snow", &[0, 1]),
            shown("snow", &[5, 5, 5]),
            shown("ice", &[]),
        ];
        let tally = Tally::of(&shown);
        assert_eq!((tally.presentations, tally.decided), (4, 2));
        assert_eq!((tally.named, tally.right), (3, 2));
        assert_eq!(tally.silent, [1, 1, 3]);
        assert_eq!(tally.contact_ms(2000), 20.0);
        assert!((tally.refused_share().share - 5.0 / 8.0).abs() < 1e-12);
        assert_eq!(tally.undecided_share().share, 0.5);
        let parts = shown.map(|shown| Tally::of([&shown]));
        assert_eq!(Tally::sum(&parts), tally);
        assert_eq!(tally.right_share().count, 2);
    }
}
