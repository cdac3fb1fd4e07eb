//! `whisker`: what someone at the bench does with a module. `whisker --help` documents it.
//!
//! # Glossary
//!
//! - *source*: a module that can be talked with, wherever it runs;
//! - *record*: what a module tells of one whisker in one tick;
//! - *recording*: samples with labels, which `host-sim train` reads;
//! - *sample* of a texture: the piece that is laid before the whisker.

mod capture;
mod commands;
mod conversation;
mod log_line;
mod monitor;
mod record_file;
mod script;
mod source;
mod table;
mod tally;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use host_sim::progress::Verbosity;
use host_sim::{Error, report};

/// Reads the log and the records of a whisker module, and captures textures for it to learn.
///
/// The module is a simulated one (--sim), or the program of a board on an emulated chip
/// (--emulated).
///
/// Exit status: 0 done, 1 the work failed, 2 the arguments or a file are wrong.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// No progress on standard error
    #[arg(long, global = true)]
    quiet: bool,

    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Prints the lines that the module logs: touches, decisions, faults
    Log(commands::log::Arguments),
    /// Writes what the module tells of every tick to a table, and counts what was lost
    Records(commands::records::Arguments),
    /// Opens a window on the module: angles, deflection, posteriors, decisions, faults
    Monitor(Box<commands::monitor::Arguments>),
    /// Records textures, label by label, as many touches of each: what host-sim train reads
    Capture(commands::capture::Arguments),
}

fn main() -> ExitCode {
    let Arguments { quiet, command } = Arguments::parse();
    let verbosity = Verbosity::of(quiet);
    if let Command::Monitor(arguments) = &command {
        // An interrupt stops the motors there before it ends the program.
        return report::ended("whisker", commands::monitor::monitor(arguments));
    }
    report::program("whisker", || -> Result<(), Error> {
        match command {
            Command::Monitor(arguments) => commands::monitor::monitor(&arguments),
            Command::Log(arguments) => commands::log::log(&arguments),
            Command::Records(arguments) => commands::records::records(&arguments, verbosity),
            Command::Capture(arguments) => commands::capture::capture(&arguments, verbosity),
        }
    })
}
