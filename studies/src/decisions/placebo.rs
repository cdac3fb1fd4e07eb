//! What is decided where there is nothing to decide: labels that mean nothing, and textures that the
//! model does not know, trained on all but one.

use std::collections::BTreeMap;

use anyhow::Result;
use host_sim::training::Tables;

use super::figures::strange;
use super::{
    Extent, Figures, Ground, Trained, known_refused as known, mean_of, number, over, percent,
    plus_minus, score_on,
};
use crate::page::{Page, row, verdict};

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
        let names = ground.textures();
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
            let decided = all(|figures| 100.0 * (1.0 - figures.all.undecided.share));
            let cells = [
                setting,
                format!("{:.0}", 100.0 / names.len().max(1) as f64),
                plus_minus(all(|figures| figures.hits().0), 1),
                number(all(|figures| 100.0 * figures.all.calibration.stated).0, 1),
                plus_minus(decided, 1),
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
    figures.all.calibration.found.count as f64
}

/// What a trial of what is truly `label` is called.
pub(crate) fn permuted(names: &[&str], label: &str, trial: u64) -> String {
    let place = names.iter().position(|name| *name == label);
    let turned = place.map(|place| (place + trial as usize) % names.len());
    let name = turned.and_then(|place| names.get(place));
    name.map_or_else(|| label.to_owned(), |name| (*name).to_owned())
}

/// Of a scene each texture left out in each training.
pub(super) fn unknown(page: &mut Page, grounds: &[Ground], extent: &Extent) -> Result<()> {
    page.heading(2, "Unknown textures");
    page.say(
        "Each texture in turn is left out of the training and presented all the same. Refused is \
         the share of the decisions on it that said \"unknown\", beside what is refused of the \
         three textures that the model knows. What it is otherwise taken for says why it is not \
         noticed: its vibration lies among those of what the model knows.",
    );
    for ground in grounds {
        let mut labels = ground.textures();
        labels.truncate(extent.values.max(1));
        let seeds: Vec<u64> = ground.seeds().collect();
        let of_label = |&label| seeds.iter().map(move |&seed| (label, seed));
        let jobs: Vec<(&str, u64)> = labels.iter().flat_map(of_label).collect();
        let of_job = |&(label, seed): &(&str, u64)| {
            let mut streams = ground.recording(seed, ground.scene.duration_s);
            streams.retain(|stream| stream.label != label);
            let model = ground.train(streams)?.model()?;
            ground.score(&model, 0.99)
        };
        let found = extent.cores.each("unknown textures", &jobs, of_job)?;
        for ((label, seed), figures) in jobs.iter().zip(&found) {
            let setting = format!("without {label}");
            figures.keep(page, ["unknown", ground.name, &setting], *seed);
        }
        let of_label = || labels.iter().zip(found.chunks(seeds.len()));
        let rows = of_label().map(|(label, of_seeds)| {
            let shipped = &of_seeds[0];
            let all = |figure: fn(&Figures) -> f64| plus_minus(over(of_seeds.iter(), figure), 1);
            let cells = [
                percent(shipped.all.strange),
                percent(shipped.all.refused),
                all(strange),
                all(known),
                taken_for(of_seeds),
            ];
            row(*label, cells)
        });
        page.heading(3, &format!("`scenes/{}.toml`", ground.name));
        let seed = seeds.first().copied().unwrap_or_default();
        page.table(
            &format!(
                "left out | refused, seed {seed} | known refused, seed {seed} | refused, all \
                 trainings | known refused | all trainings: decided as"
            ),
            rows,
        );
        let first = |figure: fn(&Figures) -> f64| mean_of(of_label().map(|(_, f)| figure(&f[0]))).0;
        let [seen, known_refused] = [first(strange), first(known)];
        page.say(format_args!(
            "Mean over those left out, seed {seed}: {seen:.1} % refused (goal: at least {} %), {}; \
             of the known {known_refused:.1} % (at most 6 %), {}. All trainings: {} % and {} %.",
            ground.goals.strange,
            verdict(seen >= ground.goals.strange),
            verdict(known_refused <= 6.0),
            plus_minus(over(found.iter(), strange), 1),
            plus_minus(over(found.iter(), known), 1),
        ));
    }
    Ok(())
}

/// What the unknown texture was decided to be, the most frequent first.
fn taken_for(of_seeds: &[Figures]) -> String {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for (name, count) in of_seeds.iter().flat_map(|figures| &figures.taken_for) {
        *counts.entry(name).or_default() += count;
    }
    let all: usize = counts.values().sum();
    let mut counts: Vec<_> = counts.into_iter().collect();
    counts.sort_by_key(|&(_, count)| std::cmp::Reverse(count));
    let shares = counts.iter().map(|(name, count)| {
        let share = 100.0 * *count as f64 / all as f64;
        format!("{name} {share:.0} %")
    });
    shares.collect::<Vec<_>>().join(", ")
}
