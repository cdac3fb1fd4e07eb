//! The campaign of injected faults: on the PC, and as every board's own programs.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;
use scene::{Scene, SensorModel};

use crate::emulate::{self, variants};
use crate::firmware::{self, Board};
use crate::run::{
    Fault, emulator, listing, read, read_bytes, remove, run, run_at_once, target, top, write,
};

const PC: &str = "host-sim";
/// What they call a run that flips a bit of a word of RAM, of which every word has one.
const WORDS: &str = "nucleo-f446re-words";
/// How many runs make a campaign, beside those of words.
const RUNS: u64 = 10_000;
/// Of so many runs, one is on each board; the others are on the PC, where they take a
/// hundredth of the time.
const A_BOARD_S: u64 = 400;

/// Which runs are made.
#[derive(Args)]
pub(crate) struct Choice {
    /// How many runs in all, beside one for every word of RAM
    #[arg(long, default_value_t = RUNS)]
    runs: u64,
    /// Where they run: host-sim, the name of a board, or nucleo-f446re-words for one run
    /// for every word of RAM; none: everywhere
    #[arg(long)]
    subject: Option<String>,
    /// One run again, by its number, printed as a row; needs --subject
    #[arg(long, value_name = "RUN", requires = "subject")]
    again: Option<u64>,
    /// How many shards run at once
    #[arg(long, default_value_t = 2)]
    shards: u64,
    /// Go on with the tables that are there; refused where the boards' programs have changed
    #[arg(long)]
    resume: bool,
}

/// Scenes, and the programs that were built for them; none: on the PC.
#[derive(Default)]
struct Subject {
    name: &'static str,
    scenes: Vec<PathBuf>,
    programs: Vec<PathBuf>,
    /// How many runs; none: one for every word of RAM.
    runs: Option<u64>,
}

/// Of a scene with real motors, other ways of its motors, each with a name of its own.
const MOTORS: [(&str, &str); 4] = [
    ("homing", "motor.rest=find"),
    ("on-command", "motor.arm=on-command"),
    ("stop-all", "motor.on_fault=stop-all"),
    ("six-step", "motor.driver=six-step"),
];

fn other_motors() -> Result<Vec<PathBuf>, Fault> {
    let named = |name| format!("name={name}");
    let other = |(name, key): (_, &str)| variants::with(emulate::WORLD, &[&*named(name), key]);
    MOTORS.into_iter().map(other).collect()
}

fn has_mlx90333(scene: &PathBuf) -> bool {
    let scene = Scene::load(scene);
    scene.is_ok_and(|scene| scene.sensor.model == SensorModel::Mlx90333)
}

impl Subject {
    fn of(name: &str, runs: u64) -> Result<Self, Fault> {
        // What is injected befalls an MLX90333.
        let scenes = listing(&top().join("scenes"), "toml")?.into_iter();
        let scenes = scenes.filter(has_mlx90333).chain(other_motors()?);
        let scenes: Vec<PathBuf> = scenes.collect();
        match name {
            PC => Ok(Self {
                name: PC,
                scenes,
                runs: Some(runs),
                ..Self::default()
            }),
            WORDS => Ok(Self {
                name: WORDS,
                runs: None,
                ..Self::on(Board::ALL[0], &[top().join(emulate::FULL)], runs)?
            }),
            _ => Self::on(Board::named(name)?, &scenes, runs),
        }
    }

    /// On a board, those of `scenes` that it takes; of several whiskers a side the first.
    fn on(board: Board, scenes: &[PathBuf], runs: u64) -> Result<Self, Fault> {
        let folder = folder().join(board.name);
        let mut subject = Self {
            name: board.name,
            runs: Some(runs),
            ..Self::default()
        };
        for scene in scenes {
            let scene = variants::single(scene)?;
            if let Ok(built) = firmware::try_build(board, &scene)? {
                let name = scene.file_stem().unwrap_or_default();
                let kept = folder.join(name).with_extension("elf");
                let built = read_bytes(&built)?;
                if kept.exists() && read_bytes(&kept)? != built {
                    return Err(format!(
                        "{}: the program of {} is not that of the tables; begin again without \
                         --resume",
                        board.name,
                        scene.display()
                    ));
                }
                // The next build takes the place of the last.
                write(&kept, built)?;
                subject.scenes.push(scene);
                subject.programs.push(kept);
            }
        }
        Ok(subject)
    }

