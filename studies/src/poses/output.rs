//! Rows of the page, its table of goals, and `poses.csv`.

use super::{Asked, REASONS, TICK_HZ, Tally, Trained};
use crate::decisions::figures::{cell, number, percent};
use crate::page::{Page, row};

pub(super) struct Output {
    pub(super) page: Page,
    /// Condition, goal, found, verdict.
    pub(super) goals: Vec<Vec<String>>,
}

/// The columns of [`cells`].
const COLUMNS: &str = "right | stated | short by | decided | presentations | contact, ms \
    | silent: unknown / pose / between";

impl Output {
    pub(super) fn new() -> Self {
        let header = "part,condition,model,training,presentations,decided,named,right,stated,\
                      contact_ms,unknown,pose,between";
        Self {
            page: Page::with_table("poses", header),
            goals: Vec::new(),
        }
    }

    pub(super) fn goal(&mut self, condition: &str, goal: &str, found: String, verdict: String) {
        let cells = [condition.to_owned(), goal.to_owned(), found, verdict];
        self.goals.push(cells.to_vec());
    }

    /// The same of what is asked of a tally.
    pub(super) fn asked(&mut self, condition: &str, asked: Asked, tally: &Tally) {
        self.goal(condition, &asked.text(), found(tally), asked.verdict(tally));
    }

    pub(super) fn keep(&mut self, of: [&str; 3], trained: &Trained<'_>, tallies: &[Tally]) {
        let [part, condition, model] = of;
        // As a cell: pages have commas and quotes.
        let condition = condition.replace(',', ";").replace('`', "");
        for (seed, tally) in trained.seeds.iter().zip(tallies) {
            let mut figures = vec![seed.to_string()];
            let counts = [tally.presentations, tally.decided, tally.named, tally.right];
            figures.extend(counts.map(|count| count.to_string()));
            figures.extend([tally.stated(), tally.contact_ms(TICK_HZ)].map(|x| cell(x, 3)));
            figures.extend(tally.silent.map(|count| count.to_string()));
            self.page.keep(&[part, &condition, model], &figures);
        }
    }

    /// A table with [`COLUMNS`] between others.
    pub(super) fn table(&mut self, first: &str, last: &str, rows: Vec<Vec<String>>) {
        let header = format!("{first} | {COLUMNS} | {last}");
        self.page.table(&header, rows);
    }

    /// Keeps them and gives the row of all trainings together: its name, [`COLUMNS`] and what is
    /// asked.
    pub(super) fn row(
        &mut self,
        of: [&str; 3],
        trained: &Trained<'_>,
        tallies: &[Tally],
        asked: Asked,
    ) -> Vec<String> {
        self.keep(of, trained, tallies);
        let tally = Tally::sum(tallies);
        let goal = [asked.text(), asked.verdict(&tally)];
        row(of[1], cells(&tally).into_iter().chain(goal))
    }
}

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
