//! Tables of POSE: κ and errors, the paper's beside ours.

use tactile::score::{Confusion, Statistics};

use super::scores::Scores;
use crate::page::{Page, figure};
use crate::paper::pose::{Figure, ROWS, TEXTURE_FEATURES, TEXTURES};

/// κ and errors of the three classifiers.
pub(super) fn main(page: &mut Page, rows: &[&Scores; 3]) {
    let errors = |paper: Figure, ours: Option<Statistics>| {
        let ours = ours.map_or("none".to_owned(), |s| {
            format!("**{} ({})**", figure(s.mean, 2), figure(s.sd, 1))
        });
        format!("{:.2} ({:.1}) / {ours}", paper.mean, paper.spread)
    };
    let lines = ROWS.iter().zip(rows).map(|(row, scores)| {
        let mut cells = vec![row.what.clone()];
        let (kappa, found) = (scores.kappa(), scores.errors());
        for k in 0..3 {
            let paper = row.figures[k];
            cells.push(format!("{:.2} / **{}**", paper.kappa, figure(kappa[k], 2)));
            cells.push(errors(paper, found[k]));
        }
        cells
    });
    let lines: Vec<_> = lines.collect();
    page.say(
        "**κ and errors** (sections III-A to III-C, Table I, Figs. 7 and 8): paper / **ours**; \
         errors are the mean (and the spread) in degrees, mm/s and classes.",
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
            format!("{} ({})", figure(s.mean, 2), figure(s.sd, 2))
        });
        let alone = feature
            .alone
            .map_or("–".to_owned(), |kappa| format!("{kappa:.2}"));
        vec![
            feature.name.clone(),
            format!("{:.2}", feature.together),
            alone,
            format!("**{}**", figure(score.kappa().unwrap_or(0.0), 2)),
            format!(
                "{:.2} ({:.2}) / **{ours}**",
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
