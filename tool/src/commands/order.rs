//! `whisker arm`, `stop`, `clear`, `home` and `status`: one command, and its answer.

use clap::{Args, Subcommand, ValueEnum};
use host_sim::{Error, report};
use wire::{Command, WhiskerId};

use crate::configuration::{Decides, RunsBy};
use crate::source::SourceChoice;
use crate::tally::SIDES;

#[derive(Debug, Subcommand)]
pub(crate) enum Order {
    /// Arms a module: its motors may be driven
    Arm(ToAll),
    /// Stops a module: its motors are off until it is armed
    Stop(ToAll),
    /// Runs a motor again that is off after faults, or was given up
    Clear(ToSide),
    /// Finds a whisker's rest again, where motor.rest is "find"
    Home(ToSide),
    /// Says what a module is and what it has lost and missed
    Status(ToAll),
}

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct ToAll {
    #[command(flatten)]
    source: SourceChoice,
}

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct ToSide {
    /// The whisker's side
    #[arg(value_enum)]
    side: SideName,
    #[command(flatten)]
    source: SourceChoice,
}

/// A side, as options have it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum SideName {
    /// The left one
    Left,
    /// The right one
    Right,
}

impl SideName {
    pub(super) const fn number(self) -> u8 {
        self as u8
    }
}

impl ToSide {
    fn whisker(&self) -> WhiskerId {
        let side = self.side.number();
        WhiskerId { side, number: 0 }
    }
}

/// Has it carried out; nothing of it is undone at the end.
pub(crate) fn order(order: &Order) -> Result<(), Error> {
    let (source, command, done) = match order {
        Order::Arm(to) => (&to.source, Command::Arm, "armed"),
        Order::Stop(to) => (&to.source, Command::Stop, "motors off until armed"),
        Order::Clear(to) => (&to.source, Command::Clear(to.whisker()), "faults cleared"),
        Order::Home(to) => (&to.source, Command::Home(to.whisker()), "is being homed"),
        Order::Status(of) => return status(&of.source),
    };
    if command == Command::Stop {
        source.stop();
    }
    let answer = source.module()?.ask(command)?;
    report::say(format_args!("{done}, after tick {}", answer.sequence));
    Ok(())
}

fn status(source: &SourceChoice) -> Result<(), Error> {
    let mut module = source.module()?;
    let about = module.about()?;
    let status = module.ask(Command::Status)?;
    let [lost, missed] = status.values.map(i32::cast_unsigned);
    report::say(format_args!(
        "scene {}\n{} ticks a second, whiskers: {}\n{} ticks since the start, {missed} \
         missed\n{lost} records found no room",
        about.scene, about.tick_hz, about.whiskers, status.sequence
    ));
    report::say(RunsBy::ask(&mut module)?);
    let origin = module.origin()?;
    let firmware = origin.get("firmware").unwrap_or("unknown");
    report::say(format_args!("firmware {firmware}"));
    for (side, name) in (0..).zip(SIDES) {
        if let Some([x, y]) = module.zero(WhiskerId { side, number: 0 })? {
            report::say(format_args!(
                "zero {name}: x {x:+} and y {y:+} codes from mid-scale, found by itself"
            ));
        }
    }
    // A scene without a classifier has nothing to say here.
    if let Ok(decides) = Decides::ask(&mut module) {
        report::say(decides);
    }
    Ok(())
}
