//! A module for tests, which answers as a script says.

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

    fn origin(&self) -> Origin {
        Origin::default()
    }
}
