//! A board whose supply dips, and whose clock stops.

use firmware::BoardCode;

use super::runner::{Case, Done, MS, Runner, US, case};
use crate::chip::{Ps, ResetCause, WELL_MV};

/// Within which the pins must be low, and the chip be reset after that.
const LOW: Ps = 50 * US;
/// Below the detector's threshold, where the clock of every board is still right, mV.
const LOW_MV: u32 = 2_750;
/// Below what the fastest clock needs, where each chip still runs, mV.
const LOWER_MV: u32 = 2_200;
/// Below the power-down reset, mV. RAM keeps its contents, as it does for a moment.
const GONE_MV: u32 = 1_000;
/// Below the highest brown-out level, mV.
const BROWN_MV: u32 = 2_800;
/// For how long a start may wait for the clock from outside, ms.
const WAIT_FOR_CLOCK: u32 = 6_000;
/// For how long the supply is low, and for how long a fault handler is watched: longer than
/// the watchdog bears.
const DIP: Ps = 45 * MS;
const TOO_LOW: &str = "brown-out level";

/// The limit of a board that runs by its own oscillator.
const INTERNAL_CLOCK: &str = "limit 37 ";

fn low(on: &mut Runner, what: &str) -> Done {
    on.within(LOW, what, |board| Ok(!board.drives()))
}

fn begin(on: &mut Runner, in_tick: bool) -> Done {
    on.whisk(250)?;
    on.until_driven(in_tick)
}

/// The module ticks, with its motors off; its second start was for this cause and fault.
fn refuses(on: &mut Runner, cause: &str, fault: u8) -> Done {
    on.rest(100)?;
    on.says(&format!("not-armed {fault} "))?;
    on.says(&format!(" {cause} 2 {fault}"))
}

/// The handler of this fault has its line in the log and feeds the watchdog, for longer than
/// that bears without; its bite is not waited for.
fn dies(on: &mut Runner, fault: u8) -> Done {
    on.stand(DIP)?;
    on.says(&format!("fault board {fault} "))?;
    on.is_so("no reset yet", |board| {
        Ok(board.board_mut().reset.is_none())
    })?;
    on.reset(ResetCause::Watchdog)?;
    refuses(on, "watchdog", fault)
}

/// A supply that dips and a clock that stops, in idle and in the middle of a tick: the motor pins
/// must be low in time, the start must wait for the supply, motors must stay off after it.
pub(super) fn dip(board: BoardCode) -> Vec<Case> {
    let is_timed_from_inside = board == BoardCode::NucleoG071rb;
    let has_brown_out = board == BoardCode::NucleoF446re;
    let falling = |in_tick, what: &'static str| case(what, move |on| falls(on, in_tick, what));
    let stops = "pins low as the clock stops in a tick";
    let stray = "pins low after a non-maskable interrupt without a cause";
    vec![
        falling(false, "pins low as the supply falls in idle"),
        falling(true, "pins low as the supply falls in a tick"),
        case("the supply goes, and comes back slowly", goes),
        case("the supply falls below the brown-out level", move |on| {
            on.whisk(250)?;
            browns_out(on, has_brown_out)?;
            on.says_times(0, TOO_LOW)
        }),
        case(stops, move |on| {
            begin(on, true)?;
            if is_timed_from_inside {
                on.is_so("no clock from outside is needed", |board| {
                    Ok(!board.machine().disturbed().stop_clock(true)?)
                })?;
                return on.whisk(250);
            }
            on.is_so("the clock from outside stops", |board| {
                board.machine().disturbed().stop_clock(true)
            })?;
            low(on, stops)?;
            on.session.machine().disturbed().stop_clock(false)?;
            dies(on, 50)
        }),
        case(stray, move |on| {
            begin(on, true)?;
            on.session.machine().core.raise_nmi();
            low(on, stray)?;
            dies(on, 51)
        }),
        // A supply without a PC: the board whisks all the same.
        case("the clock from outside never comes", move |on| {
            // Power that has come back arms none: somebody does.
            on.session.machine().disturbed().stop_clock(true)?;
            on.reset(ResetCause::Power)?;
            on.pass(WAIT_FOR_CLOCK)?;
            on.press(100)?;
            on.whisk(1_100)?;
            if is_timed_from_inside {
                return on.says_times(0, INTERNAL_CLOCK);
            }
            on.says(INTERNAL_CLOCK)
        }),
        case("a probe lets go", |on| {
            on.whisk(250)?;
            on.session.machine().chip().let_go();
            on.whisk(1_100)?;
            on.is_so("a debugger's halt stops the motors", |board| {
                Ok(board.machine().chip().stops_with_the_core())
            })
        }),
    ]
}

fn falls(on: &mut Runner, in_tick: bool, what: &str) -> Done {
    begin(on, in_tick)?;
    on.supply(LOW_MV)?;
    low(on, what)?;
    on.within(LOW, "reset, and so on its own clock", |board| {
        Ok(board.board_mut().reset.take() == Some(ResetCause::Software))
    })?;
    on.supply(LOWER_MV)?;
    on.stand(DIP)?;
    on.says("waiting for the supply")?;
    on.supply(WELL_MV)?;
    refuses(on, "software", 58)
}

fn goes(on: &mut Runner) -> Done {
    begin(on, false)?;
    for mv in [GONE_MV, LOW_MV] {
        on.supply(mv)?;
        on.stand(DIP)?;
    }
    on.says("waiting for the supply")?;
    on.supply(WELL_MV)?;
    refuses(on, "power-up", 53)
}

fn browns_out(on: &mut Runner, has_brown_out: bool) -> Done {
    if !has_brown_out {
        return on.is_so("no brown-out reset", |board| {
            Ok(!board.machine().disturbed().set_brown_out())
        });
    }
    on.says(TOO_LOW)?;
    on.is_so("the brown-out reset at its highest level", |board| {
        Ok(board.machine().disturbed().set_brown_out())
    })?;
    on.until_driven(true)?;
    on.supply(BROWN_MV)?;
    on.stand(DIP)?;
    on.forget();
    on.supply(WELL_MV)?;
    refuses(on, "brown-out", 53)
}
