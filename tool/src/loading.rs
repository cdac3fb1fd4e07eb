//! A scene and its model to a board whose own program writes them: by whatever its requests go.

use std::time::Duration;

use firmware::Part;
use host_sim::Error;
use wire::{Command, CommandStatus, Load, LoadedWord};

use crate::configuration::not_built;
use crate::conversation::Conversation;
use crate::deployment::Deployment;

/// After so long without its answer a word is sent again, which changes nothing.
const AGAIN: Duration = Duration::from_secs(1);
const TIMES: usize = 10;
/// How long flash may take to be erased, and a board to start; an emulated one has its own time.
const LONG: Duration = Duration::from_secs(20);

/// Asks for what can be asked more than once; it must be done.
fn done(
    module: &mut Conversation,
    command: Command,
    times: usize,
    patience: Duration,
) -> Result<(), Error> {
    for _ in 0..times {
        if let Some(answer) = module.ask_within(command, patience)? {
            return match answer.status {
                CommandStatus::Done => Ok(()),
                status => Err(refused(command, status)),
            };
        }
    }
    let fault = "the board does not answer any more; switch it off and on, and deploy again";
    Err(Error::Work(fault.to_owned()))
}

fn refused(command: Command, status: CommandStatus) -> Error {
    let why = match (command, status) {
        (Command::Load(_), CommandStatus::NotHere) => return not_built(Part::Deploy),
        (Command::Load(_), CommandStatus::OutOfRange) => "its flash has no room for so much",
        (Command::Word(..), CommandStatus::NotHere) => {
            "the board waited two seconds for the rest, and runs by the scene before; deploy again"
        }
        (_, CommandStatus::NotWritten) => "its flash did not take what was written; try again",
        _ => return Error::Work(format!("{}: {status}", command.name())),
    };
    Error::Work(why.to_owned())
}

/// Writes a scene and its model where the module looks for them, and has it start by them; comes
/// back once it has. Its motors are off already.
pub(crate) fn deploy(module: &mut Conversation, what: &Deployment) -> Result<(), Error> {
    if module.source().deploy(what)? {
        return Ok(());
    }
    module.source().loads(true)?;
    let loaded = load(module, what);
    module.source().loads(false)?;
    loaded
}

/// Has the board erase the slot that it does not run by, write a scene and its model there, and
/// start by them; comes back once it answers again. Interrupted, it leaves the board the scene
/// before.
fn load(module: &mut Conversation, what: &Deployment) -> Result<(), Error> {
    let [config, model] = what.words();
    let count = |words: &[u32]| {
        let fault = |_| Error::Work("the model is longer than any board's flash".to_owned());
        u16::try_from(words.len()).map_err(fault)
    };
    let load = Load {
        config: count(&config)?,
        model: count(&model)?,
    };
    done(module, Command::Load(load), 1, LONG)?;
    let words = (0..).map_while(|number| {
        let word = match load.word(number)? {
            LoadedWord::Config(n) => config.get(usize::from(n)),
            LoadedWord::Model(n) => model.get(usize::from(n)),
        };
        Some((number as u8, *word?))
    });
    for (number, word) in words {
        done(module, Command::Word(number, word), TIMES, AGAIN)?;
    }
    // The answer may be lost with the reset.
    module.ask_within(Command::Restart, AGAIN)?;
    if module.node().is_none() {
        module.source().speaks(what.config.links)?;
    }
    let times = LONG.as_secs() / AGAIN.as_secs();
    done(module, Command::Hello, times as usize, AGAIN)
}

#[cfg(test)]
mod tests;
