//! The page of faults and limits, from the firmware's table.

use std::fmt::Debug;

use firmware::FAULTS;
use firmware::design_parameters::{RECOVER_S, RETRY_S, WINDOW_S};
use firmware::faults::TABLE;

pub(super) fn page() -> String {
    let rows = TABLE.iter().map(|row| {
        let (number, name, causes, check) = (row.number, row.name, row.causes, row.check);
        let (reaction, recovery) = (words(row.reaction), words(row.recovery));
        format!("| {number} | {name} | {causes} | {check} | {reaction} | {recovery} |")
    });
    format!(
        include_str!("faults.md.in"),
        rows = rows.collect::<Vec<_>>().join("\n"),
        retry_s = RETRY_S,
        faults = FAULTS,
        window_s = WINDOW_S,
        recover_ms = 1_000.0 * RECOVER_S,
    )
}

/// The name of a kind, as the page explains it.
fn words(kind: impl Debug) -> String {
    let name = format!("{kind:?}");
    let letters = name.chars().map(|letter| {
        let space = if letter.is_uppercase() { " " } else { "" };
        format!("{space}{}", letter.to_ascii_lowercase())
    });
    letters.collect::<Vec<_>>().concat().trim_start().to_owned()
}
