//! Where a module is that can be talked with.

mod choice;
mod emulated;
mod flash;
mod laying;
mod port;
mod program;
mod simulated;
#[cfg(test)]
mod testing;

pub(crate) use choice::{SourceChoice, seconds};
#[cfg(unix)]
pub(crate) use flash::Flash;
pub(crate) use laying::Laying;
pub(crate) use program::{Board, BoardName, build, is_of, with_scene, workspace};
pub(crate) use simulated::Simulated;
#[cfg(test)]
pub(crate) use testing::{
    Alter, Altered, Around, GOOD, Scripted, chosen, parsed, record, scene_file,
};

use firmware::{Links, Packet};
use host_sim::Error;
use host_sim::origin::Origin;
use scene::{PlantKind, Scene, Texture};
use wire::{TaggedCommand, TickRecord};

use crate::deployment::Deployment;

#[derive(Debug, Default)]
pub(crate) struct Incoming {
    pub(crate) packets: Vec<Packet>,
    pub(crate) lines: Vec<String>,
    /// Whether the module has started again before these, as far as its numbers do not say so.
    pub(crate) has_restarted: bool,
}

impl Incoming {
    pub(crate) fn records(&self) -> impl Iterator<Item = &TickRecord> + Clone {
        self.packets.iter().filter_map(|packet| match packet {
            Packet::Record(record) => Some(record),
            Packet::Answer(_) | Packet::Event(_) => None,
        })
    }
}

const NO_MOTOR: &str =
    "no motor turns a whisker where plant.kind is \"ideal\"; allowed: \"textured\" or \"whisker\"";

pub(crate) trait Source {
    /// Waits for what comes next, and takes it. Nothing may have come after a while.
    fn next(&mut self) -> Result<Incoming, Error>;

    /// Sends a request, whose answer is among what comes next; with a `node` for that board of its
    /// head.
    fn request(&mut self, node: Option<u8>, request: TaggedCommand) -> Result<(), Error>;

    /// Whether its log can be read; where not, what would help.
    fn has_log(&self) -> Result<(), Error> {
        Ok(())
    }

    /// Who lays samples on a real bench; none: its world is simulated, and does.
    fn laying(&mut self) -> Option<&mut Laying> {
        None
    }

    /// The scene in whose world it is; none: on a real bench.
    fn scene(&self) -> Option<&Scene> {
        None
    }

    /// Whether motors turn its whiskers.
    fn has_motors(&self) -> Result<(), String> {
        match self.scene() {
            Some(scene) if scene.plant.kind == PlantKind::Ideal => Err(NO_MOTOR.to_owned()),
            _ => Ok(()),
        }
    }

    /// Whether it has the sample of a label; on a real bench any name will do.
    fn has(&self, sample: &str) -> Result<(), Error> {
        let or = ", or LABEL=TEXTURE with one of them";
        let found = self.scene().map(|scene| texture(sample, scene, or));
        let found = found.transpose().map(drop);
        found.map_err(|fault| Error::Input(format!("--label: {fault}")))
    }

    /// Has a sample laid before the whisker, in place of what lies there.
    fn lay(&mut self, sample: &str) -> Result<(), Error> {
        self.laying().map_or(Ok(()), |laying| laying.lay(sample))
    }

    /// Whether it lies there. Does not wait.
    fn is_laid(&mut self) -> Result<bool, Error> {
        self.laying().map_or(Ok(true), Laying::is_laid)
    }

    /// Whether a person lays it, who takes their time and gets a message when it counts.
    fn is_laid_by_hand(&mut self) -> bool {
        self.laying().is_some()
    }

    /// The time where the module is, s.
    fn now_s(&mut self) -> f64;

    /// Whether that is by another clock than the module's own.
    fn has_clock(&self) -> bool {
        true
    }

    /// How long its scene lasts, s; none: until it is switched off.
    fn duration_s(&self) -> Option<f64> {
        self.scene().map(|scene| scene.duration_s)
    }

    fn origin(&self) -> Origin;

    /// Whether it could be talked with as here by a scene with these links; what would help.
    fn would_answer(&self, _: Links) -> Result<(), Error> {
        Ok(())
    }

    /// It has these links from now on.
    fn speaks(&mut self, _: Links) -> Result<(), Error> {
        Ok(())
    }

    /// Starts by a scene and its model; `false`: the program that is there has to write them.
    fn deploy(&mut self, _: &Deployment) -> Result<bool, Error> {
        Ok(false)
    }

    /// Its program is about to write them, or has.
    fn loads(&mut self, _: bool) -> Result<(), Error> {
        Ok(())
    }
}

pub(crate) fn framed(node: Option<u8>, request: TaggedCommand) -> Vec<u8> {
    match node {
        Some(node) => wire::frame_for(node, request.tag, request.command).to_vec(),
        None => wire::frame(&request).to_vec(),
    }
}

/// A sample in a simulated world, which is one of the scene's textures, `or` what else is allowed.
pub(crate) fn texture(sample: &str, scene: &Scene, or: &str) -> Result<Texture, Error> {
    let Some(textured) = &scene.plant.textured else {
        let fault = "the scene has no textures to lay before the whisker; allowed: plant.kind = \
                     \"textured\" or \"whisker\", with plant.textures, or --world SCENE with such \
                     a scene";
        return Err(Error::Input(fault.to_owned()));
    };
    let mut known = textured.textures.iter();
    let found = known.find(|texture| texture.name() == sample);
    found.copied().ok_or_else(|| {
        let names: Vec<_> = textured.textures.iter().map(|of| of.name()).collect();
        Error::Input(format!(
            "found {sample:?}, which is none of the scene's textures; allowed: {}{or}",
            names.join(", ")
        ))
    })
}

fn no_board(node: u8) -> Error {
    Error::Input(format!("--node: found {node}; allowed: a board of a head"))
}

/// Whether a probe can talk with a module of these links.
pub(crate) fn by_probe(links: Links) -> Result<(), Error> {
    let fault = "telemetry.rtt: found false; the module could not be asked any more by what is \
                 asked here: take that line out";
    let can = links.has_rtt.then_some(());
    can.ok_or_else(|| Error::Input(fault.to_owned()))
}
