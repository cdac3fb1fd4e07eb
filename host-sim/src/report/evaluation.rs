//! What decisions are worth, for people.

use std::fmt;

use tactile::score::{Calibration, Interval};
use tactile::train::joint::Warning;

use super::warnings::InWords;
use crate::evaluation::{Candidate, ClassFigures, Evaluation};

pub(crate) struct Percent(pub(crate) Interval);

impl fmt::Display for Percent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Interval {
            share,
            low,
            high,
            count,
        } = self.0;
        if count == 0 {
            return write!(f, "of none");
        }
        let [share, low, high] = [share, low, high].map(|x| 100.0 * x);
        write!(f, "{share:.1} % ({low:.1} to {high:.1}) of {count}")
    }
}

/// What a mean is over: all classes but these.
pub(crate) struct Over<'a>(pub(crate) &'a [&'a str]);

impl fmt::Display for Over<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "classes")?;
        if !self.0.is_empty() {
            let names = self.0.join(", ");
            write!(f, " without {names}: no decision names a class there")?;
        }
        Ok(())
    }
}

/// The share of decisions that named no class, with its name, and below it that of each reason.
pub(crate) struct Refused<'a>(pub(crate) &'a Evaluation);

impl fmt::Display for Refused<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Evaluation {
            refused, reasons, ..
        } = self.0;
        writeln!(f, "refused            {}", Percent(*refused))?;
        for (reason, count) in reasons.apart() {
            let share = Interval::of(count, refused.count);
            writeln!(f, "- {reason:<16} {}", Percent(share))?;
        }
        Ok(())
    }
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
            writeln!(f, "{}", OfClass(class, *tick_hz))?;
        }
        writeln!(f)?;
        match hits {
            Some(hits) => {
                let hits = 100.0 * hits;
                let ms = samples * 1000.0 / tick_hz;
                let over = Over(&evaluation.left_out()).to_string();
                writeln!(f, "hit rate           {hits:.1} % (mean over {over})")?;
                let error = samples_error * 1000.0 / tick_hz;
                writeln!(
                    f,
                    "decision time      {samples:.0} samples ({ms:.0} ms), standard error \
                     {error:.1} ms"
                )?;
                write!(f, "{}", Stated(calibration))?;
            }
            None => writeln!(f, "no decision for a class")?,
        }
        write!(f, "{}", Refused(evaluation))?;
        if strange.count > 0 {
            writeln!(f, "refused, new       {}", Percent(*strange))?;
        }
        write!(f, "without a decision {}", Percent(*undecided))
    }
}

/// The row of a class, and samples a second.
struct OfClass<'a>(&'a ClassFigures, f64);

impl fmt::Display for OfClass<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(class, tick_hz) = self;
        if let Some(samples) = class.samples {
            let ms = 1000.0 / tick_hz;
            let error = samples.sd / (samples.count as f64).sqrt();
            write!(
                f,
                "right {}; after {:.0} ± {:.1} ms; ",
                Percent(class.hits),
                ms * samples.mean,
                ms * error
            )?;
        }
        write!(
            f,
            "refused {}; without a decision {}",
            Percent(class.refused),
            Percent(class.undecided)
        )
    }
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
                    write!(
                        f,
                        "\nwarning: {}",
                        InWords(&Warning::FewTrials { name, trials })
                    )?;
                }
                _ => {}
            }
        }
        for (a, b) in pairs(classes.len()) {
            let mistaken = f64::midpoint(score.mistaken(a, b), score.mistaken(b, a));
            if mistaken > MISTAKEN {
                let names = [a, b].map(|class| classes[class].clone());
                write!(
                    f,
                    "\nwarning: {}",
                    InWords(&Warning::Alike { names, mistaken })
                )?;
            }
        }
        for misfit in misfits {
            write!(f, "\n{misfit}")?;
        }
        write!(f, "\nwarning: {}", InWords(&Warning::OneRecording))
    }
}

fn pairs(count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..count).flat_map(|b| (0..b).map(move |a| (a, b)))
}

/// Stated against found, by bins of the posterior.
pub(crate) struct Stated<'a>(pub(crate) &'a Calibration);

impl fmt::Display for Stated<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let calibration = self.0;
        let stated = 100.0 * calibration.stated;
        writeln!(f, "stated             {stated:.2} %")?;
        writeln!(f, "found              {}", Percent(calibration.found))?;
        let error = 100.0 * calibration.error();
        writeln!(
            f,
            "calibration error  {error:.2} % (mean over decisions, by bins)"
        )?;
        for bin in &calibration.bins {
            let stated = 100.0 * bin.stated;
            let range = format!("{} to {}", bin.low, bin.high);
            writeln!(
                f,
                "    {range:<15} stated {stated:6.2} %, found {}",
                Percent(bin.found)
            )?;
        }
        Ok(())
    }
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
            let [wrong, low, high, refused, undecided] = [
                at.wrong(),
                1.0 - found.high,
                1.0 - found.low,
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
