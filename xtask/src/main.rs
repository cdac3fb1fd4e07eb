//! Everything CI does, by name: `cargo xtask ci`, `firmware`, `docs`.

/// As those of std, but that standard output that takes no line, as on a full disk, is no panic.
macro_rules! print {
    ($($text:tt)*) => { $crate::run::say(format_args!($($text)*)) };
}
macro_rules! println {
    () => { print!("\n") };
    ($($text:tt)*) => { $crate::run::say(format_args!("{}\n", format_args!($($text)*))) };
}

#[cfg(test)]
mod arrows;
mod book;
mod ci;
mod cost;
mod count;
mod dependencies;
mod descriptions;
mod desk;
mod dist;
mod docs;
mod elf;
mod emulate;
mod endurance;
mod faults;
mod figures;
mod firmware;
mod fuzz;
mod mount;
mod mutants;
mod nightly;
mod page;
mod panics;
mod python;
mod reproducible;
mod run;
mod scenarios;
mod size;
mod speed;
mod steps;
mod studies;
mod traces;
#[cfg(test)]
mod united;
mod walk;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

#[derive(Parser)]
#[command(about = "Everything CI does, by name")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// All that CI checks: format, lints, all tests, the main job and the
    /// generated documents, firmware, and short forms of the long runs
    Ci(Only),
    /// The long runs in full: every scene on every board, every count, experiments,
    /// mutations (takes hours)
    Nightly(Only),
    /// Builds the page for a browser into target/page/whisker.html
    Page {
        /// Also uses it in headless Chromium as a person would
        #[arg(long)]
        test: bool,
    },
    /// Builds the Python module and tests it in clean environments of the oldest and the newest
    /// Python of this machine
    Python,
    /// Measures the Python module and the page, and writes docs/measured/desk.md and docs/page.png
    Desk,
    /// Builds the firmware of a scene and prints its flash and RAM bytes
    Firmware {
        #[command(flatten)]
        build: Build,
        /// Instead: the program that takes any scene, and brings none with it
        #[arg(long, conflicts_with = "scene")]
        any_scene: bool,
    },
    /// Builds the firmware of a scene, flashes it onto a NUCLEO-F446RE and shows its log (needs
    /// probe-rs)
    Nucleo {
        /// The scene
        #[arg(long, default_value = "scenes/textures.toml")]
        scene: PathBuf,
    },
    /// Builds the firmware of a scene and runs it on an emulated board: writes
    /// DIR/trace.csv, DIR/log.txt, and DIR/decisions.csv where the scene classifies
    Emulate(Emulate),
    /// Injects faults at random into every scene, on the PC and on the emulated boards, and
    /// writes docs/measured/reliability.md; fails if one was harmful
    Faults(faults::Choice),
    /// Runs scenes for hours: a week on the PC, and a day as the boards' own programs with every
    /// counter started just below its wrap; writes docs/measured/endurance.md
    Endurance(endurance::Choice),
    /// Draws what both sides do in scenes with obstacles, on an emulated NUCLEO-F446RE
    Picture {
        /// The scenes, from above
        #[arg(required = true)]
        scenes: Vec<PathBuf>,
        /// The SVG file to write
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
    },
    /// Counts the instructions of every kernel on emulated processors and writes
    /// docs/measured/instructions.csv
    Count(OfTable),
    /// Says what each stage of a tick costs, beside its goal and what others take
    /// (from docs/measured/instructions.csv and the emulated board); writes docs/measured/cost.csv and
    /// docs/measured/cost.md
    Cost {
        #[command(flatten)]
        table: OfTable,
        /// Instead: measure ten minutes of the noisiest scene (docs/measured/deadlines.csv)
        #[arg(long, conflicts_with_all = ["csv", "check"])]
        deadlines: bool,
    },
    /// Builds the firmware of every scene for every board that takes it, and prints flash, static
    /// RAM, stack, and the time that host-sim takes; writes docs/measured/sizes.csv
    Size(OfTable),
    /// Shows from the binaries that no panic can be reached: from the interrupts of the
    /// tick none at all, from the start and idle none but the logger's own check
    Panics {
        /// The scenes; without any, every scene
        scenes: Vec<PathBuf>,
        /// The board; without one, every board
        #[arg(long, value_parser = firmware::Board::named)]
        board: Option<firmware::Board>,
    },
    /// Feeds the readers of untrusted data with what libFuzzer finds (needs a C++ compiler)
    Fuzz {
        /// The targets; without any, every one
        targets: Vec<String>,
        /// For how long, each
        #[arg(long, default_value_t = 1.0)]
        minutes: f64,
        /// Write docs/measured/fuzz.md
        #[arg(long, conflicts_with = "targets")]
        page: bool,
    },
    /// Makes each of the mistakes in xtask/mutants.toml in a copy of the tree, and fails unless its
    /// test does
    Mutants,
    /// Builds the firmware of a scene twice, from nothing and in folders of other names, and
    /// compares every byte
    Reproducible(Build),
    /// Measures the time that host-sim takes for a tick of an elastic whisker, free
    /// and in lasting contact, beside another host-sim if there is one
    Speed(speed::Choice),
    /// Writes docs/registers.md, and holds its facts against the descriptions that others
    /// have made of the chips
    Descriptions,
    /// Builds a release into target/dist: programs, images of the boards, wheel, page, book, parts to
    /// print, checksums
    Dist(dist::Choice),
    /// Writes what of a whisker can be printed into target/mount, as STL
    Mount,
    /// Builds the book into target/book, unless a link or an image is broken
    Book,
    /// Runs the command blocks of the book's pages, of the README and of CONTRIBUTING
    Walk(walk::Choice),
    /// Writes the generated documents again
    Docs {
        /// Only say whether they are up to date
        #[arg(long)]
        check: bool,
        /// Only the quick ones: of keys, of faults, of columns, the moving picture
        #[arg(long)]
        quick: bool,
    },
}

