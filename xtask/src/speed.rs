//! The time that host-sim takes for a tick: scene `textures`, an elastic whisker in scene `whisker`
//! and in lasting contact with rough ground. Another checkout's may run beside it by turns, and the
//! environments of both wheels.
//!
//! The time is that of the processor in user mode for a whole run of the program,
//! which other programs disturb less than they do the clock on the wall. It holds
//! the start of the program, some milliseconds, and the writing of the trace.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use serde_json::Value;

use crate::emulate::variants;
use crate::python::Measured;
use crate::run::{Fault, absolute, cargo, output, run, target, top};

/// What runs, from the top of the workspace.
const SCENES: [&str; 3] = [
    "scenes/textures.toml",
    "scenes/whisker.toml",
    "xtask/src/speed/rough.toml",
];

/// What to measure.
#[derive(clap::Args)]
pub(crate) struct Choice {
    /// Another checkout of this project, whose host-sim runs its own scenes by turns with this
    /// tree's
    #[arg(long, value_name = "FOLDER")]
    vs: Option<PathBuf>,
    /// The wheels of both, too: 128 environments of scene `textures`
    #[arg(long, requires = "vs")]
    environments: bool,
    /// Runs of each program for each scene
    #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..=1000))]
    rounds: u32,
}

/// Builds host-sim for release and prints times a tick, and how many times as fast
/// as the other program it is.
pub(crate) fn speed(choice: &Choice) -> Result<(), Fault> {
    let own = Program::own()?;
    let of = |other: &PathBuf| Program::released(absolute(other)?, &built(other)?);
    let other = choice.vs.as_ref().map(of).transpose()?;
    println!(
        "µs a tick, least and median of {}: this tree{}",
        choice.rounds,
        other.as_ref().map_or("", |_| ", the other, times as fast")
    );
    for path in SCENES {
        let scene = variants::load(&top().join(path))?;
        let (mut ours, mut theirs) = (Vec::new(), Vec::new());
        for _ in 0..choice.rounds {
            if let Some(other) = &other {
                theirs.push(other.user_s(path)?);
            }
            ours.push(own.user_s(path)?);
        }
        let a_tick = 1e6 / scene.ticks() as f64;
        let ours = least_and_median(ours).map(|s| s * a_tick);
        print!("{:10} {}", scene.name, pair(ours));
        if other.is_some() {
            let theirs = least_and_median(theirs).map(|s| s * a_tick);
            let ratio = [0, 1].map(|i| theirs[i] / ours[i]);
            print!("  {}  {}", pair(theirs), pair(ratio));
        }
        println!();
    }
    match choice.vs.as_deref().filter(|_| choice.environments) {
        Some(other) => environments(other),
        None => Ok(()),
    }
}

/// Prints how many steps environments make in a second, and how many times as many as those of the
/// other checkout.
fn environments(other: &Path) -> Result<(), Fault> {
    /// Each is a median itself.
    const TURNS: usize = 3;
    let both = [Measured::of(other, &built(other)?)?, Measured::own()?];
    let mut found: [Vec<f64>; 2] = Default::default();
    for _ in 0..TURNS {
        for (measured, found) in both.iter().zip(&mut found) {
            let said: Value = serde_json::from_str(&measured.figures()?)
                .map_err(|error| format!("speeds.py: {error}"))?;
            let median = said.pointer("/env_steps_s/0").and_then(Value::as_f64);
            found.push(median.ok_or("speeds.py: no env_steps_s")?);
        }
    }
    let [theirs, ours] = found.map(|found| least_and_median(found)[1]);
    let times = ours / theirs;
    println!("128 environments, steps a second: {ours:.0}  {theirs:.0}  {times:.3}");
    Ok(())
}

/// The time that host-sim takes for a tick of a scene on the wall's clock, ns: the least of three
/// runs of so many ticks that the start of the program does not count.
pub(crate) fn ns_per_tick(scene: &Path) -> Result<u64, Fault> {
    let ticks = 100_000;
    let duration_s = f64::from(ticks) / f64::from(variants::load(scene)?.tick_hz);
    let long = variants::with(scene, &[format!("duration_s={duration_s:?}")])?;
    let program = Program::own()?.path;
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

/// A host-sim, and the tree whose scenes it runs.
struct Program {
    path: PathBuf,
    tree: PathBuf,
}

/// Where another checkout is built.
fn built(other: &Path) -> Result<PathBuf, Fault> {
    let other = absolute(other)?;
    let name = other.file_name().unwrap_or_default();
    // Cargo runs there, not here.
    absolute(&target().join("other").join(name))
}

impl Program {
    fn own() -> Result<Self, Fault> {
        Self::released(top(), &absolute(&target())?)
    }

    fn released(tree: PathBuf, built: &Path) -> Result<Self, Fault> {
        let mut build = cargo("build --release --locked --quiet -p host-sim");
        run(build.current_dir(&tree).env("CARGO_TARGET_DIR", built))?;
        let path = built.join("release/host-sim");
        Ok(Self { path, tree })
    }

    fn user_s(&self, scene: &str) -> Result<f64, Fault> {
        let mut command = Command::new("sh");
        command
            .args(["-c", r#""$0" "$@" > /dev/null && times"#])
            .arg(&self.path)
            .args(["run", "--quiet", scene, "--out"])
            .arg(target().join("speed"))
            .current_dir(&self.tree);
        let text = output(&mut command)?;
        children_s(&text).ok_or_else(|| format!("times printed {text:?}"))
    }
}

fn pair([least, median]: [f64; 2]) -> String {
    format!("{least:6.3} {median:6.3}")
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
