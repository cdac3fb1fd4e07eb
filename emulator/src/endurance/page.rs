//! `docs/measured/endurance.md`: what ran, for how long, and how fast.

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
    let speed = hours * 60.0 / sum(&rows, |row| row.took_s);
    (rows.len(), hours, speed)
}

pub(super) fn page(rows: &[ShardRow]) -> String {
    let is_on_pc = |row: &ShardRow| row.subject == on_pc::NAME;
    let [on_pc, on_boards] = [groups(rows, is_on_pc), groups(rows, |row| !is_on_pc(row))];
    let (pc_shards, pc_hours, pc_speed) = made(&on_pc);
    let (shards, hours, speed) = made(&on_boards);
    let counters = counters::described();
    let counters = counters.map(|(what, bits, left)| format!("| {what} | {bits} | {left} |"));
    format!(
        include_str!("page.md.in"),
        pc_hours = pc_hours,
        pc_shards = pc_shards,
        pc_speed = pc_speed,
        week_h = WEEK_H / pc_speed / 60.0,
        on_pc = on_pc.iter().map(row_of_pc).collect::<String>(),
        hours = hours,
        shards = shards,
        speed = speed,
        day_h = DAY_H / speed / 60.0,
        on_boards = on_boards.iter().map(row_of_board).collect::<String>(),
        counters = counters.collect::<Vec<_>>().join("\n"),
    )
}

fn row_of_pc(group: &Group<'_>) -> String {
    let percent = |value: Option<f64>| cell(value.map(|share| 100.0 * share), 2);
    format!(
        "| {} | {} | {:.1} | {:.0} | {} | {} | {} | {} | {:.0} | {:.0} |\n",
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
    )
}

fn row_of_board(group: &Group<'_>) -> String {
    let ShardRow { subject, scene, .. } = group[0];
    format!(
        "| {subject} | {scene} | {} | {:.0} | {:.0} | {:.0} | {:.0} |\n",
        group.len(),
        sum(group, |row| 3_600.0 * row.hours),
        sum(group, |row| row.ticks as f64),
        sum(group, |row| row.decisions as f64),
        sum(group, |row| row.wrapped as f64),
    )
}
