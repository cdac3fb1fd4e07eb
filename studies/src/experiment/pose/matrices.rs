//! Confusion matrices of POSE: what each classifier makes of angle, speed and
//! texture.

use super::scores::Scores;
use crate::experiment::matrix::{Matrix, draw};
use crate::experiment::record::table::speeds;
use crate::page::Page;
use crate::paper::pose::{ANGLES_DEG, ROWS, TEXTURES};
use anyhow::Result;

/// The picture; classifiers one below the other.
pub(super) fn section(page: &mut Page, rows: &[&Scores; 3]) -> Result<()> {
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
