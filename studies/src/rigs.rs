//! The rigs of the five papers: where whiskers are fixed, how they are moved,
//! and what is before them. A rig is a file of its own, `studies/rigs/*.toml`, whose
//! keys are documented there; what runs on it is in [`crate::experiment`].

mod chance;
mod corridor;
mod floor;
mod frame;
mod head;
mod maze;
mod module;
mod overlay;
mod pad;
mod read;
mod setting;
mod surfaces;
mod table;

use std::path::Path;

pub(crate) use chance::{Chance, seed_of};
pub(crate) use corridor::{Corridor, Robot};
pub(crate) use floor::{Floor, RobotMotion};
pub(crate) use head::{CHANNELS, Visit, WhiskingHead};
pub(crate) use maze::{Made, Maze, Wall};
pub(crate) use pad::{Layout, Pad, Vibrissa, panned};
pub(crate) use read::load;
pub(crate) use setting::Setting;
pub(crate) use surfaces::Surfaces;
pub(crate) use table::{Carriage, Table, facing};

use host_sim::Error;

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rigs {
    /// LEP10 and LEP12.
    pub(crate) floor: Floor,
    /// BIOTACT.
    pub(crate) head: WhiskingHead,
    /// POSE.
    pub(crate) table: Table,
    /// PSIK, fixed head.
    pub(crate) pad: Pad,
    /// PSIK, mobile robot.
    pub(crate) corridor: Corridor,
    /// PSIK, the mobile robot's maze.
    pub(crate) maze: Maze,
    /// What is before them.
    pub(crate) surfaces: Surfaces,
}

fn names_in(folder: &Path) -> Result<Vec<String>, Error> {
    let wrong = |error| Error::file(folder, error);
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(wrong)? {
        let name = entry.map_err(wrong)?.file_name();
        let name = name.to_string_lossy().into_owned();
        if Path::new(&name).extension() == Some("toml".as_ref()) {
            names.push(name);
        }
    }
    Ok(names)
}

impl Rigs {
    /// The rigs that are built in, with what files in `folder` say, and `settings` after them.
    pub(crate) fn load(folder: Option<&Path>, settings: &[Setting]) -> Result<Self, Error> {
        const NAMES: [&str; 7] = [
            "floor", "head", "table", "pad", "corridor", "maze", "surfaces",
        ];
        let is_known = |setting: &&Setting| NAMES.contains(&setting.rig());
        if let Some(unknown) = settings.iter().find(|setting| !is_known(setting)) {
            return Err(Error::Input(format!(
                "{}: unknown rig, allowed: {}",
                unknown.rig(),
                NAMES.join(", ")
            )));
        }
        for name in folder.map(names_in).transpose()?.unwrap_or_default() {
            if !NAMES.contains(&name.trim_end_matches(".toml")) {
                let fault = format!("{name} is no rig, allowed: {}", NAMES.join(", "));
                return Err(Error::file(folder.unwrap_or(Path::new("")), fault));
            }
        }
        Ok(Self {
            floor: load(folder, settings)?,
            head: load(folder, settings)?,
            table: load(folder, settings)?,
            pad: load(folder, settings)?,
            corridor: load(folder, settings)?,
            maze: load(folder, settings)?,
            surfaces: load(folder, settings)?,
        })
    }
}
