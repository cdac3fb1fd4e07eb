//! What the variants are measured on: a robot's vibration over three grounds
//! (`tests/data/terrain`) and the whisker of `scenes/textures.toml`. Each is
//! learnt from one recording and heard on another.

use std::path::Path;

use scene::Scene;
use tactile::reference::Reference;
use tactile::train::{Options, Trainer};
use tactile::{Model, ModelBuf};

use super::likelihoods::{Bins, likelihoods};
use super::measure::About;
use host_sim::Error;
use host_sim::commands::main_job;
use host_sim::progress::Verbosity;
use host_sim::recording::{self, Stream};

/// x and y.
pub(super) const CHANNELS: usize = 2;

/// A stream that is classified.
pub(super) struct Heard {
    /// Its true class.
    pub(super) class: usize,
    /// Samples as recorded, for the yardstick.
    pub(super) samples: Vec<[f64; CHANNELS]>,
    /// The same as codes, for the product.
    pub(super) codes: Vec<[i32; CHANNELS]>,
    /// The same as bins, for the variants.
    pub(super) bins: Vec<[usize; CHANNELS]>,
}

/// What was learnt and what is heard.
pub(super) struct Recording {
    /// For the headings.
    pub(super) name: &'static str,
    /// Number of classes K.
    pub(super) classes: usize,
    /// How it was learnt.
    pub(super) options: Options,
    /// The product's model.
    pub(super) model: ModelBuf,
    /// The yardstick.
    pub(super) reference: Reference,
    /// p + floor of `[bin][channel][class]`, without gaps.
    pub(super) likelihoods: Vec<f64>,
    /// The streams to tell apart.
    pub(super) streams: Vec<Heard>,
}

impl Recording {
    /// Full blocks of a stream: what is left over is never evidence.
    pub(super) fn blocks(&self, stream: usize) -> usize {
        let samples = self.streams.get(stream).map_or(0, |s| s.samples.len());
        samples / self.options.block as usize
    }

    /// The samples of a block of a stream, in one of its forms.
    pub(super) fn block<'a, T>(
        &'a self,
        stream: usize,
        block: usize,
        form: fn(&'a Heard) -> &'a Vec<T>,
    ) -> &'a [T] {
        let length = self.options.block as usize;
        let all = self.streams.get(stream).map(form);
        let block = all.and_then(|all| all.chunks(length).nth(block));
        block.unwrap_or_default()
    }

    /// The product's model, as it is read in place.
    ///
    /// # Errors
    /// None for what the trainer made.
    pub(super) fn parsed(&self) -> Result<Model<'_>, Error> {
        let model = self.model.model();
        model.map_err(|error| Error::Work(error.to_string()))
    }

    /// What the text says of it.
    pub(super) fn about(&self) -> About {
        About {
            name: self.name,
            classes: self.classes,
            bins: self.options.bins,
            block: self.options.block,
            samples: self.streams.iter().map(|s| s.samples.len()).sum(),
        }
    }

    /// Learns from some streams, to hear others.
    ///
    /// # Errors
    /// [`Error::Work`] if nothing can be learnt, or a class was not.
    pub(super) fn learnt(
        name: &'static str,
        learn: &[Stream],
        hear: &[Stream],
    ) -> Result<Self, Error> {
        let wrong = |fault: &dyn std::fmt::Display| Error::Work(format!("{name}: {fault}"));
        let options = Options::default();
        let mut trainer = Trainer::new(CHANNELS, options).map_err(|e| wrong(&e))?;
        for stream in learn {
            for sample in &stream.samples {
                trainer.add(&stream.label, sample).map_err(|e| wrong(&e))?;
            }
        }
        let buffer = trainer.train().map_err(|e| wrong(&e))?;
        let reference = Reference::learn(&trainer).ok_or_else(|| wrong(&"one class"))?;
        let model = buffer.model().map_err(|e| wrong(&e))?;
        let (Some(x), Some(y)) = (model.quantiser(0), model.quantiser(1)) else {
            return Err(wrong(&"not two channels"));
        };
        let bins = Bins::new([x, y], options.bins).map_err(|e| wrong(&e))?;
        let names = trainer.names();
        let streams = hear.iter().map(|stream| {
            let class = names.iter().position(|name| *name == stream.label);
            let codes = || stream.samples.iter().map(|sample| bins.codes(*sample));
            Ok(Heard {
                class: class.ok_or_else(|| wrong(&"a class that was not learnt"))?,
                samples: stream.samples.clone(),
                codes: codes().collect(),
                bins: codes().map(|codes| bins.of(codes)).collect(),
            })
        });
        Ok(Self {
            name,
            classes: names.len(),
            options,
            streams: streams.collect::<Result<_, Error>>()?,
            likelihoods: likelihoods(&trainer, &bins),
            reference,
            model: buffer,
        })
    }
}

/// The workspace that this program was built in.
pub(super) fn checkout() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// Both recordings.
///
/// # Errors
/// [`Error::Input`] for a file that is not there, [`Error::Work`].
pub(super) fn recordings() -> Result<[Recording; 2], Error> {
    let checkout = checkout();
    let terrain = |file| recording::read(&checkout.join("tests/data/terrain").join(file));
    let (learn, hear) = (terrain("terrain-train.csv")?, terrain("terrain-test.csv")?);
    let ground = Recording::learnt("terrain", &learn, &hear)?;

    let path = checkout.join("scenes/textures.toml");
    let text = std::fs::read_to_string(&path).map_err(|error| Error::file(&path, error))?;
    let scene = Scene::from_str("scenes/textures.toml", &text)?;
    let other = Scene {
        seed: scene.seed.wrapping_add(1),
        ..scene.clone()
    };
    let learn = main_job::record(&scene, Verbosity::Quiet)?;
    let hear = main_job::record(&other, Verbosity::Quiet)?;
    Ok([ground, Recording::learnt("textures", &learn, &hear)?])
}
