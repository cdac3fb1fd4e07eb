//! A day of whisking: drift of phase and amplitude in every format.
//!
//! Phase is counted by upward zero crossings of ψ₁ of the left side, each
//! placed by a straight line between the two ticks around it. A day takes a
//! minute or so, so its results are kept in a table beside the page.

mod whisk;

use anyhow::{Result, anyhow};
use std::fmt::Write;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use whisking::Number;

use super::schemes::{Format, PAPERS, Pace, in_format};
use crate::chart::{Mark, Panel, Series, draw, linear};
use crate::page::{Page, short, verdict};
use host_sim::Error;
use host_sim::progress::{Progress, Verbosity};
use whisk::{Length, MINUTE_TICKS, Row};

/// A frequency that no number of ticks is whole whisks of: at 2 Hz a whisk is
/// 1000 ticks, and rounding holds the phase to the orbit that closes.
const ODD: Pace = Pace {
    frequency_hz: std::f64::consts::E,
    ..PAPERS
};
/// Largest |r − 1| that is allowed.
const ROUND: f64 = 1e-3;
const HEADER: &str = "format,frequency_hz,minutes,phase_whisks,whisks,radius_low,radius_high,theta_low_deg,theta_high_deg";

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

/// Rows of all formats.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table(Vec<Row>);

impl Table {
    /// Runs all formats side by side.
    pub(super) fn measure(length: Length, verbosity: Verbosity) -> Result<Self> {
        let formats = Format::ALL.len() as u64;
        let total = formats * (length.stretches + 1) * length.minutes;
        let done = AtomicU64::new(0);
        let mut progress = Progress::new(verbosity, "long run", total);
        let rows = thread::scope(|scope| {
            let work = Format::ALL.map(|format| {
                let done = &done;
                scope.spawn(move || in_format!(format, both(format, length, done)))
            });
            while work.iter().any(|thread| !thread.is_finished()) {
                progress.set(done.load(Ordering::Relaxed));
                thread::sleep(Duration::from_millis(50));
            }
            let lost = |_| Err(anyhow!("the long run broke down"));
            let join = |thread: thread::ScopedJoinHandle<'_, _>| thread.join().unwrap_or_else(lost);
            work.into_iter().map(join).collect::<Result<Vec<_>, _>>()
        })?;
        Ok(Self(rows.concat()))
    }

    /// Reads what [`Table::csv`] wrote.
    pub(super) fn read(path: &Path) -> Result<Self> {
        let wrong = |fault: String| Error::file(path, format!("{fault}; run with --long"));
        let text = std::fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
        // Not by the names of the header: a range takes two columns.
        let mut reader = csv::ReaderBuilder::new();
        let reader = reader.has_headers(false).from_reader(text.as_bytes());
        let rows = reader.into_deserialize().skip(1).collect::<Result<_, _>>();
        Ok(Self(rows.map_err(|error| wrong(error.to_string()))?))
    }

    /// As comma-separated text.
    pub(super) fn csv(&self) -> String {
        let mut text = format!("{HEADER}\n");
        for row in &self.0 {
            let [low, high] = row.radius;
            let [back, forth] = row.theta_deg;
            // Writing to a string does not fail.
            let _ = writeln!(
                text,
                "{},{},{},{:e},{},{low},{high},{back},{forth}",
                row.format, row.frequency_hz, row.minutes, row.phase_whisks, row.whisks
            );
        }
        text
    }
}

/// The whole run at 2 Hz, then one stretch of it at the odd frequency.
fn both<R: Number>(format: Format, length: Length, done: &AtomicU64) -> Result<Vec<Row>> {
    let mut rows = whisk::run::<R>(format, PAPERS, length, done)?;
    let stretch = Length {
        stretches: 1,
        ..length
    };
    rows.extend(whisk::run::<R>(format, ODD, stretch, done)?);
    Ok(rows)
}

/// What the table says.
pub(super) fn section(page: &mut Page, Table(rows): &Table, quick: bool) -> Result<()> {
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
    let svg = picture(rows)?;
    page.picture("long-run.svg", "phase over the run", svg);
    Ok(())
}

fn time(minutes: u64) -> String {
    match minutes {
        60 => "1 hour".to_owned(),
        1 => "1 minute".to_owned(),
        _ if minutes.is_multiple_of(60) => format!("{} hours", minutes / 60),
        _ => format!("{minutes} minutes"),
    }
}

/// The rows of one run, in order.
fn own(rows: &[Row], format: Format, pace: Pace) -> impl Iterator<Item = &Row> + Clone {
    let is_own =
        move |row: &&Row| row.format == format.name() && row.frequency_hz == pace.frequency_hz;
    rows.iter().filter(is_own)
}

fn summary(rows: &[Row], format: Format, pace: Pace) -> Option<Vec<String>> {
    let mut own = own(rows, format, pace);
    let first = own.clone().next()?;
    let last = own.clone().last()?;
    let off = |row: &Row| f64::max(row.radius[1] - 1.0, 1.0 - row.radius[0]);
    let round = own.clone().map(off).fold(0.0, f64::max);
    let finite = own.all(|row| row.radius.iter().all(|r| r.is_finite()));
    let drift = (0..2).map(|end| (last.theta_deg[end] - first.theta_deg[end]).abs());
    let drift = drift.fold(0.0, f64::max);
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

fn picture(rows: &[Row]) -> Result<String> {
    let hours = |row: &Row| row.minutes as f64 / 60.0;
    let degrees = |row: &Row| 360.0 * row.phase_whisks;
    let shown = || {
        Format::ALL
            .into_iter()
            .flat_map(|format| own(rows, format, PAPERS))
    };
    let most = shown().map(|row| degrees(row).abs());
    let most = 1.1 * most.fold(1e-9, f64::max);
    let series = |(n, format): (usize, Format)| {
        let points = own(rows, format, PAPERS).map(|row| (hours(row), degrees(row)));
        Series::new(format.name(), n + 1, Mark::Dot, points.collect())
    };
    let end = shown().map(hours).fold(0.0, f64::max);
    draw(&[Panel {
        title: "phase ahead of exactly 2 Hz".to_owned(),
        x: linear("hours", 0.0, end.max(1e-3)),
        y: linear("degrees of a whisk", -most, most),
        series: Format::ALL.into_iter().enumerate().map(series).collect(),
    }])
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
        std::fs::write(file.path(), table.csv()).unwrap();
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
