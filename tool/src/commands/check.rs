//! `whisker check`: a minute with a module, and a report on it.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use host_sim::origin::Origin;
use host_sim::output::Output;
use host_sim::plot::Ink;
use host_sim::{Error, report};

use super::order::SideName;
use super::tuning::Which;
use crate::calibrate::{
    ANGLE, Finding, LEAST_S, Listening, Panel, Watched, findings, picture, table, watch,
};
use crate::conversation::Conversation;
use crate::interrupt;
use crate::source::{Simulated, Source, seconds};

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct Arguments {
    #[command(flatten)]
    which: Which,
    /// The side whose whisker it is
    #[arg(long, value_enum, default_value = "left")]
    side: SideName,
    /// For how long, rest included
    #[arg(long, value_name = "S", default_value = "60", value_parser = seconds)]
    seconds: f64,
    /// The folder for check.md, check.svg and check.png
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

const FAULTS: usize = 40;

/// The motors are off at the end, however it ends.
pub(crate) fn check(arguments: &Arguments) -> Result<(), Error> {
    arguments.which.source.sends_all()?;
    if arguments.seconds < LEAST_S {
        let found = arguments.seconds;
        let fault = format!("--seconds: found {found}, allowed: at least {LEAST_S}, most at rest");
        return Err(Error::Input(fault));
    }
    let scene = arguments.which.scene_file()?;
    let simulation = Box::new(Simulated::in_the_air(scene)?);
    let file = |name: &str| Output::create(&arguments.out.join(name));
    let [md, svg, png] = [file("check.md")?, file("check.svg")?, file("check.png")?];
    report::warn(format_args!(
        "keep away what the whisker could touch; it is watched for {} s at rest and whisking. \
         Ctrl-C stops it",
        arguments.seconds
    ));
    let module = arguments.which.source.open(0)?;
    interrupt::heed()?;
    let seen = Seen::of(module, arguments)?;
    let simulated = Seen::of(simulation, arguments)?;
    let found = findings(&seen.watched, &simulated.watched);
    let off: Vec<&Finding> = found.iter().filter(|finding| finding.is_off()).collect();

    let origin = seen.origin.clone().with("scene", scene.display());
    let text = seen.report(&origin, &found);
    md.whole(text.as_bytes())?;
    let title = "check: at rest, whisking, at rest".to_owned();
    let picture = picture(title, &seen.watched.samples, &[X, Y, ANGLE]);
    svg.whole(picture.svg()?.as_bytes())?;
    png.whole(&picture.png()?)?;
    for finding in &off {
        report::say(format_args!(
            "{}: {:.2} {}, at most {:.2}: {}",
            finding.name, finding.found, finding.unit, finding.most, finding.sign
        ));
    }
    let out = arguments.out.display();
    report::say(format_args!(
        "{} of {} figures need a look; in {out}: check.md, check.svg, check.png",
        off.len(),
        found.len()
    ));
    if off.is_empty() && seen.faults.is_empty() {
        return Ok(());
    }
    Err(Error::Work(format!(
        "not as its simulation; docs/calibrating.md says what to do, and {out}/check.md is what \
         to send with a question"
    )))
}

struct Seen {
    watched: Watched,
    faults: Vec<String>,
    origin: Origin,
}

impl Seen {
    fn of(module: Box<dyn Source>, arguments: &Arguments) -> Result<Self, Error> {
        let has_motor = arguments.which.tuner()?.scene().motor.is_some();
        let mut module = Conversation::new(module);
        let mut whisker = Listening::new(&mut module, arguments.side.number())?;
        let origin = whisker.module().origin()?;
        let watched = watch(&mut whisker, arguments.seconds, has_motor)?;
        Ok(Self {
            watched,
            faults: std::mem::take(&mut whisker.faults),
            origin,
        })
    }

    fn report(&self, origin: &Origin, found: &[Finding]) -> String {
        let mut text = format!(
            "# Check of a whisker\n\nwhisker {}",
            env!("CARGO_PKG_VERSION")
        );
        for (key, value) in origin.iter() {
            // Writing to a string does not fail.
            let _ = write!(text, ", {key}: {value}");
        }
        text += "\n\n";
        text += &table(found);
        text += "\nAt most: from which a figure needs a look on, from that of the simulation of the \
                 same scene.\n\n## Faults and limits\n\n";
        if self.faults.is_empty() {
            text += "None.\n";
        }
        for line in self.faults.iter().take(FAULTS) {
            let _ = writeln!(text, "- `{}`", line.replace('`', "'"));
        }
        text
    }
}

/// Apart, as one would hide the other.
const X: Panel = (
    "x, codes",
    100.0,
    &[("x", Ink::Found, |s| s.codes[0].into())],
);
const Y: Panel = (
    "y, codes",
    100.0,
    &[("y", Ink::Found, |s| s.codes[1].into())],
);

#[cfg(test)]
mod tests;
