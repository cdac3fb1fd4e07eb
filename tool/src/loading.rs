//! A model to a board whose own program writes it: by whatever its requests go.

use std::time::{Duration, Instant};

use host_sim::Error;
use tactile::ModelBuf;
use wire::{Answer, Command, CommandStatus, Packet, TaggedCommand, load_order};

use crate::source::Source;

/// After so long without its answer a word is sent again, which changes nothing.
const AGAIN: Duration = Duration::from_secs(1);

/// How often.
const TIMES: usize = 10;

/// How long flash may take to be erased, and a board to start; an emulated one has its own time.
const LONG: Duration = Duration::from_secs(20);

/// Tags of these requests begin here, beyond those of a conversation that has just begun.
const FIRST_TAG: u16 = 0x8000;

/// Requests without a conversation.
struct Asking<'s, S: ?Sized> {
    source: &'s mut S,
    tag: u16,
}

impl<S: Source + ?Sized> Asking<'_, S> {
    /// Sends a request; the answer, if there is one in time.
    fn ask(&mut self, command: Command, patience: Duration) -> Result<Option<Answer>, Error> {
        self.tag = self.tag.wrapping_add(1) | FIRST_TAG;
        let tag = self.tag;
        self.source.request(TaggedCommand { tag, command })?;
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

    /// The same for what can be asked more than once; it must be done.
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
        (Command::Load(_), CommandStatus::NotHere) => {
            "this board's program does not write its flash; that of a scene whose [classifier] has \
             no model does"
        }
        (Command::Load(_), CommandStatus::Unknown) => {
            "its firmware is older than this program: whisker flash"
        }
        (_, CommandStatus::NotWritten) => "its flash did not take what was written; try again",
        _ => return Error::Work(format!("{}: {status}", command.name())),
    };
    Error::Work(why.to_owned())
}

/// Has the board erase what it has, write the model, and start anew; comes back once it answers
/// again. Interrupted, it leaves a board without a model.
///
/// # Errors
/// [`Error::Work`] if it does not answer, or refuses.
pub(crate) fn load<S: Source + ?Sized>(source: &mut S, model: &ModelBuf) -> Result<(), Error> {
    // A model is whole words.
    let (words, _) = model.as_bytes().as_chunks::<4>();
    let count = words.len() as u32;
    let mut board = Asking {
        source,
        tag: FIRST_TAG,
    };
    board.done(Command::Load(count), 1, LONG)?;
    for number in 0..count {
        let word = words.get(load_order(number, count) as usize);
        let word = u32::from_le_bytes(*word.unwrap_or(&[0; 4]));
        board.done(Command::Word(number as u8, word), TIMES, AGAIN)?;
    }
    // The answer may be lost with the reset.
    board.ask(Command::Restart, AGAIN)?;
    let times = LONG.as_secs() / AGAIN.as_secs();
    board.done(Command::Hello, times as usize, AGAIN)
}
