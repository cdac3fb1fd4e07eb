//! Brings whiskers to rest and stops their motors before a module is restarted, which takes the
//! position of its whiskers then for their rest.

use host_sim::Error;
use wire::{Command, CommandStatus, Flags, TickRecord, WhiskerId, degrees};

use crate::conversation::Conversation;
use crate::tally::side;

/// The setpoint at rest, Q24.
const REST: i32 = 0;
/// How near to it is near enough, degrees, and for how long it must be, s: who passes by goes on
/// as its motor goes off.
const NEAR_DEG: f32 = 2.0;
const NEAR_S: f64 = 0.1;
/// How long whiskers may take to get there, and motors to go off, s.
const PATIENCE_S: f64 = 1.0;

/// Motors go off once all whiskers rest, or have had time to; a module without any is left alone.
pub(crate) fn rest(module: &mut Conversation) -> Result<(), Error> {
    let [tick_hz, whiskers] = module.ask(Command::Hello)?.values;
    let near_ticks = (NEAR_S * f64::from(tick_hz)) as u32;
    let whiskers = usize::try_from(whiskers).unwrap_or(0);
    for side in (0..16).take(whiskers) {
        let whisker = WhiskerId { side, number: 0 };
        let answer = module.answer(Command::Setpoint(whisker, REST))?;
        match answer.status {
            // Its range may leave rest out.
            CommandStatus::Done | CommandStatus::OutOfRange => {}
            _ => return Ok(()),
        }
    }
    module.ask(Command::Stream(true))?;
    let is_near = |record: &TickRecord| (degrees(record.measured) - degrees(0)).abs() < NEAR_DEG;
    until(module, whiskers, near_ticks, is_near)?;
    module.ask(Command::Stop)?;
    let is_off = |record: &TickRecord| record.duty == 0 && !record.flags.contains(Flags::ARMED);
    let are_off = until(module, whiskers, 0, is_off)?;
    module.ask(Command::Stream(false))?;
    if are_off {
        return Ok(());
    }
    Err(Error::Work(format!(
        "a motor is still driven {PATIENCE_S} s after the command to stop; nothing was written"
    )))
}

/// Waits until the records of each whisker have been such for so many ticks; `false` if that
/// takes too long.
fn until(
    module: &mut Conversation,
    whiskers: usize,
    ticks: u32,
    is_such: impl Fn(&TickRecord) -> bool,
) -> Result<bool, Error> {
    let mut since: [Option<u32>; 2] = [None; 2];
    let mut such = [false; 2];
    let begun = module.source().now_s();
    while module.source().now_s() - begun < PATIENCE_S {
        for record in module.receive()?.records() {
            let (side, now) = (side(record), record.sequence);
            since[side] = is_such(record).then(|| since[side].unwrap_or(now));
            such[side] = since[side].is_some_and(|first| now.wrapping_sub(first) >= ticks);
        }
        if such.iter().filter(|such| **such).count() >= whiskers {
            return Ok(true);
        }
    }
    Ok(false)
}
