//! Every classifier's hit rate by both protocols, beside those of its placebos.

use super::request::Arm;
use super::verdicts::{Bodies, Recognised};
use crate::moments::Summary;
use crate::page::{Page, Score};

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

pub(super) fn rows(bodies: &Bodies) -> Vec<Vec<String>> {
    let of = |arm| bodies.of(arm);
    let scores = of(Arm::MAIN).first().map_or(&[][..], |page| &page.scores);
    let row = |(n, score): (usize, &Score)| {
        let recognised = |arm| {
            let scores = of(arm).iter().filter_map(|page| page.scores.get(n));
            Recognised::of(scores.map(|score| score.recognition), |found| {
                found.of_textures
            })
        };
        let spots = hits(of(Arm::SPOTS), n);
        let both = recognised(Arm::SPOTS).zip(recognised(Arm::MAIN));
        let spots = match score.recognition.of_textures {
            None => "–".to_owned(),
            Some(_) if both.is_some_and(|(spots, all)| spots.is_as_good_as(&all)) => {
                format!("**{spots}**")
            }
            Some(_) => spots,
        };
        vec![
            // |DFT| must not end the cell.
            score.classifier.replace('|', "\\|"),
            score.task.clone(),
            format!("**{}**", hits(of(Arm::MAIN), n)),
            format!("**{}**", hits(of(Arm::AGAIN), n)),
            hits(of(Arm::LABELS), n),
            spots,
            hits(of(Arm::AGAIN_LABELS), n),
            format!("{:.1}", score.recognition.chance),
        ]
    };
    scores.iter().enumerate().map(row).collect()
}

pub(super) fn section(page: &mut Page, rows: Vec<Vec<String>>) {
    if rows.is_empty() {
        return;
    }
    page.heading(2, "Every classifier");
    page.say(
        "Hit rates in percent. Placebos are recognised by the same classifier; of spots, bold is \
         what is told apart as well as textures are. What classifiers cost on a board: \
         [record 44](../decisions.md#44-what-each-classifier-of-the-experiments-takes).",
    );
    page.table(
        "classifier | on | as in the paper | drawn again | labels | spots | labels, drawn again | chance",
        rows,
    );
}
