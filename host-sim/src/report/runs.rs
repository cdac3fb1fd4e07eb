//! Scores of many runs, for people.

use std::fmt;
use std::ops::Range;

use tactile::score::Statistics;

use super::evaluation::{percent, refused, stated};
use crate::evaluation::Evaluation;
use crate::scoring::Scored;

/// The first and the last of some seeds.
pub fn seed_range(Range { start, end }: &Range<u64>) -> String {
    format!("{start} to {}", end.saturating_sub(1))
}

/// The figures of runs: of each the mean, its standard error and the worst, then all
/// decisions together.
#[derive(Debug)]
pub struct OverRuns<'a> {
    /// The runs.
    pub runs: &'a [Scored],
    /// All their presentations together.
    pub together: &'a Evaluation,
    /// Ticks a second.
    pub tick_hz: f64,
}

#[derive(Clone, Copy)]
enum Worst {
    Low,
    High,
}

impl OverRuns<'_> {
    fn row(
        &self,
        f: &mut fmt::Formatter<'_>,
        name: &str,
        worst: Worst,
        figure: impl Fn(&Scored) -> f64,
    ) -> fmt::Result {
        // A run without a decision has no such figure.
        let figures = || self.runs.iter().map(&figure).filter(|x| !x.is_nan());
        let Some(found) = Statistics::of(figures()) else {
            return writeln!(f, "{name:<36} -");
        };
        let worst = match worst {
            Worst::Low => figures().fold(f64::INFINITY, f64::min),
            Worst::High => figures().fold(f64::NEG_INFINITY, f64::max),
        };
        let error = found.error().map(|error| format!("{error:.2}"));
        let (mean, error) = (found.mean, error.unwrap_or("-".to_owned()));
        writeln!(f, "{name:<36} {mean:8.2} {error:>15} {worst:9.2}")
    }
}

impl fmt::Display for OverRuns<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share = |x: f64| 100.0 * x;
        let ms = 1000.0 / self.tick_hz;
        writeln!(f, "{:<36}     mean  standard error     worst", "over runs")?;
        self.row(f, "hit rate, %", Worst::Low, |run| {
            share(run.evaluation.hits.unwrap_or(f64::NAN))
        })?;
        self.row(f, "stated, %", Worst::Low, |run| {
            share(run.evaluation.calibration.stated)
        })?;
        self.row(f, "calibration error, %", Worst::High, |run| {
            share(run.evaluation.calibration.error())
        })?;
        self.row(f, "time of contact, ms", Worst::High, |run| {
            ms * run.evaluation.samples
        })?;
        self.row(f, "time by the clock, ms", Worst::High, |run| ms * run.wall)?;
        self.row(
            f,
            "presentations without a decision, %",
            Worst::High,
            |run| share(run.evaluation.undecided.share),
        )?;
        self.row(f, "refused, %", Worst::High, |run| {
            share(run.evaluation.refused.share)
        })?;
        let Evaluation {
            score,
            calibration,
            strange,
            undecided,
            ..
        } = self.together;
        if strange.count > 0 {
            self.row(f, "refused of the unknown texture, %", Worst::Low, |run| {
                share(run.evaluation.strange.share)
            })?;
        }
        writeln!(
            f,
            "\nall runs together (in brackets 95 % intervals)\n\n{score}"
        )?;
        write!(f, "{}{}", stated(calibration), refused(self.together))?;
        if strange.count > 0 {
            writeln!(f, "refused, unknown   {}", percent(*strange))?;
        }
        write!(f, "without a decision {}", percent(*undecided))
    }
}
