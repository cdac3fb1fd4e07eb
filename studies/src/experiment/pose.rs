//! POSE: angle, speed and texture of one brief contact, by the template, the
//! spectral template and features.

mod matrices;
mod rules;
mod scores;
mod sets;
mod tables;

use super::dataset::Dataset;
use super::record::on_other_rigs;
use super::recording::Recordings;
use super::request::Request;
use crate::page::Page;
use crate::paper::pose::{ROWS, TEXTURE_ALONE};
use host_sim::Error;
use rules::{features, spectral, template};
use scores::Scores;
use sets::Sets;

/// Evaluates the recordings.
pub(super) fn evaluate(
    page: &mut Page,
    request: &Request,
    recordings: &Recordings,
) -> Result<(), Error> {
    let sets = Sets::new(request, recordings);
    let by_template = template(&sets)?;
    let by_spectrum = spectral(&sets)?;
    let by_features = features(&sets)?;
    page.heading(2, "POSE: one contact at an unknown angle and speed");
    page.say(format_args!(
        "A textured surface is carried into a fixed whisker (`studies/rigs/table.toml`): {} contacts to \
         train on and {} to test with, each every combination of angle, speed and texture once. \
         Signals are x alone, as the paper's count of samples says. κ is Cohen's. That signals are \
         aligned by their peaks and that the approach ends at a deflection of 0.05 was chosen \
         after a first run; the paper's notch at the whisker's resonance is left out.",
        sets.training.len(),
        sets.testing.len()
    ));
    let rows = [&by_template, &by_spectrum, &by_features.together];
    tables::main(page, &rows);
    matrices::section(page, &rows)?;
    tables::features(page, &by_features.textures);
    let alone = [
        rules::template_of_textures(&sets)?,
        rules::spectral_of_textures(&sets)?,
    ];
    page.say(format_args!(
        "κ of texture alone, whatever the pose (one template a texture): template {:.2} / \
         **{:.2}**, spectral template {:.2} / **{:.2}**.",
        TEXTURE_ALONE[0], alone[0], TEXTURE_ALONE[1], alone[1]
    ));
    let why = why(request, &sets)?;
    claims(page, &rows, &why);
    for (name, scores) in [
        "template by sum of squares, 352 poses",
        "spectral template |DFT|, 352 poses",
        "features f1–f5, quadratic",
    ]
    .into_iter()
    .zip(rows)
    {
        for (property, hit) in ["angle", "speed", "texture"].into_iter().zip(scores.hit()) {
            page.score(name, property, hit);
        }
    }
    Ok(())
}

/// Largest deviation of a latency in the comparison below, s.
const IRREGULAR_S: f64 = 0.15;

/// Why the classifiers rank as they do, measured: the same contacts with a
/// controller that is much less regular; and how much of the signal differs
/// between textures.
fn why(request: &Request, sets: &Sets) -> Result<String, Error> {
    let (other, recordings) = on_other_rigs(request, Dataset::Table, |other| {
        let table = &mut other.rigs.table;
        table.latency_spread_s = IRREGULAR_S.min(table.latency_s);
    })?;
    let irregular = Sets::new(&other, &recordings);
    let kappas = [
        template(&irregular)?.kappa(),
        spectral(&irregular)?.kappa(),
        features(&irregular)?.together.kappa(),
    ];
    let text = |property: usize| {
        let [a, b, c] = kappas.map(|kappa| kappa[property]);
        format!("{a:.2}, {b:.2} and {c:.2}")
    };
    let share = sets.share_of_texture();
    Ok(format!(
        "the controller's latency here is within {:.0} ms of 300 ms, so that signals of the same \
         pose line up; within {:.0} ms, κ of template, spectral template and features is {} for \
         angle, {} for speed and {} for texture. Of the variance of all signals {:.1} % lies \
         between textures at the same angle and speed",
        1000.0 * request.rigs.table.latency_spread_s,
        1000.0 * IRREGULAR_S,
        text(0),
        text(1),
        text(2),
        100.0 * share
    ))
}

fn claims(page: &mut Page, rows: &[&Scores; 3], why: &str) {
    let kappas = rows.map(Scores::kappa);
    let all = |property: usize| kappas.map(|kappa| kappa[property]);
    for (property, name, best) in [(0, "angle", 1), (2, "texture", 1), (1, "speed", 2)] {
        let ours = all(property);
        let paper = [0, 1, 2].map(|row: usize| ROWS[row].figures[property].kappa);
        let most = ours.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let text = |kappas: [f64; 3]| {
            let [a, b, c] = kappas;
            format!("template {a:.2}, spectral {b:.2}, features {c:.2}")
        };
        page.claim(
            format_args!("POSE: {} are best for {name}", ROWS[best].what),
            text(paper),
            text(ours),
            ours[best] >= most,
            why,
        );
    }
}
