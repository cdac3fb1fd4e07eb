//! A board that runs a scene, for who talks with it as with one on a bench: by what a probe reads
//! from its RAM and writes into it, or by its serial line.

use std::ops::Range;
use std::path::Path;

use firmware::Packet;
use firmware::boards::Slot;
use host_sim::Error;
use host_sim::received::Received;
use host_sim::run::Run;
use scene::{Scene, Texture};
use wire::{Answer, Command, CommandStatus, TaggedCommand};

use crate::board::Board;
use crate::chip::{Fault, Ps};
use crate::emulate::start;
use crate::machine::Machine;
use crate::program::Program;
use crate::trial::{self, Hands};

/// Picoseconds in a second.
pub(crate) const PS: f64 = 1e12;

/// Ticks that an answer may take, as flash that is erased takes a second.
pub(crate) const PATIENCE: u32 = 10_000;

/// A board, started and before its first tick.
pub struct Session {
    pub(crate) run: Run<Board>,
    board: &'static str,
    /// Where scenes and models lie.
    place: Range<u32>,
    slots: [Slot; 2],
    pub(crate) sides: usize,
    pub(crate) tick_hz: u32,
    is_by_serial: bool,
    tag: u16,
    hands: Option<Hands>,
}

impl Session {
    /// The name of the board that a program was built for, as its main source file has it.
    ///
    /// # Errors
    /// [`Error::Input`] for what is no program of a board.
    pub fn board_of(program: &Path) -> Result<&'static str, Error> {
        let loaded = Program::load(program)?;
        let model = loaded.model();
        Ok(model.map_err(|fault| Error::file(program, fault))?.program)
    }

    /// The board that `program` was built for, in the world of `scene`; empty `flash`: scenes and
    /// models are what the program brings with it, otherwise what is there, as
    /// [`Session::flash`] gives it.
    ///
    /// # Errors
    /// [`Error::Input`] for a program that is none, or of another scene; [`Error::Work`] for a scene
    /// that its board cannot carry, and for flash of another size.
    pub fn flashed(scene: &Scene, program: &Path, flash: &[u8]) -> Result<Self, Error> {
        let path = program;
        let mut program = Program::load(path)?;
        if flash.is_empty() {
            let checked = program.check_of(scene);
            checked.map_err(|fault| Error::file(path, fault))?;
        }
        let (found, allowed) = (flash.len(), program.scenes()?.len());
        if found != 0 && found != allowed {
            return Err(Error::Work(format!(
                "found {found} bytes of flash for scenes, allowed: {allowed}; are they of another \
                 board?"
            )));
        }
        program.add(program.scenes()?.start, flash)?;
        // Decisions are in the log, by their names.
        Self::of(scene, Vec::new(), &program)
    }

    /// A board that runs `scene`, and says its classes by their names.
    pub(crate) fn running(
        scene: &Scene,
        classes: Vec<String>,
        program: &Program,
    ) -> Result<Self, Error> {
        let mut session = Self::of(scene, classes, program)?;
        let log = session.board_mut().logged();
        let lines = program.log_decoder()?.lines(log);
        if lines.iter().any(|line| line.contains("no scene: ")) {
            return Err(Error::Work(lines.join("\n")));
        }
        Ok(session)
    }

    /// A board with this program, which may have another scene, or none.
    pub(crate) fn of(
        scene: &Scene,
        classes: Vec<String>,
        program: &Program,
    ) -> Result<Self, Error> {
        let model = program.model()?;
        Ok(Self {
            run: start(scene, classes, program)?,
            board: model.program,
            place: program.scenes()?,
            slots: model.facts.flash.slots,
            sides: scene.head.sides.count(),
            tick_hz: scene.tick_hz,
            is_by_serial: false,
            tag: 0,
            hands: None,
        })
    }

    /// The same, where requests go by the serial line, as frames, and not by a probe.
    pub(crate) fn by_serial(self) -> Self {
        Self {
            is_by_serial: true,
            ..self
        }
    }

    pub(crate) fn board_mut(&mut self) -> &mut Board {
        self.run.module_mut()
    }

    pub(crate) fn machine(&mut self) -> &mut Machine {
        &mut self.board_mut().machine
    }

    pub(crate) fn period(&self) -> Ps {
        1_000_000_000_000 / Ps::from(self.tick_hz)
    }

    pub(crate) fn ticks_of(&self, seconds: f64) -> u32 {
        (seconds * f64::from(self.tick_hz)).round() as u32
    }

    /// By how much of its period the motor of each side is driven. One side may have all three
    /// outputs.
    pub(crate) fn efforts(&mut self) -> Vec<f64> {
        let duties = self.machine().chip().motor_duties();
        let share = |(on, period): (u32, u32)| f64::from(on) / f64::from(period.max(1));
        if self.sides == 1 {
            return vec![duties.into_iter().map(share).fold(0.0, f64::max)];
        }
        duties.into_iter().take(self.sides).map(share).collect()
    }

    pub(crate) fn drives(&mut self) -> bool {
        self.machine().chip().drives_a_motor()
    }

    pub(crate) fn drives_all(&mut self) -> bool {
        self.efforts().iter().all(|effort| *effort > 0.0)
    }

    /// What lies in the flash where scenes and models do, but for the marks of scenes that have
    /// armed motors by themselves: whoever starts a board with it has whiskers at rest, as with one
    /// that was just deployed to.
    ///
    /// # Errors
    /// [`Error::Work`] if it cannot be read.
    pub fn flash(&mut self) -> Result<Vec<u8>, Error> {
        let place = self.place.clone();
        let memories = &self.machine().memories;
        let mut bytes = memories.bytes_at(place.start, place.len())?;
        for mark in self.slots.map(Slot::mark) {
            let from = (mark.start - place.start) as usize;
            let marked = bytes.iter_mut().skip(from).take(mark.bytes as usize);
            marked.for_each(|byte| *byte = u8::MAX);
        }
        Ok(bytes)
    }

    /// From now on a reset that the program or the watchdog makes is no fault, and the world
    /// moves on where no tick ends; or no more.
    pub fn bear_resets(&mut self, bears: bool) {
        let bears = bears || self.hands.is_some();
        // Ticks are not equally long.
        let most_wait = self.period() * 3 / 2;
        let board = self.board_mut();
        board.bears_resets = bears;
        board.world_waits = bears.then_some(most_wait);
        if !bears {
            board.reset = None;
        }
    }

    /// Whether the board was reset since the last call.
    pub fn was_reset(&mut self) -> bool {
        self.board_mut().reset.take().is_some()
    }

    /// One tick of the board, and of the world around it.
    ///
    /// # Errors
    /// [`Error::Work`] says what has stopped the board.
    pub fn tick(&mut self) -> Result<(), Error> {
        if let Some(mut hands) = self.hands.take() {
            let done = hands.act(self.run.t_s(), self);
            self.hands = Some(hands);
            done?;
        }
        Ok(self.pass_tick()?)
    }

    /// From now on there befalls it what the file of a scenario says (docs/boards.md), resets
    /// included; comes back once it ticks.
    ///
    /// # Errors
    /// [`Error::Input`] for a file that is wrong, [`Error::Work`] for a board that does not tick.
    pub fn befall(&mut self, path: &Path, scene: &Scene) -> Result<(), Error> {
        self.hands = Some(trial::befalling(path, scene)?);
        self.bear_resets(true);
        for _ in 0..PATIENCE {
            self.tick()?;
            if !self.board_mut().is_late {
                return Ok(());
            }
        }
        let fault = format!("{}: the board does not start", path.display());
        Err(Error::Work(fault))
    }

    /// The same, for who asks what was not followed.
    pub(crate) fn pass_tick(&mut self) -> Result<(), Fault> {
        self.run.tick();
        self.board_mut().check()
    }

    /// Writes a request; whether there was room for it.
    ///
    /// # Errors
    /// [`Error::Work`] if the program's memory is not as it should be.
    pub fn request(&mut self, request: TaggedCommand) -> Result<bool, Error> {
        let frame = wire::frame(&request);
        if self.is_by_serial {
            self.serial_write(&frame);
            return Ok(true);
        }
        Ok(self.board_mut().request(&frame)?)
    }

    pub(crate) fn send(&mut self, command: Command) -> Result<TaggedCommand, Error> {
        self.tag += 1;
        let tag = self.tag;
        let request = TaggedCommand { tag, command };
        if self.request(request)? {
            return Ok(request);
        }
        Err(Error::Work(format!("{command:?}: no room for it")))
    }

    pub(crate) fn ask(&mut self, command: Command) -> Result<Answer, Error> {
        let TaggedCommand { tag, .. } = self.send(command)?;
        for _ in 0..PATIENCE {
            self.tick()?;
            if let Some(answer) = answer_to(tag, &self.packets()?) {
                return Ok(answer);
            }
        }
        Err(Error::Work(format!("{command:?}: no answer")))
    }

    pub(crate) fn must(&mut self, command: Command, status: CommandStatus) -> Result<(), Error> {
        let found = self.ask(command)?.status;
        if found == status {
            return Ok(());
        }
        Err(Error::Work(format!(
            "{command:?}: found {found:?}, expected {status:?}"
        )))
    }

    /// What the board has sent since the last call.
    ///
    /// # Errors
    /// As [`Session::request`].
    pub fn packets(&mut self) -> Result<Vec<Packet>, Error> {
        let received = self.received()?.into_iter();
        Ok(received.filter_map(Received::packet).collect())
    }

    /// The same, and lines where it goes by the serial line.
    pub(crate) fn received(&mut self) -> Result<Vec<Received>, Error> {
        let is_by_serial = self.is_by_serial;
        Ok(self.board_mut().received(is_by_serial)?)
    }

    /// Has the other end of the board's serial line, which has the scene's baud, send bytes
    /// from now on.
    pub fn serial_write(&mut self, bytes: &[u8]) {
        self.machine().disturbed().serial_write(bytes);
    }

    /// What the other end has received since the last call.
    pub fn serial_read(&mut self) -> Vec<u8> {
        self.machine().chip().serial_read()
    }

    /// The lines that it has logged since the last call.
    pub fn log(&mut self) -> Vec<String> {
        self.board_mut().lines()
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
        self.machine().now as f64 / PS
    }

    /// The name of the board's program.
    pub const fn board(&self) -> &'static str {
        self.board
    }
}

pub(crate) fn answer_to(tag: u16, packets: &[Packet]) -> Option<Answer> {
    packets.iter().find_map(|packet| match packet {
        Packet::Answer(answer) if answer.tag == tag => Some(*answer),
        _ => None,
    })
}
