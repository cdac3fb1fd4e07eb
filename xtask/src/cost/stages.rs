//! The stages of a tick: which counts they are made of, their goals, and what
//! others take for the same.
//!
//! Peers and floors were counted once in the same way (one call on an emulated
//! Cortex-M4F, gcc 12.2 -O3 or rustc 1.95 with link-time optimisation): CMSIS-DSP,
//! emlearn, idsp and newlib as a user would call them, and *floors*, kernels
//! written by hand for the purpose. They cannot be built here without their
//! sources, so their figures stand here.

/// A count that goes into a stage.
pub(super) struct Source {
    pub(super) kernel: &'static str,
    /// 1 to add it, −1 to take it away.
    pub(super) sign: f64,
}

const fn plus(kernel: &'static str) -> Source {
    Source { kernel, sign: 1.0 }
}

const fn minus(kernel: &'static str) -> Source {
    Source { kernel, sign: -1.0 }
}

/// A stage counted apart.
pub(super) struct Stage {
    pub(super) name: &'static str,
    pub(super) target: &'static str,
    pub(super) format: &'static str,
    pub(super) processor: &'static str,
    pub(super) sources: &'static [Source],
    /// At most so many instructions, mean; where a second number follows, worst.
    goal: &'static str,
    /// What others take, and who.
    peer: &'static str,
}

/// Goal and peers of a stage, both empty if there are none.
pub(super) fn beside(name: &str, target: &str) -> [&'static str; 2] {
    let is_it = |stage: &&Stage| stage.name == name && stage.target == target;
    match STAGES.iter().find(is_it) {
        Some(stage) => [stage.goal, stage.peer],
        None if name == BOARD_TICK => [BOARD_GOAL, ""],
        None => ["", ""],
    }
}

/// Single precision on a Cortex-M4F.
const fn m4f(
    name: &'static str,
    format: &'static str,
    sources: &'static [Source],
    goal: &'static str,
    peer: &'static str,
) -> Stage {
    Stage {
        name,
        target: "m4f",
        format,
        processor: "cortex-m4f",
        sources,
        goal,
        peer,
    }
}

/// Fixed point on a Cortex-M4.
const fn m4(
    name: &'static str,
    sources: &'static [Source],
    goal: &'static str,
    peer: &'static str,
) -> Stage {
    Stage {
        name,
        target: "m4-fixed",
        format: "fix",
        processor: "cortex-m4f",
        sources,
        goal,
        peer,
    }
}

/// On a Cortex-M0+, counted on a Cortex-M0, which has the same instructions.
const fn m0(
    name: &'static str,
    format: &'static str,
    sources: &'static [Source],
    goal: &'static str,
    peer: &'static str,
) -> Stage {
    Stage {
        name,
        target: "m0+",
        format,
        processor: "cortex-m0",
        sources,
        goal,
        peer,
    }
}

const PUSH_4: &[Source] = &[plus("classifier push K=4")];
const PUSH_9: &[Source] = &[plus("classifier push K=9")];
const END_9: &[Source] = &[
    plus("classifier push and end of block K=9"),
    minus("classifier push K=9"),
];
const FRAME: &[Source] = &[plus("frame decode")];
const H50: &[Source] = &[plus("h50")];
const OSCILLATORS: &[Source] = &[plus("oscillators of 2 sides")];
const DRIVE: &[Source] = &[plus("drive")];
const MUSCLE: &[Source] = &[plus("muscle")];
const GATES: &[Source] = &[plus("gates z and g")];
const PD: &[Source] = &[plus("pd")];
/// One whisker with two oscillators: that of one side, and the second oscillator.
const TICK: &[Source] = &[
    plus("computation of 1 whisker"),
    plus("oscillators of 2 sides"),
    minus("oscillator of 1 side"),
];
const HEAD: &[Source] = &[plus("computation of 24 whiskers")];

