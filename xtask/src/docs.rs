//! Generated documents: written by commands, never by hand.

#[cfg(test)]
mod by_hand;
mod faults;
mod main_job;
mod whisk;

use crate::firmware::Board;
use crate::run::{
    AT_ONCE, Fault, cargo, document, each, output, read, read_bytes, target, top, workspace_program,
};
use crate::{cost, descriptions, emulate, studies};
use main_job::DECISIONS;

/// Writes the documents that follow from the source alone or from a run of seconds, or checks that
/// they are up to date.
pub(crate) fn quick(check: bool) -> Result<(), Fault> {
    document("docs/whisk.svg", whisk::picture()?.as_bytes(), check)?;
    document("docs/scenes.md", scene::reference().as_bytes(), check)?;
    document("docs/faults.md", faults::page().as_bytes(), check)?;
    let columns = output(workspace_program("host-sim").arg("columns"))?;
    document("docs/files.md", columns.as_bytes(), check)
}

pub(crate) fn all(check: bool) -> Result<(), Fault> {
    from_tables(check)?;
    asymmetry(check)?;
    // The main job's page quotes what it measures over many runs.
    studies::page("decisions", check)?;
    of_runs(check)?;
    studies::page("poses", check)?;
    studies::page("standing", check)?;
    studies::page("report", check)
}

/// Checks that generated documents are up to date: all but the picture that a board's program is
/// built for ([`asymmetry_is_current`]) and the pages of the studies, which take longer than
/// all others. Those are only made, in short, by the studies' tests; the nightly run checks them.
pub(crate) fn short() -> Result<(), Fault> {
    from_tables(true)?;
    of_runs(true)
}

/// What follows from the source alone, from descriptions of chips, and from what boards cost.
fn from_tables(check: bool) -> Result<(), Fault> {
    quick(check)?;
    descriptions::page(check)?;
    // From the tables that `cargo xtask cost`, `cost --deadlines` and `size` write.
    cost::write_page(check)
}

/// What runs of the simulator and of the bench's program give.
fn of_runs(check: bool) -> Result<(), Fault> {
    // As the README has it.
    let said = output(&mut cargo("run --quiet -p host-sim"))?;
    print!("{said}");
    let page = main_job::page(&said, &read(&top().join(DECISIONS))?)?;
    document("docs/textures.md", page.as_bytes(), check)?;
    for (made, name) in [
        ("bench-textures.svg", "docs/textures.svg"),
        ("bench-textures.model", "scenes/models/bench-textures.model"),
    ] {
        let made = read_bytes(&top().join("out/bench-textures").join(made))?;
        document(name, &made, check)?;
    }
    each(TRAINED.to_vec(), AT_ONCE, |(scene, recorded, options)| {
        let model = trained(scene, recorded, options)?;
        document(&format!("scenes/models/{scene}.model"), &model, check)
    })?;
    at_the_bench(check)
}

/// Draws what `whisker` shows and leaves at the bench, of the simulated module.
fn at_the_bench(check: bool) -> Result<(), Fault> {
    let folder = target().join("bench");
    let monitored = folder.join("monitor.svg");
    for (drawing, command, out) in [
        (
            "monitor.svg",
            "monitor --sim scenes/textures.toml --frames 162 --size 110x36 --snapshot",
            &monitored,
        ),
        (
            "steps.svg",
            "calibrate --sim scenes/bench.toml --out",
            &folder,
        ),
        (
            "check.svg",
            "check --sim scenes/bench.toml --seconds 12 --out",
            &folder,
        ),
    ] {
        let mut whisker = workspace_program("whisker");
        output(whisker.args(command.split(' ')).arg(out))?;
        let drawn = read_bytes(&folder.join(drawing))?;
        document(&format!("docs/{drawing}"), &drawn, check)?;
    }
    Ok(())
}

/// Draws contact-induced asymmetry without CIA and with it, from the emulated board.
fn asymmetry(check: bool) -> Result<(), Fault> {
    let scenes = ["scenes/rcp.toml", "scenes/cia.toml"].map(|scene| top().join(scene));
    let drawn = target().join("picture/asymmetry.svg");
    emulate::picture(Board::named("nucleo-f446re")?, &scenes, &drawn)?;
    document("docs/asymmetry.svg", &read_bytes(&drawn)?, check)
}

pub(crate) fn asymmetry_is_current() -> Result<(), Fault> {
    asymmetry(true)
}

/// The scenes whose models are trained on a run with another seed, as their first lines say, but
/// the main job's; with the options of that training.
const TRAINED: [(&str, &[&str], &[&str]); 8] = [
    ("textures", &[], &["--expect", "same"]),
    ("active", &LONGER, &["--expect", "same"]),
    ("full", &LONGER, &["--expect", "same"]),
    ("whisker", &[], &["--expect", "same"]),
    ("both", &[], &["--expect", "same"]),
    ("unknown", &[], &["--expect", "same", "--unknown", "carpet"]),
    ("tmag5170", &[], &["--expect", "same"]),
    ("papers", &[], &["--tables", "single"]),
];
/// What a scene of some seconds is recorded with: as long as the main job.
const LONGER: [&str; 2] = ["--set", "duration_s=40"];

fn trained(scene: &str, recorded: &[&str], options: &[&str]) -> Result<Vec<u8>, Fault> {
    let folder = target().join("models").join(scene);
    let (recording, model) = (folder.join("recording.csv"), folder.join("the.model"));
    let simulator = |command: &str| {
        let mut simulator = workspace_program("host-sim");
        simulator.args(["--quiet", command]);
        simulator
    };
    let mut record = simulator("record");
    record.arg(format!("scenes/{scene}.toml")).args(recorded);
    output(record.args(["--seed", "3", "--out"]).arg(&recording))?;
    let mut train = simulator("train");
    train.arg("--data").arg(&recording).arg("--out").arg(&model);
    output(train.args(options))?;
    read_bytes(&model)
}
