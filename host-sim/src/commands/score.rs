//! `host-sim score`: a scene over many seeds.

use std::ops::Range;

use clap::Args;
use rayon::prelude::*;
use scene::{Rule, Scene};
use tactile::ModelBuf;

use super::with_seed;
use crate::classifier::{Classifier, Fault};
use crate::commands::ahead;
use crate::commands::choice::SceneChoice;
use crate::commands::record;
use crate::commands::train::of_option;
use crate::evaluation::{Evaluation, Shown};
use crate::progress::{Progress, Verbosity};
use crate::report::{over_runs, seed_range};
use crate::scoring::{self, Scored};
use crate::training::{How, TrainedModel};
use crate::{Error, report};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneChoice,
    /// The seeds to score: from A to below B
    #[arg(long, value_name = "A..B", value_parser = seeds)]
    seeds: Range<u64>,
    /// The seed of the run to train on, none of those scored [default: the scene's plus 1]
    #[arg(long, value_name = "N")]
    train_seed: Option<u64>,
    /// Decide when a posterior probability exceeds this [default: as the scene says]
    #[arg(long, value_name = "P")]
    threshold: Option<f64>,
    /// A texture of the scene that is not trained, and presented all the same
    #[arg(long, value_name = "LABEL")]
    unknown: Option<String>,
    #[command(flatten)]
    how: How,
}

pub(super) fn score(arguments: &Arguments, verbosity: Verbosity) -> Result<String, Error> {
    let Arguments { scene, seeds, .. } = arguments;
    let SceneChoice { file: path, set } = scene;
    let (mut scene, _) = Scene::load_with(path, set)?;
    config::check(&scene).map_err(|refused| Error::file(path, refused))?;
    if let Some(caution) = config::cautions(&scene) {
        report::warn(Error::file(path, caution));
    }
    let how = arguments.how.like(&scene);
    how.check().map_err(|fault| of_option(&fault))?;
    // Trained, and decided, by one gate.
    if let (Some(classifier), Some(_)) = (&mut scene.classifier, how.gate) {
        classifier.contact_min = how.gate;
    }
    let textures = scene.plant.textured.as_ref().map(|t| &t.textures);
    let labels: Vec<_> = textures.into_iter().flatten().map(|t| t.name()).collect();
    if labels.is_empty() {
        return Err(Error::file(path, "it presents no textures to tell apart"));
    }
    if let Some(label) = &arguments.unknown
        && !labels.contains(&label.as_str())
    {
        let labels = labels.join(", ");
        let fault = format!("--unknown: found {label:?}, allowed: {labels}");
        return Err(Error::Input(fault));
    }
    let train_seed = arguments.train_seed.unwrap_or(scene.seed.wrapping_add(1));
    if seeds.contains(&train_seed) {
        return Err(Error::Input(format!(
            "--train-seed: found {train_seed}, allowed: none of {}, which are scored",
            seed_range(seeds)
        )));
    }
    if let Some(threshold) = arguments.threshold {
        let wrong = |error| Error::Input(format!("--threshold: {error}"));
        tactile::Threshold::new(threshold).map_err(wrong)?;
    }

    // One more is trained on.
    ahead::tell(&scene, seeds.end - seeds.start + 1, None, verbosity);
    let trained = train(&scene, train_seed, &how, arguments, verbosity)?;
    let classifier = decides(&scene, arguments.threshold, trained.model);
    let classifier = classifier.map_err(|fault| match fault {
        Fault::Model(fault) => Error::Work(fault),
        Fault::Rule(fault) => Error::file(path, fault),
    })?;
    let runs = runs(&scene, seeds, &classifier, verbosity)?;
    let presentations = runs.iter().flat_map(|run| &run.presentations).cloned();
    let presentations: Vec<Shown> = presentations.collect();
    let together = Evaluation::new(classifier.classes(), &presentations);
    Ok(format!(
        "{}: trained on seed {train_seed}, {} runs with seeds {}\n\n{}",
        scene.name,
        runs.len(),
        seed_range(seeds),
        over_runs(&runs, &together, f64::from(scene.tick_hz))
    ))
}

fn train(
    scene: &Scene,
    seed: u64,
    how: &How,
    arguments: &Arguments,
    verbosity: Verbosity,
) -> Result<TrainedModel, Error> {
    let mut streams = record::streams(&with_seed(scene, seed), verbosity)?;
    streams.retain(|stream| Some(&stream.label) != arguments.unknown.as_ref());
    let recordings = [(scene.name.clone(), streams)];
    let trained = how.train(&recordings, scene.tick_hz);
    trained.map_err(|error| Error::Input(format!("training: {error}")))
}

/// All runs, on all cores, in the order of their seeds.
fn runs(
    scene: &Scene,
    seeds: &Range<u64>,
    classifier: &Classifier,
    verbosity: Verbosity,
) -> Result<Vec<Scored>, Error> {
    let all = scene.ticks().saturating_mul(seeds.end - seeds.start);
    let progress = Progress::new(verbosity, "scoring", all);
    let seeds: Vec<u64> = seeds.clone().collect();
    let scored = |seed: &u64| {
        let scene = with_seed(scene, *seed);
        scoring::run(&scene, classifier.clone(), progress.counter())
    };
    seeds.par_iter().map(scored).collect()
}

/// A range of seeds, A..B, with at least one in it and no more than a million.
pub(super) fn seeds(text: &str) -> Result<Range<u64>, String> {
    let ends = text.split_once("..");
    let ends = ends.and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
    let (first, end) = ends.ok_or("allowed: A..B, two whole numbers")?;
    if first < end && end - first <= 1_000_000 {
        Ok(first..end)
    } else {
        Err("allowed: A below B, up to a million seeds".to_owned())
    }
}

fn decides(scene: &Scene, threshold: Option<f64>, model: ModelBuf) -> Result<Classifier, Fault> {
    let mut scene = scene.clone();
    let Some(classifier) = &mut scene.classifier else {
        let threshold = threshold.unwrap_or(0.99);
        return Classifier::new(model, Rule::Sequential { threshold });
    };
    if let Some(threshold) = threshold {
        classifier.rule = Rule::Sequential { threshold };
        classifier.thresholds = None;
    }
    Classifier::of_scene(model, &scene)
}