/// All that is counted apart.
pub(super) const STAGES: &[Stage] = &[
    m4f(
        "H50 one sample",
        "f32",
        H50,
        "24",
        "34 idsp cascade; 22 floor in C",
    ),
    m4f(
        "classifier push 4 classes",
        "integer",
        PUSH_4,
        "30",
        "1074 CMSIS-DSP; 27 floor",
    ),
    m4f(
        "classifier push 9 classes",
        "integer",
        PUSH_9,
        "55",
        "2618 CMSIS-DSP; 53 floor",
    ),
    m4f(
        "end of block 9 classes",
        "integer",
        END_9,
        "200",
        "252 floor",
    ),
    m4f("frame decode", "integer", FRAME, "20", "18 floor"),
    m4f(
        "both oscillators exact with both drives",
        "f32",
        OSCILLATORS,
        "80",
        "75 to 85 floor",
    ),
    m4f("drive", "f32", DRIVE, "24", "106 newlib tanhf; 23 floor"),
    m4f(
        "muscle with its exponential",
        "f32",
        MUSCLE,
        "60",
        "66 floor (third order)",
    ),
    m4f("gate z and g", "f32", GATES, "35", "37 floor"),
    m4f(
        "position control",
        "f32",
        PD,
        "",
        "15 CMSIS-DSP PID (no limits)",
    ),
    m4f("active tick computed", "f32", TICK, "", "324 floor"),
    m4f(
        "head of 24 whiskers computed",
        "f32",
        HEAD,
        "",
        "5181 floor",
    ),
    m4("H50 one sample", H50, "", "138 CMSIS-DSP q31; 22 floor"),
    m4(
        "both oscillators exact with both drives",
        OSCILLATORS,
        "",
        "113 floor",
    ),
    m4("drive", DRIVE, "", "17 floor"),
    m4(
        "muscle with its exponential",
        MUSCLE,
        "",
        "52 floor (third order)",
    ),
    m4("gate z and g", GATES, "", "35 floor"),
    m4(
        "position control",
        PD,
        "",
        "21 CMSIS-DSP PID q31 (no limits)",
    ),
    m4("active tick computed", TICK, "", "373 floor"),
    m4("head of 24 whiskers computed", HEAD, "", ""),
    m0("H50 one sample", "fix", H50, "", "75 to 116 floor"),
    m0(
        "classifier push 4 classes",
        "integer",
        PUSH_4,
        "",
        "46 floor",
    ),
    m0(
        "classifier push 9 classes",
        "integer",
        PUSH_9,
        "",
        "84 floor",
    ),
    m0("end of block 9 classes", "integer", END_9, "", "364 floor"),
    m0("frame decode", "integer", FRAME, "", "34 floor"),
    m0(
        "both oscillators exact with both drives",
        "fix",
        OSCILLATORS,
        "",
        "247 to 328 floor",
    ),
    m0("drive", "fix", DRIVE, "", "24 floor"),
    m0(
        "muscle with its exponential",
        "fix",
        MUSCLE,
        "",
        "214 to 292 floor (third order)",
    ),
    m0("gate z and g", "fix", GATES, "", "55 floor"),
    m0("position control", "fix", PD, "", "22 floor (no limits)"),
    m0("active tick computed", "fix", TICK, "", "810 to 992 floor"),
];

/// A scene on the emulated board, and what is taken from it: what the board calls
/// it, and the stage.
pub(super) struct BoardStage {
    pub(super) scene: &'static str,
    pub(super) parts: &'static [(&'static str, &'static str)],
}

const BOARD_TICK: &str = "active tick with interrupts and DMA";

/// 15 % more than the 592 instructions that it took when code was bent for them.
const BOARD_GOAL: &str = "681 (worst 1000)";

/// All that is counted on the board.
pub(super) const BOARD_STAGES: &[BoardStage] = &[
    BoardStage {
        scene: "scenes/active.toml",
        parts: &[
            ("tick's handler", "handler of the active tick"),
            ("whole tick", BOARD_TICK),
        ],
    },
    BoardStage {
        scene: "scenes/full.toml",
        parts: &[("whole tick", "the same with noise")],
    },
];
