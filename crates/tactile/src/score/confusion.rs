//! A confusion matrix, and the rates that come of it.

use core::fmt;
use std::string::String;
use std::vec;
use std::vec::Vec;

use super::statistics::Statistics;

/// Why a trial cannot be counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say it")]
pub enum ScoreError {
    #[error("class {class} of {classes}, from zero")]
    Class { class: usize, classes: usize },
    #[error("matrices of {ours} and of {theirs} classes")]
    Classes { ours: usize, theirs: usize },
}

/// A confusion matrix and the trials missed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Confusion {
    classes: usize,
    /// Row by row: true class, class named.
    counts: Vec<u64>,
    /// Of each true class.
    missed: Vec<u64>,
}

impl Confusion {
    /// No trial yet.
    pub fn new(classes: usize) -> Self {
        Self {
            classes,
            counts: vec![0; classes.saturating_mul(classes)],
            missed: vec![0; classes],
        }
    }

    /// Counts a trial of a class: the class named, or none.
    ///
    /// # Errors
    /// There is no such class; nothing is then counted.
    pub fn add(&mut self, truth: usize, named: Option<usize>) -> Result<(), ScoreError> {
        let classes = self.classes;
        for class in [Some(truth), named].into_iter().flatten() {
            if class >= classes {
                return Err(ScoreError::Class { class, classes });
            }
        }
        let cell = match named {
            Some(named) => self.counts.get_mut(truth * classes + named),
            None => self.missed.get_mut(truth),
        };
        if let Some(cell) = cell {
            *cell += 1;
        }
        Ok(())
    }

    /// Adds the trials of another matrix, as of another fold or machine.
    ///
    /// # Errors
    /// It has other classes.
    pub fn merge(&mut self, other: &Self) -> Result<(), ScoreError> {
        if self.classes != other.classes {
            return Err(ScoreError::Classes {
                ours: self.classes,
                theirs: other.classes,
            });
        }
        let ours = self.counts.iter_mut().chain(&mut self.missed);
        for (ours, theirs) in ours.zip(other.counts.iter().chain(&other.missed)) {
            *ours += theirs;
        }
        Ok(())
    }

    /// How many classes there are.
    pub fn classes(&self) -> usize {
        self.classes
    }

    /// How often a class was taken for another (or for itself).
    pub fn count(&self, truth: usize, named: usize) -> u64 {
        let row = self.counts.chunks_exact(self.classes.max(1)).nth(truth);
        row.and_then(|row| row.get(named)).copied().unwrap_or(0)
    }

    /// Trials of a class in which none was named.
    pub fn missed(&self, truth: usize) -> u64 {
        self.missed.get(truth).copied().unwrap_or(0)
    }

    /// All trials.
    pub fn trials(&self) -> u64 {
        (0..self.classes).map(|truth| self.trials_of(truth)).sum()
    }

    /// Trials in which a class was named.
    pub fn named(&self) -> u64 {
        self.counts.iter().sum()
    }

    fn trials_of(&self, truth: usize) -> u64 {
        let named: u64 = (0..self.classes)
            .map(|named| self.count(truth, named))
            .sum();
        named + self.missed(truth)
    }

    fn hits(&self) -> u64 {
        (0..self.classes)
            .map(|class| self.count(class, class))
            .sum()
    }

    /// Share of all trials in which the right class was named, 0 to 1; `None`
    /// without a trial.
    pub fn hit_rate(&self) -> Option<f64> {
        ratio(self.hits(), self.trials())
    }

    /// The same of one class.
    pub fn hit_rate_of(&self, truth: usize) -> Option<f64> {
        ratio(self.count(truth, truth), self.trials_of(truth))
    }

    /// Cohen's κ (POSE eq. 8); `None` without a named class, or where chance
    /// alone would always be right.
    pub fn kappa(&self) -> Option<f64> {
        let named = self.named();
        let observed = ratio(self.hits(), named)?;
        let expected: f64 = (0..self.classes)
            .filter_map(|class| {
                let row = (0..self.classes)
                    .map(|other| self.count(class, other))
                    .sum();
                let column = (0..self.classes)
                    .map(|other| self.count(other, class))
                    .sum();
                Some(ratio(row, named)? * ratio(column, named)?)
            })
            .sum();
        (expected < 1.0).then(|| (observed - expected) / (1.0 - expected))
    }

    /// The counts as lines of text, a row a true class, with a column for each
    /// of the first `columns` classes and, where it has a title, one of those missed.
    pub fn table<'a>(
        &'a self,
        names: &'a [String],
        columns: usize,
        missed: Option<&'a str>,
    ) -> impl fmt::Display {
        fmt::from_fn(move |f| {
            let longest = names.iter().map(|name| name.chars().count()).max();
            let width = longest.unwrap_or(0).max("decided".len());
            write!(f, "{:>width$} |", "true")?;
            for name in names.iter().take(columns) {
                write!(f, " {name:>width$}")?;
            }
            if let Some(missed) = missed {
                write!(f, " {missed:>width$}")?;
            }
            writeln!(f, "   <- decided")?;
            for (truth, name) in names.iter().enumerate() {
                write!(f, "{name:>width$} |")?;
                for named in 0..columns {
                    write!(f, " {:>width$}", self.count(truth, named))?;
                }
                if missed.is_some() {
                    write!(f, " {:>width$}", self.missed(truth))?;
                }
                writeln!(f)?;
            }
            Ok(())
        })
    }

    /// The errors of ordered classes that stand for `values` (mm/s, degrees):
    /// value named minus true value, over the trials with a class named.
    /// `None` without one, or if a value is missing.
    pub fn errors(&self, values: &[f64]) -> Option<Statistics> {
        if values.len() < self.classes {
            return None;
        }
        let errors = values.iter().enumerate().flat_map(|(truth, from)| {
            values.iter().enumerate().flat_map(move |(named, to)| {
                let times = usize::try_from(self.count(truth, named)).unwrap_or(usize::MAX);
                core::iter::repeat_n(to - from, times)
            })
        });
        Statistics::of(errors)
    }
}

fn ratio(part: u64, whole: u64) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}
