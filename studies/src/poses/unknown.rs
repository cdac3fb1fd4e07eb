//! A texture that the model does not know.

use anyhow::Result;
use host_sim::recording::Stream;
use host_sim::training::Expected;

use super::Extent;
use super::asked::{at_least, at_most, said};
use super::condition::SURFACES;
use super::output::Output;
use super::tally::Tally;
use super::trained::{THRESHOLD, Trained};
use crate::decisions::figures::percent;
use crate::page::row;

/// The least of decisions on what is unknown that are to name none, and the most on what is
/// known, percent.
const GOAL: f64 = 65.0;
const FALSE: f64 = 6.0;

pub(super) fn section(
    output: &mut Output,
    all: &[(&str, Expected, &Trained<'_>)],
    extent: &Extent,
) -> Result<()> {
    output.page.heading(2, "Unknown textures");
    output.page.say(
        "Each texture in turn is left out of the training and presented all the same. Refused: \
         of decisions, those that named none, whatever the reason; of presentations, those in \
         which none was named. Known: the other three.",
    );
    let mut rows = Vec::new();
    for (poses, expect, trained) in all {
        let mut sums = [Tally::default(); 2];
        for (left_out, _) in SURFACES.iter().take(extent.surfaces) {
            let without = |streams: &mut Vec<Stream>, _: u64| {
                streams.retain(|stream| stream.label != *left_out);
            };
            let models = trained.models(*expect, &without)?;
            let is_unknown = |stream: &Stream| stream.label == *left_out;
            let unknown = trained.fresh_of(&models, THRESHOLD, is_unknown)?;
            let known = trained.fresh_of(&models, THRESHOLD, |stream| !is_unknown(stream))?;
            let setting = format!("without {left_out}; {poses}");
            output.keep(["unknown", &setting, "unknown"], trained, &unknown);
            output.keep(["unknown", &setting, "known"], trained, &known);
            let both = [Tally::sum(&unknown), Tally::sum(&known)];
            sums = [0, 1].map(|n| Tally::sum([&sums[n], &both[n]]));
            rows.push(row(format!("{poses}: {left_out}"), cells(&both)));
        }
        rows.push(row(format!("{poses}: all"), cells(&sums)));
        if *expect == Expected::Same {
            continue;
        }
        let [unknown, known] = sums.map(|tally| tally.refused_share());
        let mut missed = Vec::new();
        if !at_least(unknown, GOAL) {
            missed.push("refused");
        }
        if !at_most(known, FALSE) {
            missed.push("false");
        }
        let [of_unknown, of_known] = sums.map(|tally| tally.undecided_share());
        output.goal(
            &format!("unknown texture: {poses}"),
            &format!("refused ≥ {GOAL} of decisions, of known ≤ {FALSE}"),
            format!(
                "refused {}, of known {}; of presentations {} and {}",
                percent(unknown),
                percent(known),
                percent(of_unknown),
                percent(of_known)
            ),
            said(&missed),
        );
    }
    output.page.table(
        "trained: left out | refused, of decisions | of presentations | presentations | known: \
         refused, of decisions | of presentations | presentations",
        rows,
    );
    Ok(())
}

fn cells(both: &[Tally; 2]) -> Vec<String> {
    let cells = both.iter().flat_map(|tally| {
        [
            percent(tally.refused_share()),
            percent(tally.undecided_share()),
            tally.presentations.to_string(),
        ]
    });
    cells.collect()
}
