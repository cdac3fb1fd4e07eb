//! A head of emulated boards, for who is connected to the first of them by a probe.

use std::path::Path;

use firmware::Packet;
use host_sim::Error;
use host_sim::received::Received;
use host_sim::run::Run;
use scene::{Scene, Texture};
use wire::{Command, TaggedCommand};

use super::{Head, Node};
use crate::board::Board;
use crate::program::Program;
use crate::session::PS;

/// The boards, started.
pub struct HeadSession {
    run: Run<Head>,
    board: &'static str,
}

impl HeadSession {
    /// All with the program in `path`, which brings `scene` with it.
    ///
    /// # Errors
    /// [`Error::Input`] for a program that is none, or of another scene, and for a scene that is of
    /// no head; [`Error::Work`] for boards that do not start.
    pub fn new(scene: &Scene, path: &Path) -> Result<Self, Error> {
        let program = Program::load(path)?;
        let wrong = |fault| Error::file(path, fault);
        program.check_of(scene).map_err(wrong)?;
        let mut session = Self::of(scene, &program)?;
        session.bear();
        Ok(session)
    }

    /// From now on boards may be reset.
    pub(crate) fn bear(&mut self) {
        self.run.module_mut().bear();
    }

    /// Whose ticks are those of the simulated head, until it bears resets.
    pub(crate) fn of(scene: &Scene, program: &Program) -> Result<Self, Error> {
        let Some(bus) = config::bus(scene) else {
            let fault = "head.nodes: found none; allowed: a head of several boards";
            return Err(Error::Input(fault.to_owned()));
        };
        // Decisions are in the log, by their names.
        Ok(Self {
            run: super::start(scene, bus, Vec::new(), (program, 0))?,
            board: program.model()?.program,
        })
    }

    /// One tick of the world.
    ///
    /// # Errors
    /// [`Error::Work`] says what has stopped a board.
    pub fn tick(&mut self) -> Result<(), Error> {
        self.run.tick();
        Ok(self.run.module_mut().check()?)
    }

    /// Has the first board asked, or by way of it that of this number; whether there was room.
    ///
    /// # Errors
    /// [`Error::Work`] if the program's memory is not as it should be.
    pub fn request(&mut self, node: Option<u8>, request: TaggedCommand) -> Result<bool, Error> {
        let frame = match node {
            Some(node) => wire::frame_for(node, request.tag, request.command),
            None => wire::frame(&request),
        };
        Ok(self.first()?.request(&frame)?)
    }

    /// What the first board has sent since the last call.
    ///
    /// # Errors
    /// As [`HeadSession::request`].
    pub fn packets(&mut self) -> Result<Vec<Packet>, Error> {
        // What a reset has left of one is none.
        let heard = self.first()?.heard()?.into_iter();
        Ok(heard.filter_map(Received::packet).collect())
    }

    /// The lines that the first board has logged since the last call.
    ///
    /// # Errors
    /// As [`HeadSession::request`].
    pub fn log(&mut self) -> Result<Vec<String>, Error> {
        Ok(self.first()?.lines())
    }

    /// Has the last board asked by its own probe.
    pub(crate) fn ask_last(&mut self, command: Command) -> Result<bool, Error> {
        let request = TaggedCommand { tag: 1, command };
        Ok(self.last()?.request(&wire::frame(&request))?)
    }

    pub(crate) fn last_drives(&mut self) -> Result<bool, Error> {
        Ok(self.last()?.machine.chip().drives_a_motor())
    }

    fn last(&mut self) -> Result<&mut Board, Error> {
        board_of(self.run.module_mut().nodes.last_mut())
    }

    fn first(&mut self) -> Result<&mut Board, Error> {
        board_of(self.run.module_mut().nodes.first_mut())
    }

    /// As [`Run::lay`].
    pub const fn lay(&mut self, texture: Texture) {
        self.run.lay(texture);
    }

    /// As [`Run::is_laid`].
    pub const fn is_laid(&self) -> bool {
        self.run.is_laid()
    }

    /// Time of the bus, s.
    pub fn now_s(&mut self) -> f64 {
        self.run.module_mut().now as f64 / PS
    }

    /// The name of the boards' program.
    pub const fn board(&self) -> &'static str {
        self.board
    }
}

fn board_of(node: Option<&mut Node>) -> Result<&mut Board, Error> {
    let board = node.map(|node| &mut node.board);
    board.ok_or_else(|| Error::Work("the head has no boards".to_owned()))
}
