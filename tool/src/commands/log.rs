//! `whisker log`: the lines that a module logs.

use std::path::PathBuf;

use clap::Args;
use host_sim::{Error, report};

use crate::script::Script;
use crate::source::{SourceChoice, seconds};

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct Arguments {
    #[command(flatten)]
    source: SourceChoice,
    /// For how long; without it as long as the scene lasts
    #[arg(long, value_name = "S", value_parser = seconds)]
    seconds: Option<f64>,
    /// Commands for the module: lines TIME COMMAND [SIDE [VALUE]] or TIME set KEY VALUE, such as
    /// 1.5 gain left 0.5;
    /// what became of each is printed
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
}

pub(crate) fn log(arguments: &Arguments) -> Result<(), Error> {
    let mut script = Script::of(arguments.script.as_deref(), &arguments.source)?;
    let mut module = arguments.source.module()?;
    module.follow_log()?;
    let most = arguments.seconds.or(module.source().duration_s());
    let begun = module.now_s();
    // Of its answers; a module whose program takes no requests has a log all the same.
    let tick_hz = match arguments.script {
        Some(_) => module.about()?.tick_hz,
        None => 1,
    };
    let mut lines = 0_u64;
    while most.is_none_or(|most| module.now_s() - begun < most) {
        if let Some(line) = script.play(&mut module)? {
            lines += 1;
            report::say(line);
        }
        let incoming = module.receive()?;
        let answers = incoming.packets.iter();
        let answers = answers.filter_map(|packet| script.answered(packet, tick_hz));
        for line in answers.chain(incoming.lines) {
            lines += 1;
            report::say(line);
        }
    }
    if lines == 0 {
        report::warn(
            "nothing was logged in this time; touches and decisions are logged where the scene has \
             a [classifier]",
        );
    }
    module.leave_log()?;
    script.end()
}
