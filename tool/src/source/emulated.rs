//! A board's own program on an emulated chip.

use std::path::Path;

use emulator::head::HeadSession;
use emulator::session::Session;
use firmware::Links;
use host_sim::Error;
use host_sim::loaded::Loaded;
use host_sim::origin::Origin;
use wire::TaggedCommand;

use super::flash::Flash;
use super::texture::texture;
use super::{Incoming, Source, by_probe};
use crate::deployment::Deployment;
use crate::loading::load;

pub(super) struct Emulated {
    loaded: Loaded,
    session: Session,
    flash: Flash,
}

impl Emulated {
    pub(super) fn open(
        loaded: Loaded,
        program: &Path,
        flash: Flash,
        scenario: Option<&Path>,
    ) -> Result<Self, Error> {
        let mut flash = flash;
        let mut session = Session::flashed(&loaded.scene, program, flash.contents())?;
        if flash.contents().is_empty() {
            flash.store(&session.flash()?)?;
        }
        if let Some(scenario) = scenario {
            session.befall(scenario, &loaded.scene)?;
        }
        Ok(Self {
            loaded,
            session,
            flash,
        })
    }
}

impl Source for Emulated {
    fn next(&mut self) -> Result<Incoming, Error> {
        self.session.tick()?;
        Ok(Incoming {
            packets: self.session.packets()?,
            lines: self.session.log(),
        })
    }

    fn request(&mut self, request: TaggedCommand) -> Result<(), Error> {
        if self.session.request(request)? {
            return Ok(());
        }
        let fault = "the board takes no requests; has its scene telemetry.rtt = false?";
        Err(Error::Work(fault.to_owned()))
    }

    fn has(&self, sample: &str) -> Result<(), Error> {
        texture(sample, &self.loaded.scene).map(drop)
    }

    fn lay(&mut self, sample: &str) -> Result<(), Error> {
        self.session.lay(texture(sample, &self.loaded.scene)?);
        Ok(())
    }

    fn is_laid(&mut self) -> Result<bool, Error> {
        Ok(self.session.is_laid())
    }

    fn now_s(&mut self) -> f64 {
        self.session.now_s()
    }

    fn duration_s(&self) -> Option<f64> {
        Some(self.loaded.scene.duration_s)
    }

    fn origin(&self) -> Origin {
        let board = self.session.board();
        Origin::default().with("board", format_args!("{board} (emulated)"))
    }

    fn would_answer(&self, links: Links) -> Result<(), Error> {
        by_probe(links)
    }

    fn deploy(&mut self, what: &Deployment) -> Result<(), Error> {
        self.session.bear_resets(true);
        let loaded = load(self, what);
        self.session.bear_resets(false);
        self.flash.store(&self.session.flash()?)?;
        loaded
    }
}

/// The boards of a head, of which the first is talked with.
pub(super) struct EmulatedHead {
    loaded: Loaded,
    session: HeadSession,
}

impl EmulatedHead {
    pub(super) fn open(loaded: Loaded, program: &Path) -> Result<Self, Error> {
        let session = HeadSession::new(&loaded.scene, program)?;
        Ok(Self { loaded, session })
    }

    fn ask(&mut self, node: Option<u8>, request: TaggedCommand) -> Result<(), Error> {
        if self.session.request(node, request)? {
            return Ok(());
        }
        let fault = "the board has no room for more requests";
        Err(Error::Work(fault.to_owned()))
    }
}

impl Source for EmulatedHead {
    fn next(&mut self) -> Result<Incoming, Error> {
        self.session.tick()?;
        Ok(Incoming {
            packets: self.session.packets()?,
            lines: self.session.log()?,
        })
    }

    fn request(&mut self, request: TaggedCommand) -> Result<(), Error> {
        self.ask(None, request)
    }

    fn request_of(&mut self, node: u8, request: TaggedCommand) -> Result<(), Error> {
        self.ask(Some(node), request)
    }

    fn has(&self, sample: &str) -> Result<(), Error> {
        texture(sample, &self.loaded.scene).map(drop)
    }

    fn lay(&mut self, sample: &str) -> Result<(), Error> {
        self.session.lay(texture(sample, &self.loaded.scene)?);
        Ok(())
    }

    fn is_laid(&mut self) -> Result<bool, Error> {
        Ok(self.session.is_laid())
    }

    fn now_s(&mut self) -> f64 {
        self.session.now_s()
    }

    fn duration_s(&self) -> Option<f64> {
        Some(self.loaded.scene.duration_s)
    }

    fn origin(&self) -> Origin {
        let board = self.session.board();
        Origin::default().with("board", format_args!("{board} (emulated)"))
    }

    fn would_answer(&self, links: Links) -> Result<(), Error> {
        by_probe(links)
    }
}
