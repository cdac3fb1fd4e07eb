//! A model to a board whose loader writes it, by requests in the memory that a probe writes.

use host_sim::Error;
use wire::{Answer, Command, CommandStatus, Packet, TaggedCommand, load_order};

use crate::session::Session;

/// Ticks that an answer may take, as flash that is erased takes a second; and that a board waits
/// for more.
const PATIENCE: u32 = 10_000;

/// Asks for something, and waits for the answer.
pub(crate) fn ask(session: &mut Session, command: Command) -> Result<Answer, Error> {
    if !session.request(TaggedCommand { tag: 1, command })? {
        return Err(Error::Work(format!("{command:?}: no room for it")));
    }
    for _ in 0..PATIENCE {
        session.tick()?;
        for packet in session.packets()? {
            if let Packet::Answer(answer) = packet
                && answer.command == command.number()
            {
                return Ok(answer);
            }
        }
    }
    Err(Error::Work(format!("{command:?}: no answer")))
}

/// Asks for something, which must become of it.
pub(crate) fn must(
    session: &mut Session,
    command: Command,
    status: CommandStatus,
) -> Result<(), Error> {
    let found = ask(session, command)?.status;
    if found == status {
        return Ok(());
    }
    Err(Error::Work(format!(
        "{command:?}: found {found:?}, expected {status:?}"
    )))
}

/// Has a board whose motors are off load `model`, of which only so many `words` come: then
/// nobody asks for anything any more, and it starts anew by itself.
///
/// # Errors
/// [`Error::Work`] if it refuses, drives a motor meanwhile, or does not start.
pub(crate) fn load(session: &mut Session, model: &[u8], words: usize) -> Result<(), Error> {
    let all = model.as_chunks::<4>().0;
    let count = all.len() as u32;
    session.bear_resets(true);
    must(session, Command::Load(count), CommandStatus::Done)?;
    for number in (0..count).take(words) {
        let word = all.get(load_order(number, count) as usize);
        let word = word.map_or(0, |word| u32::from_le_bytes(*word));
        let command = Command::Word(number as u8, word);
        must(session, command, CommandStatus::Done)?;
        if number == 0 {
            // Its answer was lost, and then one of a word that is not next.
            must(session, command, CommandStatus::Done)?;
            let other = Command::Word(number as u8, !word);
            must(session, other, CommandStatus::OutOfRange)?;
            must(session, Command::Arm, CommandStatus::NotHere)?;
        }
    }
    if session.drives() {
        let fault = "a motor is driven while a model is loaded";
        return Err(Error::Work(fault.to_owned()));
    }
    if words >= all.len() {
        must(session, Command::Restart, CommandStatus::Done)?;
    }
    for _ in 0..PATIENCE {
        session.tick()?;
        if session.was_reset() {
            session.bear_resets(false);
            return Ok(());
        }
    }
    let fault = "a board whose model was not loaded whole does not start anew";
    Err(Error::Work(fault.to_owned()))
}
