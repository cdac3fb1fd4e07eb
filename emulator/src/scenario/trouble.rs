//! Boards in trouble: does the module notice, are its motors off in time, does it say why, and
//! does it carry on?

use std::iter;

use firmware::BoardCode;
use firmware::boards::BoardFacts;
use host_sim::Error;
use host_sim::bus::WireFault::{self, BadSum, Frozen, LineLow, LowAfterStart, Silent};
use mlx90333::Faults;
use scene::{OnFault, Scene};

use super::step::Step::{
    Do, Flip, Forget, Hang, Health, Move, NoContact, Pass, Press, SaysTimes, Sensors, Stand,
    Supply, UntilDriven, Upset, Within,
};
use super::step::{Case, MS, Step, US, says, whisk};
use crate::chip::{Chip, Fault, Ps, ResetCause, SIDE_NAMES, WELL_MV};
use crate::debug_info::DebugInfo;
use crate::program::Program;
use crate::session::Session;
use crate::upset::Upset::{Astray, Held, NoStack};

/// Longer than the watchdog bears.
const HANG: Ps = 60 * MS;
const BITES: Step = Upset(Held(HANG));

/// Within which the pins must be low: after the start of the tick in which the core crashes, and
/// after supply or clock fail.
const CRASH_LOW: Ps = 20 * US;
const LOW: Ps = 50 * US;

/// A case in which the chip may be reset.
fn case(what: &str, steps: impl IntoIterator<Item = Step>) -> Case {
    Case {
        what: what.to_owned(),
        may_reset: true,
        steps: steps.into_iter().collect(),
    }
}

fn all(scene: &Scene) -> Vec<usize> {
    (0..scene.head.sides.count()).collect()
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
    let rest = |ms| Move {
        ms,
        off: all(scene),
    };
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
    ]
}

/// A supply that dips and a clock that stops, in idle and in the middle of a tick: the motor pins
/// must be low in time, the start must wait for the supply, motors must stay off after it.
pub(super) fn supply(scene: &Scene, facts: &BoardFacts) -> Vec<Case> {
    /// Below the detector's threshold, where the clock of every board is still right, mV.
    const LOW_MV: u32 = 2_750;
    /// Below what the fastest clock needs, where each chip still runs, mV.
    const LOWER_MV: u32 = 2_200;
    /// Below the power-down reset, mV. RAM keeps its contents, as it does for a moment.
    const GONE_MV: u32 = 1_000;
    /// Below the highest brown-out level, mV.
    const BROWN_MV: u32 = 2_800;
    /// For how long the supply is low, and for how long a fault handler is watched: longer than
    /// the watchdog bears.
    const DIP: Ps = 45 * MS;
    const TOO_LOW: &str = "brown-out level";

    // The module ticks, with its motors off; its second start was for this cause and fault.
    let refuses = |cause: &str, fault: u8| {
        let off = all(scene);
        [
            Move { ms: 100, off },
            says(format!("not-armed {fault} ")),
            says(format!(" {cause} 2 {fault}")),
        ]
    };
    // The handler of this fault has its line in the log and feeds the watchdog, for longer than
    // that bears without; its bite is not waited for.
    let dies = |fault: u8| {
        let steps = [
            Stand(DIP),
            says(format!("fault board {fault} ")),
            Within(0, "no reset yet", |board| {
                Ok(board.board_mut().reset.is_none())
            }),
            Do(|board| board.board_mut().reset_now(ResetCause::Watchdog)),
        ];
        steps.into_iter().chain(refuses("watchdog", fault))
    };
    let begin = |in_tick| [whisk(250), UntilDriven { in_tick }].into_iter();
    let low = |what| Within(LOW, what, |board| Ok(!board.drives()));
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
        let steps = begin(in_tick).chain(falls).chain(refuses("software", 58));
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
    let steps = begin(false).chain(goes).chain(refuses("power-up", 53));
    cases.push(case("the supply goes, and comes back slowly", steps));

    let highest = |board: &mut Session| Ok(board.machine().disturb(Chip::set_brown_out));
    let browns_out = [
        says(TOO_LOW),
        Within(0, "the brown-out reset at its highest level", highest),
        UntilDriven { in_tick: true },
        Supply(BROWN_MV),
        Stand(DIP),
        Forget,
        Supply(WELL_MV),
    ];
    let steps: Vec<Step> = if facts.code == BoardCode::NucleoF103rb {
        vec![Within(0, "no brown-out reset", |board| {
            Ok(!board.machine().disturb(Chip::set_brown_out))
        })]
    } else {
        browns_out
            .into_iter()
            .chain(refuses("brown-out", 53))
            .collect()
    };
    let silent = SaysTimes(0, TOO_LOW.to_owned());
    let steps = iter::once(whisk(250)).chain(steps).chain([silent]);
    cases.push(case("the supply falls below the brown-out level", steps));

    let what = "pins low as the clock stops in a tick";
    let stops = |board: &mut Session| board.machine().disturb(|chip| chip.stop_clock(true));
    let stopped = [
        Within(0, "the clock from outside stops", stops),
        low(what),
        Do(|board| {
            board
                .machine()
                .disturb(|chip| chip.stop_clock(false))
                .map(drop)
        }),
    ];
    let steps: Vec<Step> = if facts.code == BoardCode::NucleoG071rb {
        let unused =
            |board: &mut Session| Ok(!board.machine().disturb(|chip| chip.stop_clock(true))?);
        vec![
            Within(0, "no clock from outside is needed", unused),
            whisk(250),
        ]
    } else {
        stopped.into_iter().chain(dies(50)).collect()
    };
    cases.push(case(what, begin(true).chain(steps)));

    let what = "pins low after a non-maskable interrupt without a cause";
    let comes = Do(|board| {
        board.machine().raise_nmi();
        Ok(())
    });
    cases.push(case(
        what,
        begin(true).chain([comes, low(what)]).chain(dies(51)),
    ));
    cases
}

