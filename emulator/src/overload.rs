//! Ticks that are too long on purpose: does the board notice?
//!
//! The core is held in the middle of a tick, as by a fault that was not
//! thought of; the program is the one that is flashed.

use std::path::Path;

use host_sim::Error;

use crate::chip::{Ps, ResetCause};
use crate::deployment::flashed;
use crate::trouble::Trouble;

/// A tick of two periods and a quarter lets one period pass without a tick.
const LOST: u32 = 1;
/// The most that a tick takes on the slowest core, us, and how exactly the log has it.
const TICK_US: f64 = 130.0;
/// Longer than the watchdog bears.
const HANG: Ps = 60_000_000_000;

/// Lets one tick of the scene in `path` take two periods and a quarter, and later
/// one hang; the module must count the missed ticks and say so, and the watchdog
/// must reset the chip, after which the module says so and runs on. Returns
/// the lines of the log.
///
/// # Errors
/// [`Error::Work`] says what did not happen.
pub fn overload(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (loaded, program) = flashed(path, program)?;
    let mut trouble = Trouble::new(&loaded.scene, &program)?;
    trouble.run.module_mut().bears_resets = true;
    let second = loaded.scene.tick_hz;
    let period = 1_000_000_000_000 / Ps::from(second);
    let missed = |trouble: &mut Trouble| trouble.board_mut().missed();
    let mut lines = Vec::new();

    trouble.pass(second / 10)?;
    if missed(&mut trouble)? != 0 {
        return Err(Error::Work("ticks are missed without a cause".to_owned()));
    }
    trouble.hold(period * 9 / 4);
    trouble.pass(second)?;
    let found = missed(&mut trouble)?;
    if found != LOST {
        let fault = format!("{LOST} ticks were lost, the module counted {found}");
        return Err(Error::Work(fault));
    }
    // The tick itself takes some time more.
    let held_us = period as f64 * 2.25e-6;
    let (line, worst_us, missed) = health(&trouble)?;
    if !(held_us..held_us + TICK_US).contains(&worst_us) || missed != LOST {
        return Err(Error::Work(format!("held for {held_us} us: {line}")));
    }
    lines.push(line);
    lines.push(trouble.line("limit 32 ")?);
    trouble.log.clear();

    trouble.hold(HANG);
    trouble.pass(second + second / 10)?;
    let reset = trouble.board_mut().reset.take();
    if reset != Some(ResetCause::Watchdog) {
        return Err(Error::Work(format!("the watchdog did not bite: {reset:?}")));
    }
    lines.push(trouble.line(" watchdog 2 52")?);
    let (line, _, missed) = health(&trouble)?;
    if missed != 0 {
        return Err(Error::Work(format!("ticks are missed after it: {line}")));
    }
    lines.push(line);
    Ok(lines)
}

/// The log's first line of health: the longest tick in it, us, and the ticks that were missed.
fn health(trouble: &Trouble) -> Result<(String, f64, u32), Error> {
    let line = trouble.line(" health ")?;
    let mut fields = line.split(' ').skip_while(|field| *field != "health");
    let worst = fields.nth(1).and_then(|field| field.parse().ok());
    let missed = fields.nth(1).and_then(|field| field.parse().ok());
    match (worst, missed) {
        (Some(worst), Some(missed)) => Ok((line, worst, missed)),
        _ => Err(Error::Work(format!("no health: {line}"))),
    }
}
