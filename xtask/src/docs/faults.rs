//! The page of faults and limits, from the firmware's table.

use std::fmt::Write as _;

use firmware::FAULTS;
use firmware::design_parameters::{RECOVER_S, RETRY_S, WINDOW_S};
use firmware::faults::{Reaction, Recovery, TABLE};

const HEAD: &str = "\
# Faults and limits

Generated from the table in `firmware/src/faults/table.rs` by `cargo xtask docs`. A board's log
and host-sim give the number, what is wrong and likely causes; a number never changes its
meaning. A *fault* means that a motor is off, a *limit* that the module goes on. Symptoms that
have no number are in [troubleshooting.md](troubleshooting.md).

| number | what is wrong | likely causes | what to check | at once | it ends |
|---|---|---|---|---|---|
";

/// The page.
pub(super) fn page() -> String {
    let mut page = HEAD.to_owned();
    for row in TABLE {
        let (number, name, causes, check) = (row.number, row.name, row.causes, row.check);
        let (reaction, recovery) = (at_once(row.reaction).0, ends(row.recovery).0);
        // A String takes whatever is written.
        let _ = writeln!(
            page,
            "| {number} | {name} | {causes} | {check} | {reaction} | {recovery} |"
        );
    }
    page.push_str("\n## At once\n\n");
    for reaction in [
        Reaction::WhiskerOff,
        Reaction::AllOff,
        Reaction::NotArmed,
        Reaction::GoesOn,
    ] {
        let (short, full) = at_once(reaction);
        let _ = writeln!(page, "- *{short}*: {full}");
    }
    page.push_str("\n## It ends\n\n");
    for recovery in [
        Recovery::Retry,
        Recovery::GoodFrames,
        Recovery::Restart,
        Recovery::Armed,
        Recovery::Counted,
        Recovery::Deployed,
    ] {
        let (short, full) = ends(recovery);
        let _ = writeln!(page, "- *{short}*: {full}");
    }
    page
}

/// What a fault does, as a word for the table and as a sentence.
const fn at_once(reaction: Reaction) -> (&'static str, &'static str) {
    match reaction {
        Reaction::WhiskerOff => (
            "whisker off",
            "in the tick that finds it the whisker's motor goes off, and so do the others' with\n  \
             `on_fault = \"stop-all\"` under `[motor]`. Until it ends the whisker has no contact, \
             what it\n  felt before is forgotten, and nothing is decided by it.",
        ),
        Reaction::AllOff => (
            "all off",
            "every motor output goes low, the log gets its lines, and the watchdog resets the chip. With\n  \
             a supply that is too low the reset comes at once, the start waits until it is back, and \
             the\n  line is the next start's.",
        ),
        Reaction::NotArmed => (
            "not armed",
            "motors stay off at the start; sensing, deciding and the log go on.",
        ),
        Reaction::GoesOn => ("goes on", "it is counted and logged, no more."),
    }
}

/// How it ends, likewise.
fn ends(recovery: Recovery) -> (&'static str, String) {
    match recovery {
        Recovery::Retry => (
            "retry",
            format!(
                "the motor is tried again after {RETRY_S} s. After {FAULTS} faults within \
                 {WINDOW_S} s it stays off until\n  it is told to run: by `Command::Clear`, or by \
                 the user button, which arms all motors."
            ),
        ),
        Recovery::GoodFrames => (
            "good frames",
            format!(
                "after {:.0} ms of good frames in succession.",
                1_000.0 * RECOVER_S
            ),
        ),
        Recovery::Restart => (
            "restart",
            "with the start after the reset. It does not arm the motors, which stay off until\n  \
             they are armed; all else goes on. If its cause is still there, it comes again."
                .to_owned(),
        ),
        Recovery::Armed => (
            "armed",
            "once the motors are armed: by the user button, the reset button or the programmer."
                .to_owned(),
        ),
        Recovery::Counted => (
            "counted",
            "there is nothing to end; the log has the count once a second.".to_owned(),
        ),
        Recovery::Deployed => (
            "deployed",
            "once a model is deployed that fits. Until then nothing is decided; whisking and touches\n  \
             go on."
                .to_owned(),
        ),
    }
}