/// The sensors of either side and of both fail on their wires: those sides' motors must be off, or
/// all where the scene says so, nothing be felt and decided there, the log say whose sensor fails
/// and why, and all be well again once the sensor is back.
pub(super) fn sensor_loss(scene: &Scene) -> Vec<Case> {
    /// What befalls wires, what the sensor says of itself, the fault that its whisker then has,
    /// and within how many ms that is found.
    const LOSSES: [(Option<WireFault>, Faults, u8, u32); 6] = [
        (Some(Silent), Faults::NONE, 18, 100),
        (Some(LineLow), Faults::NONE, 19, 100),
        (Some(BadSum), Faults::NONE, 21, 100),
        (None, Faults::FIELD_TOO_LOW, 22, 100),
        (Some(LowAfterStart), Faults::NONE, 23, 100),
        // A quarter of a second, unless the scene has another.
        (Some(Frozen), Faults::NONE, 24, 300),
    ];
    let sides = all(scene);
    let mut lost: Vec<&[usize]> = sides.chunks(1).collect();
    if sides.len() > 1 {
        lost.push(&sides);
    }
    let motor = scene.motor.as_ref();
    let stops_all = motor.is_some_and(|motor| motor.on_fault == OnFault::StopAll);
    let mut steps = vec![Pass(100)];
    for lost in lost {
        let off = if stops_all { &sides } else { lost };
        for (wire, word, fault, found_ms) in LOSSES {
            steps.extend([
                Forget,
                Sensors(lost.to_vec(), wire, word),
                Pass(found_ms),
                Move {
                    ms: 100,
                    off: off.to_vec(),
                },
                NoContact(lost.to_vec()),
            ]);
            for (side, name) in SIDE_NAMES.into_iter().enumerate() {
                steps.push(if lost.contains(&side) {
                    says(format!("fault {name} {fault} "))
                } else {
                    SaysTimes(0, format!("fault {name} "))
                });
            }
            if word == Faults::FIELD_TOO_LOW {
                steps.push(says("field too low"));
            }
            steps.extend([
                Sensors(lost.to_vec(), None, Faults::NONE),
                Pass(100),
                whisk(100),
            ]);
            steps.extend(
                lost.iter()
                    .map(|side| says(format!("back {}", SIDE_NAMES[*side]))),
            );
        }
    }
    vec![Case {
        what: "sensors that are lost".to_owned(),
        may_reset: false,
        steps,
    }]
}

