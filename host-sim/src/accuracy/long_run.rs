//! A day of whisking: drift of phase and amplitude in every format.
//!
//! Phase is counted by upward zero crossings of ψ₁ of the left side, each
//! placed by a straight line between the two ticks around it. A day takes a
//! minute or so, so its results are kept in a table beside the page.

mod whisk;

use std::fmt::Write;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use whisking::Fix;

use super::chart::{Axis, COLOURS, Mark, Panel, Series, draw};
use super::page::{Page, short, verdict};
use super::schemes::{Format, Pace};
use crate::Error;
use crate::progress::{Progress, Verbosity};

/// 2 Hz at 2 kHz.
const PACE: Pace = Pace {
    frequency_hz: 2.0,
    tick_hz: 2_000.0,
};
const MINUTE_TICKS: u64 = 120_000;
/// Largest |r − 1| that is allowed.
const ROUND: f64 = 1e-3;
const HEADER: &str =
    "format,minutes,phase_whisks,whisks,radius_low,radius_high,theta_low_deg,theta_high_deg";

/// How long to run: stretches after each of which a row is written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Length {
    stretches: u64,
    minutes: u64,
}

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

/// The state of a run after a stretch; extremes are those of the stretch.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    format: String,
    /// Since the run settled.
    minutes: u64,
    /// Phase ahead of the exact frequency, and whisks since the first crossing.
    phase_whisks: f64,
    whisks: f64,
    radius: [f64; 2],
    theta_deg: [f64; 2],
}

/// Rows of all formats.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table(Vec<Row>);

impl Table {
    /// Runs all formats side by side.
    pub(super) fn measure(length: Length, verbosity: Verbosity) -> Result<Self, Error> {
        let formats = Format::ALL.len() as u64;
        let total = formats * length.stretches * length.minutes;
        let done = AtomicU64::new(0);
        let mut progress = Progress::new(verbosity, "long run", total);
        let rows = thread::scope(|scope| {
            let work = Format::ALL.map(|format| {
                let done = &done;
                scope.spawn(move || match format {
                    Format::F64 => whisk::run::<f64>(format, length, done),
                    Format::F32 => whisk::run::<f32>(format, length, done),
                    Format::Fixed => whisk::run::<Fix>(format, length, done),
                })
            });
            while work.iter().any(|thread| !thread.is_finished()) {
                progress.set(done.load(Ordering::Relaxed));
                thread::sleep(Duration::from_millis(50));
            }
            let lost = |_| Err(Error::Work("the long run broke down".to_owned()));
            let join = |thread: thread::ScopedJoinHandle<'_, _>| thread.join().unwrap_or_else(lost);
            work.into_iter().map(join).collect::<Result<Vec<_>, _>>()
        })?;
        Ok(Self(rows.concat()))
    }

    /// Reads what [`Table::csv`] wrote; `None` if there is no such file.
    pub(super) fn read(path: &Path) -> Result<Option<Self>, Error> {
        let Ok(text) = std::fs::read_to_string(path) else {
            return Ok(None);
        };
        let rows = text.lines().skip(1).map(Row::parse);
        let rows: Option<Vec<Row>> = rows.collect();
        match rows.filter(|rows| !rows.is_empty()) {
            Some(rows) => Ok(Some(Self(rows))),
            None => Err(Error::file(
                path,
                "is not a table of a long run: run with --long",
            )),
        }
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
                "{},{},{:e},{},{low},{high},{back},{forth}",
                row.format, row.minutes, row.phase_whisks, row.whisks
            );
        }
        text
    }
}

impl Row {
    fn parse(line: &str) -> Option<Self> {
        let mut cells = line.split(',');
        let format = cells.next()?.to_owned();
        let minutes = cells.next()?.parse().ok()?;
        let mut number = || cells.next()?.parse::<f64>().ok();
        Some(Self {
            format,
            minutes,
            phase_whisks: number()?,
            whisks: number()?,
            radius: [number()?, number()?],
            theta_deg: [number()?, number()?],
        })
    }
}

