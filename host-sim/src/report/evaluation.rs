//! What decisions are worth, for people.

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

pub(crate) fn figures(of: &Evaluation, tick_hz: f64) -> String {
    let mut said = vec![format!("{}\n", of.score)];
    let widths = of.classes.iter().map(|class| class.name.chars().count());
    let width = widths.max().unwrap_or(0);
    for class in &of.classes {
        said.push(format!(
            "{:>width$}: {}\n",
            class.name,
            of_class(class, tick_hz)
        ));
    }
    said.push("\n".to_owned());
    match of.hits {
        Some(hits) => {
            let (hits, ms) = (100.0 * hits, of.samples * 1000.0 / tick_hz);
            let over = over(&of.left_out());
            said.push(format!(
                "hit rate           {hits:.1} % (mean over {over})\n"
            ));
            if let Some([before, after]) = of.parts {
                said.push(format!("- before the @     {}\n", percent(before)));
                said.push(format!("- after it         {}\n", percent(after)));
            }
            said.push(format!(
                "decision time      {:.0} samples ({ms:.0} ms)",
                of.samples
            ));
            match of.samples_error * 1000.0 / tick_hz {
                error if error.is_nan() => said.push("\n".to_owned()),
                error => said.push(format!(", standard error {error:.1} ms\n")),
            }
            said.push(stated(&of.calibration));
        }
        None => said.push("no decision for a class\n".to_owned()),
    }
    said.push(refused(of));
    if of.strange.count > 0 {
        said.push(format!("refused, new       {}\n", percent(of.strange)));
    }
    said.push(format!("without a decision {}", percent(of.undecided)));
    said.concat()
}

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

/// Presentations of a class below which a warning is due.
const FEW: usize = 3;
/// Decisions on a class that name one, below which nothing is said of what it is taken for.
const FEW_NAMED: u64 = 2;
/// Share of its decisions by which a class may be taken for another before the two cannot be
/// distinguished.
const MISTAKEN: f64 = 0.25;

/// What a user has to know before trusting the figures of a recording and a model of these classes;
/// `misfits` say where the one does not fit the other.
pub(crate) fn doubts(classes: &[String], of: &Evaluation, misfits: &[String]) -> String {
    let mut said = Vec::new();
    let mut warn = |warning: String| said.push(format!("\nwarning: {warning}"));
    let (score, known) = (&of.score, &of.classes);
    if known.is_empty() {
        let names = classes.join(", ");
        warn(format!(
            "none of the labels is a class of the model, which knows {names}"
        ));
    }
    for name in classes.iter().filter(|_| !known.is_empty()) {
        let class = known.iter().find(|class| class.name == *name);
        match class.map_or(0, |class| class.presented) {
            0 => warn(format!("{name}: nothing of it is in the recording")),
            trials if trials < FEW => {
                let name = name.clone();
                warn(in_words(&Warning::FewTrials { name, trials }));
            }
            _ => {}
        }
    }
    for (a, b) in pairs(classes.len()) {
        let mistaken = f64::midpoint(score.mistaken(a, b), score.mistaken(b, a));
        let are_judged = [a, b].iter().all(|class| score.named(*class) >= FEW_NAMED);
        if mistaken > MISTAKEN && are_judged {
            let names = [a, b].map(|class| classes[class].clone());
            warn(in_words(&Warning::Alike { names, mistaken }));
        }
    }
    said.extend(misfits.iter().map(|misfit| format!("\n{misfit}")));
    said.push(format!("\nwarning: {}", in_words(&Warning::OneRecording)));
    said.concat()
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
pub(crate) fn thresholds(scan: &[Candidate], tick_hz: f64) -> String {
    let header = "threshold   wrong (95 %)             time  refused  without a decision";
    let mut said = vec![header.to_owned()];
    for at in scan {
        let of = &at.evaluation;
        let [low, high] = at.wrong_interval();
        let shares = [at.wrong(), low, high, of.refused.share, of.undecided.share];
        // Of none there is no share.
        let [wrong, low, high, refused, undecided] =
            shares.map(|share| if share.is_nan() { 0.0 } else { 100.0 * share });
        let shown = if of.calibration.found.count == 0 {
            format!("no decision for a class {refused:23.1} %  {undecided:5.1} %")
        } else {
            let interval = format!("({low:.2} to {high:.2})");
            let ms = of.samples * 1000.0 / tick_hz;
            format!("{wrong:6.2} % {interval:<15} {ms:6.0} ms  {refused:5.1} %  {undecided:5.1} %")
        };
        said.push(format!("\n{:<9} {shown}", at.threshold));
    }
    said.concat()
}
