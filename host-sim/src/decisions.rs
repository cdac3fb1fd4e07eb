//! `decisions.csv`, and the score of decisions against labels.

use std::fmt;
use std::io::{self, Write};

use firmware::Place;
use tactile::Decision;
use tactile::score::{Confusion, Statistics};

use crate::columns::{self, Column, columns};

/// What a decision says where what was felt is none of the model's classes.
pub const UNKNOWN: &str = "unknown";

/// The name of a decision.
pub fn name(decision: Decision, classes: &[String]) -> &str {
    let class = decision.class().and_then(|class| classes.get(class));
    class.map_or(UNKNOWN, String::as_str)
}

/// What a decision is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// It names what was presented, or says "unknown" of what the model does not know.
    Right,
    /// It names something else.
    Wrong,
    /// It says "unknown" of what the model knows.
    Refused,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Right => "right",
            Self::Wrong => "wrong",
            Self::Refused => "refused",
        })
    }
}

/// One decision and the true class.
#[derive(Debug, Clone, PartialEq)]
pub struct Decided {
    /// When it fell in a run of a scene, s; none: in a recording.
    pub t_s: Option<f64>,
    /// The whisker that decided, or, of all together, whose block made it fall; none: in a
    /// recording.
    pub place: Option<Place>,
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

    /// What it is worth from a model of these classes.
    pub fn verdict(&self, classes: &[String]) -> Verdict {
        match (classes.contains(&self.label), self.decision.as_str()) {
            (true, UNKNOWN) => Verdict::Refused,
            (false, UNKNOWN) => Verdict::Right,
            (true, decision) if decision == self.label => Verdict::Right,
            _ => Verdict::Wrong,
        }
    }
}

/// Which columns a table of decisions has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Columns {
    /// Those of a recording, which has no clock.
    OfRecording,
    /// And last the time of the tick, as in the trace.
    OfScene,
    /// And then the whisker, by its side and its number from 1: where several are heard.
    OfSeveral,
}

/// The columns in order; those of a recording first, and of a scene.
pub const COLUMNS: [Column; 9] = columns! {
    "label", "", "the truth: what was touched";
    "trial", "", "which stream of that label";
    "decision", "", "class decided for, or `unknown`";
    "samples", "samples", "how many samples of contact the decision used";
    "posterior", "",
        "posterior probability of the class decided for; of `unknown` that of the one that came \
        nearest";
    "touch", "", "number of the touch in which it fell, or of the last one; 0 before the first";
    "t_s", "s", "when it fell, as in the trace; not of a recording, which has no clock";
    "side", "", "`left` or `right`; only where several whiskers are heard";
    "whisker", "", "number of the whisker on its side, from 1; likewise";
};

/// How many of them a recording has, and a scene with one whisker that is heard.
const OF_RECORDING: usize = 6;
const OF_SCENE: usize = 7;

/// Writes `decisions.csv`.
///
/// # Errors
/// Any error of the writer.
pub fn write(table: impl Write, decisions: &[Decided], columns: Columns) -> io::Result<()> {
    let count = match columns {
        Columns::OfRecording => OF_RECORDING,
        Columns::OfScene => OF_SCENE,
        Columns::OfSeveral => COLUMNS.len(),
    };
    let mut table = csv::Writer::from_writer(table);
    table.write_record(columns::names(&COLUMNS[..count]))?;
    for d in decisions {
        let cells = [
            d.label.clone(),
            d.trial.clone(),
            d.decision.clone(),
            d.samples.to_string(),
            format!("{:.9}", d.posterior),
            d.touch.to_string(),
            d.t_s.map_or_else(String::new, |t_s| format!("{t_s:.9}")),
            d.place
                .map_or_else(String::new, |place| place.side_name().to_owned()),
            d.place
                .map_or_else(String::new, |place| (place.whisker + 1).to_string()),
        ];
        table.write_record(&cells[..count])?;
    }
    table.flush()
}

