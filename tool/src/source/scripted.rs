//! A module for tests, which answers as a script says.

use firmware::Packet;
use host_sim::Error;
use host_sim::origin::Origin;
use wire::{Answer, Command, CommandStatus, TaggedCommand};

use super::{Incoming, Source};
use crate::deployment::Deployment;

/// What becomes of a request; `None`: its answer is lost.
type Answering = Box<dyn FnMut(Command) -> Option<(CommandStatus, [i32; 2])>>;

/// A module that answers by this.
pub(crate) struct Scripted {
    answering: Answering,
    waiting: Vec<Packet>,
    now_s: f64,
}

impl Scripted {
    pub(crate) fn new(
        answering: impl FnMut(Command) -> Option<(CommandStatus, [i32; 2])> + 'static,
    ) -> Self {
        Self {
            answering: Box::new(answering),
            waiting: Vec::new(),
            now_s: 0.0,
        }
    }
}

impl Source for Scripted {
    fn next(&mut self) -> Result<Incoming, Error> {
        self.now_s += 0.1;
        Ok(Incoming {
            packets: std::mem::take(&mut self.waiting),
            lines: Vec::new(),
        })
    }

    fn request(&mut self, request: TaggedCommand) -> Result<(), Error> {
        let TaggedCommand { tag, command } = request;
        let answer = (self.answering)(command).map(|(status, values)| {
            Packet::Answer(Answer {
                sequence: 0,
                tag,
                command: command.number(),
                status,
                values,
            })
        });
        self.waiting.extend(answer);
        Ok(())
    }

    fn now_s(&mut self) -> f64 {
        self.now_s
    }

    fn duration_s(&self) -> Option<f64> {
        None
    }

    fn origin(&self) -> Origin {
        Origin::default()
    }

    fn deploy(&mut self, what: &Deployment) -> Result<(), Error> {
        crate::loading::load(self, what)
    }
}
