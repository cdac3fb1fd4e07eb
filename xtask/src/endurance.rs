//! Scenes for hours: a week on the PC, and a day as the boards' own programs with every
//! counter started just below its wrap, in shards.

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;

use crate::emulate::{self, variants};
use crate::firmware::{self, Board};
use crate::run::{
    Fault, built, cargo, emulator, listing, read_bytes, remove, run, run_at_once, target, top,
    write,
};

/// The longest shard, h: on the PC six hours; on a board six minutes, which take about as
/// long as the others.
const SHARD_H: [f64; 2] = [6.0, 0.1];
const PAGE: &str = "docs/measured/endurance.md";

/// How many shards run at once in CI and at night.
const AT_ONCE: NonZero<usize> = NonZero::<usize>::MIN.saturating_add(1);

/// How much is run.
#[derive(Args)]
pub(crate) struct Choice {
    /// Simulated hours on the PC, of all scenes together
    #[arg(long, default_value_t = 168.0)]
    hours: f64,
    /// Simulated hours on the emulated boards, of all of them together
    #[arg(long, default_value_t = 24.0)]
    board_hours: f64,
    /// How many shards run at once
    #[arg(long, default_value = "2")]
    shards: NonZero<usize>,
    /// Keep the shards that are there
    #[arg(long)]
    resume: bool,
}

struct Shard {
    scene: PathBuf,
    seed: u32,
    hours: f64,
    board: Option<(Board, PathBuf)>,
}

fn folder() -> PathBuf {
    target().join("endurance")
}

/// How many shards of the same length `hours` are cut into, at least `least` where there are
/// any, and how long each is.
fn cut(hours: f64, longest: f64, least: usize) -> (usize, f64) {
    if hours <= 0.0 {
        return (0, 0.0);
    }
    let count = ((hours / longest).ceil() as usize).max(least);
    (count, hours / count.max(1) as f64)
}

impl Shard {
    fn file(&self) -> PathBuf {
        let board = self.board.as_ref();
        let subject = board.map_or("host-sim", |(board, _)| board.name);
        let scene = self.scene.file_stem().unwrap_or_default().to_string_lossy();
        let (seed, hours) = (self.seed, self.hours);
        folder().join(format!("{subject}-{scene}-{seed}-{hours:.4}h.csv"))
    }

    fn command(&self) -> Command {
        let mut command = emulator("endure");
        command.arg(&self.scene);
        match &self.board {
            Some((board, program)) => command
                .args(["--subject", board.name, "--program"])
                .arg(program),
            None => command.args(["--seed", &self.seed.to_string()]),
        };
        command.args(["--hours", &self.hours.to_string()]);
        command.arg("--out").arg(self.file());
        command
    }
}

fn on_pc(scenes: &[PathBuf], hours: f64) -> Vec<Shard> {
    let (count, hours) = cut(hours, SHARD_H[0], scenes.len());
    let shard = |(n, scene): (usize, &PathBuf)| Shard {
        scene: scene.clone(),
        seed: 1 + (n / scenes.len()) as u32,
        hours,
        board: None,
    };
    let scenes_again = scenes.iter().cycle().take(count);
    scenes_again.enumerate().map(shard).collect()
}

/// Whether every counter counts in a scene: whiskers move, and decide by touches.
fn counts_all(scene: &Path) -> Result<bool, Fault> {
    let scene = variants::load(scene)?;
    Ok(scene.motor.is_some() && scene.classifier.is_some() && scene.plant.obstacle.is_some())
}

/// Shards of those of `scenes` that the boards take and that [`counts_all`], with their
/// programs, which are built now.
fn on_boards(boards: &[Board], scenes: &[PathBuf], hours: f64) -> Result<Vec<Shard>, Fault> {
    let mut taken = Vec::new();
    let wanted = if hours > 0.0 { scenes } else { &[] };
    for scene in wanted {
        for &board in boards {
            let scene = variants::single(scene)?;
            if counts_all(&scene)? && firmware::try_build(board, &scene)?.is_ok() {
                taken.push((board, scene));
            }
        }
    }
    let (count, hours) = cut(hours, SHARD_H[1], taken.len());
    let mut shards = Vec::new();
    for (n, (board, scene)) in taken.iter().cycle().take(count).enumerate() {
        let seed = 1 + (n / taken.len()) as u32;
        let scene = variants::with(scene, &[format!("seed={seed}")])?;
        let stem = scene.file_stem().unwrap_or_default().display();
        let program = folder().join(format!("{}-{stem}.elf", board.name));
        let shard = Shard {
            scene: scene.clone(),
            seed,
            hours,
            board: Some((*board, program.clone())),
        };
        if !shard.file().exists() {
            write(&program, read_bytes(&firmware::build(*board, &scene)?)?)?;
        }
        shards.push(shard);
    }
    Ok(shards)
}

/// Runs those shards that have left no row yet, so many at once.
fn run_all(shards: &[Shard], at_once: NonZero<usize>) -> Result<(), Fault> {
    // Built once, before they all want to.
    if built("emulator").is_none() {
        run(&mut cargo("build --quiet -p emulator"))?;
    }
    let left = shards.iter().filter(|shard| !shard.file().exists());
    run_at_once(left.map(Shard::command).collect(), at_once.get())
}

/// All hours of `choice`, and docs/measured/endurance.md from them.
pub(crate) fn all(choice: &Choice) -> Result<(), Fault> {
    let shards = made(
        [choice.hours, choice.board_hours],
        None,
        choice.shards,
        choice.resume,
    )?;
    let mut page = emulator("endurance");
    page.args(shards.iter().map(Shard::file));
    run(page.arg("--out").arg(top().join(PAGE)))
}

/// Runs shards of so many hours on the PC and on boards: all, or of one scene on the first.
fn made(
    [on_the_pc, on_the_boards]: [f64; 2],
    alone: Option<&str>,
    at_once: NonZero<usize>,
    keeps: bool,
) -> Result<Vec<Shard>, Fault> {
    if !keeps {
        remove(&folder())?;
    }
    let scenes = listing(&top().join("scenes"), "toml")?;
    let mut shards = on_pc(&scenes, on_the_pc);
    shards.extend(match alone {
        Some(scene) => on_boards(&Board::ALL[..1], &[top().join(scene)], on_the_boards)?,
        None => on_boards(&Board::ALL, &scenes, on_the_boards)?,
    });
    run_all(&shards, at_once)?;
    Ok(shards)
}

/// The form of the night: the week on the PC, and an hour on the boards, where a day takes
/// more than one.
pub(crate) fn nightly() -> Result<(), Fault> {
    made([168.0, 1.0], None, AT_ONCE, false).map(drop)
}

/// The short form of CI: minutes of every scene on the PC, and the wraps of all counters on
/// one board.
pub(crate) fn short() -> Result<(), Fault> {
    made(SHORT_H, Some(emulate::FULL), AT_ONCE, false).map(drop)
}

/// Hours of the short form, on the PC and on the board, where touches are reported after a second
/// and the fourth wraps.
const SHORT_H: [f64; 2] = [0.65, 0.0015];
