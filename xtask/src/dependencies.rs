//! Licences, duplicates and sources of the dependencies (deny.toml) of both workspaces, and what
//! is known against them, by cargo-deny. To build that takes minutes, so that CI runs it where it
//! is installed; the nightly run installs it.

use crate::run::{Fault, cargo, installed, output, run, top};
use crate::studies;

/// What the lock file alone says.
const OFFLINE: [&str; 4] = ["licenses", "bans", "sources", "--hide-inclusion-graph"];

const WORKSPACES: [&str; 2] = ["Cargo.toml", studies::MANIFEST];

fn deny(what: &[&str]) -> Result<(), Fault> {
    WORKSPACES.into_iter().try_for_each(|manifest| {
        let mut deny = cargo(&format!("deny --locked --manifest-path {manifest} check"));
        deny.arg("--config").arg(top().join("deny.toml"));
        run(deny.args(what))
    })
}

/// Checks licences, duplicates and sources, if cargo-deny is there.
pub(crate) fn check() -> Result<(), Fault> {
    if output(&mut cargo("deny --version")).is_err() {
        println!("not checked: cargo-deny is not installed; cargo xtask nightly installs it");
        return Ok(());
    }
    deny(&OFFLINE)
}

/// The same wherever it is run, and what is known against a version, as far as the
/// database of advisories can be had.
pub(crate) fn install_and_check() -> Result<(), Fault> {
    installed("deny")?;
    check()?;
    if run(&mut cargo("deny fetch db")).is_err() {
        println!("advisories are not checked: their database cannot be reached");
        return Ok(());
    }
    deny(&["advisories"])
}
