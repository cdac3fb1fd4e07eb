//! What is measured of each variant: error of the log posterior in the open
//! loop, decisions and hit rates in the closed one.

use scene::Rule;

use super::data::Recording;
use super::evidence::Sums;
use super::ground::Ground;
use super::listeners::{Integers, Listener, Product};
use super::model::{Entry, Variant};
use host_sim::Error;

/// Thresholds of the sequential rule.
pub(super) const THRESHOLDS: [f64; 3] = [0.9, 0.99, 0.999];
/// Samples of the window rule; counted together.
pub(super) const WINDOWS: [u32; 3] = [120, 200, 260];

/// Columns of a table of decisions: the thresholds, then all windows.
pub(super) const COLUMNS: usize = THRESHOLDS.len() + 1;

/// The rules of each column.
pub(super) fn columns() -> [Vec<Rule>; COLUMNS] {
    let [a, b, c] = THRESHOLDS.map(|threshold| vec![Rule::Sequential { threshold }]);
    let windows = WINDOWS.map(|samples| Rule::Window { samples });
    [a, b, c, windows.to_vec()]
}

/// Largest and mean of some errors.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Spread {
    pub(super) largest: f64,
    sum: f64,
    count: u64,
}

impl Spread {
    pub(super) fn add(&mut self, error: f64) {
        self.largest = self.largest.max(error);
        self.sum += error;
        self.count += 1;
    }

    /// Zero of no errors.
    pub(super) fn mean(self) -> f64 {
        self.sum / (self.count.max(1) as f64)
    }

    /// How many.
    pub(super) const fn count(self) -> u64 {
        self.count
    }
}

/// Errors against the yardstick after every block of both recordings.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Errors {
    /// |Δ ln p| of the class that the yardstick has leading.
    pub(super) leader: Spread,
    /// |Δ ln p| of every class above [`super::ground::LEAST_POSTERIOR`].
    pub(super) all: Spread,
    /// |Δ p| of every class.
    pub(super) posterior: Spread,
}

/// How many of some decisions are as the yardstick's.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Same {
    pub(super) same: usize,
    pub(super) of: usize,
}

impl Same {
    /// As a share; one of no decisions.
    pub(super) fn share(self) -> f64 {
        if self.of == 0 {
            return 1.0;
        }
        self.same as f64 / self.of as f64
    }

    /// Both together.
    pub(super) const fn and(self, other: Self) -> Self {
        Self {
            same: self.same + other.same,
            of: self.of + other.of,
        }
    }
}

/// Decisions of one column on one recording. Identical is: the same stream,
/// class and samples, after the same block; of all blocks after which either
/// decides.
#[derive(Debug, Clone, Copy)]
pub(super) struct Decisions {
    /// Identical, both starting again after each decision of the yardstick.
    pub(super) restarted: Same,
    /// Identical, each starting again after his own decisions: one that falls
    /// a block apart takes those after it along.
    pub(super) running: Same,
    /// Share of the running ones that is right, mean over classes; not a
    /// number without decisions.
    pub(super) hit_rate: f64,
}

/// The decisions of one recording.
pub(super) type OnOne = [Decisions; COLUMNS];

/// Everything about a variant.
pub(super) struct Row {
    /// None: the product itself.
    pub(super) variant: Option<Variant>,
    pub(super) errors: Errors,
    /// For each recording.
    pub(super) decisions: [OnOne; 2],
}

impl Row {
    fn measure<L: Listener>(
        variant: Option<Variant>,
        grounds: &[Ground<'_>; 2],
        make: impl Fn(usize, Option<Rule>) -> Result<L, Error>,
    ) -> Result<Self, Error> {
        let mut errors = Errors::default();
        let [first, second] = grounds;
        first.errors(&mut make(0, None)?, &mut errors);
        second.errors(&mut make(1, None)?, &mut errors);
        let decisions = [
            first.decisions(|rule| make(0, Some(rule)))?,
            second.decisions(|rule| make(1, Some(rule)))?,
        ];
        Ok(Self {
            variant,
            errors,
            decisions,
        })
    }

    /// Identical decisions of the sequential rule on a recording, restarted.
    pub(super) fn restarted(&self, recording: usize) -> Same {
        self.over(recording, |decisions| decisions.restarted)
    }

    /// Identical decisions of the sequential rule on a recording, running.
    pub(super) fn running(&self, recording: usize) -> Same {
        self.over(recording, |decisions| decisions.running)
    }

    fn over(&self, recording: usize, which: fn(&Decisions) -> Same) -> Same {
        let columns = self.decisions.get(recording).into_iter().flatten();
        let sequential = columns.take(THRESHOLDS.len());
        sequential.map(which).fold(Same::default(), Same::and)
    }
}

/// A recording as the text speaks of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct About {
    pub(super) name: &'static str,
    pub(super) classes: usize,
    pub(super) bins: usize,
    pub(super) block: u32,
    pub(super) samples: usize,
}

/// All that was measured.
pub(super) struct Study {
    pub(super) about: [About; 2],
    /// Hit rates of the yardstick.
    pub(super) reference: [[f64; COLUMNS]; 2],
    /// The product itself.
    pub(super) product: Row,
    /// All variants.
    pub(super) variants: Vec<Row>,
}

impl Study {
    /// # Errors
    /// [`Error::Work`] if a rule does not fit a model.
    pub(super) fn new(recordings: &[Recording; 2]) -> Result<Self, Error> {
        let [first, second] = recordings;
        let grounds = [Ground::new(first), Ground::new(second)];
        let models = [first.parsed()?, second.parsed()?];
        let product = Row::measure(None, &grounds, |n, rule| {
            Product::new(&recordings[n], &models[n], rule)
        })?;
        let mut variants = Vec::new();
        for entry in Entry::ALL {
            let sums = [Sums::new(first, entry), Sums::new(second, entry)];
            for variant in Variant::all().filter(|variant| variant.entry == entry) {
                variants.push(Row::measure(Some(variant), &grounds, |n, rule| {
                    Ok(Integers::new(&recordings[n], &sums[n], variant, rule))
                })?);
            }
        }
        Ok(Self {
            about: [first.about(), second.about()],
            reference: grounds.each_ref().map(Ground::hit_rates),
            product,
            variants,
        })
    }

    /// The row of a variant.
    pub(super) fn of(&self, variant: Variant) -> Option<&Row> {
        let mut rows = self.variants.iter();
        rows.find(|row| row.variant == Some(variant))
    }
}
