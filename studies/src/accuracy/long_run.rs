//! A day of whisking: drift of phase and amplitude in every format.
//!
//! Phase is counted by upward zero crossings of ψ₁ of the left side, each
//! placed by a straight line between the two ticks around it. A day takes a
//! minute or so, so its results are kept in a table beside the page.

mod whisk;

use anyhow::Result;
use std::path::Path;

use super::schemes::{Format, PAPERS, Pace, in_format};
use crate::cores::each;
use crate::page::{Page, short, verdict};
use host_sim::Error;
use host_sim::progress::Verbosity;
use whisk::{Length, MINUTE_TICKS, Row, run};

/// A frequency that no number of ticks is whole whisks of: at 2 Hz a whisk is
/// 1000 ticks, and rounding holds the phase to the orbit that closes.
const ODD: Pace = Pace {
    frequency_hz: std::f64::consts::E,
    ..PAPERS
};
/// Largest |r − 1| that is allowed.
const ROUND: f64 = 1e-3;
/// 24 hours, a row an hour.
pub(super) const DAY: Length = Length {
    stretches: 24,
    minutes: 60,
};
/// Ten minutes, a row a minute.
pub(super) const QUICK: Length = Length {
    stretches: 10,
    minutes: 1,
};

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table(Vec<Row>);

impl Table {
    /// Runs all formats at 2 Hz, and one stretch of each at the odd frequency.
    pub(super) fn measure(length: Length, verbosity: Verbosity) -> Result<Self> {
        let stretch = Length {
            stretches: 1,
            ..length
        };
        let both = |format| [(format, PAPERS, length), (format, ODD, stretch)];
        let jobs: Vec<_> = Format::ALL.into_iter().flat_map(both).collect();
        let rows = each(verbosity, "long run", &jobs, |&(format, pace, length)| {
            in_format!(format, run(format, pace, length))
        })?;
        Ok(Self(rows.concat()))
    }

    /// Reads what [`Table::csv`] wrote.
    pub(super) fn read(path: &Path) -> Result<Self> {
        let rows = csv::Reader::from_path(path)
            .and_then(|file| file.into_deserialize().collect::<Result<_, _>>());
        let wrong = |fault| Error::file(path, format!("{fault}; run with --long"));
        Ok(Self(rows.map_err(wrong)?))
    }

    pub(super) fn csv(&self) -> Result<String> {
        let mut table = csv::Writer::from_writer(Vec::new());
        for row in &self.0 {
            table.serialize(row)?;
        }
        Ok(String::from_utf8(table.into_inner()?)?)
    }
}

pub(super) fn section(page: &mut Page, Table(rows): &Table, quick: bool) {
    page.heading(2, "Long run");
    let last = rows.iter().map(|row| row.minutes).max().unwrap_or(0);
    let ticks = (last + 1) * MINUTE_TICKS;
    page.say(format_args!(
        "The exact integrator at 2 Hz and 2 kHz for {} ({ticks} ticks with a minute to settle), \
         without noise. Phase against the exact frequency by interpolated zero crossings of ψ₁; \
         amplitude is the range of θ'. At 2 Hz a whisk is exactly 1000 ticks, and rounding holds \
         the phase to the orbit that closes. A shorter run at {:.4} Hz, where none closes, shows \
         what rounding does to the frequency elsewhere.",
        time(last),
        ODD.frequency_hz
    ));
    page.say(if quick {
        "**This page was written with `--quick`**: ten minutes in place of 24 hours."
    } else {
        "A day takes too long for every run of the report. `studies report --long` runs it and \
         writes `docs/measured/accuracy/long-run.csv`; what stands here is read from there."
    });
    let cells = [PAPERS, ODD].map(|pace| Format::ALL.map(|format| summary(rows, format, pace)));
    page.table(
        "run | largest deviation of r from 1 | goal 1e-3 | phase at the end, degrees | \
         frequency, ppm | drift of the range of θ', degrees",
        cells.into_iter().flatten().flatten(),
    );
}

fn time(minutes: u64) -> String {
    match minutes {
        60 => "1 hour".to_owned(),
        1 => "1 minute".to_owned(),
        _ if minutes.is_multiple_of(60) => format!("{} hours", minutes / 60),
        _ => format!("{minutes} minutes"),
    }
}

fn summary(rows: &[Row], format: Format, pace: Pace) -> Option<Vec<String>> {
    let is_own = |row: &&Row| row.format == format.name() && row.frequency_hz == pace.frequency_hz;
    let mut own = rows.iter().filter(is_own);
    let first = own.clone().next()?;
    let last = own.clone().next_back()?;
    let off = |row: &Row| f64::max(row.radius_high - 1.0, 1.0 - row.radius_low);
    let round = own.clone().map(off).fold(0.0, f64::max);
    let finite = own.all(|row| row.radius_low.is_finite() && row.radius_high.is_finite());
    let low = (last.theta_low_deg - first.theta_low_deg).abs();
    let high = (last.theta_high_deg - first.theta_high_deg).abs();
    let drift = low.max(high);
    Some(vec![
        format!(
            "{}, {:.4} Hz, {}",
            format.name(),
            pace.frequency_hz,
            time(last.minutes)
        ),
        short(round),
        verdict(finite && round <= ROUND).to_owned(),
        short(360.0 * last.phase_whisks),
        short(1e6 * last.phase_whisks / last.whisks.max(1.0)),
        // A run of one stretch has nothing to drift from.
        if first == last {
            String::new()
        } else {
            short(drift)
        },
    ])
}

#[cfg(test)]
mod tests {
    use super::{Length, Path, Table};
    use host_sim::progress::Verbosity;

    #[test]
    fn a_table_survives_its_file() {
        let length = Length {
            stretches: 2,
            minutes: 1,
        };
        let table = Table::measure(length, Verbosity::Quiet).unwrap();
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), table.csv().unwrap()).unwrap();
        assert_eq!(Table::read(file.path()).unwrap(), table);
        assert_eq!(table.0.len(), 9);
        for row in &table.0 {
            assert!(
                row.phase_whisks.abs() < 1e-4 && row.whisks > 100.0,
                "{row:?}"
            );
        }
        std::fs::write(file.path(), "format\nf64,x\n").unwrap();
        assert!(Table::read(file.path()).is_err());
        assert!(Table::read(Path::new("/nowhere/at/all")).is_err());
    }
}