/// A bit flips in the settings in RAM, in the model in flash, or in what the classifier holds of
/// it in RAM, each on a new board: the motors must be off once idle has looked at all of it, and
/// the log must say fault 55 or 56.
pub(super) fn damage(scene: &Scene, program: &Program) -> Result<Vec<Case>, Error> {
    /// The settings, and how fast the module ticks by them; and in the module what the classifier
    /// holds that no sample changes.
    const SETTINGS: [&[&str]; 2] = [&["SETTINGS", "val"], &["PACE"]];
    const CONSTANTS: [&[&str]; 2] = [
        &[
            "INNER",
            "perception",
            "classifier",
            "found",
            "classifier",
            "constants",
        ],
        &["INNER", "perception", "classifier", "found", "factors"],
    ];
    /// Bytes of the largest model that is damaged here, and where in it: in the row of a table.
    const MODEL_BYTES: u32 = 12 * 1024;
    const ROW: u32 = 1_024;

    let info = DebugInfo::new(program)?;
    let mut flips = Vec::new();
    for path in SETTINGS {
        flips.extend(evenly(&info, path)?.map(|flip| (55, flip)));
    }
    let classifier = scene.classifier.as_ref();
    if classifier.is_some_and(|classifier| classifier.model.is_some()) {
        for path in CONSTANTS {
            flips.extend(evenly(&info, path)?.map(|flip| (56, flip)));
        }
        let [slot, _] = program.model()?.facts.flash.slots;
        flips.push((56, (slot.model.start + ROW, 0, MODEL_BYTES)));
    }
    let cases = flips.into_iter().map(|(fault, (address, bit, bytes))| {
        let mut steps = vec![Pass(100)];
        steps.extend(
            scene
                .motor
                .is_some()
                .then_some(UntilDriven { in_tick: false }),
        );
        let period = 1_000_000_000_000 / Ps::from(scene.tick_hz);
        steps.extend([
            Flip { address, bit },
            Stand(Ps::from(looked_at_within(bytes)) * period),
            says(format!("fault board {fault} ")),
        ]);
        Case {
            what: format!("bit {bit} at {address:#010x}"),
            may_reset: false,
            steps,
        }
    });
    Ok(cases.collect())
}

/// Ticks after which every word of so many bytes was looked at: that of a walk which had just
/// passed the word, and a whole one; and two in which idle is late.
const fn looked_at_within(bytes: u32) -> u32 {
    /// Words of each that idle looks at in a tick.
    const LOOKED_AT: u32 = 16;
    2 * (bytes / 4).div_ceil(LOOKED_AT) + 2
}

/// Bits of four words of what these names lead to, evenly spread: address, bit, and the bytes of
/// all of it.
fn evenly(info: &DebugInfo, path: &[&str]) -> Result<impl Iterator<Item = (u32, u32, u32)>, Fault> {
    const WORDS: u32 = 4;
    let [variable, members @ ..] = path else {
        return Err(Fault::Program("no variable".to_owned()));
    };
    let found = info.variable(variable)?;
    let found = members
        .iter()
        .try_fold(found, |place, name| place.member(name))?;
    let (first, bytes) = (found.address, found.size()?);
    let last = bytes / 4 - 1;
    let mut words: Vec<u32> = (0..WORDS).map(|n| last * n / (WORDS - 1)).collect();
    words.dedup();
    let words = words.into_iter();
    Ok(words.map(move |word| (first + 4 * word, word % 8, bytes)))
}
