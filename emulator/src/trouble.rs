//! A board in trouble, and what its log says of it.

use host_sim::Error;
use host_sim::run::Run;
use scene::Scene;

use crate::board::{Board, Emulated};
use crate::chip::Ps;
use crate::emulate::start;
use crate::program::Program;
use crate::upset::{MIDDLE, Upset};
use rtt::LogDecoder;

/// A board in trouble.
pub(crate) struct Trouble {
    pub(crate) run: Run<Emulated>,
    sides: usize,
    decoder: LogDecoder,
    pub(crate) log: Vec<String>,
}

impl Trouble {
    /// A board that runs `scene`, for which `program` was flashed.
    pub(crate) fn new(scene: &Scene, program: &Program) -> Result<Self, Error> {
        Ok(Self {
            run: start(scene, Vec::new(), program)?,
            sides: scene.head.sides.count(),
            decoder: program.log_decoder()?,
            log: Vec::new(),
        })
    }

    /// Lets so many ticks pass.
    pub(crate) fn pass(&mut self, ticks: u32) -> Result<(), Error> {
        for _ in 0..ticks {
            self.run.tick();
            let board = self.run.module_mut();
            board.check()?;
            self.take_log();
        }
        Ok(())
    }

    /// Takes what the board has logged.
    pub(crate) fn take_log(&mut self) {
        let bytes = self.run.module_mut().take_log();
        self.log.extend(self.decoder.lines(&bytes));
    }

    /// Holds the core for `time` in the middle of the next tick.
    pub(crate) fn hold(&mut self, time: Ps) {
        let machine = &mut self.board_mut().machine;
        machine.upset_next_tick(MIDDLE, Upset::Held(time));
    }

    /// The board.
    pub(crate) fn board_mut(&mut self) -> &mut Board {
        &mut self.run.module_mut().board
    }

    /// Whether the motor of each side is driven. One side may have all three outputs.
    pub(crate) fn driven(&mut self) -> Vec<bool> {
        let machine = &mut self.board_mut().machine;
        let duties = machine.with_chip(|chip| chip.motor_duties());
        let mut on = duties.map(|(on, _)| on > 0);
        if self.sides == 1 {
            on[0] = on.contains(&true);
        }
        on[..self.sides].to_vec()
    }

    /// The line of the log that says `text`.
    pub(crate) fn line(&self, text: &str) -> Result<String, Error> {
        let line = self.log.iter().find(|line| line.contains(text)).cloned();
        line.ok_or_else(|| {
            let said = self.log.join("\n  ");
            Error::Work(format!("no line of the log says \"{text}\":\n  {said}"))
        })
    }
}
