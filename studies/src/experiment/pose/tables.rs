//! Tables of POSE: κ and errors, the paper's beside ours.

use tactile::score::{Confusion, Statistics};

use super::scores::Scores;
use crate::page::Page;
use crate::paper::pose::{Figure, ROWS, TEXTURE_FEATURES, TEXTURES};

/// κ and errors of the three classifiers.
pub(super) fn main(page: &mut Page, rows: &[&Scores; 3]) {
    let errors = |figure: Figure, ours: Option<Statistics>| {
        let ours = ours.map_or("none".to_owned(), |s| {
            format!("**{:.2} ± {:.1}**", s.mean, s.sd)
        });
        format!("{:.2} ± {:.1} / {ours}", figure.mean, figure.spread)
    };
    let lines = ROWS.iter().zip(rows).map(|(row, scores)| {
        let mut cells = vec![row.what.clone()];
        let (kappa, found) = (scores.kappa(), scores.errors());
        for k in 0..3 {
            let figure = row.figures[k];
            cells.push(format!("{:.2} / **{:.2}**", figure.kappa, kappa[k]));
            cells.push(errors(figure, found[k]));
        }
        cells
    });
    let lines: Vec<_> = lines.collect();
    page.say(
        "**κ and errors** (sections III-A to III-C, Table I, Figs. 7 and 8): paper / **ours**; \
         errors are mean ± spread in degrees, mm/s and classes.",
    );
    page.table(
        "classifier | angle κ | angle error | speed κ | speed error | texture κ | texture error",
        lines,
    );
}

/// Texture by each feature.
pub(super) fn features(page: &mut Page, found: &[Confusion]) {
    let classes: Vec<f64> = (0..TEXTURES.len()).map(|n| n as f64).collect();
    let lines = TEXTURE_FEATURES.iter().zip(found).map(|(feature, score)| {
        let errors = score.errors(&classes);
        let ours = errors.map_or("none".to_owned(), |s| {
            format!("{:.2} ± {:.2}", s.mean, s.sd)
        });
        let alone = feature
            .alone
            .map_or("–".to_owned(), |kappa| format!("{kappa:.2}"));
        vec![
            feature.name.clone(),
            format!("{:.2}", feature.together),
            alone,
            format!("**{:.2}**", score.kappa().unwrap_or(0.0)),
            format!(
                "{:.2} ± {:.2} / **{ours}**",
                feature.error.0, feature.error.1
            ),
        ]
    });
    let lines: Vec<_> = lines.collect();
    page.say("**Texture by features** (section III-C and Table I).");
    page.table(
        "feature | κ in the paper, together | κ in the paper, alone | κ here | error, classes",
        lines,
    );
}
