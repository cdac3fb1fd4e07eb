//! Which module a command is about.

use std::path::{Path, PathBuf};

use clap::Args;
use firmware::RELAYED_HZ;
use host_sim::Error;
use host_sim::commands::choice::seed;
use host_sim::loaded::Loaded;

use super::Source;
use super::emulated::Emulated;
use super::flash::Flash;
use super::laying::Laying;
use super::port::{self, Port};
use super::program::{self, BoardName};
use super::simulated::Simulated;
use crate::conversation::Conversation;
use crate::probe;

#[derive(Debug, Clone, Args)]
pub(crate) struct SourceChoice {
    /// A simulated module, in the world of this scene
    #[arg(long, value_name = "SCENE", group = "source")]
    sim: Option<PathBuf>,
    /// The program that a board has for this scene, on an emulated chip, in the scene's world
    #[arg(long, value_name = "SCENE", group = "source")]
    emulated: Option<PathBuf>,
    /// A board behind its debug probe, without stopping it; where there are several probes, the
    /// one whose serial number begins so
    #[arg(
        long,
        value_name = "SERIAL",
        group = "source",
        num_args = 0..=1,
        default_missing_value = "",
        conflicts_with = "seed"
    )]
    probe: Option<String>,
    /// The program's file. For --emulated it brings the scene; left out, it is built (minutes,
    /// the first time). For --probe it is what the board runs; left out, the log cannot be read
    #[arg(long, value_name = "ELF", conflicts_with = "sim")]
    program: Option<PathBuf>,
    /// The board whose program is built, or that is behind the probe [default: nucleo-f446re, or
    /// that of --program]
    #[arg(long, value_enum, conflicts_with = "sim")]
    board: Option<BoardName>,
    /// The scene in whose world the module is: what it meets, for how long, and the seed;
    /// without it the module's own
    #[arg(long, value_name = "SCENE", conflicts_with = "probe")]
    world: Option<PathBuf>,
    /// What befalls the board of --emulated: a file of events, as docs/boards.md lists them
    #[arg(long, value_name = "FILE", conflicts_with_all = ["sim", "probe", "port"])]
    scenario: Option<PathBuf>,
    /// A file that keeps what is deployed from one command to the next, as a board's flash does:
    /// scene and model of --emulated, the model of --sim; made where there is none
    #[arg(long, value_name = "FILE", conflicts_with = "probe")]
    flash: Option<PathBuf>,
    /// A board on this serial port, of a scene whose telemetry has a serial_baud
    #[arg(long, value_name = "PATH", group = "source", conflicts_with_all = ["program", "board", "world", "flash", "seed"])]
    port: Option<PathBuf>,
    /// The scene's serial_baud
    #[arg(long, value_name = "N", conflicts_with_all = ["sim", "emulated", "probe"], default_value_t = 115_200)]
    baud: u32,
    /// Lays samples on a real bench, in place of a person: a command for the shell, which finds
    /// the sample's name in $SAMPLE, and ends once it lies there
    #[arg(long, value_name = "COMMAND", conflicts_with_all = ["sim", "emulated"])]
    lay_by: Option<String>,
    /// The board of a head that is talked with, from 0: by way of that which is connected, of
    /// --emulated the first [default: that one]
    #[arg(long, value_name = "N")]
    node: Option<u8>,
    /// Another seed of the world than the scene's
    #[arg(long, value_name = "N", value_parser = seed)]
    seed: Option<u64>,
}

impl SourceChoice {
    pub(crate) fn scene(&self) -> Option<&Path> {
        self.sim.as_deref().or(self.emulated.as_deref())
    }

    fn board(&self) -> BoardName {
        self.board.unwrap_or_default()
    }

    /// Seconds in a second at which a module that has no clock of its own is watched.
    pub(crate) fn pace(&self) -> Option<f64> {
        self.sim.as_ref().map(|_| 1.0)
    }

    /// Stops motors by what takes a stop before any question; others are asked to soon enough.
    pub(crate) fn stop(&self) {
        if let Some(path) = &self.port {
            port::stop(path, self.baud);
        }
    }

