//! What the steps report: as text while they are done, and as JSON for a question.

use clap::ValueEnum;
use host_sim::{Error, report};
use serde::Serialize;
use serde_json::Value;

use super::Name;
use super::bench::Bench;
use crate::tally::SIDES;

/// What a step reports of the module, or of one whisker.
#[derive(Debug, Default, Serialize)]
pub(super) struct Part {
    step: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    side: Option<&'static str>,
    /// What was done, what was seen, and what that means.
    did: String,
    saw: Vec<String>,
    means: String,
    /// What is not as it should be, with what to do about it.
    findings: Vec<String>,
    /// The same in numbers, where there are more than the text has.
    #[serde(skip_serializing_if = "Value::is_null")]
    seen: Value,
}

pub(super) type Done = Result<Part, Ended>;

/// Why a step has ended early.
pub(super) enum Ended {
    /// There was nothing to do, for this reason.
    NotDone(String),
    Failed(Error),
}

impl From<Error> for Ended {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

pub(super) fn not_done<T>(why: impl Into<String>) -> Result<T, Ended> {
    Err(Ended::NotDone(why.into()))
}

/// What is reported of a step that was done or was not.
pub(super) fn part_of(done: Done) -> Result<Part, Error> {
    match done {
        Ok(part) => Ok(part),
        Err(Ended::NotDone(why)) => Ok(Part::new("nothing").means(why)),
        Err(Ended::Failed(error)) => Err(error),
    }
}

impl Part {
    pub(super) fn new(did: impl Into<String>) -> Self {
        Self {
            step: "module".to_owned(),
            did: did.into(),
            ..Self::default()
        }
    }

    pub(super) fn of(mut self, name: Name, side: u8) -> Self {
        let name = name.to_possible_value();
        self.step = name.map_or_else(String::new, |name| name.get_name().to_owned());
        self.side = SIDES.get(usize::from(side)).copied();
        self
    }

    pub(super) fn named(mut self, name: &str) -> Self {
        name.clone_into(&mut self.step);
        self
    }

    pub(super) fn saw(&mut self, lines: impl Into<String>) {
        self.saw.extend(lines.into().lines().map(str::to_owned));
    }

    pub(super) fn means(mut self, what: impl Into<String>) -> Self {
        self.means = what.into();
        self
    }

    pub(super) fn find(&mut self, what: impl Into<String>) {
        self.findings.push(what.into());
    }

    pub(super) fn with(mut self, seen: &impl Serialize) -> Self {
        self.seen = serde_json::to_value(seen).unwrap_or_default();
        self
    }

    pub(super) fn is_well(&self) -> bool {
        self.findings.is_empty()
    }

    fn title(&self) -> String {
        let side = self.side.map(|side| format!(" {side}"));
        format!("{}{}", self.step, side.unwrap_or_default())
    }

    fn print(&self) {
        report::say(self.title());
        report::say(format_args!("  did:   {}", self.did));
        for saw in &self.saw {
            report::say(format_args!("  saw:   {saw}"));
        }
        report::say(format_args!("  means: {}", self.means));
        for finding in &self.findings {
            report::say(format_args!("  to do: {finding}"));
        }
    }
}

#[derive(Debug, Serialize)]
pub(super) struct Report {
    whisker: &'static str,
    board: String,
    firmware: String,
    scene: String,
    tick_hz: u32,
    steps: Vec<Part>,
    findings: Vec<String>,
}

impl Report {
    pub(super) fn new(bench: &mut Bench) -> Result<Self, Error> {
        let origin = bench.module.origin()?;
        let get = |key| origin.get(key).unwrap_or("unknown").to_owned();
        Ok(Self {
            whisker: env!("CARGO_PKG_VERSION"),
            board: get("board"),
            firmware: get("firmware"),
            scene: bench.about.scene.clone(),
            tick_hz: bench.about.tick_hz,
            steps: Vec::new(),
            findings: Vec::new(),
        })
    }

    pub(super) fn add(&mut self, part: Part) {
        part.print();
        let found = |finding| format!("{}: {finding}", part.title());
        self.findings.extend(part.findings.iter().map(found));
        self.steps.push(part);
    }

    pub(super) fn json(&self) -> Result<String, Error> {
        let text = serde_json::to_string_pretty(self);
        text.map_err(|fault| Error::Work(fault.to_string()))
    }

    pub(super) fn end(&self) -> Result<(), Error> {
        report::say(format_args!("findings: {}", self.findings.len()));
        if self.findings.is_empty() {
            return Ok(());
        }
        for finding in &self.findings {
            report::say(format_args!("  {finding}"));
        }
        let fault = "not all is as it should be; docs/troubleshooting.md says more";
        Err(Error::Work(fault.to_owned()))
    }
}
