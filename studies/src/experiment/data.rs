//! What pictures show and what rigs recorded, as CSV: each file says its version and seed.

use std::fmt::Write;

use super::bodies::Bodies;
use super::dataset::Dataset;
use super::protocol::{Files, Protocol};
use super::recording::Recordings;
use crate::rigs::CHANNELS;

/// The first line of every file.
fn header(protocol: &Protocol, seeds: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let set = protocol.set.join(", ");
    format!("# whisker studies {version}; seed {seeds}; set: {set}\n")
}

/// A cell of CSV.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

/// The data of every figure, all seeds in one file.
pub(super) fn figures(protocol: &Protocol, bodies: &Bodies) -> Files {
    let mut files = Files::new();
    let shown = bodies.pages.first().map_or(&[][..], |page| &page.shown);
    for (n, first) in shown.iter().enumerate() {
        let (from, count) = protocol.seeds;
        let mut text = header(protocol, &format!("{from} to {}", from + count - 1));
        text.push_str("seed,panel,curve,x,y\n");
        for (seed, page) in protocol.all_seeds().zip(&bodies.pages) {
            for panel in page.shown.get(n).map_or(&[][..], |shown| &shown.panels) {
                for series in &panel.series {
                    let (title, name) = (quoted(&panel.title), quoted(&series.name));
                    for (x, y) in &series.points {
                        // Writing to a string does not fail.
                        let _ = writeln!(text, "{seed},{title},{name},{x},{y}");
                    }
                }
            }
        }
        files.push((format!("figures/{}.csv", first.name), text));
    }
    files
}

/// The names of a recording's columns.
fn columns(dataset: Dataset, count: usize) -> String {
    let axes = |n: usize| format!("{}{}", ["x", "y"][n % 2], n / 2);
    let name = |n: usize| match dataset {
        Dataset::Floor | Dataset::Table => ["x", "y"][n % 2].to_owned(),
        Dataset::Head if n < CHANNELS => axes(n),
        Dataset::Head => [
            "angle_left_deg",
            "angle_right_deg",
            "touching_left",
            "touching_right",
        ][(n - CHANNELS) % 4]
            .to_owned(),
        Dataset::Corridor if n + 4 >= count => {
            ["neck_m", "heading_rad", "left_mm", "right_mm"][n + 4 - count].to_owned()
        }
        Dataset::Pad | Dataset::Corridor => format!("imp{n}"),
    };
    (0..count).map(name).collect::<Vec<_>>().join(",")
}

/// Every recording of a seed, each in a file of its own.
pub(super) fn recordings(protocol: &Protocol, seed: u64, all: &Recordings) -> Files {
    let one = |(job, recording): (&super::Job, &super::Recording)| {
        let mut text = header(protocol, &seed.to_string());
        text.push_str(&columns(job.dataset, recording.channels));
        text.push('\n');
        for sample in recording.values.chunks(recording.channels.max(1)) {
            let cells: Vec<String> = sample.iter().map(f32::to_string).collect();
            text.push_str(&cells.join(","));
            text.push('\n');
        }
        let name = job.dataset.text();
        (
            format!("recordings/{seed}/{name}-{:04}.csv", job.number),
            text,
        )
    };
    all.iter().map(one).collect()
}