    pub(crate) fn module(&self) -> Result<Conversation, Error> {
        Ok(Conversation::with(self.open(0)?, self.elsewhere()))
    }

    /// Fails where not every record comes.
    pub(crate) fn sends_all(&self) -> Result<(), Error> {
        if self.elsewhere().is_none() {
            return Ok(());
        }
        let fault = format!(
            "--node: by way of another board {RELAYED_HZ} records a second come; this needs all: \
             connect the board itself"
        );
        Err(Error::Input(fault))
    }

    /// The board that is asked by way of another one.
    fn elsewhere(&self) -> Option<u8> {
        self.node.filter(|_| self.sim.is_none())
    }

    /// Opens what is connected, in a world whose seed is `later` ones after its own.
    pub(crate) fn open(&self, later: u64) -> Result<Box<dyn Source>, Error> {
        let laying = || Laying::by(self.lay_by.as_deref());
        if let Some(serial) = &self.probe {
            return probe::open(serial, self.board(), self.program.as_deref(), laying());
        }
        if let Some(port) = &self.port {
            return Ok(Box::new(Port::open(port, self.baud, laying())?));
        }
        let Some(path) = self.scene() else {
            let fault =
                "which module? allowed: --sim SCENE, --emulated SCENE, --probe, --port PATH";
            return Err(Error::Input(fault.to_owned()));
        };
        let loaded = self.placed(Loaded::new(path)?, later)?;
        let flash = Flash::open(self.flash.as_deref())?;
        let head = &loaded.scene.head;
        let boards = head.nodes.map_or(0, usize::from);
        let is_one_a_board = boards == loaded.scene.whiskers();
        if head.whiskers_per_side > 1 && !is_one_a_board {
            let fault = "a record tells a whisker's side and not its number; found more than \
                         one, allowed: head.whiskers_per_side = 1, or a board a whisker";
            return Err(Error::file(path, fault));
        }
        if self.sim.is_some() {
            let node = usize::from(self.node.unwrap_or(0));
            if node >= boards.max(1) {
                let fault = format!("--node: found {node}, allowed: boards 0 to head.nodes - 1");
                return Err(Error::file(path, fault));
            }
            return Ok(Box::new(Simulated::open(loaded, flash, node)?));
        }
        if !loaded.scene.telemetry.rtt {
            let fault = "telemetry.rtt is false: a module of this scene tells nothing but its \
                         log; take that line out";
            return Err(Error::file(path, fault));
        }
        let program = match &self.program {
            Some(program) => {
                program::is_of(program, self.board)?;
                program.clone()
            }
            None => program::build(self.board(), path)?,
        };
        if boards > 0 {
            if self.flash.is_some() || self.scenario.is_some() {
                let fault = "--flash, --scenario: found one; allowed: none with the boards of a \
                             head, for which cargo xtask emulate --head has scenarios";
                return Err(Error::file(path, fault));
            }
            return Ok(Box::new(Emulated::head(loaded, &program)?));
        }
        let emulated = Emulated::open(loaded, &program, flash, self.scenario.as_deref())?;
        Ok(Box::new(emulated))
    }

    /// A module's scene in the world that is chosen, `later` seeds after its own.
    fn placed(&self, mut loaded: Loaded, later: u64) -> Result<Loaded, Error> {
        if let Some(world) = &self.world {
            loaded = loaded.in_world(world)?;
        }
        let seed = self.seed.unwrap_or(loaded.scene.seed);
        loaded.scene.seed = seed.wrapping_add(later) & i64::MAX.cast_unsigned();
        Ok(loaded)
    }

    /// A scene as the module runs it: a simulated one knows its world and its seed.
    pub(crate) fn of_module(&self, loaded: Loaded) -> Result<Loaded, Error> {
        if self.sim.is_some() {
            self.placed(loaded, 0)
        } else {
            Ok(loaded)
        }
    }

    pub(crate) const fn is_simulated(&self) -> bool {
        self.sim.is_some()
    }
}

pub(crate) fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok();
    let seconds = seconds.filter(|seconds: &f64| *seconds > 0.0 && *seconds <= 1e6);
    seconds.ok_or_else(|| "allowed: above 0, up to 1000000 s".to_owned())
}
