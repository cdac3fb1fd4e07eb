//! `host-sim press`: how a whisker bends that is pressed slowly against a plate.

use std::path::PathBuf;

use clap::Args;

use crate::output::{Output, check_or_stdout, is_stdout};
use crate::pressing::Pressing;
use crate::{Error, files};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    pressing: Pressing,
    /// Where to write the table, a row a push; - is standard output
    #[arg(long, value_name = "FILE.csv", default_value = "-")]
    out: PathBuf,
    /// Where to write points of the bent shaft, from base to tip, of each push
    #[arg(long, value_name = "FILE.csv")]
    shape: Option<PathBuf>,
}

/// Presses a whisker and writes its tables. Returns what was done; nothing where the table is on
/// standard output.
pub(super) fn press(asked: &Arguments) -> Result<Option<String>, Error> {
    let (pressing, out) = (&asked.pressing, &asked.out);
    check_or_stdout(out)?;
    if let Some(shape) = &asked.shape {
        if shape == out || is_stdout(shape) {
            let fault = format!("--shape: found {}, allowed: another file", shape.display());
            return Err(Error::Input(fault));
        }
        check_or_stdout(shape)?;
    }
    let pressed = pressing.press().map_err(|refused| {
        let option = refused.key.replace('_', "-");
        Error::Input(format!("--{option}: {}", refused.fault))
    })?;
    if let Some(shape) = &asked.shape {
        let output = Output::create_or_stdout(shape)?;
        files::write(output, |file| pressing.write_shapes(file, &pressed))?;
    }
    let output = Output::create_or_stdout(out)?;
    files::write(output, |file| pressing.write(file, &pressed))?;
    let summary = || {
        let count = pressed.len();
        format!("{}: {count} pushes; columns: docs/files.md", out.display())
    };
    Ok((!is_stdout(out)).then(summary))
}
