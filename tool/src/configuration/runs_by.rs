//! Which scene a module runs, and by which model it decides, as it says itself.

use std::fmt;

use firmware::{ConfigError, Refusal, refusal_of};
use host_sim::Error;
use tactile::ModelBuf;
use wire::{CONFIG_CHANGED, Command, CommandStatus};

use super::Running;
use crate::conversation::Conversation;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum RunsBy {
    Scene {
        name: String,
        crc: u32,
        length: usize,
        has_changed: bool,
    },
    /// None, for a reason of this number.
    Nothing(i32),
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

    /// Whether it is by this configuration, as it was deployed.
    pub(crate) fn is(&self, config: &Running) -> Result<(), Error> {
        match self {
            Self::Scene { crc, .. } if *crc == config.crc => Ok(()),
            _ => {
                let fault = "it does not run the scene that was written; its log says why";
                Err(Error::Work(fault.to_owned()))
            }
        }
    }
}

impl fmt::Display for RunsBy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene {
                name,
                crc,
                has_changed,
                ..
            } => {
                let more = has_changed.then_some(", with keys that were set");
                let more = more.unwrap_or_default();
                write!(f, "runs scene {name} ({crc:08x}){more}")
            }
            // A number alone says nothing of a part or a field.
            Self::Nothing(kind) => match refusal_of([*kind, 0]) {
                Some(why @ (ConfigError::Absent | ConfigError::Strange | ConfigError::Damaged)) => {
                    write!(f, "runs no scene: {why}")
                }
                _ => f.write_str("runs no scene: it refuses what was deployed; its log says why"),
            },
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Decides {
    By(u32, u32),
    /// None, for this reason.
    Not(u8),
}

impl Decides {
    pub(crate) fn ask(module: &mut Conversation) -> Result<Self, Error> {
        let answer = module.answer(Command::Model)?;
        let why = match answer.status {
            CommandStatus::Done => {
                let [crc, number] = answer.values;
                return Ok(if number > 0 {
                    Self::By(crc.cast_unsigned(), number.cast_unsigned())
                } else {
                    Self::Not(number.unsigned_abs() as u8)
                });
            }
            CommandStatus::NotHere => "its scene has no [classifier]",
            CommandStatus::Unknown => "its firmware is older than this program",
            _ => "it says so",
        };
        Err(Error::Work(format!("the module takes no model: {why}")))
    }

    pub(crate) fn is(self, model: &ModelBuf) -> Result<(), Error> {
        match self {
            Self::By(crc, _) if crc == model.crc() => Ok(()),
            Self::By(..) => Err(Error::Work(
                "it decides by another model than was written".to_owned(),
            )),
            Self::Not(_) => Err(Error::Work("it has refused the model".to_owned())),
        }
    }
}

impl fmt::Display for Decides {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::By(crc, classes) => write!(f, "decides by model {crc:08x}, {classes} classes"),
            Self::Not(code) => {
                let why = Refusal::from_code(*code).map(Refusal::text);
                let why = why.unwrap_or("for a reason that this program does not know");
                write!(f, "decides by no model: {why}")
            }
        }
    }
}
