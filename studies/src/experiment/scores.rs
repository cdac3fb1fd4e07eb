//! Every classifier's hit rate, beside that of its placebo.

use super::verdicts::Bodies;
use crate::moments::Summary;
use crate::page::{Page, Score};

/// The same score of every page, of those in which there is one.
fn hits(pages: &[Page], n: usize) -> String {
    let scores = || pages.iter().filter_map(|page| page.scores.get(n));
    let hits = scores().map(|score| score.recognition.rate);
    let hits: Vec<f64> = hits.filter(|hit| hit.is_finite()).collect();
    let decided: Vec<f64> = scores().filter_map(|score| score.decided).collect();
    let share = if decided.is_empty() {
        String::new()
    } else {
        format!(" of {} decided", Summary::of(&decided).text(0, false))
    };
    if hits.is_empty() {
        return "nothing decided".to_owned();
    }
    format!("{}{share}", Summary::of(&hits).text(1, false))
}

pub(super) fn section(page: &mut Page, bodies: &Bodies) {
    let scores = bodies.pages.first().map_or(&[][..], |page| &page.scores);
    let row = |(n, score): (usize, &Score)| {
        vec![
            // |DFT| must not end the cell.
            score.classifier.replace('|', "\\|"),
            score.task.clone(),
            format!("**{}**", hits(&bodies.pages, n)),
            hits(&bodies.placebos, n),
            format!("{:.1}", score.recognition.chance),
        ]
    };
    let rows: Vec<Vec<String>> = scores.iter().enumerate().map(row).collect();
    if rows.is_empty() {
        return;
    }
    page.heading(2, "Every classifier");
    page.say(
        "The placebo is recognised by the same classifier. What they cost on a board: \
         [record 44](../decisions.md#44-what-each-classifier-of-the-experiments-takes).",
    );
    page.table(
        "classifier | on | hit rate, % | placebo, % | chance, %",
        rows,
    );
}
