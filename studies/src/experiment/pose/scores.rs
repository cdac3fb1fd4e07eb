//! What a classifier makes of angle, speed and texture: tables with the paper's figures beside
//! ours, and confusion matrices.

use anyhow::Result;
use tactile::score::{Confusion, Statistics};

use crate::experiment::matrix::{Matrix, draw};
use crate::experiment::record::table::{Contact, speeds};
use crate::page::{Page, figure};
use crate::paper::pose::{ANGLES_DEG, Figure, ROWS, SPEEDS_MM_S, TEXTURE_FEATURES, TEXTURES};

/// What a classifier makes of the test set: a matrix a property.
#[derive(Debug, Clone)]
pub(super) struct Scores(pub(super) [Confusion; 3]);

impl Scores {
    pub(super) fn new() -> Self {
        Self([ANGLES_DEG.len(), SPEEDS_MM_S.2, TEXTURES.len()].map(Confusion::new))
    }

    /// Counts a contact: its classes of angle, speed and texture, and those named.
    pub(super) fn add(&mut self, truth: &Contact, named: [usize; 3]) -> Result<()> {
        let truth = [truth.angle, truth.speed, truth.texture];
        for ((score, truth), named) in self.0.iter_mut().zip(truth).zip(named) {
            score.add(truth, Some(named))?;
        }
        Ok(())
    }

    pub(super) fn kappa(&self) -> [f64; 3] {
        self.0.each_ref().map(|score| score.kappa().unwrap_or(0.0))
    }

    pub(super) fn hit(&self) -> [f64; 3] {
        self.0
            .each_ref()
            .map(|score| 100.0 * score.hit_rate().unwrap_or(0.0))
    }

    pub(super) fn errors(&self) -> [Option<Statistics>; 3] {
        let textures: Vec<f64> = (0..TEXTURES.len()).map(|n| n as f64).collect();
        [
            self.0[0].errors(&ANGLES_DEG),
            self.0[1].errors(&speeds()),
            self.0[2].errors(&textures),
        ]
    }
}

pub(super) fn kappas(page: &mut Page, rows: &[&Scores; 3]) {
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

/// The picture; classifiers one below the other.
pub(super) fn matrices(page: &mut Page, rows: &[&Scores; 3]) -> Result<()> {
    let numbers = |values: &[f64]| values.iter().map(|value| format!("{value:.0}")).collect();
    let classes: [(&str, Vec<String>); 3] = [
        ("angle, degrees", numbers(&ANGLES_DEG)),
        ("speed, mm/s", numbers(&speeds())),
        ("texture", TEXTURES.map(str::to_owned).to_vec()),
    ];
    let mut matrices = Vec::new();
    for (row, scores) in ROWS.iter().zip(rows) {
        for ((what, classes), score) in classes.iter().zip(&scores.0) {
            matrices.push(Matrix {
                title: format!("{}: {what}", row.what),
                classes: classes.clone(),
                score: score.clone(),
            });
        }
    }
    page.say(
        "**Confusion**: a row is the true class, a column the one that was named; the darker, \
         the larger its share of the row.",
    );
    let svg = draw(&matrices, classes.len())?;
    let what = "Confusion matrices of three classifiers";
    page.picture("pose-confusion.svg", what, svg);
    Ok(())
}
