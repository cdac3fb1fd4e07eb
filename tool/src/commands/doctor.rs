//! `whisker doctor`: what this PC lacks.

use clap::Args;
use host_sim::{Error, report};

use crate::doctor::{Facts, Purpose, checks};
use crate::source::BoardName;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// What the PC is to be ready for; may be given several times; left out: everything
    #[arg(long = "for", value_name = "PURPOSE", value_enum)]
    purposes: Vec<Purpose>,
    /// The board that is behind the probe
    #[arg(long, value_enum, default_value = "nucleo-f446re")]
    board: BoardName,
}

pub(crate) fn doctor(arguments: &Arguments) -> Result<(), Error> {
    let facts = Facts::gather(arguments.board);
    let checks = checks(&facts, arguments.board, &arguments.purposes);
    checks.lines.iter().for_each(report::say);
    if checks.is_well {
        return Ok(());
    }
    let fault = "something is missing; after a colon stands what mends it";
    Err(Error::Work(fault.to_owned()))
}
