//! The rigs of the five papers: where whiskers are fixed, how they are moved,
//! and what is before them. A rig is a file of its own, `studies/rigs/*.toml`, whose
//! keys are documented there; what runs on it is in [`crate::experiment`].

mod chance;
mod corridor;
mod floor;
mod frame;
mod head;
mod module;
mod pad;
mod read;
mod table;

use std::path::Path;

pub use chance::{Chance, Wander, seed_of};
pub use corridor::{Corridor, Robot};
pub use floor::{Drive, Floor, RobotMotion};
pub use head::{CHANNELS, Felt, Visit, WhiskingHead};
pub use module::PositionControl;
pub use pad::{Layout, Pad, Sweep, Vibrissa, panned};
pub use read::{Keys, OutOfRange, Rig, load, parse};
pub use table::{Carriage, Table, facing};

use host_sim::Error;

/// All rigs.
#[derive(Debug, Clone, PartialEq)]
pub struct Rigs {
    /// LEP10 and LEP12.
    pub floor: Floor,
    /// BIOTACT.
    pub head: WhiskingHead,
    /// POSE.
    pub table: Table,
    /// PSIK, fixed head.
    pub pad: Pad,
    /// PSIK, mobile robot.
    pub corridor: Corridor,
}

impl Rigs {
    /// The rigs in `folder`, or those built in.
    ///
    /// # Errors
    /// [`Error::Input`] names the file, the line and the key.
    pub fn load(folder: Option<&Path>) -> Result<Self, Error> {
        Ok(Self {
            floor: load(folder)?,
            head: load(folder)?,
            table: load(folder)?,
            pad: load(folder)?,
            corridor: load(folder)?,
        })
    }
}
