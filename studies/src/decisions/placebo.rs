//! What is decided where there is nothing to decide: labels that mean nothing.

use anyhow::Result;
use host_sim::training::Tables;

use super::Extent;
use super::figures::{Figures, number, over, plus_minus};
use super::goals::Trained;
use super::ground::{Ground, score_on};
use crate::page::{Page, row};

const MODELS: [(&str, Tables, f64); 3] = [
    ("joint", Tables::Joint, 0.99),
    ("joint", Tables::Joint, 0.5),
    ("the papers'", Tables::Single, 0.99),
];

/// Every texture under each of the scene's names in turn, in training and in scoring.
pub(super) fn section(page: &mut Page, grounds: &[Ground], extent: &Extent) -> Result<()> {
    page.heading(2, "A placebo");
    page.say(
        "The same runs with labels that mean nothing: trial n of texture m is called by name \
         n + m, counted around, so that every name has as much of every texture, in the training \
         as in the runs that are scored. A hit rate above chance would be of the method, not of \
         the textures, and whatever is decided at a stated 99 % is stated wrongly. Decided is the \
         share of presentations with a decision for a class; the last column sets the number of \
         decisions against that of the joint model with true labels. Means of all trainings; \
         beside the joint model, which weighs its tables by held-out trials, the papers' model, \
         which does not.",
    );
    let mut rows = Vec::new();
    for ground in grounds {
        let textured = ground.scene.plant.textured.as_ref();
        let textures = textured.map_or(&[][..], |textured| &textured.textures);
        let names: Vec<&str> = textures.iter().map(|texture| texture.name()).collect();
        let mut runs = ground.runs.clone();
        for shown in runs.iter_mut().flat_map(|run| &mut run.presentations) {
            shown.label = permuted(&names, &shown.label, shown.trial);
        }
        let seeds: Vec<u64> = ground.seeds().collect();
        let true_count = over(ground.trained.iter().map(Trained::usual), count).0;
        for (name, tables, threshold) in MODELS {
            let found = extent.cores.each("placebo", &seeds, |&seed| {
                let mut streams = ground.recording(seed, ground.scene.duration_s);
                for stream in &mut streams {
                    let trial = stream.trial.parse().unwrap_or(0);
                    stream.label = permuted(&names, &stream.label, trial);
                }
                let model = ground.train_tables(streams, tables)?.model;
                score_on(&runs, &model, threshold, ground.scene.tick_hz)
            })?;
            let setting = format!("{name} at {threshold}");
            for (seed, figures) in seeds.iter().zip(&found) {
                figures.keep(page, ["placebo", ground.name, &setting], *seed);
            }
            let all = |figure: fn(&Figures) -> f64| over(found.iter(), figure);
            let share = over(found.iter(), |figures| 100.0 * count(figures) / true_count);
            let cells = [
                setting,
                format!("{:.0}", 100.0 / names.len().max(1) as f64),
                plus_minus(all(Figures::hit_rate), 1),
                number(all(|figures| 100.0 * figures.calibration.stated).0, 1),
                plus_minus(all(|figures| 100.0 * (1.0 - figures.undecided.share)), 1),
                plus_minus(share, 1),
            ];
            rows.push(row(ground.name, cells));
        }
    }
    page.table(
        "scene | model | chance | hit rate | stated | presentations decided | decisions, of the \
         true",
        rows,
    );
    Ok(())
}

fn count(figures: &Figures) -> f64 {
    figures.calibration.found.count as f64
}

/// What a trial of what is truly `label` is called.
pub(crate) fn permuted(names: &[&str], label: &str, trial: u64) -> String {
    let place = names.iter().position(|name| *name == label);
    let turned = place.map(|place| (place + trial as usize) % names.len());
    let name = turned.and_then(|place| names.get(place));
    name.map_or_else(|| label.to_owned(), |name| (*name).to_owned())
}
