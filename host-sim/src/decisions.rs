//! `decisions.csv`, and the score of decisions against labels.

mod reasons;

use std::fmt;
use std::io::{self, Write};

use firmware::{Place, lines};
use scene::Scene;
use tactile::score::{Confusion, Statistics};
use tactile::{Decision, Pose, Reason};

use crate::bench;
use crate::cells::{Cells, Line};
use crate::columns::{Column, columns};
pub use reasons::Reasons;

/// What a decision says where what was felt is none of the model's classes.
pub const UNKNOWN: &str = "unknown";

/// The name of a decision.
pub fn name(decision: Decision, classes: &[String]) -> &str {
    decision.class().map_or(UNKNOWN, |class| of(class, classes))
}

fn of(class: usize, classes: &[String]) -> &str {
    classes.get(class).map_or(UNKNOWN, String::as_str)
}

/// The names of the two classes between which a decision is, the leader first.
pub fn among(decision: Decision, classes: &[String]) -> Option<[String; 2]> {
    let among = decision.among()?;
    Some(among.map(|class| of(class, classes).to_owned()))
}

/// What a decision says to people: a class, or why it names none.
pub fn words(decision: Decision, classes: &[String]) -> String {
    let among = among(decision, classes);
    in_words(name(decision, classes), decision.reason(), among.as_ref())
}

/// The same with the certainty of a class that it names. Of a decision that names none the posterior
/// is the nearest class's, which would read as the certainty that it is unknown.
pub fn stated(decision: Decision, classes: &[String]) -> String {
    let words = words(decision, classes);
    match decision.class() {
        Some(_) => format!("{words} {:.2} %", 100.0 * decision.posterior().to_f64()),
        None => words,
    }
}

/// How what was named stands, to people.
pub fn stands(Pose { tilt, depth }: Pose) -> String {
    let [tilt, depth] = [tilt, depth].map(|of| format!("{:.1} ± {:.1}", of.value(), of.error()));
    format!("tilt {tilt}, depth {depth}")
}

fn in_words(name: &str, reason: Option<Reason>, among: Option<&[String; 2]>) -> String {
    let among = among.map_or([""; 2], |among| among.each_ref().map(String::as_str));
    match lines::why(reason, among).concat().trim_start() {
        "" => name.to_owned(),
        why => why.to_owned(),
    }
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
    /// Why it names no class, if it names none.
    pub reason: Option<Reason>,
    /// The two classes between which it is, the leader first, if that is why.
    pub among: Option<[String; 2]>,
    /// How many samples it used.
    pub samples: u32,
    /// Posterior probability of the class decided for.
    pub posterior: f64,
    /// The number of the touch in which it fell, or of the last one; 0 before the first.
    pub touch: u16,
    /// How what it names stands, where that is estimated.
    pub pose: Option<Pose>,
}

impl Decided {
    /// A decision of a model of these classes on what has this label, in a recording.
    pub fn new(decision: Decision, classes: &[String], label: &str, trial: &str) -> Self {
        Self {
            t_s: None,
            place: None,
            label: label.to_owned(),
            trial: trial.to_owned(),
            decision: name(decision, classes).to_owned(),
            reason: decision.reason(),
            among: among(decision, classes),
            samples: decision.samples(),
            posterior: decision.posterior().to_f64(),
            touch: decision.touch(),
            pose: None,
        }
    }

    /// What it says to people, as [`words`].
    pub fn words(&self) -> String {
        in_words(&self.decision, self.reason, self.among.as_ref())
    }

    /// The cell of its reason, and that of the classes between which it is.
    pub fn why(&self) -> [String; 2] {
        let reason = self.reason.map_or("", Reason::name);
        let among = self.among.as_ref().map(|among| among.join("|"));
        [reason.to_owned(), among.unwrap_or_default()]
    }

    /// Gives the cells of these columns, as many decimals as its file has.
    pub fn cells(&self, columns: Columns, to: &mut impl Cells) {
        to.text(&self.label);
        to.text(&self.trial);
        to.text(&self.decision);
        to.number(self.samples.into(), 0);
        to.number(self.posterior, 9);
        to.number(self.touch.into(), 0);
        if columns.first >= OF_SCENE {
            to.number(self.t_s.unwrap_or(f64::NAN), 9);
        }
        if columns.first >= OF_SEVERAL {
            to.text(self.place.map_or("", |at| at.side_name()));
            let number = |at: Place| f64::from(at.whisker) + 1.0;
            to.number(self.place.map_or(f64::NAN, number), 0);
        }
        for why in self.why() {
            to.text(&why);
        }
        if columns.has_pose {
            let stands = self.pose.map(|Pose { tilt, depth }| {
                [tilt.value(), tilt.error(), depth.value(), depth.error()]
            });
            to.numbers(&stands.unwrap_or([f64::NAN; 4]), 2);
        }
    }

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
pub struct Columns {
    /// How many before those that all have.
    first: usize,
    has_pose: bool,
}

impl Columns {
    /// Of a recording, and a model that estimates poses or not.
    pub const fn of_recording(has_pose: bool) -> Self {
        let first = OF_RECORDING;
        Self { first, has_pose }
    }

