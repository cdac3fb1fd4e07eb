//! docs/textures.md: what the main job printed, and its mean over many runs.

use serde::Deserialize;

use crate::run::Fault;

pub(super) const DECISIONS: &str = "docs/measured/decisions.csv";

#[derive(Debug, Deserialize)]
struct ManyRuns {
    part: String,
    runs: u32,
    hit_rate: f64,
    hit_rate_error: f64,
    worst_run: f64,
    stated: f64,
    found: f64,
    contact_ms: f64,
}

impl ManyRuns {
    fn read(table: &str) -> Result<Self, Fault> {
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        let mut lines = reader.deserialize::<Self>().flatten();
        let line = lines.find(|line| line.part == "main job");
        line.ok_or_else(|| format!("{DECISIONS} does not tell the main job"))
    }
}

/// The page of the main job: what it printed at the end, and what `decisions` tells of many runs.
pub(super) fn page(said: &str, decisions: &str) -> Result<String, Fault> {
    let score = said.split_once("\n\n").map(|(_, score)| score.trim_end());
    let score = score.ok_or("the main job printed no score")?;
    let many = ManyRuns::read(decisions)?;
    Ok(format!(
        include_str!("main_job.md.in"),
        score = score,
        runs = many.runs,
        hit_rate = many.hit_rate,
        hit_rate_error = many.hit_rate_error,
        worst_run = many.worst_run,
        stated = many.stated,
        found = many.found,
        contact_ms = many.contact_ms,
    ))
}
