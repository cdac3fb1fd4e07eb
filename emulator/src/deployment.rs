//! A scene and its model as a board has them: in its flash, put there as by a probe, or sent to it
//! word by word.

use std::path::Path;

use config::Image;
use firmware::Header;
use firmware::boards::{BoardFacts, SlotHeader};
use host_sim::Error;
use host_sim::loaded::Loaded;
use scene::Scene;
use tactile::ModelBuf;
use wire::{Command, Load, LoadedWord};

use crate::program::Program;

#[derive(Debug, Clone)]
pub(crate) struct Deployment {
    pub(crate) config: Vec<u8>,
    pub(crate) model: Vec<u8>,
}

pub(crate) fn flashed(scene: &Path, program: &Path) -> Result<(Loaded, Program), Error> {
    let loaded = Loaded::new(scene)?;
    let program = flashed_for(&loaded, program)?;
    Ok((loaded, program))
}

/// A program as it is flashed for a scene: one that brings none with it has this one in its first
/// slot.
pub(crate) fn flashed_for(loaded: &Loaded, program: &Path) -> Result<Program, Error> {
    let mut program = Program::load(program)?;
    program.check_of(&loaded.scene)?;
    if !program.brings_scene()? {
        let facts = program.model()?.facts;
        Deployment::of(&loaded.scene, loaded.model(), facts)?.flash(&mut program)?;
    }
    Ok(program)
}

pub(crate) fn image(
    scene: &Scene,
    model: Option<&ModelBuf>,
    facts: &BoardFacts,
) -> Result<Image, Error> {
    let image = config::image(scene, model, facts, "");
    image.map_err(|misfit| Error::Work(format!("{}: {misfit}", scene.name)))
}

impl Deployment {
    pub(crate) fn of(
        scene: &Scene,
        model: Option<&ModelBuf>,
        facts: &BoardFacts,
    ) -> Result<Self, Error> {
        Ok(Self {
            config: image(scene, model, facts)?.bytes.to_vec(),
            model: model.map_or(&[][..], ModelBuf::as_bytes).to_vec(),
        })
    }

    /// The CRC at the end of the model; 0: none.
    pub(crate) fn model_crc(&self) -> u32 {
        let crc = self.model.last_chunk();
        crc.map_or(0, |crc| u32::from_le_bytes(*crc))
    }

    pub(crate) fn flash(&self, program: &mut Program) -> Result<(), Error> {
        let [slot, _] = program.model()?.facts.flash.slots;
        let header = SlotHeader::linked(self.model_crc());
        program.add(slot.head.start, &header.bytes())?;
        program.add(slot.config().start, &self.config)?;
        Ok(program.add(slot.model.start, &self.model)?)
    }

    pub(crate) fn load(&self) -> Load {
        let [config, model] = [&self.config, &self.model].map(|bytes| words(bytes).len());
        Load {
            config: config as u16,
            model: model as u16,
        }
    }

    pub(crate) fn words(&self) -> impl Iterator<Item = u32> {
        let load = self.load();
        let [config, model] = [&self.config, &self.model].map(|bytes| words(bytes));
        (0..).map_while(move |number| match load.word(number)? {
            LoadedWord::Config(n) => config.get(usize::from(n)).copied(),
            LoadedWord::Model(n) => model.get(usize::from(n)).copied(),
        })
    }
}

pub(crate) fn crc_of(config: &[u8]) -> Result<u32, Error> {
    let header = Header::of(config).map_err(|fault| format!("the configuration: {fault}"));
    Ok(header.map_err(Error::Work)?.crc)
}

/// The requests by which a board is given a configuration: it is put aside, and then taken.
pub(crate) fn staged(config: &[u8]) -> impl Iterator<Item = Command> {
    let words = words(config).into_iter().enumerate();
    let words = words.map(|(number, word)| Command::Stage(number as u8, word));
    let apply = Command::Apply(config.len() as u32);
    [Command::Forget].into_iter().chain(words).chain([apply])
}

/// Little-endian words, with zeros at the end up to a whole pair, by which the flash of some
/// boards is written.
pub(crate) fn words(bytes: &[u8]) -> Vec<u32> {
    let mut padded = bytes.to_vec();
    padded.resize(bytes.len().next_multiple_of(8), 0);
    let (words, _) = padded.as_chunks();
    words.iter().map(|word| u32::from_le_bytes(*word)).collect()
}
