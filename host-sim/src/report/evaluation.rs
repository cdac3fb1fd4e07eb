//! What decisions are worth, for people.

use std::fmt;

use tactile::score::{Calibration, Interval};

use crate::evaluation::{Candidate, Evaluation};

/// A share in percent, with its interval.
pub(crate) struct Percent(pub(crate) Interval);

impl fmt::Display for Percent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Interval {
            share,
            low,
            high,
            count,
        } = self.0;
        if count == 0 {
            return write!(f, "of none");
        }
        let [share, low, high] = [share, low, high].map(|x| 100.0 * x);
        write!(f, "{share:.1} % ({low:.1} to {high:.1}) of {count}")
    }
}

/// The figures of an evaluation; times by samples a second.
#[derive(Debug)]
pub struct Figures<'a>(pub &'a Evaluation, pub f64);

impl fmt::Display for Figures<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(evaluation, tick_hz) = self;
        let Evaluation {
            score,
            hits,
            samples,
            calibration,
            refused,
            strange,
            undecided,
        } = evaluation;
        writeln!(f, "{score}")?;
        match hits {
            Some(hits) => {
                let hits = 100.0 * hits;
                let ms = samples * 1000.0 / tick_hz;
                writeln!(f, "hit rate           {hits:.1} % (mean over classes)")?;
                writeln!(f, "decision time      {samples:.0} samples ({ms:.0} ms)")?;
                write!(f, "{}", Stated(calibration))?;
            }
            None => writeln!(f, "no decision for a class")?,
        }
        writeln!(f, "refused            {}", Percent(*refused))?;
        if strange.count > 0 {
            writeln!(f, "refused, new       {}", Percent(*strange))?;
        }
        write!(f, "without a decision {}", Percent(*undecided))
    }
}

/// Stated against found, with a bar for each bin: o what was found, | what was stated.
pub(crate) struct Stated<'a>(pub(crate) &'a Calibration);

impl fmt::Display for Stated<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let calibration = self.0;
        let stated = 100.0 * calibration.stated;
        writeln!(f, "stated             {stated:.2} %")?;
        writeln!(f, "found              {}", Percent(calibration.found))?;
        let error = 100.0 * calibration.error();
        writeln!(
            f,
            "calibration error  {error:.2} % (mean over decisions, by bins)"
        )?;
        for bin in &calibration.bins {
            let stated = 100.0 * bin.stated;
            let range = format!("{} to {}", bin.low, bin.high);
            writeln!(
                f,
                "    {range:<15} stated {stated:6.2} %, found {}",
                Percent(bin.found)
            )?;
        }
        Ok(())
    }
}

/// What each threshold gives; times by samples a second.
#[derive(Debug)]
pub struct Thresholds<'a>(pub &'a [Candidate], pub f64);

impl fmt::Display for Thresholds<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(scan, tick_hz) = self;
        write!(
            f,
            "threshold   wrong (95 %)             time  refused  without a decision"
        )?;
        for at in *scan {
            let evaluation = &at.evaluation;
            let found = evaluation.calibration.found;
            let [wrong, low, high, refused, undecided] = [
                at.wrong(),
                1.0 - found.high,
                1.0 - found.low,
                evaluation.refused.share,
                evaluation.undecided.share,
            ]
            .map(|share| 100.0 * share);
            let interval = format!("({low:.2} to {high:.2})");
            let ms = evaluation.samples * 1000.0 / tick_hz;
            write!(
                f,
                "\n{:<9} {wrong:6.2} % {interval:<15} {ms:6.0} ms  {refused:5.1} %  {undecided:5.1} %",
                at.threshold
            )?;
        }
        Ok(())
    }
}
