//! Tables, claims and sections of the page of experiments.

use std::fmt::Display;

use tactile::score::Confusion;

use crate::accuracy::page::Page;

/// Something that must come out, and whether it does.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Claim {
    /// What must come out.
    pub(super) what: String,
    /// What the paper has.
    pub(super) paper: String,
    /// What we have.
    pub(super) ours: String,
    /// Whether it came out.
    pub(super) met: bool,
    /// Where it did not: why, as measured.
    pub(super) why: String,
}

/// What an experiment contributes.
#[derive(Debug, Default)]
pub(super) struct Section {
    /// Text, tables and pictures.
    pub(super) page: Page,
    /// Its claims.
    pub(super) claims: Vec<Claim>,
    /// A row a classifier: name, where measured, hit rate.
    pub(super) scores: Vec<Score>,
}

/// A classifier's hit rate.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Score {
    /// The classifier.
    pub(super) classifier: &'static str,
    /// On what.
    pub(super) task: String,
    /// Hit rate, percent.
    pub(super) hit: f64,
}

impl Section {
    /// Adds a claim.
    pub(super) fn claim(
        &mut self,
        what: impl Display,
        paper: impl Display,
        ours: impl Display,
        met: bool,
        why: impl Display,
    ) {
        self.claims.push(Claim {
            what: what.to_string(),
            paper: paper.to_string(),
            ours: ours.to_string(),
            met,
            why: why.to_string(),
        });
    }

    /// Adds a classifier's score.
    pub(super) fn score(&mut self, classifier: &'static str, task: impl Display, hit: f64) {
        self.scores.push(Score {
            classifier,
            task: task.to_string(),
            hit,
        });
    }
}

/// Percent without a digit behind the point, the paper's beside ours.
pub(super) fn beside(paper: f64, ours: f64) -> String {
    format!("{paper:.0} / **{ours:.0}**")
}

/// Percent of the trials of a true class in which `named` was named.
pub(super) fn percent_of(score: &Confusion, truth: usize, named: usize) -> f64 {
    let sum: u64 = (0..score.classes()).map(|k| score.count(truth, k)).sum();
    100.0 * score.count(truth, named) as f64 / sum.max(1) as f64
}

/// A confusion matrix in percent: a row is the true class, a column what was
/// decided; the paper's `[true][decided]` beside ours.
pub(super) fn confusion(
    page: &mut Page,
    names: &[&str],
    paper: &dyn Fn(usize, usize) -> f64,
    ours: &Confusion,
) {
    let rows = names.iter().enumerate().map(|(truth, name)| {
        let cell = |named| beside(paper(truth, named), percent_of(ours, truth, named));
        std::iter::once((*name).to_owned())
            .chain((0..names.len()).map(cell))
            .collect()
    });
    let header = format!("true \\ decided | {}", names.join(" | "));
    page.table(&header, rows);
}