/// How good some decisions are.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// The model's classes, and below them labels that it does not know.
    names: Vec<String>,
    /// How many the model has.
    classes: usize,
    confusion: Confusion,
    /// Of the decisions that count, the sums of their samples and posteriors.
    samples: u64,
    stated: f64,
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
        let (mut samples, mut stated) = (0, 0.0);
        for d in decisions {
            if let Some(truth) = place(&d.label) {
                // Both are among the names, but for what is unknown.
                let _ = confusion.add(truth, place(&d.decision));
            }
            if d.verdict(classes) != Verdict::Refused {
                samples += u64::from(d.samples);
                stated += d.posterior;
            }
        }
        Self {
            names,
            classes: classes.len(),
            confusion,
            samples,
            stated,
        }
    }

    /// Decisions that are right or wrong: all but [`Score::refused`].
    pub fn decisions(&self) -> u64 {
        self.confusion.trials() - self.refused()
    }

    /// Decisions that said "unknown" of what the model knows.
    pub fn refused(&self) -> u64 {
        let known = 0..self.classes;
        known.map(|truth| self.confusion.missed(truth)).sum()
    }

    /// Of each label that the model does not know: its name, how many decisions said
    /// "unknown", which is right, and how many there were.
    pub fn strange(&self) -> impl Iterator<Item = (&str, u64, u64)> {
        let strange = self.names.iter().enumerate().skip(self.classes);
        strange.map(|(truth, name)| {
            let missed = self.confusion.missed(truth);
            (name.as_str(), missed, missed + self.named(truth))
        })
    }

    /// Of the decisions on a class of the model the share for another one; 0 without one.
    pub fn mistaken(&self, class: usize, other: usize) -> f64 {
        self.confusion.count(class, other) as f64 / self.named(class).max(1) as f64
    }

    fn named(&self, truth: usize) -> u64 {
        let classes = 0..self.classes;
        classes
            .map(|class| self.confusion.count(truth, class))
            .sum()
    }

    /// Share of right decisions for each surface that was presented, averaged over those;
    /// `None` without a decision. Of a surface that the model does not know those are right
    /// that said "unknown"; of the others these do not count.
    pub fn hit_rate(&self) -> Option<f64> {
        let rates = (0..self.names.len()).filter_map(|truth| {
            let named = self.named(truth);
            let (right, all) = if truth < self.classes {
                (self.confusion.count(truth, truth), named)
            } else {
                let missed = self.confusion.missed(truth);
                (missed, missed + named)
            };
            (all > 0).then(|| right as f64 / all as f64)
        });
        Statistics::of(rates).map(|rates| rates.mean)
    }

    /// Mean decision time in samples; `None` without a decision.
    pub fn mean_samples(&self) -> Option<f64> {
        self.mean(self.samples as f64)
    }

    /// Mean posterior of the decisions; `None` without one.
    pub fn stated(&self) -> Option<f64> {
        self.mean(self.stated)
    }

    fn mean(&self, sum: f64) -> Option<f64> {
        let decisions = self.decisions();
        (decisions > 0).then(|| sum / decisions as f64)
    }
}

/// The confusion matrix.
impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            names, confusion, ..
        } = self;
        let said = self.confusion.trials() > self.confusion.named();
        let missed = said.then_some(UNKNOWN);
        write!(f, "{}", confusion.table(names, self.classes, missed))
    }
}

#[cfg(test)]
mod tests {
    use super::{Columns, Decided, Place, Score, UNKNOWN, Verdict, write};

    fn decided(label: &str, decision: &str, samples: u32) -> Decided {
        Decided {
            t_s: Some(0.25),
            place: Some(Place::new(1, 0)),
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
    fn of_a_label_that_the_model_does_not_know_unknown_is_right() {
        let names = ["ice".to_owned()];
        let score = Score::new(&names, &[decided("mud", "ice", 20)]);
        assert_eq!(score.hit_rate(), Some(0.0));
        assert_eq!(Score::new(&names, &[]).hit_rate(), None);

        let decisions = [
            decided("ice", "ice", 20),
            decided("ice", UNKNOWN, 900),
            decided("mud", "ice", 40),
            decided("mud", UNKNOWN, 60),
            decided("mud", UNKNOWN, 80),
            decided("mud", UNKNOWN, 100),
        ];
        let verdicts = decisions.each_ref().map(|d| d.verdict(&names));
        assert_eq!(verdicts[..2], [Verdict::Right, Verdict::Refused]);
        assert_eq!(verdicts[2..4], [Verdict::Wrong, Verdict::Right]);
        let score = Score::new(&names, &decisions);
        assert_eq!((score.decisions(), score.refused()), (5, 1));
        // All of ice, three quarters of mud.
        assert_eq!(score.hit_rate(), Some(0.875));
        assert_eq!(score.mean_samples(), Some(60.0));
        assert!((score.stated().unwrap() - 0.995).abs() < 1e-12);
        assert_eq!(score.strange().collect::<Vec<_>>(), [("mud", 3, 4)]);
    }

    #[test]
    fn unknown_is_neither_right_nor_wrong() {
        let names = ["ice".to_owned(), "loam".to_owned()];
        let decisions = [
            decided("ice", "ice", 20),
            decided("ice", UNKNOWN, 900),
            decided("loam", "loam", 40),
        ];
        let score = Score::new(&names, &decisions);
        assert_eq!((score.decisions(), score.refused()), (2, 1));
        assert_eq!(score.hit_rate(), Some(1.0));
        assert_eq!(score.mean_samples(), Some(30.0));
        let text = score.to_string();
        assert!(text.contains("    ice |       1       0       1"), "{text}");
    }

    #[test]
    fn names_with_commas_survive_the_file_and_a_scene_tells_the_time() {
        let decisions = [decided("sand, wet", "ice", 20)];
        let written = |columns| {
            let mut table = Vec::new();
            write(&mut table, &decisions, columns).unwrap();
            String::from_utf8(table).unwrap()
        };
        assert_eq!(
            written(Columns::OfRecording),
            "label,trial,decision,samples,posterior,touch\n\
             \"sand, wet\",1,ice,20,0.995000000,3\n"
        );
        assert_eq!(
            written(Columns::OfScene),
            "label,trial,decision,samples,posterior,touch,t_s\n\
             \"sand, wet\",1,ice,20,0.995000000,3,0.250000000\n"
        );
        assert_eq!(
            written(Columns::OfSeveral),
            "label,trial,decision,samples,posterior,touch,t_s,side,whisker\n\
             \"sand, wet\",1,ice,20,0.995000000,3,0.250000000,right,1\n"
        );
    }
}
