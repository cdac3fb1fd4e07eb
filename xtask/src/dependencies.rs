//! Licences, duplicates and sources of the dependencies (deny.toml), and what is known
//! against them, by cargo-deny. To build that takes minutes, so that CI runs it where it is
//! installed; the nightly run installs it.

use crate::run::{Fault, cargo, installed, output, run};

/// What the lock file alone tells.
const OFFLINE: [&str; 6] = [
    "--locked",
    "check",
    "licenses",
    "bans",
    "sources",
    "--hide-inclusion-graph",
];

/// Checks licences, duplicates and sources, if cargo-deny is there.
///
/// # Errors
/// What breaks a rule.
pub(crate) fn check() -> Result<(), Fault> {
    if output(&mut cargo(&["deny", "--version"])).is_err() {
        println!("not checked: cargo-deny is not installed; cargo xtask nightly installs it");
        return Ok(());
    }
    run(cargo(&["deny"]).args(OFFLINE))
}

/// The same wherever it is run, and what is known against a version, as far as the
/// database of advisories can be had.
///
/// # Errors
/// What breaks a rule, or is known.
pub(crate) fn install_and_check() -> Result<(), Fault> {
    installed("deny")?;
    check()?;
    if run(&mut cargo(&["deny", "fetch", "db"])).is_err() {
        println!("advisories are not checked: their database cannot be reached");
        return Ok(());
    }
    run(&mut cargo(&["deny", "--locked", "check", "advisories"]))
}
