//! The scenes that are scored, with their runs.

use anyhow::{Context, Result};
use host_sim::classifier::Classifier;
use host_sim::commands::record;
use host_sim::progress::Verbosity;
use host_sim::recording::Stream;
use host_sim::scoring::Heard;
use host_sim::training::{Expected, How, Tables, TrainedModel};
use scene::{Rule, Scene};
use tactile::ModelBuf;
use tactile::train::joint::JointModel;

use super::{Extent, Figures, Trained, measure};

/// Longest run that is trained on, s.
pub(super) const LONGEST_S: f64 = 80.0;

/// What is asked of a scene; shares in percent.
#[derive(Debug, Clone, Copy)]
pub(super) struct Goals {
    pub(super) contact_ms: f64,
    pub(super) undecided: f64,
    pub(super) strange: f64,
    pub(super) of_runs: bool,
}

const SCENES: [(&str, &str, Goals); 2] = [
    (
        "textures",
        include_str!("../../../scenes/textures.toml"),
        Goals {
            contact_ms: 180.0,
            undecided: 1.0,
            strange: 65.0,
            of_runs: true,
        },
    ),
    (
        "whisker",
        include_str!("../../../scenes/whisker.toml"),
        Goals {
            contact_ms: 340.0,
            undecided: 8.0,
            strange: 45.0,
            of_runs: false,
        },
    ),
];

pub(super) struct Ground {
    pub(super) name: &'static str,
    pub(super) scene: Scene,
    pub(super) goals: Goals,
    /// By the seed of each training a run of [`LONGEST_S`].
    recorded: Vec<(u64, Vec<Stream>)>,
    pub(super) runs: Vec<Heard>,
    /// A model a training, the one that is shipped first.
    pub(super) trained: Vec<Trained>,
}

impl Ground {
    pub(super) fn all(extent: &Extent) -> Result<Vec<Self>> {
        let seeds: Vec<u64> = extent.scored.clone().collect();
        let one = |(name, text, goals): (&'static str, &str, Goals)| {
            let scene = Scene::from_str(&format!("scenes/{name}.toml"), text)?;
            let record = |&seed: &u64| {
                let mut scene = scene.clone();
                (scene.seed, scene.duration_s) = (seed, LONGEST_S);
                Ok((seed, record::streams(&scene, Verbosity::Quiet)?))
            };
            let cores = extent.cores;
            let mut ground = Self {
                name,
                goals,
                recorded: cores.each("training runs", &extent.trainings, record)?,
                runs: record_all(&scene, &seeds, extent)?,
                trained: Vec::new(),
                scene,
            };
            ground.trained = measure(&ground, extent)?;
            Ok(ground)
        };
        SCENES.into_iter().map(one).collect()
    }

    pub(super) fn textures(&self) -> Vec<&str> {
        let textured = self.scene.plant.textured.iter();
        let textures = textured.flat_map(|textured| &textured.textures);
        textures.map(|texture| texture.name()).collect()
    }

    pub(super) fn shipped(&self) -> &Trained {
        &self.trained[0]
    }

    pub(super) fn seeds(&self) -> impl Iterator<Item = u64> {
        self.recorded.iter().map(|(seed, _)| *seed)
    }

    pub(super) fn recording(&self, seed: u64, seconds: f64) -> Vec<Stream> {
        let mut left = (seconds * f64::from(self.scene.tick_hz)).round() as usize;
        let recorded = self.recorded.iter().find(|(of, _)| *of == seed);
        let mut streams = Vec::new();
        for stream in recorded.into_iter().flat_map(|(_, streams)| streams) {
            if left == 0 {
                break;
            }
            let mut stream = stream.clone();
            stream.samples.truncate(left);
            left -= stream.samples.len();
            streams.push(stream);
        }
        streams
    }

    /// A joint model as `host-sim train --expect same` makes it.
    pub(super) fn train(&self, streams: Vec<Stream>) -> Result<JointModel> {
        let joint = self.train_tables(streams, Tables::Joint)?.joint;
        joint.context("training made no joint model")
    }

    /// A model of any tables as `host-sim train --expect same` makes it.
    pub(super) fn train_tables(
        &self,
        streams: Vec<Stream>,
        tables: Tables,
    ) -> Result<TrainedModel> {
        let recordings = [(self.scene.name.clone(), streams)];
        // In the pose of training: the page of poses has the others.
        let how = How {
            expect: Expected::Same,
            ..How::of(tables).like(&self.scene)
        };
        let trained = how.train(&recordings, self.scene.tick_hz);
        trained.map_err(anyhow::Error::new)
    }

    pub(super) fn score(&self, model: &ModelBuf, threshold: f64) -> Result<Figures> {
        score_on(&self.runs, model, threshold, self.scene.tick_hz)
    }
}

pub(super) fn score_on(
    runs: &[Heard],
    model: &ModelBuf,
    threshold: f64,
    tick_hz: u32,
) -> Result<Figures> {
    let rule = Rule::Sequential { threshold };
    let classifier = Classifier::new(model.clone(), rule)?;
    let scored = runs.iter().map(|run| run.score(classifier.clone()));
    Ok(Figures::of(scored.collect(), classifier.classes(), tick_hz))
}

pub(super) fn record_all(scene: &Scene, seeds: &[u64], extent: &Extent) -> Result<Vec<Heard>> {
    extent.cores.each("scored runs", seeds, |&seed| {
        let mut scene = scene.clone();
        scene.seed = seed;
        Ok(Heard::record(&scene)?)
    })
}
