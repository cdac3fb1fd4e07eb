//! A scene and its model to a board whose loader writes them, by requests.

use firmware::{ConfigError, Packet, refusal_code};
use host_sim::Error;
use wire::{Answer, Command, CommandStatus, TaggedCommand};

use crate::deployment::{Deployment, words};
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

/// Sends a configuration that the board puts aside, and must refuse for this reason; nothing is
/// written.
///
/// # Errors
/// [`Error::Work`] if it does not.
pub(crate) fn refuses(
    session: &mut Session,
    config: &[u8],
    error: ConfigError,
) -> Result<(), Error> {
    must(session, Command::Forget, CommandStatus::Done)?;
    for (number, word) in words(config).into_iter().enumerate() {
        let stage = Command::Stage(number as u8, word);
        must(session, stage, CommandStatus::Done)?;
    }
    let answer = ask(session, Command::Apply(config.len() as u32))?;
    if answer.status == CommandStatus::OutOfRange && answer.values == refusal_code(error) {
        return Ok(());
    }
    Err(Error::Work(format!("not refused ({error}): {answer:?}")))
}

/// Has a board whose motors are off load a scene and its model, of which only so many `words`
/// come: then there are no more requests, and it starts again by itself.
///
/// # Errors
/// [`Error::Work`] if it refuses, drives a motor meanwhile, or does not start.
pub(crate) fn load(session: &mut Session, what: &Deployment, words: usize) -> Result<(), Error> {
    load_watched(session, what, words, |_, _| Ok(()))
}

/// The same; `watch` looks at it after each word, with the number of those that were written.
///
/// # Errors
/// As [`load`], and what `watch` says.
pub(crate) fn load_watched(
    session: &mut Session,
    what: &Deployment,
    words: usize,
    mut watch: impl FnMut(&mut Session, usize) -> Result<(), Error>,
) -> Result<(), Error> {
    let count = what.load().words() as usize;
    session.bear_resets(true);
    must(session, Command::Load(what.load()), CommandStatus::Done)?;
    watch(session, 0)?;
    for (number, word) in what.words().take(words).enumerate() {
        let command = Command::Word(number as u8, word);
        must(session, command, CommandStatus::Done)?;
        if number == 0 {
            // Its answer was lost, and then one of a word that is not next.
            must(session, command, CommandStatus::Done)?;
            let other = Command::Word(number as u8, !word);
            must(session, other, CommandStatus::OutOfRange)?;
            must(session, Command::Arm, CommandStatus::NotHere)?;
        }
        watch(session, number + 1)?;
    }
    if session.drives() {
        let fault = "a motor is driven while a scene is loaded";
        return Err(Error::Work(fault.to_owned()));
    }
    if words >= count {
        must(session, Command::Restart, CommandStatus::Done)?;
    }
    for _ in 0..PATIENCE {
        session.tick()?;
        if session.was_reset() {
            session.bear_resets(false);
            return Ok(());
        }
    }
    let fault = "a board does not start again after loading";
    Err(Error::Work(fault.to_owned()))
}
