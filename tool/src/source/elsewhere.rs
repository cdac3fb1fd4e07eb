//! A board of a head, asked by way of the one that this PC is connected to.

use std::time::Instant;

use host_sim::Error;
use host_sim::origin::Origin;
use scene::Scene;
use wire::{Command, TaggedCommand};

use super::{Incoming, Laying, Source};

/// For how long a board that sends records may be silent, s.
const SILENCE_S: f64 = 3.0;

pub(super) struct Elsewhere {
    by: Box<dyn Source>,
    node: u8,
    since: Instant,
    /// When something has come last, s, while it is to send records.
    came_s: Option<f64>,
}

impl Elsewhere {
    pub(super) fn new(by: Box<dyn Source>, node: u8) -> Self {
        Self {
            by,
            node,
            since: Instant::now(),
            came_s: None,
        }
    }
}

impl Source for Elsewhere {
    fn next(&mut self) -> Result<Incoming, Error> {
        let Incoming { packets, .. } = self.by.next()?;
        let now_s = self.now_s();
        if let Some(came_s) = &mut self.came_s {
            if !packets.is_empty() {
                *came_s = now_s;
            }
            if now_s - *came_s > SILENCE_S {
                let node = self.node;
                return Err(Error::Work(format!(
                    "board {node} has sent nothing for {SILENCE_S} s: has it lost its supply or its \
                     bus, or started again?"
                )));
            }
        }
        // Its lines are those of the board between.
        let lines = Vec::new();
        Ok(Incoming {
            packets,
            lines,
            ..Incoming::default()
        })
    }

    fn request(&mut self, node: Option<u8>, request: TaggedCommand) -> Result<(), Error> {
        if let (None, Command::Stream(on)) = (node, request.command) {
            self.came_s = on.then(|| self.now_s());
        }
        self.by.request(node.or(Some(self.node)), request)
    }

    fn node(&self) -> Option<u8> {
        Some(self.node)
    }

    fn laying(&mut self) -> Option<&mut Laying> {
        self.by.laying()
    }

    fn scene(&self) -> Option<&Scene> {
        self.by.scene()
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

    fn origin(&self) -> Origin {
        self.by.origin().with("node", self.node)
    }
}

#[cfg(test)]
mod tests {
    use wire::{Command, CommandStatus, TaggedCommand};

    use super::{Elsewhere, SILENCE_S, Source};
    use crate::source::Scripted;

    #[test]
    fn a_board_that_was_to_send_records_and_is_silent_has_gone() {
        let answering = |_| Some((CommandStatus::Done, [0; 2]));
        let mut source = Elsewhere::new(Box::new(Scripted::new(answering)), 1);
        let mut ask = |command, most_s: f64| {
            let request = TaggedCommand { tag: 1, command };
            source.request(None, request).unwrap();
            let begun_s = source.now_s();
            while source.now_s() - begun_s < most_s {
                if let Err(error) = source.next() {
                    return Some((source.now_s() - begun_s, error.to_string()));
                }
            }
            None
        };
        assert_eq!(ask(Command::Stream(false), 10.0), None);
        let (after_s, fault) = ask(Command::Stream(true), 10.0).unwrap();
        assert!((SILENCE_S..SILENCE_S + 0.4).contains(&after_s), "{after_s}");
        assert!(fault.contains("board 1 has sent nothing"), "{fault}");
        // What asks for something else waits for that by itself.
        assert_eq!(ask(Command::Stream(false), 10.0), None);
    }
}
