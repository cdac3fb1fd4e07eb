//! `host-sim sweep`: a scene with other values of some keys, every combination of them.

mod grid;
pub(crate) mod measured;

use std::ops::Range;
use std::path::PathBuf;

use clap::Args;
use rayon::prelude::*;
use scene::Scene;

use super::choice::SceneChoice;
use super::score::seeds;
use super::with_seed;
use crate::classifier::Classifier;
use crate::loaded::Loaded;
use crate::output::{Output, check_apart, check_or_stdout};
use crate::progress::{Progress, Verbosity};
use crate::run::Run;
use crate::{Error, report};
use grid::{Axis, combinations};
use measured::Measured;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneChoice,
    /// A key and its values, such as plant.stiffness=0.1,0.2; of several keys every
    /// combination is run
    #[arg(long, value_name = "KEY=V,V,...")]
    key: Vec<Axis>,
    /// The seeds of each combination: from A to below B [default: the scene's own]
    #[arg(long, value_name = "A..B", value_parser = seeds)]
    seeds: Option<Range<u64>>,
    /// Where to write the table, a row a run; - is standard output
    #[arg(long, value_name = "FILE.csv")]
    pub(super) out: PathBuf,
}

const MOST_RUNS: usize = 1_000_000;

struct Setting {
    values: Vec<String>,
    scene: Scene,
    classifier: Option<Classifier>,
}

/// Runs every combination with every seed, on all cores, and writes a row for each. Returns what
/// was done.
pub(super) fn sweep(arguments: &Arguments, verbosity: Verbosity) -> Result<String, Error> {
    let Arguments { key, out, .. } = arguments;
    check_or_stdout(out)?;
    check_apart(out, [arguments.scene.file.as_path()])?;
    let settings = settings(arguments)?;
    let all = settings.iter().flat_map(|setting| {
        let own = setting.scene.seed;
        let seeds = arguments.seeds.clone().unwrap_or(own..own + 1);
        seeds.map(move |seed| (setting, seed))
    });
    let all: Vec<(&Setting, u64)> = all.collect();
    let scenes = || all.iter().map(|(setting, _)| &setting.scene);
    let simulated_s: f64 = scenes().map(|scene| scene.duration_s).sum();
    let ticks = scenes().map(Scene::ticks).sum();
    let (runs, combinations) = (all.len(), settings.len());
    if verbosity == Verbosity::Normal {
        report::warn(format_args!(
            "sweep: {combinations} settings, {runs} runs, {simulated_s:.0} s of simulated time on {} \
             cores",
            rayon::current_num_threads()
        ));
    }
    let output = Output::create_or_stdout(out)?;
    let progress = Progress::new(verbosity, "sweeping", ticks);
    let measured = |(setting, seed): &(&Setting, u64)| {
        let scene = with_seed(&setting.scene, *seed);
        let run = Run::new(&scene, setting.classifier.clone())?;
        Ok(Measured::of(run, &scene, progress.counter()))
    };
    let measured: Vec<Measured> = all.par_iter().map(measured).collect::<Result<_, Error>>()?;
    drop(progress);

    let names = key.iter().map(|axis| axis.key.as_str());
    let rows = all.iter().zip(&measured);
    let rows = rows.map(|((setting, seed), measured)| (setting.values.as_slice(), *seed, measured));
    measured::write(output, names, rows)?;
    Ok(format!(
        "{}: {runs} runs of {combinations} settings; columns: docs/files.md",
        out.display()
    ))
}

/// All combinations, each checked as a scene file is.
fn settings(arguments: &Arguments) -> Result<Vec<Setting>, Error> {
    let Arguments { scene, key, .. } = arguments;
    let seeds = arguments.seeds.as_ref();
    let each = seeds.map_or(1, |seeds| seeds.end - seeds.start);
    let mut count = key.iter().map(|axis| axis.values.len());
    let count = count.try_fold(each as usize, usize::checked_mul);
    if count.is_none_or(|count| count > MOST_RUNS) {
        let fault =
            format!("--key, --seeds: found more than {MOST_RUNS} runs, allowed: up to {MOST_RUNS}");
        return Err(Error::Input(fault));
    }
    for (n, axis) in key.iter().enumerate() {
        let is_same = |other: &Axis| other.key == axis.key;
        if axis.key == "seed" {
            let fault = "--key: seed has a column of its own; allowed: --seeds";
            return Err(Error::Input(fault.to_owned()));
        }
        if key.iter().take(n).any(is_same) {
            let fault = format!("--key: {} is given twice, allowed: once", axis.key);
            return Err(Error::Input(fault));
        }
    }
    let mut settings = Vec::new();
    let mut cautions: Vec<String> = Vec::new();
    for combination in combinations(key) {
        let set = [&scene.set[..], &combination].concat();
        let loaded = Loaded::checked(&scene.file, &set)?;
        cautions.extend(loaded.caution());
        let values = combination.iter().map(|one| one.value().to_owned());
        settings.push(Setting {
            values: values.collect(),
            classifier: loaded.classifier()?,
            scene: loaded.scene,
        });
    }
    cautions.sort_unstable();
    cautions.dedup();
    for caution in cautions {
        report::warn(caution);
    }
    Ok(settings)
}
