//! `docs/measured/endurance.md`: what ran, for how long, and how fast.

use std::fmt::Write as _;

use super::on_pc;
use super::row::ShardRow;
use crate::counters;

const WEEK_H: f64 = 168.0;
const DAY_H: f64 = 24.0;

struct Group<'r> {
    rows: Vec<&'r ShardRow>,
}

impl<'r> Group<'r> {
    /// Of those that are `wanted`, by scene and subject.
    fn all(rows: &'r [ShardRow], wanted: impl Fn(&ShardRow) -> bool) -> Vec<Self> {
        let mut groups: Vec<Self> = Vec::new();
        for row in rows.iter().filter(|row| wanted(row)) {
            let is_its = |group: &&mut Self| {
                let mut rows = group.rows.iter();
                rows.any(|of| (&of.subject, &of.scene) == (&row.subject, &row.scene))
            };
            match groups.iter_mut().find(is_its) {
                Some(group) => group.rows.push(row),
                None => groups.push(Self { rows: vec![row] }),
            }
        }
        groups
    }

    fn sum(&self, of: impl Fn(&ShardRow) -> f64) -> f64 {
        self.rows.iter().map(|row| of(row)).sum()
    }

    fn mean(&self, of: impl Fn(&ShardRow) -> Option<f64>) -> Option<f64> {
        let values: Vec<f64> = self.rows.iter().filter_map(|row| of(row)).collect();
        let count = values.len() as f64;
        (count > 0.0).then(|| values.into_iter().sum::<f64>() / count)
    }

    fn names(&self) -> (&str, &str) {
        let first = self.rows.first();
        first.map_or(("", ""), |row| (&row.subject, &row.scene))
    }
}

fn cell(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.decimals$}"))
}

fn hours_per_minute(rows: &[&ShardRow]) -> f64 {
    let hours: f64 = rows.iter().map(|row| row.hours).sum();
    let took_s: f64 = rows.iter().map(|row| row.took_s).sum();
    hours * 60.0 / took_s
}

pub(super) fn page(rows: &[ShardRow]) -> String {
    let mut page = String::from(HEAD);
    let is_on_pc = |row: &ShardRow| row.subject == on_pc::NAME;
    on_the_pc(&mut page, &Group::all(rows, is_on_pc));
    on_boards(&mut page, &Group::all(rows, |row| !is_on_pc(row)));
    page.push_str(COUNTERS);
    for (what, bits, left) in counters::described() {
        // Writing to a string does not fail.
        let _ = writeln!(page, "| {what} | {bits} | {left} |");
    }
    page
}

fn on_the_pc(page: &mut String, groups: &[Group<'_>]) {
    let rows: Vec<&ShardRow> = groups.iter().flat_map(|group| group.rows.clone()).collect();
    let hours: f64 = rows.iter().map(|row| row.hours).sum();
    let speed = hours_per_minute(&rows);
    // Writing to a string does not fail.
    let _ = write!(
        page,
        "\n## On the PC\n\n{hours:.1} simulated hours in {} shards, {speed:.1} hours in a minute: one \
         shard after the other, a week takes {:.1} h.\n\n{ON_PC}",
        rows.len(),
        WEEK_H / speed / 60.0
    );
    for group in groups {
        let (_, scene) = group.names();
        let percent = |value: Option<f64>| cell(value.map(|share| 100.0 * share), 2);
        let _ = writeln!(
            page,
            "| {scene} | {} | {:.1} | {:.0} | {} | {} | {} | {} | {:.0} | {:.0} |",
            group.rows.len(),
            group.sum(|row| row.hours),
            group.sum(|row| row.decisions as f64),
            cell(group.mean(|row| row.first_rate), 0),
            cell(group.mean(|row| row.last_rate), 0),
            percent(group.mean(|row| row.first_right)),
            percent(group.mean(|row| row.last_right)),
            group.sum(|row| row.touches as f64),
            group.sum(|row| row.wrapped as f64),
        );
    }
}

fn on_boards(page: &mut String, groups: &[Group<'_>]) {
    let rows: Vec<&ShardRow> = groups.iter().flat_map(|group| group.rows.clone()).collect();
    let hours: f64 = rows.iter().map(|row| row.hours).sum();
    let speed = hours_per_minute(&rows);
    // Writing to a string does not fail.
    let _ = write!(
        page,
        "\n## On the emulated boards\n\n{hours:.2} simulated hours in {} shards, {speed:.3} hours in a minute: \
         one shard after the other, a day takes {:.1} h.\n\n{ON_BOARDS}",
        rows.len(),
        DAY_H / speed / 60.0
    );
    for group in groups {
        let (subject, scene) = group.names();
        let _ = writeln!(
            page,
            "| {subject} | {scene} | {} | {:.0} | {:.0} | {:.0} | {:.0} |",
            group.rows.len(),
            group.sum(|row| 3_600.0 * row.hours),
            group.sum(|row| row.ticks as f64),
            group.sum(|row| row.decisions as f64),
            group.sum(|row| row.wrapped as f64),
        );
    }
}

const HEAD: &str = "\
# Endurance

Made by `cargo xtask endurance`: scenes for hours, in shards of one scene with one seed. A shard
that does not end well has no row here, and the command fails. Speeds are by the clock of the
machine that made the page, with whatever else it did.
";

const ON_PC: &str = "\
In every tick every number is one, and no sensor and no motor has a fault; memory does not grow.
The last hour is as the first (the last quarter as the first, where a shard has less than four
hours): whiskers range within 5 degrees of the same, decisions are as many and as right, but for
5 standard deviations of chance and 1 %. A decision for unknown counts as one that is not right.

| scene | shards | hours | decisions | an hour, first | last | right, %, first | last | touches | wraps of their number |
|---|---|---|---|---|---|---|---|---|---|
";

const ON_BOARDS: &str = "\
The board starts with every counter just below its wrap, the PC at zero; every tick and every
decision is the same, to the last bit, and no tick is missed.

| board | scene | shards | seconds | ticks | decisions | counters that wrapped |
|---|---|---|---|---|---|---|
";

const COUNTERS: &str = "
## Counters that wrap

| what is counted | bits | starts so many counts before its wrap, at 2,000 ticks a second |
|---|---|---|
";
