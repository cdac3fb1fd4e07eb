//! Output on the terminal.

mod evaluation;
mod runs;
mod training;

use std::fmt::{self, Display};
use std::io::{self, Write};
use std::process::ExitCode;

use firmware::Event;

use crate::Error;
use crate::decisions::{Decided, Score, UNKNOWN};
pub use evaluation::{Figures, Thresholds};
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

/// How a program ends: its exit status, and on standard error what went wrong.
pub fn exit(program: &str, done: Result<(), Error>) -> ExitCode {
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            warn(format_args!("{program}: {error}"));
            ExitCode::from(error.exit_status())
        }
    }
}

/// Reports faults and recoveries on standard error; for decisions see [`decision`].
pub fn limits_and_faults(t_s: f64, event: &Event) {
    let place = |place: &firmware::Place| {
        let side = if place.side == 0 { "left" } else { "right" };
        format!("{side} whisker {}", place.whisker + 1)
    };
    match event {
        Event::Decision(_) | Event::Touch { .. } | Event::TouchEnd { .. } => {}
        Event::SensorLost(at, fault) => {
            warn(format_args!(
                "{t_s:.4} s: {}: sensor fault {}: {fault}",
                place(at),
                fault.code()
            ));
        }
        Event::SensorBack(at) => warn(format_args!("{t_s:.4} s: {}: sensor is back", place(at))),
        Event::MotorFault(at, fault) => warn(format_args!("{t_s:.4} s: {}: {fault}", place(at))),
        Event::MotorRetry(at) => warn(format_args!("{t_s:.4} s: {}: motor tried again", place(at))),
    }
}

/// Reports a decision on standard output.
pub fn decision(t_s: f64, decided: &Decided) {
    let Decided {
        label,
        decision,
        samples,
        posterior,
        ..
    } = decided;
    let verdict = match decision.as_str() {
        UNKNOWN => "refused",
        _ if decided.is_right() => "right",
        _ => "wrong",
    };
    let percent = 100.0 * posterior;
    say(format_args!(
        "{t_s:8.3} s  {decision:<8} {percent:6.2} %  {samples:5} samples  {verdict} ({label})"
    ));
}

/// A score for people: confusion matrix, hit rate, decision time.
#[derive(Debug)]
pub struct Summary<'a>(pub &'a Score, pub u32);

impl fmt::Display for Summary<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(score, tick_hz) = self;
        let (Some(hits), Some(samples)) = (score.hit_rate(), score.mean_samples()) else {
            return write!(f, "no decision");
        };
        let milliseconds = samples * 1000.0 / f64::from(*tick_hz);
        write!(f, "{score}")?;
        write!(
            f,
            "{} decisions, hit rate {:.1} % (mean over classes), mean decision time {samples:.0} \
             samples ({milliseconds:.0} ms)",
            score.decisions(),
            100.0 * hits,
        )?;
        match score.unknown() {
            0 => Ok(()),
            unknown => write!(f, "; {unknown} more were \"{UNKNOWN}\""),
        }
    }
}
