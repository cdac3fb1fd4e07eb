//! Which scene a module runs, as it says itself.

use std::fmt;

use firmware::{ConfigError, refusal_of};
use host_sim::Error;

use super::Running;

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
                write!(f, "runs scene {name} ({crc:08x})")?;
                f.write_str(if *has_changed {
                    ", with keys that were set"
                } else {
                    ""
                })
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
