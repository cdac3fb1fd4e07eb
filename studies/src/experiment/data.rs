//! What pictures show and what rigs recorded, as CSV: each file says its version and seed.

use anyhow::Result;
use std::fmt::Display;

use host_sim::origin::Origin;

use super::{Arm, Asked, Bodies, Dataset, Job, Part, Recording, Recordings};
use crate::page::Files;
use crate::rigs::{CHANNELS, FELT, INPUTS};

fn origin(asked: &Asked, seeds: impl Display) -> Origin {
    let said = Origin::default()
        .with("version", env!("CARGO_PKG_VERSION"))
        .with("seed", seeds);
    let folder = asked.rigs.iter();
    let said = folder.fold(said, |said, folder| said.with("rigs", folder.display()));
    let settings = asked.set.iter();
    settings.fold(said, |said, setting| said.with("set", setting))
}

fn table(
    origin: &Origin,
    header: &[String],
    rows: impl Iterator<Item = Vec<String>>,
) -> Result<String> {
    let mut text = Vec::new();
    origin.write(&mut text)?;
    let mut table = csv::Writer::from_writer(text);
    table.write_record(header)?;
    for row in rows {
        table.write_record(row)?;
    }
    let text = table.into_inner()?;
    String::from_utf8(text).map_err(anyhow::Error::new)
}

/// The data of every figure of a part, all seeds and both protocols in one file.
pub(super) fn figures(asked: &Asked, part: &Part, bodies: &Bodies) -> Result<Files> {
    let seeds = part.seeds.clone();
    let last = seeds.end.saturating_sub(1);
    let origin = origin(asked, format_args!("{} to {last}", seeds.start));
    let header = ["seed", "protocol", "panel", "curve", "x", "y"].map(str::to_owned);
    let mut files = Files::new();
    let shown = bodies.of(Arm::MAIN).first();
    for (name, _) in shown.map_or(&[][..], |page| &page.shown) {
        let mut rows = Vec::new();
        for arm in [Arm::MAIN, Arm::AGAIN] {
            for (seed, page) in seeds.clone().zip(bodies.of(arm)) {
                let shown = page.shown.iter().find(|(other, _)| other == name);
                for panel in shown.map_or(&[][..], |(_, panels)| panels) {
                    for series in &panel.series {
                        let protocol = arm.protocol.text().to_owned();
                        let (title, name) = (panel.title.clone(), series.name.clone());
                        let of = [seed.to_string(), protocol, title, name];
                        let point = |(x, y): &(f64, f64)| [x.to_string(), y.to_string()];
                        let points = series.points.iter().map(point);
                        rows.extend(points.map(|point| [&of[..], &point].concat()));
                    }
                }
            }
        }
        let text = table(&origin, &header, rows.into_iter())?;
        files.push((format!("figures/{name}.csv"), text));
    }
    Ok(files)
}

fn columns(dataset: Dataset, count: usize) -> Vec<String> {
    let axes = |n: usize| format!("{}{}", ["x", "y"][n % 2], n / 2);
    let name = |n: usize| match dataset {
        Dataset::Floor | Dataset::Table | Dataset::Vibrissa => ["x", "y"][n % 2].to_owned(),
        Dataset::Head if n < CHANNELS => axes(n),
        Dataset::Head => [
            "angle_left_deg",
            "angle_right_deg",
            "touching_left",
            "touching_right",
        ][(n - CHANNELS) % 4]
            .to_owned(),
        Dataset::Corridor if n >= FELT => axes(n - FELT),
        Dataset::Corridor if n >= INPUTS => {
            ["neck_m", "heading_rad", "left_mm", "right_mm"][(n - INPUTS) % 4].to_owned()
        }
        Dataset::Pad | Dataset::Corridor => format!("imp{n}"),
    };
    (0..count).map(name).collect()
}

pub(super) fn recordings(asked: &Asked, seed: u64, all: &Recordings) -> Result<Files> {
    let origin = origin(asked, seed);
    let one = |(job, recording): (&Job, &Recording)| {
        let header = columns(job.dataset, recording.channels);
        let samples = recording.values.chunks(recording.channels.max(1));
        let rows = samples.map(|sample| sample.iter().map(f32::to_string).collect());
        let name = job.dataset.text();
        let path = format!("recordings/{seed}/{name}-{:04}.csv", job.number);
        Ok((path, table(&origin, &header, rows)?))
    };
    all.iter().map(one).collect()
}
