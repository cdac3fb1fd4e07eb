//! A board of a head, asked by way of the one that this PC is connected to.

use std::time::Instant;

use firmware::Links;
use host_sim::Error;
use host_sim::origin::Origin;
use wire::TaggedCommand;

use super::{Incoming, Laying, Source};

pub(super) struct Elsewhere {
    by: Box<dyn Source>,
    node: u8,
    since: Instant,
}

impl Elsewhere {
    pub(super) fn new(by: Box<dyn Source>, node: u8) -> Self {
        Self {
            by,
            node,
            since: Instant::now(),
        }
    }
}

impl Source for Elsewhere {
    fn next(&mut self) -> Result<Incoming, Error> {
        let Incoming { packets, .. } = self.by.next()?;
        // Its lines are those of the board between.
        let lines = Vec::new();
        Ok(Incoming { packets, lines })
    }

    fn request(&mut self, request: TaggedCommand) -> Result<(), Error> {
        self.by.request_of(self.node, request)
    }

    fn request_of(&mut self, node: u8, request: TaggedCommand) -> Result<(), Error> {
        self.by.request_of(node, request)
    }

    fn node(&self) -> Option<u8> {
        Some(self.node)
    }

    fn laying(&mut self) -> Option<&mut Laying> {
        self.by.laying()
    }

    fn has(&self, sample: &str) -> Result<(), Error> {
        self.by.has(sample)
    }

    fn lay(&mut self, sample: &str) -> Result<(), Error> {
        self.by.lay(sample)
    }

    fn is_laid(&mut self) -> Result<bool, Error> {
        self.by.is_laid()
    }

    fn now_s(&mut self) -> f64 {
        if self.by.has_clock() {
            self.by.now_s()
        } else {
            // That is by the clock of the board between.
            self.since.elapsed().as_secs_f64()
        }
    }

    fn duration_s(&self) -> Option<f64> {
        self.by.duration_s()
    }

    fn origin(&self) -> Origin {
        self.by.origin().with("node", self.node)
    }

    fn would_answer(&self, _: Links) -> Result<(), Error> {
        Ok(())
    }
}
