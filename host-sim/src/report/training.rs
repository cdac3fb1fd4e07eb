//! What training says of a joint model, for people.

use std::fmt;

use tactile::train::joint::{CHANCE, JointModel, Warning};

use super::evaluation::percent;
use super::poses::{held_out, of_training};
use super::warnings::in_words;

/// What held-out trials say of a model.
#[derive(Debug)]
pub struct TrainingReport<'a>(pub &'a JointModel);

impl fmt::Display for TrainingReport<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let report = &self.0.report;
        let names: Vec<_> = report.classes.iter().map(|class| &class.name).collect();
        let longest = names.iter().map(|name| name.chars().count()).max();
        let width = longest.unwrap_or(0).max("decided".len());
        let names_between = self.0.opinion.as_ref().is_some_and(|of| of.names);
        writeln!(f, "{}\n", of_training(self.0))?;
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
            write!(f, "{:>width$}: ", class.name)?;
            if class.hits.count > 0 {
                write!(
                    f,
                    "right {}; mean {:.0} samples; right but refused {}; ",
                    percent(class.hits),
                    class.samples,
                    percent(class.refused)
                )?;
            }
            let parts = match class.trials {
                trials if trials < class.parts => "halves",
                _ => "trials",
            };
            write!(
                f,
                "nothing decided in {} of {} {parts}",
                class.undecided, class.parts
            )?;
            // Tables and floors say so, which a model that names between poses does not have.
            if !names_between {
                write!(
                    f,
                    "; were it not trained, unknown {}",
                    percent(class.noticed)
                )?;
            }
            writeln!(f)?;
        }
        let decided = report.calibration.iter().filter(|at| at.found.count > 0);
        if decided.clone().next().is_some() {
            writeln!(
                f,
                "\nthreshold  stated  found              samples  unknown"
            )?;
        }
        for at in decided {
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
        if !report.poses.is_empty() {
            let classes = report.classes.iter().map(|class| class.name.as_str());
            let classes: Vec<&str> = classes.collect();
            write!(f, "\n{}", held_out(&report.poses, &classes))?;
        }
        write!(f, "{}", standing(self.0))?;
        let opinion = self.0.opinion.as_ref();
        for warning in &report.warnings {
            write!(f, "\nwarning: {}", in_words(warning))?;
            let Warning::Alike { mistaken, .. } = warning else {
                continue;
            };
            if opinion.map_or(*mistaken > CHANCE, |opinion| !opinion.names) {
                write!(f, "; the model names neither")?;
            }
        }
        Ok(())
    }
}

/// By how much estimates of tilt and depth were wrong; nothing where none were learnt.
fn standing(model: &JointModel) -> String {
    let opinion = model.opinion.as_ref();
    let classes = opinion.map_or(&[][..], |opinion| &opinion.pose_errors);
    if classes.is_empty() {
        return String::new();
    }
    let errors = model.names.iter().zip(classes);
    let errors = errors.filter_map(|(name, stages)| Some((name, stages.last()?, stages.len())));
    let each = errors
        .enumerate()
        .map(|(n, (name, [tilt, depth], blocks))| {
            let samples = blocks * model.options.block as usize;
            let first = format!(
                "\nErrors of tilt and depth after {samples} samples, in poses that were held out:"
            );
            let first = if n == 0 { &first } else { "" };
            format!("{first} {name} {tilt:.2}, {depth:.2};")
        });
    each.collect::<Vec<_>>().concat() + " for this sensor and these surfaces\n"
}
