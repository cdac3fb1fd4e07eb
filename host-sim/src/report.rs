//! Output on the terminal.

mod evaluation;
mod poses;
mod runs;
mod training;
mod warnings;

use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::OnceLock;

use firmware::lines::{self, Context};
use firmware::{Event, NodeEvent};
use tactile::name::{self, Shown};
use wire::Line;

use crate::Error;
use crate::decisions::{self, Decided, Score, UNKNOWN};
use crate::output::{remove_on_interrupt, unless_closed};
use evaluation::over;
pub(crate) use evaluation::{doubts, figures, thresholds};
pub use poses::of_model;
pub(crate) use poses::second_opinion;
pub(crate) use runs::{over_runs, seed_range};
pub(crate) use training::training;

/// What has kept a line from standard output.
static UNSAID: OnceLock<String> = OnceLock::new();

/// A line on standard output. A closed pipe does not stop the work: what
/// counts is in the files; where a line is lost otherwise, as on a full disk, it has failed in
/// the end ([`ended`]). What is not to be seen, as of a file's name, is shown escaped, so that
/// nothing of others can command the terminal.
pub fn say(line: impl Display) {
    let written = writeln!(io::stdout().lock(), "{}", seen(line));
    if let Err(fault) = unless_closed(written, ()) {
        let _ = UNSAID.set(format!("standard output: {fault}"));
    }
}

/// A line on standard error, likewise.
pub fn warn(line: impl Display) {
    let _ = writeln!(io::stderr().lock(), "{}", seen(line));
}

/// Lines that have no other control character than their ends.
fn seen(lines: impl Display) -> String {
    let lines = lines.to_string();
    let shown = lines.split('\n').map(|line| Shown(line).to_string());
    shown.collect::<Vec<_>>().join("\n")
}

/// A program's arguments; where they are wrong, or help is asked for, that is said, and the
/// program ends.
pub fn arguments<A: clap::Parser>() -> A {
    A::try_parse().unwrap_or_else(|refused| {
        let said = refused.to_string();
        // Colours are only for what has nothing of others in it that is not to be seen.
        if said.replace('\n', "").contains(name::is_hidden) && refused.use_stderr() {
            warn(said.trim_end());
            std::process::exit(refused.exit_code());
        }
        refused.exit()
    })
}

/// A program from start to end: an interrupt leaves no half-written file; returns its exit
/// status, and says on standard error what went wrong.
pub fn program(program: &str, work: impl FnOnce() -> Result<(), Error>) -> ExitCode {
    let ready = remove_on_interrupt();
    let ready = ready.map_err(|error| Error::Work(format!("interrupts: {error}")));
    ended(program, ready.and_then(|()| work()))
}

/// The exit status of a program that has ended so; what went wrong it says on standard error.
pub fn ended(program: &str, done: Result<(), Error>) -> ExitCode {
    let done = done.and_then(|()| match UNSAID.get() {
        Some(why) => Err(Error::Work(why.clone())),
        None => Ok(()),
    });
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            warn(format_args!("{program}: {error}"));
            ExitCode::from(error.exit_status())
        }
    }
}

/// What a module says of an event, of a model of these classes, and its level in the log. How it
/// fares a board says alone.
pub fn said(event: &Event, classes: &[String]) -> Option<(&'static str, String)> {
    said_by(event, classes, None)
}

/// The line of a log for an event at `t_s`; a board's ticks take `period_us`.
pub fn logged(
    t_s: f64,
    event: &Event,
    classes: &[String],
    period_us: Option<u32>,
) -> Option<String> {
    let (level, said) = said_by(event, classes, period_us)?;
    // As defmt pads it.
    let level = level.to_uppercase();
    Some(format!("{t_s:.3} {level:<5} {said}"))
}

fn said_by(
    event: &Event,
    classes: &[String],
    period_us: Option<u32>,
) -> Option<(&'static str, String)> {
    let context = Context {
        class_name: |class| classes.get(class).map_or("", String::as_str),
        period_us: period_us.unwrap_or_default(),
        lost: 0,
    };
    let mut line = Line::new();
    let level = match event {
        Event::Health(_) if period_us.is_none() => None,
        _ => lines::event(&mut line, event, context),
    };
    let text = String::from_utf8_lossy(line.ended());
    Some((level?, text.trim().to_owned()))
}

/// Reports faults and recoveries on standard error; for decisions see [`decision`].
pub(crate) fn limits_and_faults(t_s: f64, event: &Event) {
    let whose = match event {
        Event::Node(_, NodeEvent::Left | NodeEvent::Lost(_) | NodeEvent::Twin) => String::new(),
        Event::SensorLost(place, _)
        | Event::Frame(place, _)
        | Event::ZeroMoved(place, _)
        | Event::SensorBack(place)
        | Event::MotorFault(place, _)
        | Event::MotorGivenUp(place)
        | Event::MotorRetry(place) => format!("{place}: "),
        _ => return,
    };
    if let Some((_, said)) = said(event, &[]) {
        warn(format_args!("{t_s:.4} s: {whose}{said}"));
    }
}