    /// The command that makes so many runs from `first` on, of which a shard.
    fn command(
        &self,
        first: u64,
        runs: Option<u64>,
        [shard, shards]: [u64; 2],
        out: &Path,
    ) -> Command {
        let mut command = emulator("campaign");
        command.args(&self.scenes);
        for program in &self.programs {
            command.arg("--program").arg(program);
        }
        for (option, value) in [("--first", first), ("--shard", shard), ("--shards", shards)] {
            command.args([option, &value.to_string()]);
        }
        if let Some(runs) = runs {
            command.args(["--runs", &runs.to_string()]);
        }
        if self.runs.is_none() {
            command.arg("--words");
        }
        command.args(["--subject", self.name]).arg("--out").arg(out);
        command
    }

    fn run(&self, shards: u64) -> Result<Vec<PathBuf>, Fault> {
        let as_words = || "as many runs as words".to_owned();
        let runs = self.runs.map_or_else(as_words, |runs| runs.to_string());
        println!("{}: {runs} in {} scenes", self.name, self.scenes.len());
        let table = |shard| folder().join(format!("{}-{shard}.csv", self.name));
        let tables: Vec<PathBuf> = (0..shards).map(table).collect();
        let commands = (0..shards).zip(&tables);
        let commands =
            commands.map(|(shard, out)| self.command(0, self.runs, [shard, shards], out));
        run_at_once(commands.collect(), tables.len())?;
        Ok(tables)
    }
}

fn folder() -> PathBuf {
    target().join("faults")
}

/// The campaign, or what `choice` leaves of it; writes docs/measured/reliability.md where
/// nothing is left out.
pub(crate) fn all(choice: &Choice) -> Result<(), Fault> {
    if let (Some(name), Some(number)) = (&choice.subject, choice.again) {
        return again(name, number);
    }
    let on_a_board = choice.runs / A_BOARD_S;
    let boards = Board::ALL.map(|board| (board.name, on_a_board));
    let on_pc = choice.runs - on_a_board * boards.len() as u64;
    let wanted = match choice.subject.as_deref() {
        Some(name @ (PC | WORDS)) => vec![(name, choice.runs)],
        Some(name) => vec![(Board::named(name)?.name, choice.runs)],
        None => [&[(PC, on_pc), (WORDS, 0)], &boards[..]].concat(),
    };
    if !choice.resume {
        remove(&folder())?;
    }
    let mut tables = Vec::new();
    for (name, runs) in wanted {
        tables.extend(Subject::of(name, runs)?.run(choice.shards.max(1))?);
    }
    let page = top().join("docs/measured/reliability.md");
    summed_up(&tables, choice.subject.is_none().then_some(page.as_path()))
}

/// The whole campaign, as the command without options makes it.
pub(crate) fn whole() -> Result<(), Fault> {
    all(&Choice {
        runs: RUNS,
        subject: None,
        again: None,
        shards: 2,
        resume: false,
    })
}

fn again(name: &str, number: u64) -> Result<(), Fault> {
    let out = folder().join("again.csv");
    if out.exists() {
        fs::remove_file(&out).map_err(|error| error.to_string())?;
    }
    run(&mut Subject::of(name, 1)?.command(number, Some(1), [0, 1], &out))?;
    print!("{}", read(&out)?);
    Ok(())
}

fn summed_up(tables: &[PathBuf], page: Option<&Path>) -> Result<(), Fault> {
    let mut command = emulator("reliability");
    command.args(tables);
    if let Some(page) = page {
        command.arg("--out").arg(page);
    }
    run(&mut command)
}

/// The short form of CI: some runs on the PC, and a few as the program of a board.
pub(crate) fn short() -> Result<(), Fault> {
    remove(&folder())?;
    let mut tables = Subject::of(PC, 500)?.run(2)?;
    let one = [top().join(emulate::FULL)];
    tables.extend(Subject::on(Board::ALL[0], &one, 10)?.run(2)?);
    summed_up(&tables, None)
}