#[derive(clap::Args)]
struct Only {
    /// Only the steps with one of these in their name
    steps: Vec<String>,
}

#[derive(clap::Args)]
struct OfTable {
    /// The table to write or to check; - prints it alone
    #[arg(long)]
    csv: Option<PathBuf>,
    /// Measure everything again and only say what has become dearer or has grown
    #[arg(long)]
    check: bool,
}

#[derive(clap::Args)]
struct Build {
    /// The scene to build; the default is the main job's
    #[arg(long, default_value = "scenes/textures.toml")]
    scene: PathBuf,
    /// The board to build for
    #[arg(long, default_value = "nucleo-f446re", value_parser = firmware::Board::named)]
    board: firmware::Board,
}

#[derive(clap::Args)]
struct Emulate {
    /// The scene to run
    #[arg(required_unless_present = "all")]
    scene: Option<PathBuf>,
    /// The board to build for
    #[arg(long, default_value = "nucleo-f446re", value_parser = firmware::Board::named)]
    board: firmware::Board,
    /// Deploy the scene to the program that takes any, in place of one with the scene linked
    #[arg(long)]
    any_scene: bool,
    #[command(flatten)]
    what: EmulateWhat,
    /// Where --scenario writes what became of it
    #[arg(long, value_name = "FILE", requires = "scenario")]
    json: Option<PathBuf>,
    /// The scene in whose world --scenario runs; none: its own, with a simulated motor
    #[arg(long, value_name = "SCENE", requires = "scenario")]
    world: Option<PathBuf>,
    /// A key of the scene with another value, such as motor.arm=on-command
    #[arg(long, value_name = "KEY=VALUE", requires = "scene")]
    set: Vec<String>,
    /// Who fetches the log meanwhile
    #[arg(
        long,
        requires = "check",
        conflicts_with = "all",
        default_value = "attached"
    )]
    #[arg(value_parser = ["attached", "absent", "pulled"])]
    probe: String,
    /// Compare every scene in scenes/
    #[arg(long, requires = "check", conflicts_with = "scene")]
    all: bool,
    /// Over how many minutes of simulated time
    #[arg(long, requires = "deadlines", default_value_t = 10.0)]
    minutes: f64,
    /// By how many millionths the crystals of boards are faster and, of every other one, slower
    #[arg(long, requires = "head", default_value_t = 0)]
    ppm: u16,
    /// How often under each flood
    #[arg(long, requires = "stopping", default_value_t = 100)]
    stops: u32,
}

