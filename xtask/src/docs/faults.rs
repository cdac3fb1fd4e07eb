//! The page of faults and limits, from the firmware's table.

use firmware::FAULTS;
use firmware::design_parameters::{RECOVER_S, RETRY_S, WINDOW_S};
use firmware::faults::{Reaction, Recovery, TABLE};

pub(super) fn page() -> String {
    let rows = TABLE.iter().map(|row| {
        let (number, name, causes, check) = (row.number, row.name, row.causes, row.check);
        let (reaction, recovery) = (at_once(row.reaction), ends(row.recovery));
        format!("| {number} | {name} | {causes} | {check} | {reaction} | {recovery} |")
    });
    format!(
        include_str!("faults.md"),
        rows = rows.collect::<Vec<_>>().join("\n"),
        retry_s = RETRY_S,
        faults = FAULTS,
        window_s = WINDOW_S,
        recover_ms = 1_000.0 * RECOVER_S,
    )
}

/// What a fault does, in a word that the page explains.
const fn at_once(reaction: Reaction) -> &'static str {
    match reaction {
        Reaction::WhiskerOff => "whisker off",
        Reaction::AllOff => "all off",
        Reaction::NotArmed => "not armed",
        Reaction::GoesOn => "goes on",
    }
}

/// How it ends, likewise.
const fn ends(recovery: Recovery) -> &'static str {
    match recovery {
        Recovery::Retry => "retry",
        Recovery::GoodFrames => "good frames",
        Recovery::Restart => "restart",
        Recovery::Armed => "armed",
        Recovery::Counted => "counted",
        Recovery::Deployed => "deployed",
    }
}
