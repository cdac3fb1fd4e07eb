//! `decisions.csv`, and the score of decisions against labels.

use std::fmt;
use std::io::{self, Write};

use tactile::Decision;
use tactile::score::{Confusion, Statistics};

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
    /// The number of the touch in which it fell, or of the last one; 0 before the first.
    pub touch: u16,
}

impl Decided {
    /// Whether it named the true class.
    pub fn is_right(&self) -> bool {
        self.label == self.decision
    }
}

/// Writes `decisions.csv`.
///
/// # Errors
/// Any error of the writer.
pub fn write(table: impl Write, decisions: &[Decided]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(table);
    table.write_record([
        "label",
        "trial",
        "decision",
        "samples",
        "posterior",
        "touch",
    ])?;
    for d in decisions {
        table.write_record([
            d.label.as_str(),
            &d.trial,
            &d.decision,
            &d.samples.to_string(),
            &format!("{:.9}", d.posterior),
            &d.touch.to_string(),
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
    pub fn new<'d>(classes: &[String], decisions: impl IntoIterator<Item = &'d Decided>) -> Self {
        let decisions: Vec<&Decided> = decisions.into_iter().collect();
        let mut names = classes.to_vec();
        for d in &decisions {
            if !names.contains(&d.label) {
                names.push(d.label.clone());
            }
        }
        let place = |name: &String| names.iter().position(|other| other == name);
        let mut confusion = Confusion::new(names.len());
        let mut samples = 0;
        for d in decisions {
            let named = place(&d.decision);
            if let Some(truth) = place(&d.label) {
                // Both are among the names, but for what is unknown.
                let _ = confusion.add(truth, named);
            }
            if named.is_some() {
                samples += u64::from(d.samples);
            }
        }
        Self {
            names,
            classes: classes.len(),
            confusion,
            samples,
        }
    }

    /// Decisions that named a class.
    pub fn decisions(&self) -> u64 {
        self.confusion.named()
    }

    /// Decisions that said "unknown".
    pub fn unknown(&self) -> u64 {
        self.confusion.trials() - self.confusion.named()
    }

    /// Of the decisions that named a class the share that was right, for each surface
    /// that was presented, averaged over those; `None` without a decision.
    pub fn hit_rate(&self) -> Option<f64> {
        let rates = (0..self.names.len()).filter_map(|truth| {
            let named: u64 = (0..self.classes)
                .map(|class| self.confusion.count(truth, class))
                .sum();
            (named > 0).then(|| self.confusion.count(truth, truth) as f64 / named as f64)
        });
        Statistics::of(rates).map(|rates| rates.mean)
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
        let Self {
            names, confusion, ..
        } = self;
        let missed = (self.unknown() > 0).then_some(UNKNOWN);
        write!(f, "{}", confusion.table(names, self.classes, missed))
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
            touch: 3,
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
    fn unknown_is_neither_right_nor_wrong() {
        let names = ["ice".to_owned(), "loam".to_owned()];
        let decisions = [
            decided("ice", "ice", 20),
            decided("ice", super::UNKNOWN, 900),
            decided("loam", "loam", 40),
        ];
        let score = Score::new(&names, &decisions);
        assert_eq!((score.decisions(), score.unknown()), (2, 1));
        assert_eq!(score.hit_rate(), Some(1.0));
        assert_eq!(score.mean_samples(), Some(30.0));
        let text = score.to_string();
        assert!(text.contains("    ice |       1       0       1"), "{text}");
    }

    #[test]
    fn names_with_commas_survive_the_file() {
        let mut table = Vec::new();
        write(&mut table, &[decided("sand, wet", "ice", 20)]).unwrap();
        let text = String::from_utf8(table).unwrap();
        assert_eq!(
            text,
            "label,trial,decision,samples,posterior,touch\n\
             \"sand, wet\",1,ice,20,0.995000000,3\n"
        );
    }
}
