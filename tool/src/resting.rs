//! Brings whiskers to rest and stops their motors before a module is restarted, which takes the
//! position of its whiskers then for their rest.

use host_sim::Error;
use wire::{Command, CommandStatus, Flags, TickRecord, WhiskerId, degrees};

use crate::conversation::Conversation;

/// The setpoint at rest, Q24.
const REST: i32 = 0;
/// How near to it is near enough, degrees, and for how long it must be, s: who passes by goes on
/// as its motor goes off.
const NEAR_DEG: f32 = 2.0;
const NEAR_S: f64 = 0.1;
/// Most whiskers of a side, as a head may have.
const MOST_A_SIDE: u8 = 12;
/// How long whiskers may take to get there, and motors to go off, s.
const PATIENCE_S: f64 = 1.0;

/// Motors go off once all whiskers rest, or have had time to; a module without any is left alone.
pub(crate) fn rest(module: &mut Conversation) -> Result<(), Error> {
    let [tick_hz, whiskers] = module.ask(Command::Hello)?.values;
    let near_ticks = (NEAR_S * f64::from(tick_hz)) as u32;
    let whiskers = usize::try_from(whiskers).unwrap_or(0);
    // A board of a head may have any of its whiskers.
    let all = (0..MOST_A_SIDE).flat_map(|number| [0, 1].map(|side| WhiskerId { side, number }));
    let mut found = 0;
    for whisker in all {
        if found == whiskers {
            break;
        }
        let answer = module.answer(Command::Setpoint(whisker, REST))?;
        // Its range may leave rest out.
        let are_there = [CommandStatus::Done, CommandStatus::OutOfRange];
        found += usize::from(are_there.contains(&answer.status));
    }
    if found == 0 {
        return Ok(());
    }
    if module.answer(Command::Stream(true))?.status != CommandStatus::Done {
        // Its link is too slow for records: they have had time to.
        let begun = module.now_s();
        while module.now_s() - begun < PATIENCE_S {
            module.receive()?;
        }
        return module.ask(Command::Stop).map(drop);
    }
    let is_near = |record: &TickRecord| (degrees(record.measured) - degrees(0)).abs() < NEAR_DEG;
    until(module, whiskers, near_ticks, is_near)?;
    module.ask(Command::Stop)?;
    let is_off = |record: &TickRecord| record.duty == 0 && !record.flags.contains(Flags::ARMED);
    let are_off = until(module, whiskers, 0, is_off)?;
    module.ask(Command::Stream(false))?;
    if are_off {
        return Ok(());
    }
    let fault = format!("a motor is still driven {PATIENCE_S} s after the command to stop");
    Err(Error::Work(format!("{fault}; nothing was written")))
}

/// Lets whiskers go that [`rest`] has held, with their motors off: nothing was restarted.
pub(crate) fn let_go(module: &mut Conversation) -> Result<(), Error> {
    module.ask(Command::Stop)?;
    for number in 0..MOST_A_SIDE {
        for side in [0, 1] {
            module.answer(Command::Release(WhiskerId { side, number }))?;
        }
    }
    Ok(())
}

/// Waits until all records have been such for so many ticks, with one of each whisker at least;
/// `false` if that takes too long.
fn until(
    module: &mut Conversation,
    whiskers: usize,
    ticks: u32,
    is_such: impl Fn(&TickRecord) -> bool,
) -> Result<bool, Error> {
    let mut since: Option<(u32, usize)> = None;
    let begun = module.now_s();
    while module.now_s() - begun < PATIENCE_S {
        for record in module.receive()?.records() {
            if !is_such(record) {
                since = None;
                continue;
            }
            let (first, count) = since.map_or((record.sequence, 1), |(first, n)| (first, n + 1));
            since = Some((first, count));
            if record.sequence.wrapping_sub(first) >= ticks && count >= whiskers {
                return Ok(true);
            }
        }
    }
    Ok(false)
}
