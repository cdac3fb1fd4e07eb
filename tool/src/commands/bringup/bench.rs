//! The module, and whoever stands before it.

use host_sim::{Error, report};
use wire::{Command, CommandStatus};

use super::Arguments;
use super::report::{Ended, not_done};
use crate::calibrate::Listening;
use crate::configuration::Running;
use crate::conversation::{AboutModule, Conversation};
use crate::frames::Seen;
use crate::interrupt;
use crate::typed::Typed;

pub(super) struct Bench {
    pub(super) module: Conversation,
    pub(super) about: AboutModule,
    pub(super) running: Running,
    /// How many frames are read, and ticks watched.
    pub(super) frames: u32,
    /// What was seen of the frames of each side, and whether its encoder counts up.
    pub(super) seen: [Option<Seen>; 2],
    pub(super) counts_up: [Option<bool>; 2],
    /// What is typed; none: nothing is asked.
    typed: Option<Typed>,
    may_drive: bool,
}

impl Bench {
    pub(super) fn new(arguments: &Arguments) -> Result<Self, Error> {
        arguments.source.sends_all()?;
        let mut module = arguments.source.module()?;
        Ok(Self {
            about: module.about()?,
            running: Running::ask(&mut module)?,
            module,
            frames: arguments.frames,
            seen: [None, None],
            counts_up: [None; 2],
            typed: (!arguments.yes).then(Typed::at_standard_input),
            may_drive: arguments.motor,
        })
    }

    pub(super) fn ask_again(&mut self) -> Result<(), Error> {
        self.about = self.module.about()?;
        self.running = Running::ask(&mut self.module)?;
        Ok(())
    }

    /// 0 for the left side, 1 for the right.
    pub(super) fn sides(&self) -> std::ops::Range<u8> {
        0..self.about.whiskers.min(2) as u8
    }

    /// Motors are off from here on, where there are any.
    pub(super) fn stop(&mut self) -> Result<(), Error> {
        self.module.stop()
    }

    pub(super) fn ask(&mut self, what: &str) -> Result<(), Error> {
        if self.typed.is_none() {
            report::warn(what);
            return Ok(());
        }
        report::warn(format_args!("{what}; then press Enter"));
        self.answer().map(drop)
    }

    /// Whether the motor may be driven, which this says.
    pub(super) fn may_drive(&mut self, what: &str) -> Result<bool, Error> {
        if self.may_drive || self.typed.is_none() {
            report::warn(what);
            return Ok(self.may_drive);
        }
        let choice = "type yes, or press Enter to leave it out";
        report::warn(format_args!("{what}; {choice}"));
        Ok(self.answer()?.trim() == "yes")
    }

    /// What is typed next. What the module tells meanwhile is fetched.
    fn answer(&mut self) -> Result<String, Error> {
        let gone = |why: String| {
            Error::Work(format!(
                "standard input {why} before an answer came: run this in a terminal, or with --yes"
            ))
        };
        while let Some(typed) = &self.typed {
            interrupt::check()?;
            if let Some(line) = typed.line().map_err(gone)? {
                return Ok(line);
            }
            self.module.source().next()?;
        }
        Ok(String::new())
    }

    /// Has records of every tick sent.
    pub(super) fn stream(&mut self) -> Result<(), Ended> {
        match self.module.answer(Command::Stream(true))?.status {
            CommandStatus::Done => Ok(()),
            status => not_done(format!(
                "not done, as no records of every tick can be had: {status}; by a probe, or with a \
                 higher telemetry.serial_baud, as scenes/bringup.toml has it"
            )),
        }
    }

    pub(super) fn whisker(&mut self, side: u8) -> Result<Listening<'_>, Error> {
        let mut whisker = Listening::new(&mut self.module, side)?;
        whisker.go_on()?;
        Ok(whisker)
    }
}
