//! A scene and its model to a board whose own program writes them: by whatever its requests go.

use std::time::{Duration, Instant};

use firmware::{Packet, Part};
use host_sim::Error;
use wire::{Answer, Command, CommandStatus, Load, LoadedWord, TaggedCommand};

use crate::configuration::not_built;
use crate::deployment::Deployment;
use crate::source::Source;

/// After so long without its answer a word is sent again, which changes nothing.
const AGAIN: Duration = Duration::from_secs(1);

const TIMES: usize = 10;

/// How long flash may take to be erased, and a board to start; an emulated one has its own time.
const LONG: Duration = Duration::from_secs(20);

/// Tags of these requests begin here, beyond those of a conversation that has just begun.
const FIRST_TAG: u16 = 0x8000;

struct Asking<'s, S: ?Sized> {
    source: &'s mut S,
    tag: u16,
}

impl<S: Source + ?Sized> Asking<'_, S> {
    fn ask(&mut self, command: Command, patience: Duration) -> Result<Option<Answer>, Error> {
        self.tag = self.tag.wrapping_add(1) | FIRST_TAG;
        let tag = self.tag;
        self.source.request(None, TaggedCommand { tag, command })?;
        let begun = Instant::now();
        while begun.elapsed() < patience {
            let found = self.source.next()?.packets.into_iter().find_map(|packet| {
                let Packet::Answer(answer) = packet else {
                    return None;
                };
                (answer.tag == tag).then_some(answer)
            });
            if found.is_some() {
                return Ok(found);
            }
        }
        Ok(None)
    }

    /// Asks for what can be asked more than once; it must be done.
    fn done(&mut self, command: Command, times: usize, patience: Duration) -> Result<(), Error> {
        for _ in 0..times {
            if let Some(answer) = self.ask(command, patience)? {
                return match answer.status {
                    CommandStatus::Done => Ok(()),
                    status => Err(refused(command, status)),
                };
            }
        }
        let fault = "the board does not answer any more; switch it off and on, and deploy again";
        Err(Error::Work(fault.to_owned()))
    }
}

fn refused(command: Command, status: CommandStatus) -> Error {
    let why = match (command, status) {
        (Command::Load(_), CommandStatus::NotHere) => return not_built(Part::Deploy),
        (Command::Load(_), CommandStatus::OutOfRange) => "its flash has no room for so much",
        (_, CommandStatus::NotWritten) => "its flash did not take what was written; try again",
        _ => return Error::Work(format!("{}: {status}", command.name())),
    };
    Error::Work(why.to_owned())
}

/// Has the board erase the slot that it does not run by, write a scene and its model there, and
/// start by them; comes back once it answers again. Interrupted, it leaves the board the scene
/// before.
pub(crate) fn load<S: Source + ?Sized>(source: &mut S, what: &Deployment) -> Result<(), Error> {
    let [config, model] = what.words();
    let count = |words: &[u32]| {
        let fault = |_| Error::Work("the model is longer than any board's flash".to_owned());
        u16::try_from(words.len()).map_err(fault)
    };
    let load = Load {
        config: count(&config)?,
        model: count(&model)?,
    };
    let mut board = Asking {
        source,
        tag: FIRST_TAG,
    };
    board.done(Command::Load(load), 1, LONG)?;
    let words = (0..).map_while(|number| {
        let word = match load.word(number)? {
            LoadedWord::Config(n) => config.get(usize::from(n)),
            LoadedWord::Model(n) => model.get(usize::from(n)),
        };
        Some((number as u8, *word?))
    });
    for (number, word) in words {
        board.done(Command::Word(number, word), TIMES, AGAIN)?;
    }
    // The answer may be lost with the reset.
    board.ask(Command::Restart, AGAIN)?;
    board.source.speaks(what.config.links)?;
    let times = LONG.as_secs() / AGAIN.as_secs();
    board.done(Command::Hello, times as usize, AGAIN)
}

#[cfg(test)]
mod tests;