    /// Of a scene: also the time of the tick, as in the trace, and of several whiskers that are
    /// heard the whisker, by its side and its number from 1.
    pub fn of_scene(scene: &Scene) -> Self {
        let first = match bench::heard(scene) {
            1 => OF_SCENE,
            _ => OF_SEVERAL,
        };
        let has_pose = scene.classifier.as_ref().is_some_and(|of| of.pose);
        Self { first, has_pose }
    }

    /// Which of [`COLUMNS`].
    pub fn indices(self) -> impl Iterator<Item = usize> {
        let end = if self.has_pose {
            COLUMNS.len()
        } else {
            OF_POSE
        };
        (0..self.first).chain(OF_SEVERAL..end)
    }
}

/// The columns in order: those of a recording, of a scene, of several whiskers, and why no class
/// is named.
pub const COLUMNS: [Column; 15] = columns! {
    "label", "", "the truth: what was touched";
    "trial", "", "which stream of that label";
    "decision", "", "class decided for, or `unknown`";
    "samples", "samples", "how many samples of contact the decision used";
    "posterior", "",
        "posterior probability of the class decided for; of `unknown` that of the one that came \
        nearest";
    "touch", "", "number of the touch in which it fell, or of the last one; 0 before the first";
    "t_s", "s", "when it fell, as in the trace; not of a recording, which has no clock";
    "side", "", "`left` or `right`; only where several whiskers decide";
    "whisker", "", "number of the whisker on its side, from 1; likewise";
    "reason", "",
        "why no class is named: `unknown` (what was felt is unlike all classes), `pose` (it was \
        touched in a way that lies outside the poses of training), `between` (it is one of two \
        classes); empty where one is named";
    "among", "",
        "the two classes of `between`, the likelier one first, with `|` between them; otherwise \
        empty";
    "tilt_deg", "degrees, or any",
        "estimated tilt of the class that is named, as in recordings; this and the next three only \
        where a model has estimated poses, with `classifier.pose`; empty where no class is named";
    "tilt_error_deg", "degrees, or any",
        "root mean square of its error, in poses that training held out";
    "depth_deg", "degrees, or any", "estimated depth of contact, as in recordings";
    "depth_error_deg", "degrees, or any", "the same of it";
};

/// How many of them a recording has, a scene with one whisker that is heard, and with several,
/// before those that all have.
const OF_RECORDING: usize = 6;
const OF_SCENE: usize = 7;
const OF_SEVERAL: usize = 9;
/// How many there are before those of a pose.
const OF_POSE: usize = 11;

/// Writes `decisions.csv`.
///
/// # Errors
/// Any error of the writer.
pub fn write(mut table: impl Write, decisions: &[Decided], columns: Columns) -> io::Result<()> {
    let mut line = Line::default();
    for index in columns.indices() {
        line.text(COLUMNS[index].name);
    }
    line.write(&mut table)?;
    for decided in decisions {
        decided.cells(columns, &mut line);
        line.write(&mut table)?;
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
    /// Why those decisions name no class that name none, whatever they were on.
    pub reasons: Reasons,
    /// Of the decisions that count the sum of their samples, and of those that name a class the sum
    /// of their posteriors.
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
        let place = |among: &[String], name: &String| among.iter().position(|other| other == name);
        let mut confusion = Confusion::new(names.len());
        let reasons = Reasons::of(decisions.iter().copied());
        let (mut samples, mut stated) = (0, 0.0);
        for d in decisions {
            if let Some(truth) = place(&names, &d.label) {
                // Both are among the names. What is unknown is no class, though a label may be
                // called so.
                let _ = confusion.add(truth, place(classes, &d.decision));
            }
            if d.verdict(classes) != Verdict::Refused {
                samples += u64::from(d.samples);
            }
            if d.decision != UNKNOWN {
                stated += d.posterior;
            }
        }
        Self {
            names,
            classes: classes.len(),
            confusion,
            reasons,
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

    /// Decisions on a class that name one.
    pub fn named(&self, truth: usize) -> u64 {
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

    /// The classes that [`Score::hit_rate`] leaves out: no decision names one there.
    pub fn left_out(&self) -> Vec<&str> {
        let names = self.names.iter().take(self.classes).enumerate();
        let names = names.filter(|(truth, _)| self.named(*truth) == 0);
        names.map(|(_, name)| name.as_str()).collect()
    }

    /// Mean decision time in samples; `None` without a decision.
    pub fn mean_samples(&self) -> Option<f64> {
        let decisions = self.decisions();
        (decisions > 0).then(|| self.samples as f64 / decisions as f64)
    }

    /// Mean posterior of the decisions that name a class; `None` without one.
    pub fn stated(&self) -> Option<f64> {
        let named = self.confusion.named();
        (named > 0).then(|| self.stated / named as f64)
    }
}

/// The confusion matrix.
impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let said = self.confusion.trials() > self.confusion.named();
        let missed = said.then_some(UNKNOWN);
        let table = self.confusion.table(&self.names, self.classes, missed);
        write!(f, "{table}")
    }
}

#[cfg(test)]
mod tests {
    use tactile::Estimate;

    use super::{
        Columns, Decided, Decision, OF_SEVERAL, Place, Pose, Reason, Score, UNKNOWN, Verdict,
        words, write,
    };

    fn decided(label: &str, decision: &str, samples: u32) -> Decided {
        Decided {
            t_s: Some(0.25),
            place: Some(Place::new(1, 0)),
            label: label.into(),
            trial: "1".into(),
            decision: decision.into(),
            reason: (decision == UNKNOWN).then_some(Reason::Unknown),
            among: None,
            samples,
            posterior: 0.995,
            touch: 3,
            pose: Some(Pose {
                tilt: Estimate {
                    hundredths: -150,
                    error_hundredths: 20,
                },
                depth: Estimate {
                    hundredths: 2204,
                    error_hundredths: 7,
                },
            }),
        }
    }

    /// Of a label that the model does not know "unknown" is right.
    #[test]
    fn the_hit_rate_is_the_mean_over_classes() {
        let names = ["ice".to_owned()];
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
        let text = score.to_string();
        assert!(text.contains("    ice |       1       1"), "{text}");
    }

    /// What is not to be known may be labelled as what is decided of it.
    #[test]
    fn a_label_called_unknown_is_scored_as_any_other() {
        let of = |label: &str| {
            let decisions = [UNKNOWN, UNKNOWN, "ice"].map(|said| decided(label, said, 20));
            let score = Score::new(&["ice".to_owned()], &decisions);
            let strange = score.strange().map(|(_, right, all)| (right, all));
            let strange: Vec<_> = strange.collect();
            (strange, score.hit_rate(), score.refused())
        };
        assert_eq!(of(UNKNOWN), (vec![(2, 3)], Some(2.0 / 3.0), 0));
        assert_eq!(of(UNKNOWN), of("mud"));
    }

    fn written(decisions: &[Decided], columns: Columns) -> String {
        let mut table = Vec::new();
        write(&mut table, decisions, columns).unwrap();
        String::from_utf8(table).unwrap()
    }

    #[test]
    fn names_with_commas_survive_the_file_and_a_scene_tells_the_time() {
        let decisions = [decided("sand, wet", "ice", 20)];
        assert_eq!(
            written(&decisions, Columns::of_recording(true)),
            "label,trial,decision,samples,posterior,touch,reason,among,tilt_deg,tilt_error_deg,\
             depth_deg,depth_error_deg\n\
             \"sand, wet\",1,ice,20,0.995000000,3,,,-1.50,0.20,22.04,0.07\n"
        );
        let (first, has_pose) = (OF_SEVERAL, false);
        let of_several = Columns { first, has_pose };
        assert_eq!(
            written(&decisions, of_several),
            "label,trial,decision,samples,posterior,touch,t_s,side,whisker,reason,among\n\
             \"sand, wet\",1,ice,20,0.995000000,3,0.250000000,right,1,,\n"
        );
    }

    #[test]
    fn a_decision_that_names_no_class_says_why() {
        let classes = ["ice", "loam", "sand, wet"].map(str::to_owned);
        let (mut rows, mut said) = (Vec::new(), Vec::new());
        // Of the leader loam: named, and for each reason not.
        for bits in [0, 1, 1 | 1 << 1, 1 | 2 << 1 | 2 << 3] {
            let decision = Decision::from_memory(20, 1 << 27, bits << 16).unwrap();
            let decided = Decided::new(decision, &classes, "loam", "1");
            assert_eq!(decided.words(), words(decision, &classes));
            said.push(decided.words());
            rows.push(decided);
        }
        let outside = "outside the poses of training";
        assert_eq!(
            said,
            ["loam", "unknown", outside, "between loam and sand, wet"]
        );
        let table = written(&rows, Columns::of_recording(false));
        let mut cells = table.lines().skip(1).map(|row| {
            let [decision, why] = [2, 6].map(|n| row.splitn(n + 1, ',').last().unwrap());
            let decision = decision.split(',').next().unwrap();
            format!("{decision}: {why}")
        });
        assert!(cells.by_ref().eq([
            "loam: ,",
            "unknown: unknown,",
            "unknown: pose,",
            "unknown: between,\"loam|sand, wet\"",
        ]));
        let verdicts = rows.iter().map(|row| row.verdict(&classes));
        let refused = [Verdict::Refused; 3];
        assert!(verdicts.eq([Verdict::Right].into_iter().chain(refused)));
    }
}
