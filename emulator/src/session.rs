//! A board that runs a scene, for a program that talks with it as with one on a bench: by what
//! a probe reads from its RAM and writes into it.

use std::ops::Range;
use std::path::Path;

use firmware::Packet;
use host_sim::Error;
use host_sim::run::Run;
use scene::{Scene, Texture};
use wire::TaggedCommand;

use crate::board::{self, Emulated};
use crate::chip::Ps;
use crate::emulate::start_without;
use crate::program::Program;
use rtt::LogDecoder;

/// Picoseconds in a second.
const PS: f64 = 1e12;

/// A board, started and before its first tick.
pub struct Session {
    run: Run<Emulated>,
    decoder: LogDecoder,
    board: &'static str,
    /// Where scenes and models lie.
    place: Range<u32>,
    /// Longer than any tick takes.
    most_wait: Ps,
    /// Whether requests go by the serial line.
    is_by_serial: bool,
}

impl Session {
    /// The board that `program` was built for, in the world of `scene`; empty `flash`: scenes and
    /// models are what the program brings with it, otherwise what is there, as
    /// [`Session::flash`] gives it.
    ///
    /// # Errors
    /// [`Error::Work`] for a program that cannot be run, a scene that its board cannot carry, and
    /// for flash of another size.
    pub fn flashed(scene: &Scene, program: &Path, flash: &[u8]) -> Result<Self, Error> {
        let mut program = Program::load(program)?;
        let (found, allowed) = (flash.len(), program.scenes()?.len());
        if found != 0 && found != allowed {
            return Err(Error::Work(format!(
                "found {found} bytes of flash for scenes, allowed: {allowed}; are they of another \
                 board?"
            )));
        }
        program.add(program.scenes()?.start, flash)?;
        Self::of(scene, &program)
    }

    /// The same of what is flashed.
    pub(crate) fn of(scene: &Scene, program: &Program) -> Result<Self, Error> {
        Ok(Self {
            // Decisions are in the log, by their names.
            run: start_without(scene, Vec::new(), program)?,
            decoder: program.log_decoder()?,
            board: program.model()?.program,
            place: program.scenes()?,
            // Ticks are not equally long.
            most_wait: (1.5 * PS / f64::from(scene.tick_hz)) as Ps,
            is_by_serial: false,
        })
    }

    /// The same, where requests go by the serial line, as frames, and not by a probe.
    pub(crate) fn by_serial(self) -> Self {
        Self {
            is_by_serial: true,
            ..self
        }
    }

    /// Whether a motor is driven.
    pub fn drives(&mut self) -> bool {
        let machine = &mut self.run.module_mut().board.machine;
        let duties = machine.with_chip(|chip| chip.motor_duties());
        duties.iter().any(|(on, _)| *on > 0)
    }

    /// What lies in the flash where scenes and models do.
    ///
    /// # Errors
    /// [`Error::Work`] if it cannot be read.
    pub fn flash(&mut self) -> Result<Vec<u8>, Error> {
        let memories = &self.run.module_mut().board.machine.memories;
        Ok(memories.flashed_bytes(self.place.start, self.place.len())?)
    }

    /// From now on a reset that the program or the watchdog makes is no fault, and the world
    /// moves on where no tick ends; or no more.
    pub fn bear_resets(&mut self, bears: bool) {
        let emulated = self.run.module_mut();
        emulated.bears_resets = bears;
        emulated.board.world_waits = bears.then_some(self.most_wait);
        if !bears {
            emulated.board.reset = None;
        }
    }

    /// Whether the board was reset since the last call.
    pub fn was_reset(&mut self) -> bool {
        self.run.module_mut().board.reset.take().is_some()
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
        let frame = wire::frame(&request);
        if self.is_by_serial {
            board.serial_write(&frame);
            return Ok(true);
        }
        Ok(board.request(&frame)?)
    }

    /// What the board has sent since the last call.
    ///
    /// # Errors
    /// As [`Session::request`].
    pub fn packets(&mut self) -> Result<Vec<Packet>, Error> {
        let board = &mut self.run.module_mut().board;
        if self.is_by_serial {
            return Ok(board::packets(&board.received()?));
        }
        Ok(board.packets()?)
    }

    /// Has the other end of the board's serial line, which has the scene's baud, send bytes
    /// from now on.
    pub fn serial_write(&mut self, bytes: &[u8]) {
        self.run.module_mut().board.serial_write(bytes);
    }

    /// What the other end has received since the last call.
    pub fn serial_read(&mut self) -> Vec<u8> {
        self.run.module_mut().board.serial_read()
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