/// One of them is done; only the first writes files. Each other is a scenario of the emulator
/// of the same name.
#[derive(clap::Args)]
#[group(required = true, multiple = false)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "each is a switch of the command line"
)]
struct EmulateWhat {
    /// Write the files of a run there
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Run the scene against what befalls it, a list of events in this file
    #[arg(long, value_name = "FILE", requires = "json")]
    scenario: Option<PathBuf>,
    /// Compare every tick with host-sim
    #[arg(long)]
    check: bool,
    /// Measure latency and length of the ticks
    #[arg(long)]
    deadlines: bool,
    /// Make ticks too long on purpose and see the deadline counter and the watchdog act
    #[arg(long)]
    overload: bool,
    /// Break the sensors' wires, side by side, and see the motors of those sides switched off
    #[arg(long)]
    sensor_loss: bool,
    /// Measure how long contact on one side takes to excite the other
    #[arg(long)]
    latency: bool,
    /// Reset the chip in every way that was not asked for, and see its motors off until the
    /// user button is pressed
    #[arg(long)]
    starting: bool,
    /// Let the supply dip and the clock stop, and see the motor pins low in time and the next
    /// start say why
    #[arg(long)]
    supply: bool,
    /// Flip bits in the settings and in the model, and see the motors off and the log say so
    #[arg(long)]
    damage: bool,
    /// Deploy scenes and models to one that names none, right ones and wrong, and see these refused
    #[arg(long)]
    deploying: bool,
    /// Have a PC ask for records and carry out commands, and see what that costs
    #[arg(long)]
    telemetry: bool,
    /// Talk with the board over its serial line: lines, records, commands and garbage
    #[arg(long)]
    serial: bool,
    /// Run as many boards as the scene's head has, joined by their bus, and compare every tick with
    /// the simulated head
    #[arg(long)]
    head: bool,
    /// Talk with the last board of the scene's head by way of the first
    #[arg(long, requires = "any_scene")]
    relay: bool,
    /// Stop motors by every way while the links are flooded, and see each stop obeyed and answered
    #[arg(long)]
    stopping: bool,
}

impl Emulate {
    /// Refuses what would have no effect: clap asks for no option that one which is there excludes.
    fn check(&self) -> Result<(), run::Fault> {
        let what = &self.what;
        let given = [
            (
                self.json.is_some() || self.world.is_some(),
                what.scenario.is_some(),
                "--scenario",
            ),
            (self.all || self.probe != "attached", what.check, "--check"),
            (self.minutes != 10.0, what.deadlines, "--deadlines"),
            (self.ppm != 0, what.head, "--head"),
            (self.stops != 100, what.stopping, "--stopping"),
        ];
        match given
            .into_iter()
            .find(|(is_given, is_of_use, _)| *is_given && !is_of_use)
        {
            Some((.., of)) => Err(format!("an option is given that is of use with {of} alone")),
            None => Ok(()),
        }
    }

