//! Asks a module which scene it runs and by which configuration, and sends it another one.

use firmware::{ConfigError, VERSION, refusal_of};
use host_sim::Error;
use tactile::ModelBuf;
use wire::{CONFIG_CHANGED, Command, CommandStatus, HAS_OPINIONS};

use crate::configuration::{Program, Running, RunsBy, builds};
use crate::conversation::Conversation;
use crate::deployment::Deployment;

/// What has become of a configuration that was sent to a module.
pub(crate) enum Taken {
    Runs,
    Refused(ConfigError),
    /// Its image was built without taking any ([`firmware::Part::Set`]).
    NotBuilt,
}

impl Program {
    pub(crate) fn ask(module: &mut Conversation) -> Result<Self, Error> {
        let answer = module.answer(Command::Board)?;
        let [program, version] = answer.values;
        if answer.status != CommandStatus::Done || version as u16 != VERSION {
            return Err(Error::Work(format!(
                "the module's program does not take scenes of version {VERSION}: whisker flash \
                 gives it one that does"
            )));
        }
        let [board, format, ..] = program.to_le_bytes();
        Self::of(board, format)
    }
}

impl RunsBy {
    pub(crate) fn ask(module: &mut Conversation) -> Result<Self, Error> {
        let [crc, second] = module.ask(Command::Scene)?.values;
        if second < 0 {
            return Ok(Self::Nothing(-second));
        }
        Ok(Self::Scene {
            name: module.about()?.scene,
            crc: crc.cast_unsigned(),
            length: (second & (CONFIG_CHANGED - 1)).unsigned_abs() as usize,
            has_changed: second & CONFIG_CHANGED != 0,
        })
    }
}

impl Running {
    pub(crate) fn ask(module: &mut Conversation) -> Result<Self, Error> {
        let runs_by = RunsBy::ask(module)?;
        let RunsBy::Scene { crc, length, .. } = runs_by else {
            return Err(Error::Work(format!(
                "the module {runs_by}; whisker deploy --scene FILE gives it one"
            )));
        };
        let mut bytes = Vec::with_capacity(length);
        for word in (0..length.div_ceil(4)).step_by(2) {
            let two = module.ask(Command::Config(word as u32))?.values;
            bytes.extend(two.map(i32::to_le_bytes).as_flattened());
        }
        bytes.truncate(length);
        let found = Self::of(bytes)?;
        if found.crc == crc {
            return Ok(found);
        }
        let fault = "somebody else sets keys in the module meanwhile; try again";
        Err(Error::Work(fault.to_owned()))
    }

    /// Has a module go on by it, between two ticks.
    pub(crate) fn send(&self, module: &mut Conversation) -> Result<Taken, Error> {
        let first = module.answer(Command::Forget)?;
        match first.status {
            CommandStatus::Done => {}
            CommandStatus::NotHere => return Ok(Taken::NotBuilt),
            status => return Err(Error::Work(format!("the module takes no scene: {status}"))),
        }
        // Zeros follow the last byte.
        let mut bytes = self.bytes().to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        for (number, word) in bytes.as_chunks().0.iter().enumerate() {
            module.ask(Command::Stage(number as u8, u32::from_le_bytes(*word)))?;
        }
        let answer = module.answer(Command::Apply(self.bytes().len() as u32))?;
        match (answer.status, refusal_of(answer.values)) {
            (CommandStatus::Done, _) => Ok(Taken::Runs),
            (CommandStatus::OutOfRange | CommandStatus::Armed, Some(refused)) => {
                Ok(Taken::Refused(refused))
            }
            (status, _) => Err(Error::Work(format!(
                "the module does not take the configuration: {status}"
            ))),
        }
    }
}

impl Deployment {
    /// Whether a module whose motors are off can read it: what its image was built without it
    /// refuses by name. Nothing is written. An image that takes no configuration so says it after
    /// its restart, and goes on by the scene before.
    pub(crate) fn try_out(&self, module: &mut Conversation) -> Result<(), Error> {
        if self.model.as_ref().is_some_and(ModelBuf::has_opinion) {
            let [_, flags] = module.ask(Command::Board)?.values;
            if flags & HAS_OPINIONS == 0 {
                let fault = "the model has a second opinion, and the module's image was built \
                             without: cargo xtask firmware --scene SCENE builds one for it";
                return Err(Error::Work(fault.to_owned()));
            }
        }
        let refused = match self.config.send(module)? {
            // Another scene is what a restart is for.
            Taken::Refused(ConfigError::Shape(_) | ConfigError::Armed(_))
            | Taken::Runs
            | Taken::NotBuilt => return Ok(()),
            Taken::Refused(refused) => refused,
        };
        let help = match refused {
            ConfigError::NotBuilt(part) => format!("; {}", builds(part)),
            _ => String::new(),
        };
        Err(Error::Work(format!(
            "the module refuses the scene: {refused}{help}; nothing was written"
        )))
    }
}
