//! `whisker`: what someone at the bench does with a module. `whisker --help` documents it.
//!
//! # Glossary
//!
//! - *source*: a module that can be talked with, wherever it runs;
//! - *record*: what a module reports of one whisker in one tick;
//! - *recording*: samples with labels, which `host-sim train` reads;
//! - *sample* of a texture: the piece that is laid before the whisker.

mod calibrate;
mod capture;
mod commands;
mod configuration;
mod conversation;
mod deployment;
mod doctor;
mod faults;
mod frames;
mod interrupt;
mod loading;
mod monitor;
mod probe;
mod quoted;
mod record_file;
mod resting;
mod sample;
mod scene_file;
mod script;
mod source;
mod table;
mod tally;
mod tuning;
mod typed;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use host_sim::progress::Verbosity;
use host_sim::{Error, report};

/// The program for the bench: brings a whisker module up, calibrates it, captures textures, deploys
/// scenes and models, and shows what the module does.
///
/// The module is a simulated one (--sim), the program of a board on an emulated chip
/// (--emulated), a board behind its debug probe (--probe), or one on a serial port (--port).
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
    /// Writes what the module reports of every tick to a table, and counts what was lost
    Records(commands::records::Arguments),
    /// Opens a window on the module: angles, deflection, posteriors, decisions, faults
    Monitor(Box<commands::monitor::Arguments>),
    /// Records textures, label by label, as many touches of each: what host-sim train reads
    Capture(commands::capture::Arguments),
    /// Finds a whisker's zero, range and stops, its motor's direction and friction, and gains that
    /// fit; moves it, gently
    Calibrate(commands::calibrate::Arguments),
    /// Watches a whisker for a minute and writes a report: where it differs from its simulation,
    /// and what that is a sign of
    Check(commands::check::Arguments),
    /// Brings a module up step by step, and says what it saw and what to do: start, sensors'
    /// frames, encoder turned by hand; the motor last, if somebody types yes
    Bringup(commands::bringup::Arguments),
    /// Programs a board through its debug probe with a scene
    Flash(commands::flash::Arguments),
    /// Says what this PC lacks to work with a board, and the command that mends it
    Doctor(commands::doctor::Arguments),
    #[command(flatten)]
    Order(commands::order::Order),
    /// Gives a module another scene, a model to decide by, or both; its program stays
    Deploy(commands::deploy::Arguments),
    /// Runs a board's program on an emulated chip, with its serial port as a pseudo-terminal
    #[cfg(unix)]
    Board(commands::board::Arguments),
    /// Prints what the module has for keys of its scene, beside what the scene says
    Get(commands::tuning::GetArguments),
    /// Sets keys of the scene in the module while it runs
    Set(commands::tuning::SetArguments),
    /// Writes what the module has into its scene file
    Save(commands::tuning::SaveArguments),
}

fn main() -> ExitCode {
    let Arguments { quiet, command } = report::arguments();
    let work = || run(&command, Verbosity::of(quiet));
    match command {
        // An interrupt stops the motors there before it ends the program.
        Command::Monitor(_) | Command::Calibrate(_) | Command::Check(_) | Command::Bringup(_) => {
            report::ended("whisker", work())
        }
        _ => report::program("whisker", work),
    }
}

fn run(command: &Command, verbosity: Verbosity) -> Result<(), Error> {
    match command {
        Command::Monitor(arguments) => commands::monitor::monitor(arguments),
        Command::Calibrate(arguments) => commands::calibrate::calibrate(arguments),
        Command::Check(arguments) => commands::check::check(arguments),
        Command::Log(arguments) => commands::log::log(arguments),
        Command::Records(arguments) => commands::records::records(arguments, verbosity),
        Command::Capture(arguments) => commands::capture::capture(arguments, verbosity),
        Command::Bringup(arguments) => commands::bringup::bringup(arguments),
        Command::Flash(arguments) => commands::flash::flash(arguments, verbosity),
        Command::Doctor(arguments) => commands::doctor::doctor(arguments),
        Command::Order(order) => commands::order::order(order),
        Command::Deploy(arguments) => commands::deploy::deploy(arguments),
        #[cfg(unix)]
        Command::Board(arguments) => commands::board::board(arguments),
        Command::Get(arguments) => commands::tuning::get(arguments),
        Command::Set(arguments) => commands::tuning::set(arguments),
        Command::Save(arguments) => commands::tuning::save(arguments),
    }
}
