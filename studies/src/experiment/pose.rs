//! POSE: angle, speed and texture of one brief contact, by the template, the
//! spectral template and features.

mod rules;
mod sets;

use super::{Dataset, Recordings, Request, product, ranges};
use crate::page::{Page, figure};
use crate::paper::pose::{ANGLES_DEG, ROWS, SPEEDS_MM_S, TEXTURE_ALONE, TEXTURES};
use crate::rigs::table::Contact;
use anyhow::Result;
use rules::{Nearest, Scores, features};
use sets::{Sets, Signal, notched, resonance_hz};

pub(super) fn evaluate(page: &mut Page, request: &Request, recordings: &Recordings) -> Result<()> {
    let sets = Sets::new(request, recordings)?;
    let by_template = Nearest::Signal.contacts(&sets)?;
    let by_spectrum = Nearest::Spectrum.contacts(&sets)?;
    let by_features = features(&sets)?;
    page.heading(2, "POSE: one contact at an unknown angle and speed");
    page.say(format_args!(
        "A textured surface is carried into a fixed whisker (`studies/rigs/table.toml`): {} contacts to \
         train on and {} to test with, each every combination of angle, speed and texture once. \
         Either way of the table meets the same spot. Signals are x alone, as the paper's count of samples says. κ is Cohen's. The \
         features of texture are taken behind a notch at the whisker's resonance, {:.1} Hz.",
        sets.training.len(),
        sets.testing.len(),
        resonance_hz()?
    ));
    let rows = [&by_template, &by_spectrum, &by_features.together];
    rules::kappas(page, &rows);
    rules::matrices(page, &rows)?;
    rules::table_of_features(page, &by_features.textures);
    let [template, spectral] = TEXTURE_ALONE;
    let by_signal = figure(Nearest::Signal.textures(&sets)?, 2);
    let by_spectrum = figure(Nearest::Spectrum.textures(&sets)?, 2);
    page.say(format_args!(
        "κ of texture alone, whatever the pose (one template a texture): template {template:.2} / \
         **{by_signal}**, spectral template {spectral:.2} / **{by_spectrum}**."
    ));
    claims(page, &rows);
    product(page, &sets)?;
    ranges::say(page, (request, recordings), (Dataset::Table, 2), 8191.0);
    let names = [
        "template by sum of squares, 352 poses",
        "spectral template |DFT|, 352 poses",
        "features f1–f5, quadratic",
    ];
    for (name, scores) in names.into_iter().zip(rows) {
        let counts = [ANGLES_DEG.len(), SPEEDS_MM_S.2, TEXTURES.len()];
        let properties = ["angle", "speed", "texture"].into_iter().zip(counts);
        for ((property, classes), hit) in properties.zip(scores.hit()) {
            let chance = 100.0 / classes as f64;
            let of_textures = (property == "texture").then_some(chance);
            page.score(name, property, hit, (chance, of_textures));
        }
    }
    Ok(())
}

fn product(page: &mut Page, sets: &Sets) -> Result<()> {
    let streams = |set: usize| -> Result<Vec<_>> {
        let all = sets.pairs[set].iter().enumerate();
        let one = |(n, (contact, pairs)): (usize, &(Contact, Vec<[f64; 2]>))| {
            let name = TEXTURES[contact[2]];
            product::stream(name, n, pairs.clone(), Some(sets.rate_hz))
        };
        all.map(one).collect()
    };
    let name = "texture of one contact".to_owned();
    let tasks = vec![(name, streams(0)?, streams(1)?)];
    product::section(page, sets.rate_hz, tasks)
}

fn claims(page: &mut Page, rows: &[&Scores; 3]) {
    let kappas = rows.map(Scores::kappa);
    for (property, name, best) in [(0, "angle", 1), (2, "texture", 1), (1, "speed", 2)] {
        let ours = kappas.map(|kappa| kappa[property]);
        let [a, b, c] = [0, 1, 2].map(|row: usize| ROWS[row].figures[property].kappa);
        let others = (0..ours.len()).filter(|row| *row != best);
        let others = others.map(|row| ours[row]).fold(f64::MIN, f64::max);
        let [x, y, z] = ours.map(|kappa| figure(kappa, 2));
        page.claim(
            format_args!("POSE: best for {name}: {}", ROWS[best].what),
            format_args!("template {a:.2}, spectral {b:.2}, features {c:.2}"),
            format_args!("template {x}, spectral {y}, features {z}"),
            (ours[best] - others, "of κ"),
        )
        .rests_on_both(ours[best], (0.0, (property == 2).then_some(0.0)));
    }
}
