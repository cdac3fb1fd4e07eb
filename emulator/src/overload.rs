//! Ticks that are too long on purpose: does the board notice?
//!
//! The core is held in the middle of a tick, as by a fault that nobody thought
//! of; the program is the one that is flashed.

use std::path::Path;

use host_sim::Error;

use crate::chip::{Ps, ResetCause};
use crate::deployment::flashed;
use crate::trouble::Trouble;

/// A tick of two periods and a quarter lets one period pass without a tick.
const LOST: u32 = 1;
/// The most that a tick takes on the slowest core, us, and how exactly it is told.
const TICK_US: f64 = 130.0;
/// Longer than the watchdog bears.
const HANG: Ps = 60_000_000_000;

/// Lets one tick of the scene in `path` take two periods and a quarter, and later
/// one hang; the module must count and tell the missed ticks, and the watchdog
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
    let mut heard = Vec::new();

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
    let line = trouble.hear("longest tick")?;
    let told = longest_us(&line);
    // The tick itself takes some time more.
    let held_us = period as f64 * 2.25e-6;
    if !told.is_some_and(|told| (held_us..held_us + TICK_US).contains(&told)) {
        return Err(Error::Work(format!(
            "held for {held_us} us, and told: {line}"
        )));
    }
    heard.push(line);
    heard.push(trouble.hear(&format!("missed {LOST}"))?);
    heard.push(trouble.hear("limit 32")?);
    trouble.log.clear();

    trouble.hold(HANG);
    trouble.pass(second + second / 10)?;
    let reset = trouble.board_mut().reset.take();
    if reset != Some(ResetCause::Watchdog) {
        return Err(Error::Work(format!("the watchdog did not bite: {reset:?}")));
    }
    heard.push(trouble.hear("reset by the watchdog")?);
    heard.push(trouble.hear("missed 0")?);
    heard.dedup();
    Ok(heard)
}

/// The number in the log's line of the longest tick.
fn longest_us(line: &str) -> Option<f64> {
    let (_, rest) = line.split_once("longest tick ")?;
    rest.split(' ').next()?.parse().ok()
}
