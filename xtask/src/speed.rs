//! The time that host-sim takes for a tick: scene `textures`, an elastic whisker in scene `whisker`
//! and in lasting contact with rough ground. Another host-sim may run beside it, and another wheel,
//! whose environments are measured.
//!
//! The time is that of the processor in user mode for a whole run of the program,
//! which other programs disturb less than they do the clock on the wall. It holds
//! the start of the program, some milliseconds, and the writing of the trace.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use scene::Scene;

use crate::emulate::variants;
use crate::python;
use crate::run::{Fault, cargo, output, run, target, top};

/// What runs, from the top of the workspace.
const SCENES: [&str; 3] = [
    "scenes/textures.toml",
    "scenes/whisker.toml",
    "xtask/src/speed/rough.toml",
];

/// What to measure.
#[derive(clap::Args)]
pub(crate) struct Choice {
    /// Another host-sim, run by turns with this tree's
    #[arg(long, value_name = "PROGRAM")]
    vs: Option<PathBuf>,
    /// Another wheel, whose 128 environments run by turns with this tree's
    #[arg(long, value_name = "WHEEL")]
    vs_wheel: Option<PathBuf>,
    /// Runs of each program for each scene
    #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..=1000))]
    rounds: u32,
}

/// Builds host-sim for release and prints times a tick, and how many times as fast
/// as the other program it is.
pub(crate) fn speed(choice: &Choice) -> Result<(), Fault> {
    let own = released()?;
    println!(
        "µs a tick, least and median of {}: this tree{}",
        choice.rounds,
        if choice.vs.is_some() {
            ", the other, times as fast"
        } else {
            ""
        }
    );
    for path in SCENES {
        let scene = Scene::load(top().join(path)).map_err(|error| error.to_string())?;
        let (mut ours, mut theirs) = (Vec::new(), Vec::new());
        for _ in 0..choice.rounds {
            if let Some(other) = &choice.vs {
                theirs.push(user_s(other, Path::new(path))?);
            }
            ours.push(user_s(&own, Path::new(path))?);
        }
        let a_tick = 1e6 / scene.ticks() as f64;
        let ours = least_and_median(ours).map(|s| s * a_tick);
        print!("{:10} {}", scene.name, pair(ours));
        if choice.vs.is_some() {
            let theirs = least_and_median(theirs).map(|s| s * a_tick);
            let ratio = [0, 1].map(|i| theirs[i] / ours[i]);
            print!("  {}  {}", pair(theirs), pair(ratio));
        }
        println!();
    }
    choice
        .vs_wheel
        .as_deref()
        .map_or(Ok(()), |other| environments(other, choice.rounds))
}

/// Prints how many steps environments make in a second, and how many times as many as those of the
/// other wheel.
fn environments(other: &Path, rounds: u32) -> Result<(), Fault> {
    let ours = python::with_environments(&python::release()?, "speeds")?;
    let theirs = python::with_environments(other, "speeds-other")?;
    let mut pairs = Vec::new();
    for _ in 0..rounds {
        let of = |inside| python::steps_a_second(inside);
        pairs.push([of(&ours)?, of(&theirs)?]);
    }
    let [ours, theirs] =
        [0, 1].map(|of| least_and_median(pairs.iter().map(|pair| pair[of]).collect())[1]);
    println!(
        "128 environments, steps a second, median of {rounds}: {ours:.0}  {theirs:.0}  {:.3}",
        ours / theirs
    );
    Ok(())
}

/// The time that host-sim takes for a tick of a scene on the wall's clock, ns: the least of three
/// runs of so many ticks that the start of the program does not count.
pub(crate) fn ns_per_tick(scene: &Path) -> Result<u64, Fault> {
    let ticks = 100_000;
    let (program, long) = (released()?, variants::with_ticks(scene, ticks)?);
    let mut least = f64::INFINITY;
    for _ in 0..3 {
        let begun = Instant::now();
        let mut run = Command::new(&program);
        run.args(["run", "--quiet"]).arg(&long).arg("--out");
        output(run.arg(target().join("speed")).current_dir(top()))?;
        least = least.min(begun.elapsed().as_secs_f64());
    }
    Ok((1e9 * least / f64::from(ticks)) as u64)
}

fn released() -> Result<PathBuf, Fault> {
    let build = ["build", "--release", "--locked", "--quiet"];
    run(cargo(&build).args(["-p", "host-sim"]))?;
    Ok(target().join("release/host-sim"))
}

fn pair([least, median]: [f64; 2]) -> String {
    format!("{least:6.3} {median:6.3}")
}

fn user_s(program: &Path, scene: &Path) -> Result<f64, Fault> {
    let out = target().join("speed");
    let mut command = Command::new("sh");
    command
        .args(["-c", r#""$0" "$@" > /dev/null && times"#])
        .arg(std::path::absolute(program).map_err(|error| error.to_string())?)
        .args(["run", "--quiet"])
        .arg(scene)
        .arg("--out")
        .arg(out)
        .current_dir(top());
    let text = output(&mut command)?;
    children_s(&text).ok_or_else(|| format!("times printed {text:?}"))
}

/// User time of its children in what the shell's `times` prints, s: minutes and
/// seconds in the second line.
fn children_s(text: &str) -> Option<f64> {
    let user = text.lines().nth(1)?.split_whitespace().next()?;
    let (minutes, seconds) = user.strip_suffix('s')?.split_once('m')?;
    Some(60.0 * minutes.parse::<f64>().ok()? + seconds.parse::<f64>().ok()?)
}

/// Of a list that is not empty.
fn least_and_median(mut list: Vec<f64>) -> [f64; 2] {
    list.sort_by(f64::total_cmp);
    [0, list.len() / 2].map(|at| list.get(at).copied().unwrap_or(f64::NAN))
}
