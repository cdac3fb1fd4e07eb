//! `docs/measured/reliability.md`: what became of all runs.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

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

fn cells(rows: &[&RunRow]) -> String {
    let counts = OUTCOMES.map(|outcome| {
        let count = rows.iter().filter(|row| row.outcome == outcome).count();
        format!("{count} |")
    });
    counts.join(" ")
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
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = writeln!(text, "{}", include_str!("page.md").trim_end());
    let _ = writeln!(
        text,
        "\n## By where it ran\n\n| | runs | masked | noticed | silent | harmful | not followed |\n\
         |---|---|---|---|---|---|---|"
    );
    let subjects: BTreeSet<&str> = rows.iter().map(|row| row.subject.as_str()).collect();
    for subject in subjects {
        let of: Vec<&RunRow> = rows.iter().filter(|row| row.subject == subject).collect();
        let _ = writeln!(text, "| {subject} | {} | {}", of.len(), cells(&of));
    }
    let all: Vec<&RunRow> = rows.iter().collect();
    let _ = writeln!(text, "| all | {} | {}", all.len(), cells(&all));

    let _ = writeln!(
        text,
        "\n## By what was injected\n\n| | runs | masked | noticed | silent | harmful | not followed \
         | noticed after, ms: middle | most |\n|---|---|---|---|---|---|---|---|---|"
    );
    let (two, one): (Vec<&RunRow>, _) = rows.iter().partition(|row| row.and.is_some());
    let mut kinds: BTreeMap<Kind, Vec<&RunRow>> = BTreeMap::new();
    for row in one {
        kinds.entry(row.kind).or_default().push(row);
    }
    let kinds = kinds.into_iter().map(|(kind, of)| (name(kind), of));
    for (kind, of) in kinds.chain([(TWO.to_owned(), two)]) {
        let (cells, noticed) = (cells(&of), noticed(&of));
        let _ = writeln!(text, "| {kind} | {} | {cells} {noticed}", of.len());
    }

    let _ = writeln!(text, "\n## Harmful\n");
    list(&mut text, rows, Ending::Harmful);

    let _ = writeln!(
        text,
        "\n## Silent, by what was hit\n\n| | runs | how it ends | why nothing is said |\n\
         |---|---|---|---|"
    );
    let mut silent: BTreeMap<String, Vec<&RunRow>> = BTreeMap::new();
    for row in with(rows, Ending::Silent) {
        silent.entry(place(row)).or_default().push(row);
    }
    for (place, of) in &silent {
        let ends: BTreeSet<&str> = of.iter().map(|row| row.reason.as_str()).collect();
        let ends: Vec<&str> = ends.into_iter().collect();
        let reason = reason(place, &reasons).unwrap_or_else(|| {
            let runs: Vec<String> = of.iter().map(|row| row.run.to_string()).collect();
            format!("**not known**: runs {}", runs.join(", "))
        });
        let _ = writeln!(
            text,
            "| `{place}` | {} | {} | {reason} |",
            of.len(),
            ends.join(", ")
        );
    }

    let _ = writeln!(text, "\n## Not followed\n");
    list(&mut text, rows, Ending::Unfollowed);
    Ok(text)
}

fn list(text: &mut String, rows: &[RunRow], outcome: Ending) {
    let mut rows = with(rows, outcome).peekable();
    if rows.peek().is_none() {
        let _ = writeln!(text, "None.");
    }
    for row in rows {
        let _ = writeln!(text, "- {}", described(row));
    }
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
