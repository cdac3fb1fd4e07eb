//! The stages of a tick and why some miss their goals: the rows of stages.csv and reasons.toml.

use serde::Deserialize;

use crate::figures::Figure;
use crate::run::Fault;

#[derive(Deserialize)]
pub(super) struct Stage {
    #[serde(rename = "stage")]
    pub(super) name: String,
    pub(super) target: String,
    /// The processor of the counts, or the scene that runs on the emulated board.
    pub(super) from: String,
    pub(super) format: String,
    /// Kernels, or what the board calls it.
    pub(super) counts: String,
    /// At most so many instructions, mean; where a second number follows, worst.
    pub(super) goal: String,
    /// What others take, and who.
    pub(super) others: String,
}

impl Stage {
    /// Whether one run measures both.
    pub(super) fn goes_with(&self, other: &Self) -> bool {
        self.from == other.from && (!self.is_on_board() || self.target == other.target)
    }

    pub(super) fn is_on_board(&self) -> bool {
        self.from.starts_with("scenes/")
    }

    /// The kernels it is made of, with 1 to add one and −1 to take it away.
    pub(super) fn kernels(&self) -> impl Iterator<Item = (&str, f64)> {
        self.counts.split(" + ").flat_map(|sum| {
            let kernels = sum.split(" - ").enumerate();
            kernels.map(|(place, kernel)| (kernel, if place == 0 { 1.0 } else { -1.0 }))
        })
    }
}

/// All stages, those of one processor or scene side by side.
pub(super) fn stages() -> Result<Vec<Stage>, Fault> {
    let mut reader = csv::ReaderBuilder::new();
    let reader = reader.comment(Some(b'#'));
    let rows = reader.from_reader(&include_bytes!("stages.csv")[..]);
    let rows: Result<_, _> = rows.into_deserialize().collect();
    rows.map_err(|error| format!("stages.csv: {error}"))
}

/// Goal and peers of a stage, both empty if there are none.
pub(super) fn beside<'s>(stages: &'s [Stage], figure: &Figure) -> [&'s str; 2] {
    let is_it = |stage: &&Stage| *figure.key == [&*stage.name, &*stage.target];
    let stage = stages.iter().find(is_it);
    stage.map_or([""; 2], |stage| [&stage.goal, &stage.others])
}

/// Stages that miss their goal for one reason, and the reason.
#[derive(Deserialize)]
pub(super) struct Reason {
    pub(super) stages: Vec<String>,
    pub(super) why: String,
}

pub(super) fn reasons() -> Result<Vec<Reason>, Fault> {
    #[derive(Deserialize)]
    struct Reasons {
        reason: Vec<Reason>,
    }
    let known: Result<Reasons, _> = toml::from_str(include_str!("reasons.toml"));
    let known = known.map_err(|error| format!("reasons.toml: {error}"))?;
    Ok(known.reason)
}
