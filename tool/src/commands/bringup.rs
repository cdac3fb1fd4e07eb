//! `whisker bringup`: a module at its first power-up, step by step. Each step says what it did, what
//! it saw, what that means and what to do; motors stay off until the last, which asks first.

mod bench;
mod module;
mod moving;
mod report;
mod sensor;

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use host_sim::Error;
use host_sim::output::Output;

use crate::interrupt;
use crate::source::SourceChoice;
use bench::Bench;
use report::{Done, Report, part_of};

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct Arguments {
    #[command(flatten)]
    source: SourceChoice,
    /// The steps that are done, with commas between them; without it all
    #[arg(long, value_name = "STEP", value_enum, value_delimiter = ',')]
    steps: Vec<Name>,
    /// In place of the steps: deploys this scene at slower and slower ticks, until each frame of the
    /// sensors is answered
    #[arg(long, value_name = "SCENE", conflicts_with = "steps")]
    find_rest: Option<PathBuf>,
    /// Frames to read of each sensor, and ticks to watch it for
    #[arg(long, value_name = "N", default_value = "1000",
          value_parser = clap::value_parser!(u32).range(10..=100_000))]
    frames: u32,
    /// Waits for no key: what a step asks for is there. Drives no motor without
    /// --motor
    #[arg(long)]
    yes: bool,
    /// Drives the motor without asking
    #[arg(long)]
    motor: bool,
    /// Where to write the report, to be sent with a question
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Name {
    /// What it is, how it started, its clock and supply; its motors are stopped
    Module,
    /// The sensor's frames as they come: whether it answers, and how it sends them
    Frames,
    /// How long the sensor rests between two frames, and whether that is enough
    Rest,
    /// How often the sensor has a new reading
    Rate,
    /// How much its readings scatter while nothing moves
    Noise,
    /// Which way the encoder counts as the whisker is turned by hand
    Encoder,
    /// Which way the motor turns the whisker, at a fifth of its duty
    Motor,
}

/// What is done of a whisker, of this side.
type OfSide = fn(&mut Bench, u8) -> Done;

/// The steps but for the first, in their order.
const STEPS: [(Name, OfSide); 6] = [
    (Name::Frames, sensor::frames),
    (Name::Rest, sensor::rest),
    (Name::Rate, sensor::rate),
    (Name::Noise, sensor::noise),
    (Name::Encoder, moving::encoder),
    (Name::Motor, moving::motor),
];

/// Goes through the steps; the exit status is that of failed work if any has found something.
pub(crate) fn bringup(arguments: &Arguments) -> Result<(), Error> {
    let json = arguments.json.as_deref().map(Output::create).transpose()?;
    let mut bench = Bench::new(arguments)?;
    interrupt::heed()?;
    let mut report = Report::new(&mut bench)?;
    let stepped = steps(arguments, &mut bench, &mut report);
    // Whatever has ended them.
    let stopped = bench.stop();
    if let Some(json) = json {
        json.whole(report.json()?.as_bytes())?;
    }
    stepped?;
    stopped?;
    report.end()
}

fn steps(arguments: &Arguments, bench: &mut Bench, report: &mut Report) -> Result<(), Error> {
    let is_asked = |name| arguments.steps.is_empty() || arguments.steps.contains(&name);
    bench.stop()?;
    if let Some(scene) = &arguments.find_rest {
        report.add(part_of(sensor::find(bench, scene))?.named("find-rest"));
        return Ok(());
    }
    if is_asked(Name::Module) {
        report.add(module::module(bench)?);
    }
    for (name, step) in STEPS.into_iter().filter(|(name, _)| is_asked(*name)) {
        for side in bench.sides() {
            let part = part_of(step(bench, side))?;
            report.add(part.of(name, side));
        }
    }
    Ok(())
}
