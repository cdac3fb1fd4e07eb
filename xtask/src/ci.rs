//! What CI checks, in the order in which it is quickest to fail: everything once, and
//! of what takes long as much as can still fail. The long runs are [`crate::nightly`]'s.

use crate::emulate::{Emulated, variants};
use crate::firmware::Board;
use crate::run::{Fault, cargo, linted, run, take_built_programs};
use crate::steps::{Step, Steps};
use crate::{
    book, cost, dependencies, descriptions, docs, emulate, endurance, faults, page, python,
    scenarios, size, studies, walk,
};

pub(crate) const DENY: [&str; 3] = ["--", "-D", "warnings"];

/// All that runs on this PC in one build, so that nothing is compiled twice with other features:
/// without the counts, which take the crates as a board does, and without what only Python loads.
pub(crate) const ALL: &str = "--workspace --exclude count --exclude whisker-python";

/// Of the properties' cases.
const SEED: &str = "1";

/// What runs on this PC: tests, the main job, whose output and files are what the generated documents
/// must hold, and all that is built beside the product.
const ON_THE_PC: [Step; 5] = [
    ("tests", tests),
    ("main job and documents", docs::short),
    ("Python", python::test),
    ("studies", studies_on_same_cases),
    ("page", page),
];

/// What builds programs of boards, all in one place and therefore one after the other.
const ON_THE_BOARDS: [Step; 10] = [
    ("firmware of some scenes", size::short),
    ("picture of the emulated board", docs::asymmetry_is_current),
    ("the walk through the book", walk::short),
    ("emulated boards, one side and two", board),
    ("injected faults, five hundred", faults::short),
    ("faults from files", scenarios::short),
    ("endurance, in short", endurance::short),
    ("cost of a tick on the board", cost::short),
    // Of the other list, which takes longer.
    ("chips as described", descriptions::compare),
    ("the book", the_book),
];

/// Everything, or the steps whose names contain one of `only`.
pub(crate) fn all(only: Vec<String>) -> Result<(), Fault> {
    let steps = Steps::new(only);
    let done = in_order(&steps);
    steps.end().and(done)
}

fn in_order(steps: &Steps) -> Result<(), Fault> {
    steps.run("format", format)?;
    steps.run("lints of what is not built here", lints)?;
    steps.run("programs and tests, built with lints", build)?;
    steps.run("dependencies", dependencies::check)?;
    steps.beside(&[&ON_THE_BOARDS, &ON_THE_PC])?;
    // With the processors to itself.
    steps.run("page, frames counted", || page::count_frames(None))
}

fn the_book() -> Result<(), Fault> {
    book::test()?;
    book::build()
}

fn studies_on_same_cases() -> Result<(), Fault> {
    studies::check(Some(SEED))
}

fn page() -> Result<(), Fault> {
    page::build()?;
    page::test()
}

fn format() -> Result<(), Fault> {
    run(&mut cargo("fmt --all --check"))?;
    studies::format()
}

fn lints() -> Result<(), Fault> {
    // Debug probes and libFuzzer are linted and built at night: they make a fifth more to compile.
    run(cargo("clippy -p count --all-targets").args(DENY))?;
    let [board, ..] = Board::ALL;
    let board = board.build_arguments(board.every_part);
    run(cargo(&format!("clippy {board}")).args(DENY))
}

/// With the tests' features, which programs alone have not.
fn build() -> Result<(), Fault> {
    run(linted(&mut cargo(&format!(
        "build --locked --all-targets {ALL}"
    ))))?;
    take_built_programs()
}

/// Properties are tried on the same cases in each run, so that a change passes or fails by what
/// it changes; the nightly run tries others.
fn tests() -> Result<(), Fault> {
    let mut test = cargo(&format!("test --locked {ALL}"));
    run(linted(&mut test).env("PROPTEST_RNG_SEED", SEED))
}

/// Half of it runs beside the other half; the rest is for the night.
fn board() -> Result<(), Fault> {
    std::thread::scope(|scope| {
        let beside = scope.spawn(other_boards);
        let done = first_board();
        let beside = beside.join().unwrap_or_else(|_| Err("panicked".to_owned()));
        done.and(beside)
    })
}

/// What the first board does with one side, by a program made for it; and what is deployed to the
/// last.
fn first_board() -> Result<(), Fault> {
    let one_side = "compare overload starting supply damage sensor-loss";
    let one_side: Vec<&str> = one_side.split(' ').collect();
    let [first, _, smallest] = Board::ALL;
    Emulated::linked(first).run(emulate::FULL, &one_side)?;
    // As long as all the rest: beside it.
    let smallest = Emulated::deployed(smallest)?;
    smallest.run(emulate::BENCH, &["deploying"])
}

/// What it does with two, and in other ways; and the others: a program a board, to which scenes
/// are deployed, but in fixed point, as two boards of a head and with TMAG5170s on the first; the
/// night has these on each, and every scene.
fn other_boards() -> Result<(), Fault> {
    let [board, small, smallest] = Board::ALL;
    let linked = Emulated::linked(board);
    let tilted = emulate::tilt(board)?;
    linked.run(tilted, &["compare --duration 4", "sensor-loss"])?;
    let fixed = variants::with(&emulate::noisiest()?, &emulate::FIXED)?;
    linked.run(fixed, &["compare"])?;
    linked.run(emulate::head_of_two()?, &["head --duration 2 --ppm 300"])?;
    let board = Emulated::deployed(board)?;
    // The scene in which records cost most.
    board.run(emulate::WORLD, &["telemetry"])?;
    board.run(emulate::CIA, &["compare --probe absent", "latency"])?;
    let both_sides = ["deadlines --minutes 0.05", "sensor-loss"];
    board.run(emulate::noisiest()?, &both_sides)?;
    board.run(emulate::brushless()?, &["compare --duration 2", "damage"])?;
    board.run(emulate::head_of_two()?, &["relay"])?;
    board.run(emulate::FULL, &["serial", "stopping --stops 10"])?;
    board.run(emulate::with_slow_sensors()?, &["compare"])?;
    board.run(emulate::judged_with_options()?, &["compare --duration 6"])?;
    for board in [small, smallest] {
        // What their programs for any scene have no room for.
        Emulated::linked(board).run(emulate::JUDGED, &["compare --duration 4"])?;
    }
    let in_short = ["compare --probe pulled", "sensor-loss"];
    let [small, smallest] = [Emulated::deployed(small)?, Emulated::deployed(smallest)?];
    // What not every board has room for.
    let keys = ["classifier.prior.smooth=0.6", "sensor.self_motion_s=0.5"];
    small.run(variants::with(emulate::FULL, &keys[..1])?, &in_short)?;
    smallest.run(variants::with(emulate::FULL, &keys)?, &in_short)
}