/// Reports a decision of a model of these classes on standard output.
pub fn decision(decided: &Decided, classes: &[String]) {
    let (t_s, verdict) = (decided.t_s.unwrap_or_default(), decided.verdict(classes));
    // Of what is none of the classes the posterior says only which came nearest.
    let sure = match decided.reason {
        Some(_) => String::new(),
        None => format!("{:.2} %", 100.0 * decided.posterior),
    };
    let (said, label, samples) = (decided.words(), &decided.label, decided.samples);
    let stands = decided
        .pose
        .map(|pose| format!("  {}", decisions::stands(pose)));
    let stands = stands.unwrap_or_default();
    say(format_args!(
        "{t_s:8.3} s  {said:<8} {sure:>8}  {samples:5} samples  {verdict} ({label}){stands}"
    ));
}

/// A score for people: confusion matrix, hit rate, decision time in samples and, at so many ticks a
/// second, in milliseconds.
pub(crate) fn summary(score: &Score, tick_hz: Option<u32>) -> String {
    let refused = score.refused();
    let (Some(hits), Some(samples), Some(stated)) =
        (score.hit_rate(), score.mean_samples(), score.stated())
    else {
        return match refused {
            0 => "no decision".to_owned(),
            refused => format!("{score}no decision but {refused} \"{UNKNOWN}\""),
        };
    };
    let [hits, stated] = [hits, stated].map(|share| 100.0 * share);
    // They count as classes do.
    let strange = match score.strange().filter(|(.., all)| *all > 0).count() {
        0 => "",
        _ => " and what is none",
    };
    let mut said = vec![format!(
        "{score}{} decisions, hit rate {hits:.1} % (mean over {}{strange}), mean ",
        score.decisions(),
        over(&score.left_out())
    )];
    said.push(match tick_hz {
        Some(tick_hz) => format!(
            "decision time {samples:.0} samples ({:.0} ms of contact)\n\
             the classifier itself stated {stated:.1} % in the mean",
            samples * 1000.0 / f64::from(tick_hz)
        ),
        None => format!("{samples:.0} samples"),
    });
    for (name, right, all) in score.strange() {
        said.push(format!(
            "\n{name} is none of the model's classes: \"{UNKNOWN}\" is right, and was decided \
             {right} times of {all}"
        ));
    }
    if refused > 0 {
        said.push(format!(
            "\n{refused} more said \"{UNKNOWN}\" of what the model knows: refused, neither right \
             nor wrong"
        ));
    }
    let reasons = score.reasons.apart();
    let each: Vec<String> = reasons
        .map(|(reason, count)| format!("{count} {reason}"))
        .collect();
    if !each.is_empty() {
        said.push(format!("\nfor no class: {}", each.join(", ")));
    }
    said.concat()
}

#[cfg(test)]
mod tests {
    use tactile::Decision;

    use super::{figures, over_runs, summary};
    use crate::decisions::{Decided, Score};
    use crate::evaluation::{Evaluation, Shown};

    #[test]
    fn what_is_not_named_is_counted_by_its_reason() {
        let classes = ["ice", "loam"].map(str::to_owned);
        let told = |bits: &[u32]| {
            let decided = bits.iter().map(|bits| {
                let decision = Decision::from_memory(34, 1 << 27, bits << 16).unwrap();
                Decided::new(decision, &classes, "loam", "1")
            });
            let (label, decided) = ("loam".to_owned(), decided.collect());
            let shown = [Shown { label, decided }];
            let evaluation = Evaluation::new(&classes, &shown);
            let score = Score::new(&classes, &shown[0].decided);
            [
                figures(&evaluation, 2000.0),
                over_runs(&[], &evaluation, 2000.0),
                summary(&score, None),
            ]
        };
        // Five for a class, two unknown, one outside the poses, two between two classes.
        let [figures, runs, summary] = told(&[0, 0, 0, 0, 0, 1, 1, 3, 5, 5]);
        for report in [figures, runs] {
            for line in [
                "\nrefused            50.0 % (",
                "\n- unknown          20.0 % (",
                "\n- pose             10.0 % (",
                "\n- between          20.0 % (",
            ] {
                assert!(report.contains(line), "{line}:\n{report}");
            }
        }
        let reasons = "\nfor no class: 2 unknown, 1 pose, 2 between";
        assert!(summary.ends_with(reasons), "{summary}");
        let without = told(&[0, 1, 1]);
        let tells = |report: &String| report.contains("\n- ") || report.contains("for no class");
        assert!(!without.iter().any(tells));
    }
}
