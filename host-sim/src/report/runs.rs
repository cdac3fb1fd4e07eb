//! Scores of many runs, for people.

use std::ops::Range;

use tactile::score::Statistics;

use super::evaluation::{percent, refused, stated};
use crate::evaluation::Evaluation;
use crate::scoring::Scored;

pub(crate) fn seed_range(Range { start, end }: &Range<u64>) -> String {
    format!("{start} to {}", end.saturating_sub(1))
}

/// A figure of runs: its mean, the standard error of that, and the worst.
fn row(
    runs: &[Scored],
    name: &str,
    worst: fn(f64, f64) -> f64,
    figure: impl Fn(&Scored) -> f64,
) -> String {
    // A run without a decision has no such figure.
    let figures = || runs.iter().map(&figure).filter(|x| !x.is_nan());
    let Some(found) = Statistics::of(figures()) else {
        return format!("{name:<36} -\n");
    };
    let error = found.error().map(|error| format!("{error:.2}"));
    let (mean, error) = (found.mean, error.unwrap_or("-".to_owned()));
    let worst = figures().fold(f64::NAN, worst);
    format!("{name:<36} {mean:8.2} {error:>15} {worst:9.2}\n")
}

/// The figures of runs at so many ticks a second: of each the mean, its standard error and the
/// worst; then of all decisions together.
pub(crate) fn over_runs(runs: &[Scored], together: &Evaluation, tick_hz: f64) -> String {
    let ms = 1000.0 / tick_hz;
    let (low, high) = (f64::min, f64::max);
    let mut said = vec![format!(
        "{:<36}     mean  standard error     worst\n",
        "over runs"
    )];
    said.push(row(runs, "hit rate, %", low, |run| {
        100.0 * run.evaluation.hits.unwrap_or(f64::NAN)
    }));
    said.push(row(runs, "stated, %", low, |run| {
        100.0 * run.evaluation.calibration.stated
    }));
    said.push(row(runs, "calibration error, %", high, |run| {
        100.0 * run.evaluation.calibration.error()
    }));
    said.push(row(runs, "time of contact, ms", high, |run| {
        ms * run.evaluation.samples
    }));
    said.push(row(runs, "time by the clock, ms", high, |run| {
        ms * run.wall
    }));
    said.push(row(
        runs,
        "presentations without a decision, %",
        high,
        |run| 100.0 * run.evaluation.undecided.share,
    ));
    said.push(row(runs, "refused, %", high, |run| {
        100.0 * run.evaluation.refused.share
    }));
    let strange = together.strange;
    if strange.count > 0 {
        said.push(row(runs, "refused of the unknown texture, %", low, |run| {
            100.0 * run.evaluation.strange.share
        }));
    }
    said.push(format!(
        "\nall runs together (in brackets 95 % intervals)\n\n{}\n{}{}",
        together.score,
        stated(&together.calibration),
        refused(together)
    ));
    if strange.count > 0 {
        said.push(format!("refused, unknown   {}\n", percent(strange)));
    }
    said.push(format!(
        "without a decision {}",
        percent(together.undecided)
    ));
    said.concat()
}
