//! What decisions are worth, for people.

use std::fmt;

use tactile::score::{Calibration, Interval};
use tactile::train::joint::Warning;

use super::warnings::in_words;
use crate::evaluation::{Candidate, ClassFigures, Evaluation};

pub(super) fn percent(of: Interval) -> String {
    if of.count == 0 {
        return "of none".to_owned();
    }
    let [share, low, high] = [of.share, of.low, of.high].map(|x| 100.0 * x);
    format!("{share:.1} % ({low:.1} to {high:.1}) of {}", of.count)
}

/// What a mean is over: all classes but these.
pub(super) fn over(left_out: &[&str]) -> String {
    if left_out.is_empty() {
        return "classes".to_owned();
    }
    let names = left_out.join(", ");
    format!("classes without {names}: no decision names a class there")
}

/// The share of decisions that named no class, with its name, and below it that of each reason.
pub(super) fn refused(of: &Evaluation) -> String {
    let reasons = of.reasons.apart().map(|(reason, count)| {
        let share = Interval::of(count, of.refused.count);
        format!("- {reason:<16} {}\n", percent(share))
    });
    let reasons = reasons.collect::<Vec<_>>().concat();
    format!("refused            {}\n{reasons}", percent(of.refused))
}

/// The figures of an evaluation; times by samples a second.
#[derive(Debug)]
pub struct Figures<'a>(pub &'a Evaluation, pub f64);

impl fmt::Display for Figures<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(evaluation, tick_hz) = self;
        let Evaluation {
            score,
            hits,
            parts,
            classes,
            samples,
            samples_error,
            calibration,
            strange,
            undecided,
            ..
        } = evaluation;
        writeln!(f, "{score}")?;
        let width = classes.iter().map(|class| class.name.chars().count()).max();
        for class in classes {
            write!(f, "{:>1$}: ", class.name, width.unwrap_or(0))?;
            writeln!(f, "{}", of_class(class, *tick_hz))?;
        }
        writeln!(f)?;
        match hits {
            Some(hits) => {
                let hits = 100.0 * hits;
                let ms = samples * 1000.0 / tick_hz;
                let over = over(&evaluation.left_out());
                writeln!(f, "hit rate           {hits:.1} % (mean over {over})")?;
                if let Some([before, after]) = parts {
                    writeln!(f, "- before the @     {}", percent(*before))?;
                    writeln!(f, "- after it         {}", percent(*after))?;
                }
                write!(f, "decision time      {samples:.0} samples ({ms:.0} ms)")?;
                match samples_error * 1000.0 / tick_hz {
                    error if error.is_nan() => writeln!(f)?,
                    error => writeln!(f, ", standard error {error:.1} ms")?,
                }
                write!(f, "{}", stated(calibration))?;
            }
            None => writeln!(f, "no decision for a class")?,
        }
        write!(f, "{}", refused(evaluation))?;
        if strange.count > 0 {
            writeln!(f, "refused, new       {}", percent(*strange))?;
        }
        write!(f, "without a decision {}", percent(*undecided))
    }
}

/// The row of a class.
fn of_class(class: &ClassFigures, tick_hz: f64) -> String {
    let decided = class.samples.map_or_else(String::new, |samples| {
        let ms = 1000.0 / tick_hz;
        let error = samples.error().map(|error| format!(" ± {:.1}", ms * error));
        let error = error.unwrap_or_default();
        let (hits, ms) = (percent(class.hits), ms * samples.mean);
        format!("right {hits}; after {ms:.0}{error} ms; ")
    });
    let [refused, undecided] = [class.refused, class.undecided].map(percent);
    format!("{decided}refused {refused}; without a decision {undecided}")
}

/// What a user has to know before trusting the figures of a recording.
#[derive(Debug)]
pub struct Doubts<'a> {
    /// The classes of the model.
    pub classes: &'a [String],
    /// The figures.
    pub evaluation: &'a Evaluation,
    /// Where the recording does not fit the model, a line each.
    pub misfits: Vec<String>,
}

