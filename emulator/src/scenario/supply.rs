//! A board whose supply dips, and whose clock stops.

use std::iter;

use firmware::BoardCode;
use firmware::boards::BoardFacts;
use scene::Scene;

use super::step::Step::{Do, Forget, Pass, Press, SaysTimes, Stand, Supply, UntilDriven, Within};
use super::step::{Case, MS, Step, US, says, whisk};
use super::trouble::{case, rest};
use crate::chip::{Ps, ResetCause, WELL_MV};
use crate::session::Session;

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

fn low(what: &'static str) -> Step {
    Within(LOW, what, |board| Ok(!board.drives()))
}

fn begin(in_tick: bool) -> impl Iterator<Item = Step> {
    [whisk(250), UntilDriven { in_tick }].into_iter()
}

/// The module ticks, with its motors off; its second start was for this cause and fault.
fn refuses(scene: &Scene, cause: &str, fault: u8) -> [Step; 3] {
    [
        rest(scene, 100),
        says(format!("not-armed {fault} ")),
        says(format!(" {cause} 2 {fault}")),
    ]
}

/// The handler of this fault has its line in the log and feeds the watchdog, for longer than
/// that bears without; its bite is not waited for.
fn dies(scene: &Scene, fault: u8) -> impl Iterator<Item = Step> {
    let steps = [
        Stand(DIP),
        says(format!("fault board {fault} ")),
        Within(0, "no reset yet", |board| {
            Ok(board.board_mut().reset.is_none())
        }),
        Do(|board| board.board_mut().reset_now(ResetCause::Watchdog)),
    ];
    steps.into_iter().chain(refuses(scene, "watchdog", fault))
}

/// A supply that dips and a clock that stops, in idle and in the middle of a tick: the motor pins
/// must be low in time, the start must wait for the supply, motors must stay off after it.
pub(super) fn dip(scene: &Scene, facts: &BoardFacts) -> Vec<Case> {
    let mut cases = falls(scene, facts);
    cases.extend(clock_fails(scene, facts));
    cases
}

fn falls(scene: &Scene, facts: &BoardFacts) -> Vec<Case> {
    let software =
        |board: &mut Session| Ok(board.board_mut().reset.take() == Some(ResetCause::Software));
    let mut cases = Vec::new();
    for (in_tick, what) in [
        (false, "pins low as the supply falls in idle"),
        (true, "pins low as the supply falls in a tick"),
    ] {
        let falls = [
            Supply(LOW_MV),
            low(what),
            Within(LOW, "reset, and so on its own clock", software),
            Supply(LOWER_MV),
            Stand(DIP),
            says("waiting for the supply"),
            Supply(WELL_MV),
        ];
        let steps = begin(in_tick)
            .chain(falls)
            .chain(refuses(scene, "software", 58));
        cases.push(case(what, steps));
    }
    let goes = [
        Supply(GONE_MV),
        Stand(DIP),
        Supply(LOW_MV),
        Stand(DIP),
        says("waiting for the supply"),
        Supply(WELL_MV),
    ];
    let steps = begin(false)
        .chain(goes)
        .chain(refuses(scene, "power-up", 53));
    cases.push(case("the supply goes, and comes back slowly", steps));

    let highest = |board: &mut Session| Ok(board.machine().disturbed().set_brown_out());
    let browns_out = [
        says(TOO_LOW),
        Within(0, "the brown-out reset at its highest level", highest),
        UntilDriven { in_tick: true },
        Supply(BROWN_MV),
        Stand(DIP),
        Forget,
        Supply(WELL_MV),
    ];
    let steps: Vec<Step> = if facts.code == BoardCode::NucleoF446re {
        let refused = refuses(scene, "brown-out", 53);
        browns_out.into_iter().chain(refused).collect()
    } else {
        vec![Within(0, "no brown-out reset", |board| {
            Ok(!board.machine().disturbed().set_brown_out())
        })]
    };
    let silent = SaysTimes(0, TOO_LOW.to_owned());
    let steps = iter::once(whisk(250)).chain(steps).chain([silent]);
    cases.push(case("the supply falls below the brown-out level", steps));
    cases
}

/// The limit of a board that runs by its own oscillator.
const INTERNAL_CLOCK: &str = "limit 37 ";

fn clock_fails(scene: &Scene, facts: &BoardFacts) -> [Case; 4] {
    let what = "pins low as the clock stops in a tick";
    let stops = |board: &mut Session| board.machine().disturbed().stop_clock(true);
    let stopped = [
        Within(0, "the clock from outside stops", stops),
        low(what),
        Do(|board| board.machine().disturbed().stop_clock(false).map(drop)),
    ];
    let steps: Vec<Step> = if facts.code == BoardCode::NucleoG071rb {
        let unused = |board: &mut Session| Ok(!board.machine().disturbed().stop_clock(true)?);
        vec![
            Within(0, "no clock from outside is needed", unused),
            whisk(250),
        ]
    } else {
        stopped.into_iter().chain(dies(scene, 50)).collect()
    };
    let stopped = case(what, begin(true).chain(steps));

    let what = "pins low after a non-maskable interrupt without a cause";
    let comes = Do(|board| {
        board.machine().raise_nmi();
        Ok(())
    });
    let comes = [comes, low(what)];
    let stray = case(what, begin(true).chain(comes).chain(dies(scene, 51)));
    [stopped, stray, never_comes(facts), lets_go()]
}

/// A supply without a PC: the clock from outside is not there as power comes, and the board whisks all
/// the same.
fn never_comes(facts: &BoardFacts) -> Case {
    // Power that has come back arms none: somebody does.
    let starts = Do(|board| {
        board.machine().disturbed().stop_clock(true)?;
        board.board_mut().reset_now(ResetCause::Power)
    });
    let is_said = if facts.code == BoardCode::NucleoG071rb {
        SaysTimes(0, INTERNAL_CLOCK.to_owned())
    } else {
        says(INTERNAL_CLOCK)
    };
    let moves = [
        starts,
        Pass(WAIT_FOR_CLOCK),
        Press(100),
        whisk(1_100),
        is_said,
    ];
    case("the clock from outside never comes", moves)
}

fn lets_go() -> Case {
    let lets_go = Do(|board| {
        board.machine().chip().let_go();
        Ok(())
    });
    let stops = |board: &mut Session| Ok(board.machine().chip().stops_with_the_core());
    let steps = [
        whisk(250),
        lets_go,
        whisk(1_100),
        Within(0, "a debugger's halt stops the motors", stops),
    ];
    case("a probe lets go", steps)
}
