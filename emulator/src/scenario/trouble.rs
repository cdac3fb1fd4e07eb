//! Boards whose ticks are too long, or that start when they were not asked to: does the module
//! notice, are its motors off in time, does it say why, and does it carry on?

use scene::Scene;
use wire::{Command, TaggedCommand};

use super::runner::{Case, Done, MS, Runner, US, case};
use crate::chip::{Ps, ResetCause};
use crate::upset::Upset::{self, Astray, Held, NoStack};

/// Longer than the watchdog bears.
const BITES: Upset = Held(60 * MS);

/// Within which the pins must be low after the start of the tick in which the core crashes.
const CRASH_LOW: Ps = 20 * US;

/// A tick of two periods and a quarter lets one period pass without a tick, which the module
/// must count; later one hangs, and the watchdog must reset the chip.
pub(super) fn overload(scene: &Scene) -> Vec<Case> {
    /// The most that a tick takes on the slowest core beside what it is held, us, and how exactly
    /// the log has it.
    const TICK_US: f64 = 130.0;
    let held = 1_000_000_000_000 / Ps::from(scene.tick_hz) * 9 / 4;
    let held_us = 1e6 / f64::from(scene.tick_hz) * 2.25;
    let steps = move |on: &mut Runner| {
        on.pass(100)?;
        on.is_so("no tick is missed", |board| {
            Ok(board.board_mut().missed()? == 0)
        })?;
        on.upset(Held(held));
        on.pass(1_000)?;
        on.is_so(
            "one is missed",
            |board| Ok(board.board_mut().missed()? == 1),
        )?;
        on.health(&(held_us..held_us + TICK_US), 1)?;
        on.says("limit 32 ")?;
        on.forget();
        on.upset(BITES);
        on.pass(1_100)?;
        on.is_so("the watchdog bites", |board| {
            Ok(board.board_mut().reset.take() == Some(ResetCause::Watchdog))
        })?;
        on.says(" watchdog 2 52")?;
        on.health(&(0.0..f64::INFINITY), 0)
    };
    vec![case("ticks that are too long", steps)]
}

/// The chip is reset in every way that was not asked for: by the watchdog while whiskers whisk, by
/// crashes of the core every 0.75 s, three times in a minute, and, on another board, by a stack
/// that overflows. Motors must be off after each until the button is pressed as it should be.
/// There is no panic in the program that could be provoked.
pub(super) fn starting() -> Vec<Case> {
    let unasked = |on: &mut Runner| {
        on.whisk(1_000)?;
        on.says(" power-up 1 0")?;
        on.upset(BITES);
        on.rest(1_000)?;
        on.says(" watchdog 2 52")?;
        on.says("not-armed 52 ")?;
        on.press(1_500)?;
        on.rest(100)?;
        on.press(100)?;
        on.whisk(1_000)?;
        on.says("INFO  armed")?;
        // The first while it whisks, the others after it.
        (3..6).try_for_each(|start| crash(on, Astray, 49, start))?;
        on.forget();
        on.reset(ResetCause::Pin)?;
        on.rest(100)?;
        on.says("not-armed 59 ")
    };
    vec![
        case("starts that were not asked for", unasked),
        case("a stack that overflows", |on| {
            on.whisk(1_000)?;
            crash(on, NoStack, 54, 2)
        }),
        case("a stop, and resets after it", stopped),
    ]
}

/// The pins must be low in time and stay so; the log must say which fault it is, and so must the
/// next start, which has this number.
fn crash(on: &mut Runner, upset: Upset, fault: u8, start: u8) -> Done {
    on.forget();
    on.upset(upset);
    on.hang(on.session.period() + CRASH_LOW)?;
    on.rest(750)?;
    on.says_times(2, &format!("fault board {fault} "))?;
    on.says(&format!(" watchdog {start} {fault}"))?;
    on.says(&format!("not-armed {fault} "))
}

/// Motors that somebody has stopped are off after every reset, and the log says why, until the
/// button is pressed; pressed again it stops them.
fn stopped(on: &mut Runner) -> Done {
    on.whisk(1_000)?;
    let request = TaggedCommand {
        tag: 1,
        command: Command::Stop,
    };
    on.session.board_mut().request(&wire::frame(&request))?;
    on.rest(100)?;
    for cause in [ResetCause::Pin, ResetCause::Software] {
        on.reset(cause)?;
        on.rest(100)?;
        on.says("not-armed 0 somebody has stopped the motors")?;
        on.forget();
    }
    on.press(100)?;
    on.whisk(1_000)?;
    on.says("INFO  armed")?;
    on.press(100)?;
    on.rest(100)?;
    on.says("INFO  stopped")?;
    on.forget();
    on.reset(ResetCause::BrownOut)?;
    on.rest(100)?;
    on.says("not-armed 53 ")
}