/// Presentations of a class below which a warning is due.
const FEW: usize = 3;
/// Decisions on a class that name one, below which nothing is said of what it is taken for.
const FEW_NAMED: u64 = 2;
/// Share of its decisions by which a class may be taken for another before the two cannot be
/// distinguished.
const MISTAKEN: f64 = 0.25;

impl fmt::Display for Doubts<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            classes,
            evaluation:
                Evaluation {
                    score,
                    classes: known,
                    ..
                },
            misfits,
        } = self;
        if known.is_empty() {
            write!(
                f,
                "\nwarning: none of the labels is a class of the model, which knows {}",
                classes.join(", ")
            )?;
        }
        for name in classes.iter().filter(|_| !known.is_empty()) {
            let class = known.iter().find(|class| class.name == *name);
            match class.map_or(0, |class| class.presented) {
                0 => write!(f, "\nwarning: {name}: nothing of it is in the recording")?,
                trials if trials < FEW => {
                    let name = name.clone();
                    let few = Warning::FewTrials { name, trials };
                    write!(f, "\nwarning: {}", in_words(&few))?;
                }
                _ => {}
            }
        }
        for (a, b) in pairs(classes.len()) {
            let mistaken = f64::midpoint(score.mistaken(a, b), score.mistaken(b, a));
            let are_judged = [a, b].iter().all(|class| score.named(*class) >= FEW_NAMED);
            if mistaken > MISTAKEN && are_judged {
                let names = [a, b].map(|class| classes[class].clone());
                let alike = Warning::Alike { names, mistaken };
                write!(f, "\nwarning: {}", in_words(&alike))?;
            }
        }
        for misfit in misfits {
            write!(f, "\n{misfit}")?;
        }
        write!(f, "\nwarning: {}", in_words(&Warning::OneRecording))
    }
}

fn pairs(count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..count).flat_map(|b| (0..b).map(move |a| (a, b)))
}

/// Stated against found, by bins of the posterior.
pub(super) fn stated(calibration: &Calibration) -> String {
    let bins = calibration.bins.iter().map(|bin| {
        let range = format!("{} to {}", bin.low, bin.high);
        let (stated, found) = (100.0 * bin.stated, percent(bin.found));
        format!("    {range:<15} stated {stated:6.2} %, found {found}\n")
    });
    let [stated, error] = [calibration.stated, calibration.error()].map(|x| 100.0 * x);
    format!(
        "stated             {stated:.2} %\nfound              {}\n\
         calibration error  {error:.2} % (mean over decisions, by bins)\n{}",
        percent(calibration.found),
        bins.collect::<Vec<_>>().concat()
    )
}

/// What each threshold gives; times by samples a second.
#[derive(Debug)]
pub struct Thresholds<'a>(pub &'a [Candidate], pub f64);

impl fmt::Display for Thresholds<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(scan, tick_hz) = self;
        write!(
            f,
            "threshold   wrong (95 %)             time  refused  without a decision"
        )?;
        for at in *scan {
            let evaluation = &at.evaluation;
            let found = evaluation.calibration.found;
            let [low, high] = at.wrong_interval();
            let [wrong, low, high, refused, undecided] = [
                at.wrong(),
                low,
                high,
                evaluation.refused.share,
                evaluation.undecided.share,
            ]
            // Of none there is no share.
            .map(|share| if share.is_nan() { 0.0 } else { 100.0 * share });
            if found.count == 0 {
                write!(
                    f,
                    "\n{:<9} no decision for a class {refused:23.1} %  {undecided:5.1} %",
                    at.threshold
                )?;
                continue;
            }
            let interval = format!("({low:.2} to {high:.2})");
            let ms = evaluation.samples * 1000.0 / tick_hz;
            write!(
                f,
                "\n{:<9} {wrong:6.2} % {interval:<15} {ms:6.0} ms  {refused:5.1} %  {undecided:5.1} %",
                at.threshold
            )?;
        }
        Ok(())
    }
}
