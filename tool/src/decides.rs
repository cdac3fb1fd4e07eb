//! By which model a module decides.

use firmware::Refusal;
use host_sim::Error;
use tactile::ModelBuf;
use wire::{Command, CommandStatus};

use crate::conversation::Conversation;

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

impl std::fmt::Display for Decides {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
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
