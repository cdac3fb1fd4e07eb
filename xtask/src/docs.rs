//! Generated documents: written by commands, never by hand.

#[cfg(test)]
mod by_hand;
mod faults;
mod main_job;

use crate::firmware::Board;
use crate::run::{
    Fault, cargo, document, output, read, read_bytes, target, top, workspace_program,
};
use crate::{cost, descriptions, emulate, studies};
use main_job::DECISIONS;

/// Writes the documents that follow from the source alone, or checks that they are up to date.
pub(crate) fn quick(check: bool) -> Result<(), Fault> {
    document("docs/scenes.md", scene::reference().as_bytes(), check)?;
    document("docs/faults.md", faults::page().as_bytes(), check)?;
    document(
        "docs/files.md",
        output(workspace_program("host-sim").arg("columns"))?.as_bytes(),
        check,
    )
}

/// Writes every generated document, or checks that they are up to date.
pub(crate) fn all(check: bool) -> Result<(), Fault> {
    of_boards(check)?;
    // The main job's page quotes what it measures over many runs.
    studies::page("decisions", check)?;
    of_runs(check)?;
    studies::page("report", check)
}

/// Checks that every generated document is up to date but the two pages of the studies, which
/// take longer than all others: those are only made, in short. The nightly run checks them.
pub(crate) fn short() -> Result<(), Fault> {
    of_boards(true)?;
    of_runs(true)?;
    studies::pages_in_short()
}

/// What follows from the source alone, from descriptions of chips, and from what boards cost.
fn of_boards(check: bool) -> Result<(), Fault> {
    quick(check)?;
    descriptions::page(check)?;
    asymmetry(check)?;
    // From the tables that `cargo xtask cost`, `cost --deadlines` and `size` write.
    cost::write_page(check)
}

/// What runs of the simulator and of the bench's program give.
fn of_runs(check: bool) -> Result<(), Fault> {
    // As the README has it.
    let said = output(&mut cargo(&["run", "--quiet", "-p", "host-sim"]))?;
    print!("{said}");
    let page = main_job::page(&said, &read(&top().join(DECISIONS))?)?;
    document("docs/textures.md", page.as_bytes(), check)?;
    for (made, name) in [
        ("textures.svg", "docs/textures.svg"),
        ("textures.model", "scenes/models/textures.model"),
    ] {
        let made = read_bytes(&top().join("out/textures").join(made))?;
        document(name, &made, check)?;
    }
    for scene in TRAINED {
        document(scene.model, &scene.train()?, check)?;
    }
    at_the_bench(check)
}

/// Draws what `whisker` shows and leaves at the bench, of the simulated module.
fn at_the_bench(check: bool) -> Result<(), Fault> {
    let folder = target().join("bench");
    let whisker = || workspace_program("whisker");
    let monitor = "monitor --sim scenes/textures.toml --frames 162 --size 110x36 --snapshot";
    let monitored = folder.join("monitor.svg");
    output(whisker().args(monitor.split(' ')).arg(&monitored))?;
    document("docs/monitor.svg", &read_bytes(&monitored)?, check)?;
    let calibrate = "calibrate --sim scenes/bench.toml --out";
    output(whisker().args(calibrate.split(' ')).arg(&folder))?;
    document(
        "docs/steps.svg",
        &read_bytes(&folder.join("steps.svg"))?,
        check,
    )?;
    let watched = "check --sim scenes/bench.toml --seconds 12 --out";
    output(whisker().args(watched.split(' ')).arg(&folder))?;
    document(
        "docs/check.svg",
        &read_bytes(&folder.join("check.svg"))?,
        check,
    )
}

/// Draws contact-induced asymmetry without CIA and with it, from the emulated board.
fn asymmetry(check: bool) -> Result<(), Fault> {
    let scenes = ["scenes/rcp.toml", "scenes/cia.toml"].map(|scene| top().join(scene));
    let drawn = target().join("picture/asymmetry.svg");
    emulate::picture(Board::named("nucleo-f446re")?, &scenes, &drawn)?;
    document("docs/asymmetry.svg", &read_bytes(&drawn)?, check)
}

/// A scene whose model is trained on a run of it with another seed, as its first lines say.
struct Trained {
    scene: &'static str,
    model: &'static str,
    /// How, unless by default.
    options: &'static [&'static str],
}

/// Those but the main job.
const TRAINED: [Trained; 5] = [
    Trained {
        scene: "scenes/whisker.toml",
        model: "scenes/models/whisker.model",
        options: &[],
    },
    Trained {
        scene: "scenes/both.toml",
        model: "scenes/models/both.model",
        options: &[],
    },
    Trained {
        scene: "scenes/unknown.toml",
        model: "scenes/models/unknown.model",
        options: &["--unknown", "carpet"],
    },
    Trained {
        scene: "scenes/tmag5170.toml",
        model: "scenes/models/tmag5170.model",
        options: &[],
    },
    Trained {
        scene: "scenes/papers.toml",
        model: "scenes/models/papers.model",
        options: &["--tables", "single"],
    },
];

impl Trained {
    /// The bytes of its model.
    fn train(&self) -> Result<Vec<u8>, Fault> {
        let folder = target().join("models");
        let (heard, model) = (folder.join("heard.csv"), folder.join("the.model"));
        let simulator = |command: &str| {
            let mut simulator = workspace_program("host-sim");
            simulator.args(["--quiet", command]);
            simulator
        };
        let record = ["--seed", "3", "--out"];
        output(simulator("record").arg(self.scene).args(record).arg(&heard))?;
        let mut train = simulator("train");
        train.arg("--data").arg(&heard).arg("--out").arg(&model);
        output(train.args(self.options))?;
        read_bytes(&model)
    }
}
