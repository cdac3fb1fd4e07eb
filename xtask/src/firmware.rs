//! The firmware of a scene: building and measuring it.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use object::{Object, ObjectSection};

use crate::run::{Fault, cargo, read_bytes, run, target, top, write};

/// A board that the firmware runs on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Board {
    /// Its name, and its feature in `firmware/Cargo.toml`.
    pub(crate) name: &'static str,
    /// The program in `firmware/src/bin`.
    program: &'static str,
    target: &'static str,
    /// Whether its core computes f32 by itself.
    pub(crate) has_fpu: bool,
    /// Whether it carries a whisker a side, and not the left alone.
    pub(crate) has_both_sides: bool,
}

impl Board {
    /// Every board.
    pub(crate) const ALL: [Self; 3] = [
        Self {
            name: "nucleo-f446re",
            program: "nucleo_f446re",
            target: "thumbv7em-none-eabihf",
            has_fpu: true,
            has_both_sides: true,
        },
        Self {
            name: "nucleo-f103rb",
            program: "nucleo_f103rb",
            target: "thumbv7m-none-eabi",
            has_fpu: false,
            has_both_sides: false,
        },
        Self {
            name: "nucleo-g071rb",
            program: "nucleo_g071rb",
            target: "thumbv6m-none-eabi",
            has_fpu: false,
            has_both_sides: false,
        },
    ];

    /// The board of that name.
    pub(crate) fn named(name: &str) -> Result<Self, Fault> {
        let names = || Self::ALL.map(|board| board.name).join(", ");
        let board = Self::ALL.into_iter().find(|board| board.name == name);
        board.ok_or_else(|| format!("no such board; there is: {}", names()))
    }

    /// What cargo needs to build its program.
    pub(crate) fn build_arguments(self) -> [&'static str; 11] {
        [
            "--locked",
            "--profile",
            "firmware",
            "-p",
            "firmware",
            "--features",
            self.name,
            "--bin",
            self.program,
            "--target",
            self.target,
        ]
    }
}

/// Builds the firmware of `scene` with warnings as errors; gives the ELF file.
///
/// # Errors
/// If the scene does not exist or the build fails.
pub(crate) fn build(board: Board, scene: &Path) -> Result<PathBuf, Fault> {
    let scene = find(scene)?;
    run(&mut compiler(board, &scene))?;
    Ok(elf(board))
}

/// The same, kept apart: the next program is built in the place of the last. Several threads
/// may ask for programs, which are built one after the other.
///
/// # Errors
/// As [`build`], and if it cannot be kept.
pub(crate) fn build_kept(board: Board, scene: &Path) -> Result<PathBuf, Fault> {
    static BUILT: Mutex<u32> = Mutex::new(0);
    // A build that has panicked has left nothing that another needs.
    let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    let program = read_bytes(&build(board, scene)?)?;
    *built += 1;
    let kept = target().join(format!("kept/{}.elf", *built));
    write(&kept, program)?;
    Ok(kept)
}

/// The same, with checks of overflow, which panic.
///
/// # Errors
/// As [`build`].
pub(crate) fn build_checked(board: Board, scene: &Path) -> Result<PathBuf, Fault> {
    let checks = ["--config", "profile.firmware.overflow-checks=true"];
    run(compiler(board, &find(scene)?).args(checks))?;
    Ok(elf(board))
}

/// As [`build`], quietly, and told apart: the ELF file, or why the board does not
/// take the scene.
///
/// # Errors
/// If the scene does not exist, or the build fails for another reason.
pub(crate) fn try_build(board: Board, scene: &Path) -> Result<Result<PathBuf, String>, Fault> {
    let scene = find(scene)?;
    let mut command = compiler(board, &scene);
    let done = command.output().map_err(|error| error.to_string())?;
    if done.status.success() {
        return Ok(Ok(elf(board)));
    }
    let said = String::from_utf8_lossy(&done.stderr);
    // What the build script says, and cargo puts its package before.
    let reason = said
        .lines()
        .find_map(|line| line.strip_prefix("error: firmware@")?.split_once(": "));
    match reason {
        Some((_, reason)) => Ok(Err(reason.to_owned())),
        None => Err(said.into_owned()),
    }
}

/// A scene, seen from here or from the top of the workspace.
fn find(scene: &Path) -> Result<PathBuf, Fault> {
    std::path::absolute(scene)
        .ok()
        .filter(|path| path.is_file())
        .or_else(|| Some(top().join(scene)).filter(|path| path.is_file()))
        .ok_or_else(|| format!("{}: no such scene", scene.display()))
}

fn compiler(board: Board, scene: &Path) -> Command {
    let mut command = cargo(&["build"]);
    command
        .args(board.build_arguments())
        .env("WHISKER_SCENE", scene)
        .env("RUSTFLAGS", "-D warnings");
    command
}

/// Where the program of a board is.
fn elf(board: Board) -> PathBuf {
    elf_in(board, &target())
}

/// The same, where cargo builds in another folder.
pub(crate) fn elf_in(board: Board, built: &Path) -> PathBuf {
    built
        .join(board.target)
        .join("firmware")
        .join(board.program)
}

/// Bytes that a program takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Size {
    /// Code, constants, and the first values of variables.
    pub(crate) flash: u64,
    /// Variables; the stack apart.
    pub(crate) ram: u64,
}

impl Size {
    /// Sections that stand in flash; `.data` is there too, as first values.
    const FLASH: [&str; 5] = [".vector_table", ".text", ".rodata", ".data", ".gnu.sgstubs"];
    /// Sections that stand in RAM.
    const RAM: [&str; 3] = [".data", ".bss", ".uninit"];

    /// Of an ELF file.
    ///
    /// # Errors
    /// If it cannot be read or has no code.
    pub(crate) fn of(elf: &Path) -> Result<Self, Fault> {
        let sum = |file: &object::File<'_>, names: &[&str]| -> u64 {
            file.sections()
                .filter(|section| section.name().is_ok_and(|name| names.contains(&name)))
                .map(|section| section.size())
                .sum()
        };
        with_elf(elf, |file| {
            match (sum(file, &Self::FLASH), sum(file, &Self::RAM)) {
                (0, _) => Err("there is no code"),
                (flash, ram) => Ok(Self { flash, ram }),
            }
        })
    }
}

/// What `ask` says of an ELF file.
///
/// # Errors
/// If it cannot be read, or `ask`'s own.
pub(crate) fn with_elf<T, E: Display>(
    elf: &Path,
    ask: impl FnOnce(&object::File<'_>) -> Result<T, E>,
) -> Result<T, Fault> {
    let wrong = |error: &dyn Display| format!("{}: {error}", elf.display());
    let bytes = read_bytes(elf)?;
    let file = object::File::parse(&*bytes).map_err(|error| wrong(&error))?;
    ask(&file).map_err(|error| wrong(&error))
}
