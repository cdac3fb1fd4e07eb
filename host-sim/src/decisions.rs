//! `decisions.csv`, and the score of decisions against labels.

use std::fmt;
use std::io::{self, Write};

use tactile::Decision;
use tactile::score::Confusion;

/// What a decision says where what was felt is none of the model's classes.
pub const UNKNOWN: &str = "unknown";

/// The name of a decision.
pub fn name(decision: Decision, classes: &[String]) -> &str {
    let class = decision.class().and_then(|class| classes.get(class));
    class.map_or(UNKNOWN, String::as_str)
}

/// One decision and the true class.
#[derive(Debug, Clone, PartialEq)]
pub struct Decided {
    /// True class.
    pub label: String,
    /// Which stream of that label.
    pub trial: String,
    /// The class decided for, or [`UNKNOWN`].
    pub decision: String,
    /// How many samples it used.
    pub samples: u32,
    /// Posterior probability of the class decided for.
    pub posterior: f64,
}

/// Writes `decisions.csv`.
///
/// # Errors
/// Any error of the writer.
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

/// How good some decisions are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Score {
    /// The model's classes, and below them labels that it does not know.
    names: Vec<String>,
    /// How many the model has.
    classes: usize,
    confusion: Confusion,
    samples: u64,
}

impl Score {
    /// Counts `decisions` among `classes`; labels that the model does not know
    /// get a row of their own below.
    pub fn new(classes: &[String], decisions: &[Decided]) -> Self {
        let mut names = classes.to_vec();
        for d in decisions {
            if !names.contains(&d.label) {
                names.push(d.label.clone());
            }
        }
        let place = |name: &String| names.iter().position(|other| other == name);
        let mut confusion = Confusion::new(names.len());
        for d in decisions {
            if let Some(truth) = place(&d.label) {
                // Both are among the names, but for what is unknown.
                let _ = confusion.add(truth, place(&d.decision));
            }
        }
        let samples = decisions.iter().map(|d| u64::from(d.samples)).sum();
        Self {
            names,
            classes: classes.len(),
            confusion,
            samples,
        }
    }

    /// Decisions in all.
    pub fn decisions(&self) -> u64 {
        self.confusion.named()
    }

    /// Share of right decisions for each class that was presented, averaged
    /// over those classes; `None` without a decision.
    pub fn hit_rate(&self) -> Option<f64> {
        self.confusion.mean_hit_rate()
    }

    /// Mean decision time in samples; `None` without a decision.
    pub fn mean_samples(&self) -> Option<f64> {
        let decisions = self.decisions();
        (decisions > 0).then(|| self.samples as f64 / decisions as f64)
    }
}

/// The confusion matrix.
impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.confusion.table(&self.names, self.classes))
    }
}

#[cfg(test)]
mod tests {
    use super::{Decided, Score, write};

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
        let score = Score::new(&names, &decisions);
        assert_eq!(score.hit_rate(), Some(0.875));
        assert_eq!(score.mean_samples(), Some(32.0));
        let text = score.to_string();
        assert!(text.contains("    ice |       3       1"), "{text}");
    }

    #[test]
    fn a_label_that_the_model_does_not_know_is_never_a_hit() {
        let names = ["ice".to_owned()];
        let score = Score::new(&names, &[decided("mud", "ice", 20)]);
        assert_eq!(score.hit_rate(), Some(0.0));
        assert_eq!(Score::new(&names, &[]).hit_rate(), None);
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
