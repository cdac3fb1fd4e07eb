//! The long runs: what CI checks in part, in full. A failure does not keep the others from running.

use ::firmware::boards::InHead;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use crate::emulate::Emulated;
use crate::emulate::variants::with;
use crate::firmware::{self, Board};
use crate::run::{Fault, cargo, installed, run, target, top};
use crate::steps::Steps;
use crate::{
    ci, cost, dependencies, dist, docs, emulate, endurance, faults, fuzz, mutants, panics, python,
    reproducible, scenarios, size, studies, walk,
};

/// In how many nights every mutation is tried once.
const NIGHTS: u64 = 7;

/// Everything, or the steps whose names contain one of `only`.
pub(crate) fn all(only: Vec<String>) -> Result<(), Fault> {
    let mut steps = Steps::new(only);
    steps.try_run("lints of every board", lints);
    steps.try_run("the bench's program with debug probes", with_probes);
    steps.try_run("properties on other cases", || {
        let test = format!("test --locked {}", ci::ALL);
        run(&mut cargo(&test))?;
        // What a newcomer's `cargo test` leaves out: it builds the program of another board.
        run(cargo(&test).args(["--test", "program", "--", "--ignored"]))?;
        studies::check(None)
    });
    steps.try_run("size of every scene on every board", || {
        size::all(None, true)
    });
    steps.try_run("a panic would be found on every board", || {
        Board::ALL.into_iter().try_for_each(panics::control)
    });
    steps.try_run("every scene on the emulated boards", boards);
    steps.try_run("counts and cost of every stage", || cost::all(None, true));
    steps.try_run("documents", || docs::all(true));
    steps.try_run("experiments", studies::experiments);
    steps.try_run("Python: sources, sweeps, notebooks", python::whole);
    steps.try_run("bending against MuJoCo", python::against_mujoco);
    steps.try_run("the walk through the book", walk::nightly);
    steps.try_run("endurance", endurance::nightly);
    steps.try_run("injected faults", faults::whole);
    steps.try_run("faults from files, all of them", scenarios::all);
    steps.try_run("untrusted input", || fuzz::all(&[], 60.0, false));
    steps.try_run("dependencies", dependencies::install_and_check);
    steps.try_run("two builds, the same bytes", || {
        let scene = Path::new(emulate::FULL);
        let mut boards = Board::ALL.into_iter();
        boards.try_for_each(|board| reproducible::twice(board, scene))
    });
    steps.try_run("a release, and its use without Rust", dist::nightly);
    steps.try_run("mutants", mutants::all);
    steps.try_run("mutations", mutations);
    steps.end()
}

fn with_probes() -> Result<(), Fault> {
    run(&mut cargo("test --locked -p whisker --features probe"))
}

fn lints() -> Result<(), Fault> {
    for board in Board::ALL {
        // What reads the other sensor.
        let tilt = firmware::linked(board, &top().join(emulate::TILT))??;
        for parts in [board.every_part, &tilt.image.features] {
            let arguments = board.build_arguments(parts);
            run(cargo(&format!("clippy {arguments}")).args(ci::DENY))?;
        }
    }
    let features = ["--features", "whisker/probe,fuzz/engine"];
    let mut apart = cargo("clippy --all-targets -p whisker -p fuzz");
    run(apart.args(features).args(ci::DENY))
}

fn boards() -> Result<(), Fault> {
    for board in Board::ALL {
        let (linked, deployed) = (Emulated::linked(board), Emulated::deployed(board)?);
        for on in [&linked, &deployed] {
            emulate::compare_all(on)?;
            on.run(emulate::BENCH, &["deploying"])?;
        }
        linked.run(emulate::brushless()?, &["compare", "damage"])?;
        let mut scenes = vec![PathBuf::from(emulate::FULL)];
        if board.facts.in_head == InHead::Untuned {
            linked.run(emulate::head_of_two()?, &["head"])?;
        }
        if board.facts.max_sides > 1 {
            linked.run(emulate::CIA, &["latency"])?;
            let both = emulate::noisiest()?;
            linked.run(&both, &["compare"])?;
            // A board a whisker: what bus and boards bear at most.
            let keys = ["head.nodes=24", "head.whiskers_per_side=12"];
            linked.run(with(emulate::CIA, &keys)?, &["head --duration 2"])?;
            // Two boards with a whisker each, by crystals apart.
            for whiskers in ["first", "each", "together"] {
                let whiskers = format!("classifier.whiskers={whiskers:?}");
                let keys = ["head.nodes=2", "head.whiskers_per_side=2", &whiskers];
                let head = with(emulate::WORLD, &keys)?;
                linked.run(head, &["head --duration 10 --ppm 300"])?;
            }
            scenes.push(both);
        }
        for scene in &scenes {
            let tasks = [
                "compare --probe absent",
                "compare --probe pulled",
                "deadlines --minutes 10",
                "overload",
                "starting",
                "supply",
                "telemetry",
                "damage",
                "sensor-loss",
            ];
            linked.run(scene, &tasks)?;
            // What the port costs is seen where the program is the same with it and without.
            deployed.run(scene, &["serial"])?;
        }
        // Eleven floods.
        linked.run(emulate::FULL, &["stopping --stops 1000"])?;
    }
    Ok(())
}

/// Changes the product's crates (.cargo/mutants.toml) in one place at a time and asks
/// their tests; another seventh of the places every night.
fn mutations() -> Result<(), Fault> {
    installed("mutants")?;
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let day = now.map_err(|error| error.to_string())?.as_secs() / (24 * 60 * 60);
    let shard = format!("mutants --shard {}/{NIGHTS} --output", day % NIGHTS);
    run(cargo(&shard).arg(target()))
}
