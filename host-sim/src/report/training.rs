//! What training says of a joint model, for people.

use std::fmt;

use tactile::train::joint::{JointModel, Warning};

use super::evaluation::Percent;

/// What held-out trials say of a model.
#[derive(Debug)]
pub struct TrainingReport<'a>(pub &'a JointModel);

impl fmt::Display for TrainingReport<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let report = &self.0.report;
        let names: Vec<_> = report.classes.iter().map(|class| &class.name).collect();
        let longest = names.iter().map(|name| name.chars().count()).max();
        let width = longest.unwrap_or(0).max("decided".len());
        writeln!(
            f,
            "On trials that were held out, threshold {} (in brackets 95 % intervals):\n",
            report.threshold
        )?;
        write!(f, "{:>width$} |", "true")?;
        for name in names {
            write!(f, " {name:>width$}")?;
        }
        writeln!(f, " {:>width$}   <- decided", "unknown")?;
        for class in &report.classes {
            write!(f, "{:>width$} |", class.name)?;
            for named in class.named.iter().chain([&class.unknown]) {
                write!(f, " {named:>width$}")?;
            }
            writeln!(f)?;
        }
        writeln!(f)?;
        for class in &report.classes {
            writeln!(
                f,
                "{:>width$}: right {}; mean {:.0} samples; right but refused {}; \
                 nothing decided in {} of {} trials",
                class.name,
                Percent(class.hits),
                class.samples,
                Percent(class.refused),
                class.undecided,
                class.trials
            )?;
        }
        writeln!(
            f,
            "\nthreshold  stated  found              samples  unknown"
        )?;
        for at in report.calibration.iter().filter(|at| at.found.count > 0) {
            let [stated, found, low, high, unknown] = [
                at.stated,
                at.found.share,
                at.found.low,
                at.found.high,
                at.unknown.share,
            ]
            .map(|share| 100.0 * share);
            writeln!(
                f,
                "{:9}  {stated:6.2}  {found:6.2} ({low:.1} to {high:.1})  {:5.0}  {unknown:5.1} %",
                at.threshold, at.samples
            )?;
        }
        for warning in &report.warnings {
            write!(f, "\nwarning: {}", Told(warning))?;
        }
        Ok(())
    }
}

/// A warning in words.
struct Told<'a>(&'a Warning);

impl fmt::Display for Told<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Warning::FewTrials { name, trials } => {
                write!(f, "{name}: {trials} trials are too few to judge by")
            }
            Warning::Empty { name, trials } => write!(
                f,
                "{name}: {trials} trials have not one block of samples with contact"
            ),
            Warning::Halved { name } => write!(
                f,
                "{name}: its only trial was cut in halves, which are more alike than trials"
            ),
            Warning::OneRecording => write!(
                f,
                "all is of one recording: what this says of another one is unknown"
            ),
            Warning::NotAcrossRecordings => write!(
                f,
                "not every class is in several recordings: trials were held out, not \
                 recordings, so what this says of another recording is unknown"
            ),
            Warning::Alike { names, mistaken } => write!(
                f,
                "{} and {} cannot be told apart: the other one wins {:.0} % of stretches",
                names[0],
                names[1],
                100.0 * mistaken
            ),
            Warning::Weight { table, weight } if *weight <= 0.0 => {
                write!(f, "table {} tells nothing: its weight is zero", table + 1)
            }
            Warning::Weight { table, weight } => write!(
                f,
                "table {} has the largest weight there is, {weight:.2}",
                table + 1
            ),
            other => write!(f, "{other:?}"),
        }
    }
}
