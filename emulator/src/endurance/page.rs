//! `docs/measured/endurance.md`: what ran, for how long, and how fast.

use std::fmt::Write as _;

use super::{ShardRow, on_pc};
use crate::counters;

const WEEK_H: f64 = 168.0;
const DAY_H: f64 = 24.0;

/// Rows of one scene on one subject.
type Group<'r> = Vec<&'r ShardRow>;

fn groups(rows: &[ShardRow], wanted: impl Fn(&ShardRow) -> bool) -> Vec<Group<'_>> {
    let mut groups: Vec<Group<'_>> = Vec::new();
    for row in rows.iter().filter(|row| wanted(row)) {
        let is_its = |of: &ShardRow| (&of.subject, &of.scene) == (&row.subject, &row.scene);
        match groups.iter_mut().find(|group| is_its(group[0])) {
            Some(group) => group.push(row),
            None => groups.push(vec![row]),
        }
    }
    groups
}

fn sum(group: &Group<'_>, of: impl Fn(&ShardRow) -> f64) -> f64 {
    group.iter().map(|row| of(row)).sum()
}

fn mean(group: &Group<'_>, of: impl Fn(&ShardRow) -> Option<f64>) -> Option<f64> {
    let values: Vec<f64> = group.iter().filter_map(|row| of(row)).collect();
    let count = values.len() as f64;
    (count > 0.0).then(|| values.into_iter().sum::<f64>() / count)
}

fn cell(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.decimals$}"))
}

/// How many shards there are, their hours, and how many of those a minute makes.
fn made(groups: &[Group<'_>]) -> (usize, f64, f64) {
    let rows = groups.concat();
    let hours = sum(&rows, |row| row.hours);
    (
        rows.len(),
        hours,
        hours * 60.0 / sum(&rows, |row| row.took_s),
    )
}

pub(super) fn page(rows: &[ShardRow]) -> String {
    let mut page = String::from(HEAD);
    let is_on_pc = |row: &ShardRow| row.subject == on_pc::NAME;
    on_the_pc(&mut page, &groups(rows, is_on_pc));
    on_boards(&mut page, &groups(rows, |row| !is_on_pc(row)));
    page.push_str(COUNTERS);
    for (what, bits, left) in counters::described() {
        // Writing to a string does not fail.
        let _ = writeln!(page, "| {what} | {bits} | {left} |");
    }
    page
}

fn on_the_pc(page: &mut String, groups: &[Group<'_>]) {
    let (shards, hours, speed) = made(groups);
    // Writing to a string does not fail.
    let _ = write!(
        page,
        "\n## On the PC\n\n{hours:.1} simulated hours in {shards} shards, {speed:.1} hours in a minute: one \
         shard after the other, a week takes {:.1} h.\n\n{ON_PC}",
        WEEK_H / speed / 60.0
    );
    for group in groups {
        let percent = |value: Option<f64>| cell(value.map(|share| 100.0 * share), 2);
        let _ = writeln!(
            page,
            "| {} | {} | {:.1} | {:.0} | {} | {} | {} | {} | {:.0} | {:.0} |",
            group[0].scene,
            group.len(),
            sum(group, |row| row.hours),
            sum(group, |row| row.decisions as f64),
            cell(mean(group, |row| row.first_rate), 0),
            cell(mean(group, |row| row.last_rate), 0),
            percent(mean(group, |row| row.first_right)),
            percent(mean(group, |row| row.last_right)),
            sum(group, |row| row.touches as f64),
            sum(group, |row| row.wrapped as f64),
        );
    }
}

fn on_boards(page: &mut String, groups: &[Group<'_>]) {
    let (shards, hours, speed) = made(groups);
    // Writing to a string does not fail.
    let _ = write!(
        page,
        "\n## On the emulated boards\n\n{hours:.2} simulated hours in {shards} shards, {speed:.3} hours in a minute: \
         one shard after the other, a day takes {:.1} h.\n\n{ON_BOARDS}",
        DAY_H / speed / 60.0
    );
    for group in groups {
        let ShardRow { subject, scene, .. } = group[0];
        let _ = writeln!(
            page,
            "| {subject} | {scene} | {} | {:.0} | {:.0} | {:.0} | {:.0} |",
            group.len(),
            sum(group, |row| 3_600.0 * row.hours),
            sum(group, |row| row.ticks as f64),
            sum(group, |row| row.decisions as f64),
            sum(group, |row| row.wrapped as f64),
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
