//! A scene and its model to a board whose loader writes them, by requests.

use firmware::{ConfigError, refusal_code};
use host_sim::Error;
use wire::{Command, CommandStatus};

use crate::deployment::{Deployment, words};
use crate::session::{PATIENCE, Session};

/// Sends a configuration that the board puts aside, and must refuse for this reason; nothing is
/// written.
pub(crate) fn refuses(
    session: &mut Session,
    config: &[u8],
    error: ConfigError,
) -> Result<(), Error> {
    session.must(Command::Forget, CommandStatus::Done)?;
    for (number, word) in words(config).into_iter().enumerate() {
        let stage = Command::Stage(number as u8, word);
        session.must(stage, CommandStatus::Done)?;
    }
    let answer = session.ask(Command::Apply(config.len() as u32))?;
    if answer.status == CommandStatus::OutOfRange && answer.values == refusal_code(error) {
        return Ok(());
    }
    Err(Error::Work(format!("not refused ({error}): {answer:?}")))
}

/// Has a board whose motors are off load a scene and its model, of which only so many `words`
/// come: then there are no more requests, and it starts again by itself. Then somebody arms it.
pub(crate) fn load(session: &mut Session, what: &Deployment, words: usize) -> Result<(), Error> {
    load_watched(session, what, words, |_, _| Ok(()))
}

/// Ticks for which a board that was reset drives nothing before it is armed.
const WAITS: u32 = 200;

fn arm(session: &mut Session) -> Result<(), Error> {
    for _ in 0..WAITS {
        session.tick()?;
        if session.drives() {
            let fault = "a board arms its motors by itself after a reset";
            return Err(Error::Work(fault.to_owned()));
        }
    }
    session.must(Command::Arm, CommandStatus::Done)
}

/// As [`load`]; `watch` looks at it after each word, with the number of those that were written.
pub(crate) fn load_watched(
    session: &mut Session,
    what: &Deployment,
    words: usize,
    mut watch: impl FnMut(&mut Session, usize) -> Result<(), Error>,
) -> Result<(), Error> {
    let count = what.load().words() as usize;
    session.bear_resets(true);
    session.must(Command::Load(what.load()), CommandStatus::Done)?;
    watch(session, 0)?;
    for (number, word) in what.words().take(words).enumerate() {
        let command = Command::Word(number as u8, word);
        session.must(command, CommandStatus::Done)?;
        if number == 0 {
            // Its answer was lost, and then one of a word that is not next.
            session.must(command, CommandStatus::Done)?;
            let other = Command::Word(number as u8, !word);
            session.must(other, CommandStatus::OutOfRange)?;
            session.must(Command::Arm, CommandStatus::NotHere)?;
        }
        watch(session, number + 1)?;
    }
    if session.drives() {
        let fault = "a motor is driven while a scene is loaded";
        return Err(Error::Work(fault.to_owned()));
    }
    if words >= count {
        session.must(Command::Restart, CommandStatus::Done)?;
    }
    for _ in 0..PATIENCE {
        session.tick()?;
        if session.was_reset() {
            session.bear_resets(false);
            return arm(session);
        }
    }
    let fault = "a board does not start again after loading";
    Err(Error::Work(fault.to_owned()))
}
