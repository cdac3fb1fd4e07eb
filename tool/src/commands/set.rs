//! `whisker set`: keys of the scene, in a module that runs.

use clap::Args;
use host_sim::{Error, report};
use scene::Override;

use super::get::{Which, table};
use crate::source::seconds;

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct Arguments {
    /// Keys and values as a scene file has them, such as motor.kp=0.07; docs/calibrating.md lists
    /// those that can be set
    #[arg(required = true, value_name = "KEY=VALUE")]
    set: Vec<Override>,
    #[command(flatten)]
    which: Which,
    /// For how long to print what the module logs then
    #[arg(long, value_name = "S", value_parser = seconds)]
    seconds: Option<f64>,
}

pub(crate) fn set(arguments: &Arguments) -> Result<(), Error> {
    let tuner = arguments.which.tuner()?;
    let mut module = arguments.which.source.module()?;
    let has = tuner.set(&mut module, &arguments.set)?.done()?;
    let keys: Vec<&str> = arguments.set.iter().map(Override::key).collect();
    report::say(table(&has.values(tuner.scene()), &keys, true));
    if !has.differing.is_empty() {
        report::say("to keep it: whisker save; a reset brings the scene's back");
    }
    module.print_log(arguments.seconds.unwrap_or(0.0))
}