/// What the table says.
pub(super) fn section(page: &mut Page, table: Option<&Table>, quick: bool) -> Result<(), Error> {
    page.heading(2, "Long run");
    let Some(Table(rows)) = table else {
        page.say("Not run yet: `host-sim report --long` writes `docs/accuracy/long-run.csv`.");
        return Ok(());
    };
    let last = rows.last().map_or(0, |row| row.minutes);
    let ticks = (last + 1) * MINUTE_TICKS;
    page.say(format_args!(
        "The exact integrator for {} at 2 Hz and 2 kHz ({ticks} ticks), after a minute to \
         settle, without noise. Phase against exactly 2 Hz by interpolated zero crossings of \
         ψ₁; amplitude is the range of θ'.",
        if last % 60 == 0 {
            format!("{} hours", last / 60)
        } else {
            format!("{last} minutes")
        }
    ));
    page.say(if quick {
        "**This page was written with `--quick`**: ten minutes in place of 24 hours."
    } else {
        "A day takes too long for every run of the report. `host-sim report --long` runs it and \
         writes `docs/accuracy/long-run.csv`; what stands here is read from there."
    });
    let cells = Format::ALL.map(|format| summary(rows, format));
    page.table(
        "format | largest deviation of r from 1 | goal 1e-3 | phase at the end, degrees | \
         frequency, ppm | drift of the range of θ', degrees",
        cells.into_iter().flatten(),
    );
    let svg = picture(rows)?;
    page.picture("long-run.svg", "phase over the run", svg);
    Ok(())
}

fn summary(rows: &[Row], format: Format) -> Option<Vec<String>> {
    let mut own = rows.iter().filter(|row| row.format == format.name());
    let first = own.clone().next()?;
    let last = own.clone().next_back()?;
    let off = |row: &Row| f64::max(row.radius[1] - 1.0, 1.0 - row.radius[0]);
    let round = own.clone().map(off).fold(0.0, f64::max);
    let finite = own.all(|row| row.radius.iter().all(|r| r.is_finite()));
    let drift = (0..2).map(|end| (last.theta_deg[end] - first.theta_deg[end]).abs());
    Some(vec![
        format.name().to_owned(),
        short(round),
        verdict(finite && round <= ROUND).to_owned(),
        short(360.0 * last.phase_whisks),
        short(1e6 * last.phase_whisks / last.whisks.max(1.0)),
        short(drift.fold(0.0, f64::max)),
    ])
}

fn picture(rows: &[Row]) -> Result<String, Error> {
    let hours = |row: &Row| row.minutes as f64 / 60.0;
    let degrees = |row: &Row| 360.0 * row.phase_whisks;
    let most = rows.iter().map(|row| degrees(row).abs());
    let most = 1.1 * most.fold(1e-9, f64::max);
    let series = |(n, format): (usize, Format)| Series {
        name: format.name().to_owned(),
        colour: COLOURS.get(n + 1).copied().unwrap_or(COLOURS[0]),
        mark: Mark::Dot,
        joined: true,
        points: rows
            .iter()
            .filter(|row| row.format == format.name())
            .map(|row| (hours(row), degrees(row)))
            .collect(),
    };
    let end = rows.iter().map(hours).fold(0.0, f64::max);
    draw(&[Panel {
        title: "phase ahead of exactly 2 Hz".to_owned(),
        x: Axis {
            name: "hours",
            low: 0.0,
            high: end.max(1e-3),
            log: false,
        },
        y: Axis {
            name: "degrees of a whisk",
            low: -most,
            high: most,
            log: false,
        },
        series: Format::ALL.into_iter().enumerate().map(series).collect(),
    }])
}

#[cfg(test)]
mod tests {
    use super::{Length, Table};
    use crate::progress::Verbosity;

    #[test]
    fn a_table_survives_its_file() {
        let length = Length {
            stretches: 2,
            minutes: 1,
        };
        let table = Table::measure(length, Verbosity::Quiet).unwrap();
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), table.csv()).unwrap();
        assert_eq!(Table::read(file.path()).unwrap(), Some(table.clone()));
        assert_eq!(table.0.len(), 6);
        for row in &table.0 {
            assert!(
                row.phase_whisks.abs() < 1e-4 && row.whisks > 100.0,
                "{row:?}"
            );
        }
        std::fs::write(file.path(), "format\nf64,x\n").unwrap();
        assert!(Table::read(file.path()).is_err());
        assert_eq!(
            Table::read(std::path::Path::new("/nowhere/at/all")).unwrap(),
            None
        );
    }
}
