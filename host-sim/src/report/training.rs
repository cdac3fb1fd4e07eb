//! What training says of a joint model, for people.

use tactile::train::joint::{CHANCE, JointModel, Warning};

use super::evaluation::percent;
use super::poses::{held_out, of_training};
use super::warnings::in_words;

pub(crate) fn training(model: &JointModel) -> String {
    let report = &model.report;
    let names: Vec<_> = report.classes.iter().map(|class| &class.name).collect();
    let longest = names.iter().map(|name| name.chars().count()).max();
    let width = longest.unwrap_or(0).max("decided".len());
    let names_between = model.opinion.as_ref().is_some_and(|of| of.names);
    let mut said = vec![format!(
        "{}\n\nOn trials that were held out, threshold {} (in brackets 95 % intervals):\n\n",
        of_training(model),
        report.threshold
    )];
    said.push(format!("{:>width$} |", "true"));
    for name in names {
        said.push(format!(" {name:>width$}"));
    }
    said.push(format!(" {:>width$}   <- decided\n", "unknown"));
    for class in &report.classes {
        said.push(format!("{:>width$} |", class.name));
        for named in class.named.iter().chain([&class.unknown]) {
            said.push(format!(" {named:>width$}"));
        }
        said.push("\n".to_owned());
    }
    said.push("\n".to_owned());
    for class in &report.classes {
        said.push(format!("{:>width$}: ", class.name));
        if class.hits.count > 0 {
            said.push(format!(
                "right {}; mean {:.0} samples; right but refused {}; ",
                percent(class.hits),
                class.samples,
                percent(class.refused)
            ));
        }
        let (undecided, of) = (class.undecided, class.parts);
        let parts = if class.trials < of {
            "halves"
        } else {
            "trials"
        };
        said.push(format!("nothing decided in {undecided} of {of} {parts}"));
        // Tables and floors say so, which a model that names between poses does not have.
        if !names_between {
            let noticed = percent(class.noticed);
            said.push(format!("; were it not trained, unknown {noticed}"));
        }
        said.push("\n".to_owned());
    }
    let mut header = "\nthreshold  stated  found              samples  unknown\n";
    for at in report.calibration.iter().filter(|at| at.found.count > 0) {
        let shares = [
            at.stated,
            at.found.share,
            at.found.low,
            at.found.high,
            at.unknown.share,
        ];
        let [stated, found, low, high, unknown] = shares.map(|share| 100.0 * share);
        let (threshold, samples) = (at.threshold, at.samples);
        said.push(std::mem::take(&mut header).to_owned());
        said.push(format!(
            "{threshold:9}  {stated:6.2}  {found:6.2} ({low:.1} to {high:.1})  {samples:5.0}  \
             {unknown:5.1} %\n"
        ));
    }
    if !report.poses.is_empty() {
        let classes = report.classes.iter().map(|class| class.name.as_str());
        let classes: Vec<&str> = classes.collect();
        said.push("\n".to_owned());
        said.push(held_out(&report.poses, &classes));
    }
    said.push(standing(model));
    let opinion = model.opinion.as_ref();
    for warning in &report.warnings {
        said.push(format!("\nwarning: {}", in_words(warning)));
        let Warning::Alike { mistaken, .. } = warning else {
            continue;
        };
        if opinion.map_or(*mistaken > CHANCE, |opinion| !opinion.names) {
            said.push("; the model names neither".to_owned());
        }
    }
    said.concat()
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
