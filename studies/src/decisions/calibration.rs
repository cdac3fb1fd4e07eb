//! Stated against found, as a picture and a table.

use anyhow::Result;
use tactile::score::{CalibrationBin, Interval};

use super::figures::percent;
use super::goals::{THRESHOLDS, Trained};
use super::ground::Ground;
use crate::chart::{Axis, Mark, Panel, Series};
use crate::page::{Page, row};

/// The least that is stated, the least that is found, and the most: shares of errors.
const STATED: f64 = 1e-5;
const FOUND: f64 = 1e-4;
const HIGH: f64 = 0.1;

pub(super) fn section(page: &mut Page, grounds: &[Ground]) -> Result<()> {
    page.heading(2, "Stated against found");
    page.say(
        "Decisions of all trainings by their posterior, at three thresholds. The picture shows \
         the share of errors: stated 99 % is 1e-2. On the grey line a posterior is what it says; \
         below it decisions are right more often than they say, above it less often. Bars are \
         95 % intervals; where none was wrong only the bar is drawn, from the bottom.",
    );
    let panels: Vec<Panel> = grounds
        .iter()
        .map(|ground| panel(ground.name, &ground.trained))
        .collect();
    page.panels("calibration.svg", "stated against found", &panels)?;
    let (at, (threshold, _)) = (0, THRESHOLDS[0]);
    for ground in grounds {
        let rows = pooled(&ground.trained, at).into_iter().map(|bin| {
            let setting = format!("{} to {}", bin.low, bin.high);
            let cells = [
                format!("{:.2}", 100.0 * bin.stated),
                percent(bin.found),
                bin.found.count.to_string(),
            ];
            row(setting, cells)
        });
        let rows: Vec<_> = rows.collect();
        page.say(format_args!("{}, threshold {threshold}:", ground.name));
        page.table("posterior | stated | found | decisions", rows);
    }
    Ok(())
}

fn pooled(trained: &[Trained], at: usize) -> Vec<CalibrationBin> {
    let mut pooled: Vec<CalibrationBin> = Vec::new();
    let bins = trained.iter().flat_map(|one| &one.at[at].calibration.bins);
    for bin in bins {
        match pooled.iter_mut().find(|other| other.low == bin.low) {
            Some(other) => *other = both(other, bin),
            None => pooled.push(*bin),
        }
    }
    pooled.sort_by(|a, b| a.low.total_cmp(&b.low));
    pooled
}

fn both(a: &CalibrationBin, b: &CalibrationBin) -> CalibrationBin {
    let count = a.found.count + b.found.count;
    let sum = |figure: fn(&CalibrationBin) -> f64| {
        figure(a) * a.found.count as f64 + figure(b) * b.found.count as f64
    };
    CalibrationBin {
        stated: sum(|bin| bin.stated) / count as f64,
        found: Interval::of(sum(|bin| bin.found.share).round() as usize, count),
        ..*a
    }
}

fn panel(name: &str, trained: &[Trained]) -> Panel {
    let axis = |name, low| Axis::decades(name, [low, HIGH].into_iter());
    let inside = |x: f64| x.clamp(FOUND, HIGH);
    let mut series = vec![Series::new(
        "as stated",
        0,
        Mark::Nothing,
        vec![(FOUND, FOUND), (HIGH, HIGH)],
    )];
    let marks = [Mark::Dot, Mark::Ring, Mark::Cross];
    for (at, ((threshold, _), mark)) in THRESHOLDS.iter().zip(marks).enumerate() {
        let bins = pooled(trained, at);
        let place = |bin: &CalibrationBin| (1.0 - bin.stated).clamp(STATED, HIGH);
        let wrong = bins.iter().filter(|bin| bin.found.share < 1.0);
        let points = wrong.map(|bin| (place(bin), inside(1.0 - bin.found.share)));
        let name = format!("threshold {threshold}");
        series.push(Series::new(&name, at + 1, mark, points.collect()).unjoined());
        for bin in &bins {
            let bar = [bin.found.high, bin.found.low].map(|x| (place(bin), inside(1.0 - x)));
            series.push(Series::new("", at + 1, Mark::Nothing, bar.to_vec()));
        }
    }
    Panel {
        title: name.to_owned(),
        x: axis("share of errors stated", STATED),
        y: axis("share of errors found", FOUND),
        series,
    }
}
