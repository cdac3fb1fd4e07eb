//! The boards, and the program of one: built, and with a scene that it brings with it.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::ValueEnum;
use config::Image;
use emulator::session::Session;
use firmware::boards::{BoardFacts, NUCLEO_F103RB, NUCLEO_F446RE, NUCLEO_G071RB};
use firmware::{Header, Part};
use host_sim::loaded::Loaded;
use host_sim::output::write_whole;
use host_sim::{Error, report};
use scene::file;
use tactile::ModelBuf;
use tempfile::NamedTempFile;

use crate::deployment::model_of;

/// A board whose program can be built, emulated and flashed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum BoardName {
    /// Cortex-M4F, a whisker a side
    #[default]
    NucleoF446re,
    /// Cortex-M3, in fixed point, one whisker
    NucleoF103rb,
    /// Cortex-M0+, likewise
    NucleoG071rb,
}

/// What building a board's program, and looking for the board, must know of it.
pub(crate) struct Board {
    pub(crate) name: &'static str,
    pub(crate) program: &'static str,
    pub(crate) target: &'static str,
    pub(crate) facts: &'static BoardFacts,
    pub(crate) chip: &'static str,
    /// The identity of its chip (RM0390, RM0008 and RM0444, "Debug support", "MCU device ID
    /// code": DEV_ID).
    pub(crate) chip_id: u16,
}

impl BoardName {
    pub(crate) const fn board(self) -> Board {
        match self {
            Self::NucleoF446re => Board {
                name: "nucleo-f446re",
                program: "nucleo_f446re",
                target: "thumbv7em-none-eabihf",
                facts: &NUCLEO_F446RE,
                chip: "STM32F446RETx",
                chip_id: 0x421,
            },
            Self::NucleoF103rb => Board {
                name: "nucleo-f103rb",
                program: "nucleo_f103rb",
                target: "thumbv7m-none-eabi",
                facts: &NUCLEO_F103RB,
                chip: "STM32F103RBTx",
                chip_id: 0x410,
            },
            Self::NucleoG071rb => Board {
                name: "nucleo-g071rb",
                program: "nucleo_g071rb",
                target: "thumbv6m-none-eabi",
                facts: &NUCLEO_G071RB,
                chip: "STM32G071RBTx",
                chip_id: 0x460,
            },
        }
    }
}

/// Bytes of flash in which a program has room for all its parts, and so takes any scene. A smaller
/// one has those that its scene needs.
const ROOM_FOR_ALL: u32 = 128 * 1024;

/// Whether the program in a file is one of a board, of this one if it is named.
pub(crate) fn is_of(program: &Path, board: Option<BoardName>) -> Result<(), Error> {
    let found = Session::board_of(program)?;
    let Some(board) = board.map(BoardName::board) else {
        return Ok(());
    };
    if found == board.program {
        return Ok(());
    }
    let name = board.name;
    let fault = format!("found the program of another board, {found}; allowed: that of {name}");
    Err(Error::file(program, fault))
}

/// The workspace that this was built in; none of a release, which knows no folder of the machine
/// that built it.
pub(crate) fn workspace() -> Option<&'static Path> {
    match option_env!("WHISKER_RELEASE") {
        None => Path::new(env!("CARGO_MANIFEST_DIR")).parent(),
        Some(_) => None,
    }
}

struct Brought {
    image: Image,
    model: Option<ModelBuf>,
}

impl Brought {
    fn of(scene: &Path, facts: &BoardFacts) -> Result<Self, Error> {
        let loaded = Loaded::new(scene)?;
        let model = model_of(scene, &loaded.scene)?;
        let image = config::image(&loaded.scene, model.as_ref(), facts, "");
        let image = image.map_err(|misfit| Error::file(scene, misfit))?;
        Ok(Self { image, model })
    }

    fn put_into(&self, program: &Path, board: &Board) -> Result<Vec<u8>, Error> {
        let bytes = file::read(program, file::BINARY_BYTES);
        let bytes = bytes.map_err(|error| Error::file(program, error))?;
        let (model, flash) = (self.model.as_ref(), &board.facts.flash);
        let linked = config::linked(&bytes, &self.image, model, flash);
        linked.map_err(|fault| Error::file(program, fault))
    }
}

/// A copy of a program that takes any scene, which brings this one with it; it is there until
/// dropped.
pub(crate) fn with_scene(
    board: BoardName,
    program: &Path,
    scene: &Path,
) -> Result<NamedTempFile, Error> {
    let board = board.board();
    let bytes = Brought::of(scene, board.facts)?.put_into(program, &board)?;
    let written = NamedTempFile::new().and_then(|mut copy| {
        copy.write_all(&bytes)?;
        Ok(copy)
    });
    written.map_err(|error| Error::Work(format!("a copy of {}: {error}", program.display())))
}

pub(crate) fn build(board: BoardName, scene: &Path) -> Result<PathBuf, Error> {
    let board = board.board();
    let Board {
        name: feature,
        program,
        target,
        facts,
        ..
    } = board;
    let Some(top) = workspace() else {
        let fault = format!(
            "a released whisker builds no programs; allowed: --program boards/{feature}.elf, of \
             the release's folder"
        );
        return Err(Error::Input(fault));
    };
    let built = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| top.join("target"), Into::into);
    let built: PathBuf = std::path::absolute(built)
        .map_err(|error| Error::Work(format!("the folder that is built in: {error}")))?;
    let brought = Brought::of(scene, facts)?;
    let parts = &brought.image.features;
    report::warn(format_args!(
        "building the {feature}'s program of {}",
        scene.display()
    ));
    let has_room = facts.flash.program.bytes >= ROOM_FOR_ALL;
    // A program reads one kind of sensor, by default the other one.
    let takes_any = has_room && !parts.contains(&Part::Tmag5170.feature());
    let mut features = vec![feature];
    if takes_any {
        features.extend(["default", Part::Bus.feature()]);
    }
    let is_needed = |part: &&str| !takes_any || *part == "fixed";
    features.extend(parts.iter().copied().filter(is_needed));
    let folder = built.join("scenes");
    std::fs::create_dir_all(&folder).map_err(|error| Error::write(&folder, error))?;
    // All programs of a board are built in the same place.
    let _lock = lock(&folder.join("lock"))?;
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .args(["build", "--quiet", "--locked", "--profile", "firmware"])
        .args(["-p", "firmware", "--no-default-features"])
        .args(["--features", &features.join(",")])
        .args(["--bin", program, "--target", target])
        // As all programs of boards are built: others would be compiled again.
        .env("RUSTFLAGS", "-D warnings")
        .current_dir(top);
    let status = cargo.status().map_err(|error| {
        Error::Work(format!(
            "cargo: {error}; Rust is installed by https://rustup.rs"
        ))
    })?;
    if !status.success() {
        return Err(Error::Work(format!(
            "the program could not be built ({status}); is the target there? rustup target add \
             {target}"
        )));
    }
    let elf = built.join(target).join("firmware").join(program);
    let linked = brought.put_into(&elf, &board)?;
    // Another one for each scene and model.
    let sum = Header::of(&brought.image.bytes).map_or(0, |header| header.crc);
    let of_model = brought.model.as_ref().map_or(0, ModelBuf::crc);
    let kept = folder.join(format!("{feature}-{sum:08x}-{of_model:08x}.elf"));
    write_whole(&kept, &linked)?;
    Ok(kept)
}

fn lock(path: &Path) -> Result<File, Error> {
    let wrong = |error| Error::write(path, error);
    let file = File::create(path).map_err(wrong)?;
    file.lock().map_err(wrong)?;
    Ok(file)
}
