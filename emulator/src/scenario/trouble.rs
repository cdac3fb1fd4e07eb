//! Boards whose ticks are too long, or that start when they were not asked to: does the module
//! notice, are its motors off in time, does it say why, and does it carry on?

use scene::Scene;
use wire::{Command, TaggedCommand};

use super::step::Step::{Do, Forget, Hang, Health, Move, Pass, Press, SaysTimes, Upset, Within};
use super::step::{Case, MS, Step, US, says, whisk};
use crate::chip::{Ps, ResetCause};
use crate::upset::Upset::{Astray, Held, NoStack};

/// Longer than the watchdog bears.
const HANG: Ps = 60 * MS;
const BITES: Step = Upset(Held(HANG));

/// Within which the pins must be low after the start of the tick in which the core crashes.
const CRASH_LOW: Ps = 20 * US;

/// A case in which the chip may be reset.
pub(super) fn case(what: &str, steps: impl IntoIterator<Item = Step>) -> Case {
    Case {
        what: what.to_owned(),
        may_reset: true,
        steps: steps.into_iter().collect(),
    }
}

pub(super) fn all(scene: &Scene) -> Vec<usize> {
    (0..scene.head.sides.count()).collect()
}

/// Every motor is off.
pub(super) fn rest(scene: &Scene, ms: u32) -> Step {
    let off = all(scene);
    Move { ms, off }
}

/// A tick of two periods and a quarter lets one period pass without a tick, which the module
/// must count; later one hangs, and the watchdog must reset the chip.
pub(super) fn overload(scene: &Scene) -> Vec<Case> {
    /// The most that a tick takes on the slowest core beside what it is held, us, and how exactly
    /// the log has it.
    const TICK_US: f64 = 130.0;
    let held = 1_000_000_000_000 / Ps::from(scene.tick_hz) * 9 / 4;
    let held_us = 1e6 / f64::from(scene.tick_hz) * 2.25;
    let steps = vec![
        Pass(100),
        Within(0, "no tick is missed", |board| {
            Ok(board.board_mut().missed()? == 0)
        }),
        Upset(Held(held)),
        Pass(1_000),
        Within(0, "one is missed", |board| {
            Ok(board.board_mut().missed()? == 1)
        }),
        Health {
            us: held_us..held_us + TICK_US,
            missed: 1,
        },
        says("limit 32 "),
        Forget,
        BITES,
        Pass(1_100),
        Within(0, "the watchdog bites", |board| {
            Ok(board.board_mut().reset.take() == Some(ResetCause::Watchdog))
        }),
        says(" watchdog 2 52"),
        Health {
            us: 0.0..f64::INFINITY,
            missed: 0,
        },
    ];
    vec![case("ticks that are too long", steps)]
}

/// The chip is reset in every way that was not asked for: by the watchdog while whiskers whisk, by
/// crashes of the core every 0.75 s, three times in a minute, and, on another board, by a stack
/// that overflows. Motors must be off after each until the button is pressed as it should be.
/// There is no panic in the program that could be provoked.
pub(super) fn starting(scene: &Scene) -> Vec<Case> {
    let rest = |ms| rest(scene, ms);
    // The pins must be low in time and stay so; the log must say which fault it is, and so must
    // the next start, which has this number.
    let crash = |upset, fault: u8, start: u8| {
        [
            Forget,
            Upset(upset),
            Hang(1_000_000_000_000 / Ps::from(scene.tick_hz) + CRASH_LOW),
            rest(750),
            SaysTimes(2, format!("fault board {fault} ")),
            says(format!(" watchdog {start} {fault}")),
            says(format!("not-armed {fault} ")),
        ]
    };
    let mut steps = vec![
        whisk(1_000),
        says(" power-up 1 0"),
        BITES,
        rest(1_000),
        says(" watchdog 2 52"),
        says("not-armed 52 "),
        Press(1_500),
        rest(100),
        Press(100),
        whisk(1_000),
        says("INFO  armed"),
    ];
    // The first while it whisks, the others after it.
    steps.extend((3..6).flat_map(|start| crash(Astray, 49, start)));
    steps.extend([
        Forget,
        Do(|board| board.board_mut().reset_now(ResetCause::Pin)),
        rest(100),
        says("not-armed 59 "),
    ]);
    let mut stack = vec![whisk(1_000)];
    stack.extend(crash(NoStack, 54, 2));
    vec![
        case("starts that were not asked for", steps),
        case("a stack that overflows", stack),
        case("a stop, and resets after it", stopped(scene)),
    ]
}

/// Motors that somebody has stopped are off after every reset, and the log says why, until the
/// button is pressed; pressed again it stops them.
fn stopped(scene: &Scene) -> Vec<Step> {
    let off = |ms| rest(scene, ms);
    let stop = Do(|board| {
        let request = TaggedCommand {
            tag: 1,
            command: Command::Stop,
        };
        board.board_mut().request(&wire::frame(&request)).map(drop)
    });
    let why = "not-armed 0 somebody has stopped the motors";
    vec![
        whisk(1_000),
        stop,
        off(100),
        Do(|board| board.board_mut().reset_now(ResetCause::Pin)),
        off(100),
        says(why),
        Forget,
        Do(|board| board.board_mut().reset_now(ResetCause::Software)),
        off(100),
        says(why),
        Press(100),
        whisk(1_000),
        says("INFO  armed"),
        Press(100),
        off(100),
        says("INFO  stopped"),
        Forget,
        Do(|board| board.board_mut().reset_now(ResetCause::BrownOut)),
        off(100),
        says("not-armed 53 "),
    ]
}
