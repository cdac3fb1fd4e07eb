//! `decisions.csv`, and the score of decisions against labels.

use std::fmt;
use std::io::{self, Write};

/// One decision and what it should have been.
#[derive(Debug, Clone, PartialEq)]
pub struct Decided {
    /// True class.
    pub label: String,
    /// Which stream of that label.
    pub trial: String,
    /// The class decided for.
    pub decision: String,
    /// How many samples it used.
    pub samples: u32,
    /// Posterior probability of the class decided for.
    pub posterior: f64,
}

/// Writes `decisions.csv`.
///
/// # Errors
/// What writing brings.
pub fn write(table: impl Write, decisions: &[Decided]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(table);
    table.write_record(["label", "trial", "decision", "samples", "posterior"])?;
    for d in decisions {
        table.write_record([
            d.label.as_str(),
            &d.trial,
            &d.decision,
            &d.samples.to_string(),
            &format!("{:.9}", d.posterior),
        ])?;
    }
    table.flush()
}

/// How often each class was taken for each other.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Confusion {
    classes: Vec<String>,
    /// Row: true class; column: decision.
    counts: Vec<Vec<u64>>,
    samples: u64,
}

impl Confusion {
    /// Counts `decisions` among `classes`; labels that the model does not know
    /// get a row of their own below.
    pub fn new(classes: &[String], decisions: &[Decided]) -> Self {
        let mut rows = classes.to_vec();
        for d in decisions {
            if !rows.contains(&d.label) {
                rows.push(d.label.clone());
            }
        }
        let place = |name: &String| rows.iter().position(|row| row == name);
        let mut counts = vec![vec![0; classes.len()]; rows.len()];
        for d in decisions {
            if let (Some(row), Some(column)) = (place(&d.label), place(&d.decision))
                && let Some(count) = counts.get_mut(row).and_then(|row| row.get_mut(column))
            {
                *count += 1;
            }
        }
        let samples = decisions.iter().map(|d| u64::from(d.samples)).sum();
        Self {
            classes: rows,
            counts,
            samples,
        }
    }

    /// Decisions in all.
    pub fn decisions(&self) -> u64 {
        self.counts.iter().flatten().sum()
    }

    /// Share of right decisions for each class that was presented, averaged
    /// over those classes; `None` without a decision.
    pub fn hit_rate(&self) -> Option<f64> {
        let rates: Vec<f64> = self
            .counts
            .iter()
            .enumerate()
            .filter_map(|(class, row)| {
                let total: u64 = row.iter().sum();
                let right = row.get(class).copied().unwrap_or(0);
                (total > 0).then(|| right as f64 / total as f64)
            })
            .collect();
        (!rates.is_empty()).then(|| rates.iter().sum::<f64>() / rates.len() as f64)
    }

    /// Mean decision time in samples; `None` without a decision.
    pub fn mean_samples(&self) -> Option<f64> {
        let decisions = self.decisions();
        (decisions > 0).then(|| self.samples as f64 / decisions as f64)
    }
}

impl fmt::Display for Confusion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.counts.first().map_or(0, Vec::len);
        let width = self
            .classes
            .iter()
            .map(|name| name.chars().count())
            .max()
            .unwrap_or(0)
            .max(7);
        write!(f, "{:>width$} |", "true")?;
        for name in self.classes.iter().take(columns) {
            write!(f, " {name:>width$}")?;
        }
        writeln!(f, "   <- decided")?;
        for (name, row) in self.classes.iter().zip(&self.counts) {
            write!(f, "{name:>width$} |")?;
            for count in row {
                write!(f, " {count:>width$}")?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{Confusion, Decided, write};

    fn decided(label: &str, decision: &str, samples: u32) -> Decided {
        Decided {
            label: label.into(),
            trial: "1".into(),
            decision: decision.into(),
            samples,
            posterior: 0.995,
        }
    }

    #[test]
    fn the_hit_rate_is_the_mean_over_classes() {
        let names = ["ice".to_owned(), "loam".to_owned()];
        let mut decisions = vec![decided("ice", "ice", 20); 3];
        decisions.push(decided("ice", "loam", 40));
        decisions.push(decided("loam", "loam", 60));
        let confusion = Confusion::new(&names, &decisions);
        assert_eq!(confusion.hit_rate(), Some(0.875));
        assert_eq!(confusion.mean_samples(), Some(32.0));
        let text = confusion.to_string();
        assert!(text.contains("    ice |       3       1"), "{text}");
    }

    #[test]
    fn a_label_that_the_model_does_not_know_is_never_a_hit() {
        let names = ["ice".to_owned()];
        let confusion = Confusion::new(&names, &[decided("mud", "ice", 20)]);
        assert_eq!(confusion.hit_rate(), Some(0.0));
        assert_eq!(Confusion::new(&names, &[]).hit_rate(), None);
    }

    #[test]
    fn names_with_commas_survive_the_file() {
        let mut table = Vec::new();
        write(&mut table, &[decided("sand, wet", "ice", 20)]).unwrap();
        let text = String::from_utf8(table).unwrap();
        assert_eq!(
            text,
            "label,trial,decision,samples,posterior\n\"sand, wet\",1,ice,20,0.995000000\n"
        );
    }
}
