//! A board's own program on an emulated chip, or on those of a head, whose first board is talked
//! with.

use std::path::Path;

use emulator::head::HeadSession;
use emulator::session::Session;
use firmware::Links;
use host_sim::Error;
use host_sim::loaded::Loaded;
use host_sim::origin::Origin;
use scene::Scene;
use wire::TaggedCommand;

use super::flash::Flash;
use super::{Incoming, Source, by_probe, no_board, texture};

pub(super) struct Emulated {
    loaded: Loaded,
    boards: Boards,
}

enum Boards {
    One(Session, Flash),
    Head(HeadSession),
}

impl Emulated {
    pub(super) fn open(
        loaded: Loaded,
        program: &Path,
        mut flash: Flash,
        scenario: Option<&Path>,
    ) -> Result<Self, Error> {
        let mut session = Session::flashed(&loaded.scene, program, flash.contents())?;
        if flash.contents().is_empty() {
            flash.store(&session.flash()?)?;
        }
        if let Some(scenario) = scenario {
            session.befall(scenario, &loaded.scene)?;
        }
        let boards = Boards::One(session, flash);
        Ok(Self { loaded, boards })
    }

    pub(super) fn head(loaded: Loaded, program: &Path) -> Result<Self, Error> {
        let boards = Boards::Head(HeadSession::new(&loaded.scene, program)?);
        Ok(Self { loaded, boards })
    }
}

impl Source for Emulated {
    fn next(&mut self) -> Result<Incoming, Error> {
        let (packets, lines) = match &mut self.boards {
            Boards::One(board, _) => {
                board.tick()?;
                (board.packets()?, board.log())
            }
            Boards::Head(head) => {
                head.tick()?;
                (head.packets()?, head.log()?)
            }
        };
        Ok(Incoming {
            packets,
            lines,
            ..Incoming::default()
        })
    }

    fn request(&mut self, node: Option<u8>, request: TaggedCommand) -> Result<(), Error> {
        let (has_room, fault) = match &mut self.boards {
            Boards::One(board, _) => (
                node.map_or_else(|| board.request(request), |node| Err(no_board(node)))?,
                "the board takes no requests; has its scene telemetry.rtt = false?",
            ),
            Boards::Head(head) => (
                head.request(node, request)?,
                "the board has no room for more requests",
            ),
        };
        let room = has_room.then_some(());
        room.ok_or_else(|| Error::Work(fault.to_owned()))
    }

    fn scene(&self) -> Option<&Scene> {
        Some(&self.loaded.scene)
    }

    fn lay(&mut self, sample: &str) -> Result<(), Error> {
        let texture = texture(sample, &self.loaded.scene, "")?;
        match &mut self.boards {
            Boards::One(board, _) => board.lay(texture),
            Boards::Head(head) => head.lay(texture),
        }
        Ok(())
    }

    fn is_laid(&mut self) -> Result<bool, Error> {
        Ok(match &self.boards {
            Boards::One(board, _) => board.is_laid(),
            Boards::Head(head) => head.is_laid(),
        })
    }

    fn now_s(&mut self) -> f64 {
        match &mut self.boards {
            Boards::One(board, _) => board.now_s(),
            Boards::Head(head) => head.now_s(),
        }
    }

    fn origin(&self) -> Origin {
        let board = match &self.boards {
            Boards::One(board, _) => board.board(),
            Boards::Head(head) => head.board(),
        };
        Origin::default().with("board", format_args!("{board} (emulated)"))
    }

    fn would_answer(&self, links: Links) -> Result<(), Error> {
        by_probe(links)
    }

    fn loads(&mut self, loads: bool) -> Result<(), Error> {
        // Those of a head always may be reset.
        if let Boards::One(board, flash) = &mut self.boards {
            board.bear_resets(loads);
            if !loads {
                flash.store(&board.flash()?)?;
            }
        }
        Ok(())
    }
}
