//! `docs/measured/reliability.md`: what became of all runs.

use std::collections::{BTreeMap, BTreeSet};

use super::injection::Kind;
use super::table::{Ending, RunRow};
use crate::counters::bare;

/// Why what is silent is silent, by the kind of fault or the beginning of a variable's name.
const REASONS: &str = include_str!("reasons.toml");

const TWO: &str = "two-at-once";

const OUTCOMES: [Ending; 5] = [
    Ending::Masked,
    Ending::Noticed,
    Ending::Silent,
    Ending::Harmful,
    Ending::Unfollowed,
];

fn name(value: impl serde::Serialize) -> String {
    let value = toml::Value::try_from(value).ok();
    let name = value.and_then(|value| value.as_str().map(str::to_owned));
    name.unwrap_or_default()
}

fn with(rows: &[RunRow], outcome: Ending) -> impl Iterator<Item = &RunRow> {
    rows.iter().filter(move |row| row.outcome == outcome)
}

/// The first cells of a row: what is counted, all runs, and those with each outcome.
fn counted(name: &str, rows: &[&RunRow]) -> String {
    let counts = OUTCOMES.map(|outcome| {
        let count = rows.iter().filter(|row| row.outcome == outcome).count();
        format!(" {count} |")
    });
    format!("| {name} | {} |{}", rows.len(), counts.concat())
}

/// Middle and largest time until something was reported, ms.
fn noticed(rows: &[&RunRow]) -> String {
    let mut times: Vec<f64> = rows.iter().filter_map(|row| row.noticed_ms).collect();
    times.sort_by(f64::total_cmp);
    match (times.get(times.len() / 2), times.last()) {
        (Some(middle), Some(most)) => format!("{middle:.1} | {most:.1} |"),
        _ => "| |".to_owned(),
    }
}

fn place(row: &RunRow) -> String {
    match &row.changed {
        Some(changed) => {
            let word = changed.split(" bit ").next().unwrap_or(changed);
            let named = word.split_once(' ').map_or(word, |(_, name)| name);
            bare(named)
        }
        None if row.and.is_some() => TWO.to_owned(),
        None => name(row.kind),
    }
}

fn reason(place: &str, reasons: &BTreeMap<String, String>) -> Option<String> {
    let reasons = reasons.iter();
    let fitting = reasons.filter(|(of, _)| place.starts_with(of.as_str()));
    let longest = fitting.max_by_key(|(of, _)| of.len());
    longest.map(|(_, reason)| reason.clone())
}

/// The page, of the rows of all shards of all subjects.
///
/// # Errors
/// What is wrong with the table of reasons.
pub fn page(rows: &[RunRow]) -> Result<String, String> {
    let reasons: BTreeMap<String, String> =
        toml::from_str(REASONS).map_err(|error| error.to_string())?;
    let subjects: BTreeSet<&str> = rows.iter().map(|row| row.subject.as_str()).collect();
    let subjects = subjects.into_iter().map(|subject| {
        let of = rows.iter().filter(|row| row.subject == subject);
        counted(subject, &of.collect::<Vec<_>>())
    });
    let all = counted("all", &rows.iter().collect::<Vec<_>>());
    let (two, one): (Vec<&RunRow>, _) = rows.iter().partition(|row| row.and.is_some());
    let mut kinds: BTreeMap<Kind, Vec<&RunRow>> = BTreeMap::new();
    for row in one {
        kinds.entry(row.kind).or_default().push(row);
    }
    let kinds = kinds.into_iter().map(|(kind, of)| (name(kind), of));
    let kinds = kinds.chain([(TWO.to_owned(), two)]);
    let kinds = kinds.map(|(kind, of)| format!("{} {}", counted(&kind, &of), noticed(&of)));
    let mut silent: BTreeMap<String, Vec<&RunRow>> = BTreeMap::new();
    for row in with(rows, Ending::Silent) {
        silent.entry(place(row)).or_default().push(row);
    }
    let silent = silent.into_iter().map(|(place, of)| {
        let ends: BTreeSet<&str> = of.iter().map(|row| row.reason.as_str()).collect();
        let ends = ends.into_iter().collect::<Vec<_>>().join(", ");
        let reason = reason(&place, &reasons).unwrap_or_else(|| {
            let runs: Vec<String> = of.iter().map(|row| row.run.to_string()).collect();
            format!("**not known**: runs {}", runs.join(", "))
        });
        format!("| `{place}` | {} | {ends} | {reason} |\n", of.len())
    });
    Ok(format!(
        include_str!("page.md.in"),
        subjects = subjects.chain([all]).collect::<Vec<_>>().join("\n"),
        kinds = kinds.collect::<Vec<_>>().join("\n"),
        harmful = list(rows, Ending::Harmful),
        silent = silent.collect::<String>(),
        unfollowed = list(rows, Ending::Unfollowed),
    ))
}

fn list(rows: &[RunRow], outcome: Ending) -> String {
    let lines = with(rows, outcome).map(|row| format!("- {}", described(row)));
    let lines: Vec<String> = lines.collect();
    if lines.is_empty() {
        return "None.".to_owned();
    }
    lines.join("\n")
}

/// A run in a line.
pub fn described(row: &RunRow) -> String {
    let changed = row.changed.as_ref().map(|word| format!(" of `{word}`"));
    let and = row.and.map(|kind| format!(" and {}", name(kind)));
    format!(
        "{}, run {}, scene {}: {}{}{} before tick {}: {}",
        row.subject,
        row.run,
        row.scene,
        name(row.kind),
        changed.unwrap_or_default(),
        and.unwrap_or_default(),
        row.start,
        row.reason
    )
}
