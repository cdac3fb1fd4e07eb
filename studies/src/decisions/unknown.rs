//! Textures that the model does not know: trained on all but one.

use anyhow::Result;
use std::collections::BTreeMap;

use super::Extent;
use super::figures::{Figures, mean_of, over, percent, plus_minus};
use super::ground::Ground;
use crate::page::{Page, row, verdict};

/// Of a scene each texture left out in each training.
pub(super) fn section(page: &mut Page, grounds: &[Ground], extent: &Extent) -> Result<()> {
    page.heading(2, "Unknown textures");
    page.say(
        "Each texture in turn is left out of the training and presented all the same. Refused is \
         the share of the decisions on it that said \"unknown\", beside what is refused of the \
         three textures that the model knows. What it is otherwise taken for says why it is not \
         noticed: its vibration lies among those of what the model knows.",
    );
    for ground in grounds {
        let textured = ground.scene.plant.textured.as_ref();
        let textures = textured.map_or(&[][..], |textured| &textured.textures);
        let labels = textures.iter().map(|texture| texture.name());
        let labels: Vec<&str> = labels.take(extent.values.max(1)).collect();
        let seeds: Vec<u64> = ground.seeds().collect();
        let jobs: Vec<(&str, u64)> = labels
            .iter()
            .flat_map(|&label| seeds.iter().map(move |&seed| (label, seed)))
            .collect();
        let found = extent
            .cores
            .each("unknown textures", &jobs, |&(label, seed)| {
                let mut streams = ground.recording(seed, ground.scene.duration_s);
                streams.retain(|stream| stream.label != label);
                let model = ground.train(streams)?.model()?;
                ground.score(&model, 0.99)
            })?;
        for ((label, seed), figures) in jobs.iter().zip(&found) {
            let setting = format!("without {label}");
            figures.keep(page, ["unknown", ground.name, &setting], *seed);
        }
        let of_label = || labels.iter().zip(found.chunks(seeds.len()));
        let rows = of_label().map(|(label, of_seeds)| {
            let shipped = &of_seeds[0];
            let all = |figure: fn(&Figures) -> f64| plus_minus(over(of_seeds.iter(), figure), 1);
            let cells = [
                percent(shipped.strange),
                percent(shipped.refused),
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

fn strange(figures: &Figures) -> f64 {
    100.0 * figures.strange.share
}

fn known(figures: &Figures) -> f64 {
    100.0 * figures.refused.share
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
