//! Starts that were not asked for, and the button: is the motor off after them, and does the
//! module say why?

use std::path::Path;

use host_sim::Error;

use crate::chip::{Ps, ResetCause};
use crate::deployment::flashed;
use crate::trouble::Trouble;
use crate::upset::{MIDDLE, Upset};

/// Longer than the watchdog bears.
const HANG: Ps = 60_000_000_000;
/// Within which after the start of its tick a crash must have taken the pins low.
const PINS_LOW: Ps = 20_000_000;
/// Hard faults in succession, and how often they come, in hundredths of a second.
const FAULTS: usize = 3;
const FAULT_HUNDREDTHS: u32 = 75;
/// How far a whisker may run on without its motor, degrees.
const RUN_ON_DEG: f64 = 60.0;

/// Has the watchdog reset the chip while the whiskers of the scene in `path` whisk; presses
/// the user button, for long and as it should be; crashes the core every 0.75 s; resets the chip
/// three times in a minute; and, on another board that whisks, overflows the stack. The motors
/// must be off after each but the press, and the log must say why. There is no panic in the
/// program that could be provoked. Returns the lines of the log.
///
/// # Errors
/// [`Error::Work`] says what did not happen.
pub fn start_again(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (loaded, program) = flashed(path, program)?;
    let mut trouble = Trouble::new(&loaded.scene, &program)?;
    trouble.run.module_mut().bears_resets = true;
    let hundredth = loaded.scene.tick_hz / 100;
    let mut lines = Vec::new();

    whisks(&mut trouble, 100 * hundredth, "after power-up")?;
    lines.push(trouble.line(" power-up 1 0")?);

    trouble.hold(HANG);
    rests(&mut trouble, 100 * hundredth, "after the watchdog")?;
    lines.push(trouble.line(" watchdog 2 52")?);
    lines.push(trouble.line("not-armed 52 ")?);
    press(&mut trouble, 150 * hundredth)?;
    rests(&mut trouble, 10 * hundredth, "after a press of 1.5 s")?;
    press(&mut trouble, 10 * hundredth)?;
    whisks(&mut trouble, 100 * hundredth, "after a press")?;
    lines.push(trouble.line("INFO  armed")?);

    // The first while it whisks, the others after it.
    for n in 0..FAULTS {
        lines.push(crash(&mut trouble, Upset::Astray, (49, 3 + n), hundredth)?);
    }
    trouble.log.clear();
    trouble.board_mut().reset_now(ResetCause::Pin)?;
    rests(&mut trouble, 10 * hundredth, "after many resets")?;
    lines.push(trouble.line("not-armed 59 ")?);

    let mut trouble = Trouble::new(&loaded.scene, &program)?;
    trouble.run.module_mut().bears_resets = true;
    whisks(&mut trouble, 100 * hundredth, "after power-up")?;
    lines.push(crash(&mut trouble, Upset::NoStack, (54, 2), hundredth)?);
    Ok(lines)
}

/// Lets a fault of the program befall the core in the next tick. The pins must be low within
/// [`PINS_LOW`] of its start, and stay so; the log must say which fault it is, and so must the next start, which has this number.
fn crash(
    trouble: &mut Trouble,
    upset: Upset,
    (fault, start): (u8, usize),
    hundredth: u32,
) -> Result<String, Error> {
    trouble.log.clear();
    let period = 10_000_000_000 / Ps::from(hundredth);
    let board = trouble.board_mut();
    board.machine.upset_next_tick(MIDDLE, upset);
    if board.run_for(period + PINS_LOW)? || trouble.driven().contains(&true) {
        return Err(Error::Work(format!("driven in fault {fault}")));
    }
    rests(trouble, FAULT_HUNDREDTHS * hundredth, "after a fault")?;
    let line = format!("fault board {fault} ");
    let said = trouble.log.iter().filter(|said| said.contains(&line));
    if said.count() != 2 {
        return Err(Error::Work(format!("not twice: {line}")));
    }
    trouble.line(&format!(" watchdog {start} {fault}"))?;
    trouble.line(&format!("not-armed {fault} "))
}

/// Holds the button down for so many ticks, and lets it go before and after.
fn press(trouble: &mut Trouble, ticks: u32) -> Result<(), Error> {
    for is_down in [false, true, false] {
        let ticks = if is_down { ticks } else { 100 };
        let machine = &mut trouble.board_mut().machine;
        machine.with_chip(|chip| chip.set_button(is_down));
        trouble.pass(ticks)?;
    }
    Ok(())
}

/// Lets so many ticks pass, in half of which every motor must be driven.
pub(crate) fn whisks(trouble: &mut Trouble, ticks: u32, when: &str) -> Result<(), Error> {
    let mut driven = 0;
    for _ in 0..ticks {
        trouble.pass(1)?;
        driven += u32::from(trouble.driven().iter().all(|driven| *driven));
    }
    if 2 * driven < ticks {
        return Err(Error::Work(format!(
            "driven in {driven} of {ticks} ticks {when}"
        )));
    }
    Ok(())
}

/// Lets so many ticks pass, in none of which a motor may be driven.
pub(crate) fn rests(trouble: &mut Trouble, ticks: u32, when: &str) -> Result<(), Error> {
    let [before, _] = trouble.run.row().angle_deg;
    for tick in 0..ticks {
        trouble.pass(1)?;
        if trouble.driven().contains(&true) {
            return Err(Error::Work(format!("driven in tick {tick} {when}")));
        }
    }
    let [after, _] = trouble.run.row().angle_deg;
    if (after - before).abs() > RUN_ON_DEG {
        return Err(Error::Work(format!(
            "moved from {before} to {after} {when}"
        )));
    }
    Ok(())
}
