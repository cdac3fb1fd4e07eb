//! Output on the terminal.

mod evaluation;
mod runs;
mod training;
mod warnings;

use std::fmt::{self, Display};
use std::io::{self, Write};
use std::process::ExitCode;

use firmware::Event;
use firmware::lines::{self, Context};
use wire::Line;

use crate::Error;
use crate::decisions::{Decided, Score, UNKNOWN};
use crate::output::remove_on_interrupt;
pub use evaluation::{Doubts, Figures, Thresholds};
pub use runs::{OverRuns, SeedRange};
pub use training::TrainingReport;

/// A line on standard output. A closed pipe does not stop the work: what
/// counts is in the files.
pub fn say(line: impl Display) {
    let _ = writeln!(io::stdout().lock(), "{line}");
}

/// A line on standard error, likewise.
pub fn warn(line: impl Display) {
    let _ = writeln!(io::stderr().lock(), "{line}");
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
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            warn(format_args!("{program}: {error}"));
            ExitCode::from(error.exit_status())
        }
    }
}

/// What a module says of an event, of a model of these classes, and its level in the log. How it
/// fares it says of itself alone.
pub fn said(event: &Event, classes: &[String]) -> Option<(&'static str, String)> {
    let context = Context {
        class_name: |class| classes.get(class).map_or("", String::as_str),
        period_us: 0,
        lost: 0,
    };
    let mut line = Line::new();
    let level = match event {
        Event::Health(_) => None,
        _ => lines::event(&mut line, event, context),
    };
    let text = String::from_utf8_lossy(line.ended());
    Some((level?, text.trim().to_owned()))
}

/// Reports faults and recoveries on standard error; for decisions see [`decision`].
pub fn limits_and_faults(t_s: f64, event: &Event) {
    let (Event::SensorLost(place, _)
    | Event::ZeroMoved(place, _)
    | Event::SensorBack(place)
    | Event::MotorFault(place, _)
    | Event::MotorGivenUp(place)
    | Event::MotorRetry(place)) = event
    else {
        return;
    };
    if let Some((_, said)) = said(event, &[]) {
        let number = place.whisker + 1;
        warn(format_args!("{t_s:.4} s: whisker {number}: {said}"));
    }
}

/// Reports a decision of a model of these classes on standard output.
pub fn decision(decided: &Decided, classes: &[String]) {
    let Decided {
        t_s,
        label,
        decision,
        samples,
        posterior,
        ..
    } = decided;
    let (t_s, verdict) = (t_s.unwrap_or_default(), decided.verdict(classes));
    // Of what is none of the classes the posterior says only which came nearest.
    let sure = match decision.as_str() {
        UNKNOWN => String::new(),
        _ => format!("{:.2} %", 100.0 * posterior),
    };
    say(format_args!(
        "{t_s:8.3} s  {decision:<8} {sure:>8}  {samples:5} samples  {verdict} ({label})"
    ));
}

/// A score for people: confusion matrix, hit rate, decision time in samples and, at so
/// many ticks a second, in milliseconds.
#[derive(Debug)]
pub struct Summary<'a>(pub &'a Score, pub Option<u32>);

impl fmt::Display for Summary<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(score, tick_hz) = self;
        let (Some(hits), Some(samples), Some(stated)) =
            (score.hit_rate(), score.mean_samples(), score.stated())
        else {
            return match score.refused() {
                0 => write!(f, "no decision"),
                refused => write!(f, "{score}no decision but {refused} \"{UNKNOWN}\""),
            };
        };
        let [hits, stated] = [hits, stated].map(|share| 100.0 * share);
        let decisions = score.decisions();
        write!(
            f,
            "{score}{decisions} decisions, hit rate {hits:.1} % (mean over classes), mean "
        )?;
        match tick_hz {
            Some(tick_hz) => {
                let ms = samples * 1000.0 / f64::from(*tick_hz);
                write!(
                    f,
                    "decision time {samples:.0} samples ({ms:.0} ms of contact)\n\
                     the classifier itself stated {stated:.1} % in the mean"
                )?;
            }
            None => write!(f, "{samples:.0} samples")?,
        }
        for (name, right, all) in score.strange() {
            write!(
                f,
                "\n{name} is none of the model's classes: \"{UNKNOWN}\" is right, and was \
                 decided {right} times of {all}"
            )?;
        }
        match score.refused() {
            0 => Ok(()),
            refused => write!(
                f,
                "\n{refused} more said \"{UNKNOWN}\" of what the model knows: refused, neither \
                 right nor wrong"
            ),
        }
    }
}
