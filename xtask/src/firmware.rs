//! The firmware of a scene: building, measuring and flashing it.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::run::{Fault, cargo, output, run, top};

/// A board that the firmware runs on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Board {
    name: &'static str,
    /// The program in `firmware/src/bin`.
    program: &'static str,
    target: &'static str,
    /// What probe-rs calls its chip.
    chip: &'static str,
}

impl Board {
    /// Every board.
    pub(crate) const ALL: [Self; 1] = [Self {
        name: "nucleo-f446re",
        program: "nucleo_f446re",
        target: "thumbv7em-none-eabihf",
        chip: "STM32F446RETx",
    }];

    /// The board of that name.
    pub(crate) fn named(name: &str) -> Result<Self, Fault> {
        let names = || Self::ALL.map(|board| board.name).join(", ");
        let board = Self::ALL.into_iter().find(|board| board.name == name);
        board.ok_or_else(|| format!("no such board; there is: {}", names()))
    }

    /// What cargo needs to build its program.
    pub(crate) fn build_arguments(self) -> [&'static str; 9] {
        [
            "--locked",
            "--profile",
            "firmware",
            "-p",
            "firmware",
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
    let scene = std::path::absolute(scene)
        .ok()
        .filter(|path| path.is_file())
        .or_else(|| Some(top().join(scene)).filter(|path| path.is_file()))
        .ok_or_else(|| format!("{}: no such scene", scene.display()))?;
    run(cargo(&["build"])
        .args(board.build_arguments())
        .env("WHISKER_SCENE", scene)
        .env("RUSTFLAGS", "-D warnings"))?;
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| top().join("target"), PathBuf::from);
    Ok(target
        .join(board.target)
        .join("firmware")
        .join(board.program))
}

/// Prints flash and static RAM of an ELF file in bytes.
///
/// # Errors
/// If llvm-size cannot be run or says something else.
pub(crate) fn print_size(board: Board, scene: &Path, elf: &Path) -> Result<(), Fault> {
    let size = Size::of(elf)?;
    println!(
        "{} on {}: flash {} bytes, static RAM {} bytes",
        scene.display(),
        board.name,
        size.flash,
        size.ram
    );
    Ok(())
}

/// Bytes that a program takes.
struct Size {
    flash: u64,
    ram: u64,
}

impl Size {
    /// Sections that stand in flash: code, constants, and the first values of `.data`.
    const FLASH: [&str; 5] = [".vector_table", ".text", ".rodata", ".data", ".gnu.sgstubs"];
    /// Sections that stand in RAM.
    const RAM: [&str; 3] = [".data", ".bss", ".uninit"];

    fn of(elf: &Path) -> Result<Self, Fault> {
        let text = output(Command::new(llvm_size()?).arg("-A").arg(elf))?;
        let sum = |names: &[&str]| -> u64 {
            text.lines()
                .filter_map(|line| {
                    let mut words = line.split_whitespace();
                    names
                        .contains(&words.next()?)
                        .then(|| words.next()?.parse::<u64>().ok())?
                })
                .sum()
        };
        let size = Self {
            flash: sum(&Self::FLASH),
            ram: sum(&Self::RAM),
        };
        if size.flash == 0 {
            return Err(format!(
                "{}: llvm-size found no code:\n{text}",
                elf.display()
            ));
        }
        Ok(size)
    }
}

/// llvm-size of the pinned toolchain (component llvm-tools).
fn llvm_size() -> Result<PathBuf, Fault> {
    let rustc = || Command::new("rustc");
    let sysroot = output(rustc().args(["--print", "sysroot"]).current_dir(top()))?;
    let host = output(rustc().args(["--print", "host-tuple"]).current_dir(top()))?;
    let path = Path::new(sysroot.trim())
        .join("lib/rustlib")
        .join(host.trim())
        .join("bin/llvm-size");
    if path.is_file() {
        Ok(path)
    } else {
        Err("llvm-size is missing: rustup component add llvm-tools".to_owned())
    }
}

/// Flashes an ELF file and streams its log until interrupted.
///
/// # Errors
/// If probe-rs is not installed or finds no board.
pub(crate) fn flash(board: Board, elf: &Path) -> Result<(), Fault> {
    let mut probe = Command::new("probe-rs");
    probe.args(["run", "--chip", board.chip]).arg(elf);
    match probe.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!(
            "probe-rs ended with {status}. Is the board plugged in by its ST-LINK socket, and \
             does `probe-rs list` show it? On Linux the udev rules of probe-rs must be installed."
        )),
        Err(error) => Err(format!(
            "probe-rs cannot be run ({error}). Install it: cargo install probe-rs-tools --locked"
        )),
    }
}
