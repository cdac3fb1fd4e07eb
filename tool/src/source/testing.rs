//! Modules for tests: one that answers as a script says, and one with something wrong on the way
//! to it.

use std::path::{Path, PathBuf};

use firmware::Packet;
use host_sim::Error;
use host_sim::origin::Origin;
use wire::{Answer, Command, CommandStatus, Flags, TaggedCommand, TickRecord};

use super::{Incoming, Source, SourceChoice};

pub(crate) fn record(sequence: u32, flags: Flags) -> TickRecord {
    TickRecord {
        sequence,
        flags,
        ..TickRecord::default()
    }
}

pub(crate) fn scene_file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../scenes")
        .join(name)
}

/// Arguments of a command, read from these words behind its name.
pub(crate) fn parsed<A: clap::Args>(words: &[&str]) -> A {
    #[derive(clap::Parser)]
    struct Line<A: clap::Args> {
        #[command(flatten)]
        arguments: A,
    }
    let words = ["whisker"].iter().chain(words);
    <Line<A> as clap::Parser>::parse_from(words).arguments
}

pub(crate) fn chosen(words: &[&str]) -> SourceChoice {
    parsed(words)
}

impl Incoming {
    pub(crate) fn of(packets: impl Into<Vec<Packet>>) -> Self {
        Self {
            packets: packets.into(),
            ..Self::default()
        }
    }
}

/// What becomes of a request; `None`: its answer is lost.
type Answering = Box<dyn FnMut(Command) -> Option<(CommandStatus, [i32; 2])>>;

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
        Ok(Incoming::of(std::mem::take(&mut self.waiting)))
    }

    fn request(&mut self, _: Option<u8>, request: TaggedCommand) -> Result<(), Error> {
        let TaggedCommand { tag, command } = request;
        let answer = (self.answering)(command).map(|(status, values)| Answer {
            sequence: 0,
            tag,
            command: command.number(),
            status,
            values,
        });
        self.waiting.extend(answer.map(Packet::Answer));
        Ok(())
    }

    fn now_s(&mut self) -> f64 {
        self.now_s
    }

    fn origin(&self) -> Origin {
        Origin::default()
    }
}

/// What becomes of a record at its time, s; false: it is lost.
pub(crate) type Alter = fn(&mut TickRecord, f64) -> bool;

/// What comes between a module and who listens.
#[derive(Clone, Copy)]
pub(crate) struct Around {
    /// How fast the clock beside it runs.
    pub(crate) clock: f64,
    /// When somebody says that the sample lies there; 0: it is laid by the world.
    pub(crate) laid_s: f64,
    /// How much comes at once, as on a PC that is busy.
    pub(crate) at_once: u32,
}

pub(crate) const GOOD: Around = Around {
    clock: 1.0,
    laid_s: 0.0,
    at_once: 1,
};

pub(crate) struct Altered {
    pub(crate) module: Box<dyn Source>,
    pub(crate) alter: Alter,
    pub(crate) around: Around,
}

impl Source for Altered {
    fn next(&mut self) -> Result<Incoming, Error> {
        let mut incoming = Incoming::default();
        for _ in 0..self.around.at_once {
            incoming.packets.extend(self.module.next()?.packets);
        }
        let t_s = self.module.now_s();
        incoming.packets.retain_mut(|packet| match packet {
            Packet::Record(record) => (self.alter)(record, t_s),
            Packet::Answer(_) | Packet::Event(_) => true,
        });
        Ok(incoming)
    }

    fn request(&mut self, node: Option<u8>, request: TaggedCommand) -> Result<(), Error> {
        self.module.request(node, request)
    }

    fn has(&self, sample: &str) -> Result<(), Error> {
        self.module.has(sample)
    }

    fn lay(&mut self, sample: &str) -> Result<(), Error> {
        self.module.lay(sample)
    }

    fn is_laid(&mut self) -> Result<bool, Error> {
        Ok(self.module.is_laid()? && self.module.now_s() >= self.around.laid_s)
    }

    fn is_laid_by_hand(&mut self) -> bool {
        self.around.laid_s > 0.0
    }

    fn now_s(&mut self) -> f64 {
        self.around.clock * self.module.now_s()
    }

    fn origin(&self) -> Origin {
        self.module.origin()
    }
}