    fn run(self) -> Result<(), run::Fault> {
        self.check()?;
        let on = if self.any_scene {
            emulate::Emulated::deployed(self.board)?
        } else {
            emulate::Emulated::linked(self.board)
        };
        let Some(scene) = self.scene else {
            return emulate::compare_all(&on);
        };
        let scene = emulate::variants::with(scene, &self.set)?;
        let what = self.what;
        if let (Some(scenario), Some(json)) = (&what.scenario, &self.json) {
            return emulate::tried(&on, &scene, scenario, self.world.as_deref(), json);
        }
        if let Some(out) = what.out {
            return emulate::files(&on, &scene, &out);
        }
        let compare = format!("compare --probe {}", self.probe);
        let deadlines = format!("deadlines --minutes {}", self.minutes);
        let head = format!("head --ppm {}", self.ppm);
        let stopping = format!("stopping --stops {}", self.stops);
        let scenarios = [
            (what.check, &*compare),
            (what.deadlines, &*deadlines),
            (what.head, &*head),
            (what.relay, "relay"),
            (what.overload, "overload"),
            (what.sensor_loss, "sensor-loss"),
            (what.latency, "latency"),
            (what.starting, "starting"),
            (what.supply, "supply"),
            (what.damage, "damage"),
            (what.deploying, "deploying"),
            (what.telemetry, "telemetry"),
            (what.serial, "serial"),
            (what.stopping, &*stopping),
        ];
        let wanted = scenarios.into_iter().filter(|(is_wanted, _)| *is_wanted);
        let names: Vec<&str> = wanted.map(|(_, name)| name).collect();
        on.run(scene, &names)
    }
}

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::Ci(Only { steps }) => ci::all(steps),
        Command::Nightly(Only { steps }) => nightly::all(steps),
        Command::Page { test: false } => page::build(),
        Command::Page { test: true } => page::build()
            .and_then(|()| page::test())
            .and_then(|()| page::count_frames(None)),
        Command::Python => python::test(),
        Command::Desk => desk::measure(),
        Command::Firmware {
            build: Build { board, .. },
            any_scene: true,
        } => firmware::build_any_scene(board)
            .and_then(|elf| size::print(board, size::ANY_SCENE, &elf)),
        Command::Firmware { build, .. } => firmware::build(build.board, &build.scene)
            .and_then(|elf| size::print(build.board, &build.scene.display().to_string(), &elf)),
        Command::Nucleo { scene } => {
            firmware::build(firmware::Board::ALL[0], &scene).and_then(|elf| firmware::flash(&elf))
        }
        Command::Emulate(emulate) => emulate.run(),
        Command::Faults(choice) => faults::all(&choice),
        Command::Endurance(choice) => endurance::all(&choice),
        Command::Picture { scenes, out } => firmware::Board::named("nucleo-f446re")
            .and_then(|board| emulate::picture(board, &scenes, &out)),
        Command::Cost {
            deadlines: true, ..
        } => cost::deadlines(),
        Command::Cost { table, .. } => cost::all(table.csv.as_deref(), table.check),
        Command::Count(table) => count::all(table.csv.as_deref(), table.check),
        Command::Size(table) => size::all(table.csv.as_deref(), table.check),
        Command::Panics { scenes, board } => panics::all(board, &scenes),
        Command::Fuzz {
            targets,
            minutes,
            page,
        } => fuzz::all(&targets, minutes, page),
        Command::Mutants => mutants::all(),
        Command::Reproducible(build) => reproducible::twice(build.board, &build.scene),
        Command::Speed(choice) => speed::speed(&choice),
        Command::Descriptions => descriptions::page(false).and_then(|()| descriptions::compare()),
        Command::Dist(choice) => dist::all(&choice),
        Command::Mount => mount::all(),
        Command::Book => book::build(),
        Command::Walk(choice) => walk::all(&choice),
        Command::Docs { check, quick: true } => docs::quick(check),
        Command::Docs { check, .. } => docs::all(check),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            eprintln!("xtask: {fault}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::{Arguments, Command};

    #[test]
    fn an_option_of_another_scenario_is_refused() {
        for (line, of) in [
            ("--latency --ppm 10 scenes/rcp.toml", "--head"),
            ("--out o --all", "--check"),
            ("--out o --probe absent scenes/rcp.toml", "--check"),
            ("--check --json o scenes/rcp.toml", "--scenario"),
            ("--head --ppm 10 scenes/rcp.toml", ""),
        ] {
            let words = ["xtask", "emulate"].into_iter().chain(line.split(' '));
            let Command::Emulate(emulate) = Arguments::parse_from(words).command else {
                panic!("{line}");
            };
            let refused = emulate.check().err().unwrap_or_default();
            assert!(
                refused.contains(of) && refused.is_empty() == of.is_empty(),
                "{line}"
            );
        }
    }
}
