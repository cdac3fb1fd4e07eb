//! Ticks that are too long on purpose: does the board notice?
//!
//! The core is held in the middle of a tick, as by a fault that nobody thought
//! of; the program is the one that is flashed.

use std::path::Path;

use host_sim::Error;
use host_sim::commands::run::Loaded;

use crate::chip::{Ps, ResetCause};
use crate::trouble::Trouble;

/// A tick of two periods and a quarter lets one period pass without a tick.
const LOST: u32 = 1;
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
    let loaded = Loaded::new(path)?;
    let mut trouble = Trouble::new(&loaded.scene, program)?;
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
    // To a tenth of a millisecond: the tick itself takes some microseconds more.
    let hundreds_us = period * 9 / 4 / 100_000_000;
    heard.push(trouble.hear(&format!("longest tick {hundreds_us}"))?);
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
