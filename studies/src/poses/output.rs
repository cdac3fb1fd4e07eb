//! Rows of the page, its table of goals, and `poses.csv`.

use std::fmt::Write;

use super::tally::{REASONS, Tally};
use super::trained::TICK_HZ;
use crate::decisions::figures::{cell, number, percent};
use crate::page::Page;

pub(super) struct Output {
    pub(super) page: Page,
    /// Condition, goal, found, verdict.
    pub(super) goals: Vec<Vec<String>>,
    pub(super) table: String,
}

/// The columns of [`cells`].
pub(super) const COLUMNS: &str = "right | stated | short by | decided | presentations | contact, ms \
    | silent: unknown / pose / between";

impl Output {
    pub(super) fn new() -> Self {
        Self {
            page: Page::new("poses"),
            goals: Vec::new(),
            table: "part,condition,model,training,presentations,decided,named,right,stated,\
                    contact_ms,unknown,pose,between\n"
                .to_owned(),
        }
    }

    pub(super) fn goal(&mut self, condition: &str, goal: &str, found: String, verdict: String) {
        let cells = [condition.to_owned(), goal.to_owned(), found, verdict];
        self.goals.push(cells.to_vec());
    }

    /// Keeps the figures of each training.
    pub(super) fn keep(&mut self, of: [&str; 3], seeds: &[u64], tallies: &[Tally]) {
        let [part, condition, model] = of;
        // As a cell: pages have commas and quotes.
        let condition = condition.replace(',', ";").replace('`', "");
        for (seed, tally) in seeds.iter().zip(tallies) {
            let silent = tally.silent.map(|count| count.to_string()).join(",");
            // Writing to a string does not fail.
            let _ = writeln!(
                self.table,
                "{part},{condition},{model},{seed},{},{},{},{},{},{},{silent}",
                tally.presentations,
                tally.decided,
                tally.named,
                tally.right,
                cell(tally.stated()),
                cell(tally.contact_ms(TICK_HZ)),
            );
        }
    }
}

/// The cells of a row, as [`COLUMNS`] has them.
pub(super) fn cells(tally: &Tally) -> Vec<String> {
    vec![
        percent(tally.right_share()),
        number(tally.stated(), 1),
        number(tally.short(), 1),
        percent(tally.decided_share()),
        tally.presentations.to_string(),
        number(tally.contact_ms(TICK_HZ), 0),
        silent(tally),
    ]
}

/// Shares of the reasons among decisions that name no class, percent.
fn silent(tally: &Tally) -> String {
    let all: usize = tally.silent.iter().sum();
    if all == 0 {
        return "–".to_owned();
    }
    let share = |count: usize| format!("{:.0}", 100.0 * count as f64 / all as f64);
    format!("{} of {all}", tally.silent.map(share).join(" / "))
}

pub(super) fn found(tally: &Tally) -> String {
    format!(
        "right {}, stated {}, decided {}, {} ms",
        percent(tally.right_share()),
        number(tally.stated(), 1),
        percent(tally.decided_share()),
        number(tally.contact_ms(TICK_HZ), 0),
    )
}

const _: () = assert!(REASONS.len() == 3, "the heading names them");
