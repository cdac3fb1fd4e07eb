//! A scene and its model to a board whose loader writes them, by requests.

use firmware::{ConfigError, refusal_code};
use host_sim::Error;
use wire::{Command, CommandStatus};

use crate::deployment::{Deployment, staged};
use crate::session::{PATIENCE, Session};
use crate::talk::wrong;

/// Sends a configuration that the board puts aside, and must refuse for this reason; nothing is
/// written.
pub(crate) fn refuses(
    session: &mut Session,
    config: &[u8],
    error: ConfigError,
) -> Result<(), Error> {
    for command in staged(config) {
        if !matches!(command, Command::Apply(_)) {
            session.must(command, CommandStatus::Done)?;
            continue;
        }
        let answer = session.ask(command)?;
        if answer.status != CommandStatus::OutOfRange || answer.values != refusal_code(error) {
            return wrong(format!("not refused ({error}): {answer:?}"));
        }
    }
    Ok(())
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
            return wrong("a board arms its motors by itself after a reset");
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
        return wrong("a motor is driven while a scene is loaded");
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
    wrong("a board does not start again after loading")
}
