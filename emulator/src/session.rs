//! A board that runs a scene, for a program that talks with it as with one on a bench: by what
//! a probe reads from its RAM and writes into it.

use std::path::Path;

use host_sim::Error;
use host_sim::run::Run;
use scene::{Scene, Texture};
use wire::{Packet, TaggedCommand};

use crate::board::Emulated;
use crate::emulate::start;
use crate::program::Program;
use rtt::LogDecoder;

/// Picoseconds in a second.
const PS: f64 = 1e12;

/// A board, started and before its first tick.
pub struct Session {
    run: Run<Emulated>,
    decoder: LogDecoder,
    board: &'static str,
}

impl Session {
    /// The board that `program` was built for, in the world of `scene`.
    ///
    /// # Errors
    /// [`Error::Work`] for a program that cannot be run, or a scene that its board cannot
    /// carry.
    pub fn open(scene: &Scene, program: &Path) -> Result<Self, Error> {
        let program = Program::load(program)?;
        Ok(Self {
            // Decisions are told in the log, by their names.
            run: start(scene, Vec::new(), &program)?,
            decoder: program.log_decoder()?,
            board: program.model()?.program,
        })
    }

    /// One tick of the board, and of the world around it.
    ///
    /// # Errors
    /// [`Error::Work`] says what has stopped the board.
    pub fn tick(&mut self) -> Result<(), Error> {
        self.run.tick();
        Ok(self.run.module_mut().check()?)
    }

    /// Writes a request; whether there was room for it.
    ///
    /// # Errors
    /// [`Error::Work`] if the program's memory is not as it should be.
    pub fn request(&mut self, request: TaggedCommand) -> Result<bool, Error> {
        let board = &mut self.run.module_mut().board;
        Ok(board.request(&request.bytes())?)
    }

    /// What the board has sent since the last call.
    ///
    /// # Errors
    /// As [`Session::request`].
    pub fn packets(&mut self) -> Result<Vec<Packet>, Error> {
        Ok(self.run.module_mut().board.packets()?)
    }

    /// The lines that it has logged since the last call.
    pub fn log(&mut self) -> Vec<String> {
        let bytes = self.run.module_mut().take_log();
        self.decoder.lines(&bytes)
    }

    /// As [`Run::lay`].
    pub const fn lay(&mut self, texture: Texture) {
        self.run.lay(texture);
    }

    /// As [`Run::is_laid`].
    pub const fn is_laid(&self) -> bool {
        self.run.is_laid()
    }

    /// Time on the chip, s.
    pub fn now_s(&mut self) -> f64 {
        self.run.module_mut().board.machine.now as f64 / PS
    }

    /// The name of the board's program.
    pub const fn board(&self) -> &'static str {
        self.board
    }
}
