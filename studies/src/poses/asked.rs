//! What is asked of a condition, and whether it is found: a goal is missed where the interval of
//! the figure excludes it.

use tactile::score::Interval;

use super::tally::Tally;
use super::trained::TICK_HZ;
use crate::decisions::figures::mean_of;
use crate::moments::SURE;
use crate::page::verdict;

/// The most presentations with a name where nothing is asked of the names, percent.
const SILENT: f64 = 5.0;
/// The least of names that is to be right, percent, and how far stated may lie from it, points.
const RIGHT: f64 = 98.5;
const APART: f64 = 1.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Asked {
    /// Right and stated rightly, and so much decided, percent, within so many ms of contact.
    Known { decided: f64, ms: Option<f64> },
    /// Right is no more points below stated than this, or next to nothing is decided.
    Honest { short: f64 },
}

impl Asked {
    pub(super) fn text(self) -> String {
        match self {
            Self::Known { decided, ms } => {
                let ms = ms.map_or_else(String::new, |ms| format!(", within {ms} ms"));
                format!("right ≥ {RIGHT}, gap ≤ {APART}, decided ≥ {decided}{ms}")
            }
            Self::Honest { short } => format!("right ≥ stated − {short}, or decided ≤ {SILENT}"),
        }
    }

    pub(super) fn missed(self, tally: &Tally) -> Vec<&'static str> {
        let [least, most] = tally.short_within();
        let [right, decided] = [tally.right_share(), tally.decided_share()];
        let is_missed = match self {
            Self::Known { decided: goal, ms } => vec![
                ("right", 100.0 * right.high < RIGHT),
                ("gap", least > APART || most < -APART),
                ("decided", 100.0 * decided.high < goal),
                ("time", ms.is_some_and(|ms| tally.contact_ms(TICK_HZ) > ms)),
            ],
            Self::Honest { short } => {
                let is_loud = 100.0 * decided.low > SILENT;
                vec![("right", is_loud && least > short)]
            }
        };
        let missed = is_missed.into_iter().filter(|(_, missed)| *missed);
        missed.map(|(name, _)| name).collect()
    }

    pub(super) fn verdict(self, tally: &Tally) -> String {
        said(&self.missed(tally))
    }
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
    let half = SURE.quantile(count) * error;
    [mean - half, mean, mean + half]
}

/// Whether a share, percent, is to be called at least this.
pub(super) fn at_least(share: Interval, goal: f64) -> bool {
    100.0 * share.high >= goal
}

/// At most this.
pub(super) fn at_most(share: Interval, goal: f64) -> bool {
    100.0 * share.low <= goal
}
