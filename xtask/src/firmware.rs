//! The firmware of a scene: building and measuring it.

use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use config::Image;
use firmware::boards::{self, BoardFacts};
use object::{Object, ObjectSection};
use scene::Scene;
use tactile::ModelBuf;

use crate::run::{Fault, cargo, read_bytes, run, target, top, write};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Board {
    pub(crate) name: &'static str,
    pub(crate) target: &'static str,
    /// What its program and a PC know of it.
    pub(crate) facts: &'static BoardFacts,
    /// The parts of a program that takes any scene, features of the crate `firmware`: all that the
    /// board has time, room and a driver for.
    pub(crate) every_part: &'static [&'static str],
}

impl Board {
    pub(crate) const ALL: [Self; 3] = [
        Self {
            name: "nucleo-f446re",
            target: "thumbv7em-none-eabihf",
            facts: &boards::NUCLEO_F446RE,
            every_part: &["default", "bus"],
        },
        Self {
            name: "nucleo-f103rb",
            target: "thumbv7m-none-eabi",
            facts: &boards::NUCLEO_F103RB,
            // What self-motion learns does not fit its RAM.
            every_part: &["without-opinion"],
        },
        Self {
            name: "nucleo-g071rb",
            target: "thumbv6m-none-eabi",
            facts: &boards::NUCLEO_G071RB,
            every_part: &["without-opinion", "self-motion"],
        },
    ];

    fn program(self) -> String {
        self.name.replace('-', "_")
    }

    pub(crate) fn named(name: &str) -> Result<Self, Fault> {
        let names = || Self::ALL.map(|board| board.name).join(", ");
        let board = Self::ALL.into_iter().find(|board| board.name == name);
        board.ok_or_else(|| format!("no such board; there is: {}", names()))
    }

    /// What cargo needs to build its program with `parts`, features of the crate `firmware`.
    pub(crate) fn build_arguments(self, parts: &[&str]) -> String {
        let features = [&[self.name], parts].concat().join(",");
        let (program, target) = (self.program(), self.target);
        format!(
            "--locked --profile firmware -p firmware --no-default-features --features {features} \
             --bin {program} --target {target}"
        )
    }
}

/// Builds the firmware of `scene` with warnings as errors, the scene linked and of the parts that
/// it needs; gives the ELF file, as all that build here do: a copy, as the next program is built in
/// the place of the last. What was built before is not built again. Several threads may ask for
/// programs, which are built one after the other.
pub(crate) fn build(board: Board, scene: &Path) -> Result<PathBuf, Fault> {
    try_build(board, scene)?
}

/// As [`build`], or why the board does not take the scene.
pub(crate) fn try_build(board: Board, scene: &Path) -> Result<Result<PathBuf, String>, Fault> {
    try_built(board, scene, &[])
}

/// As [`build`], with checks of overflow, which panic, in the crate of the module: with checks in
/// all of them, its dependencies and what writes code at compile time would be compiled again.
pub(crate) fn build_checked(board: Board, scene: &Path) -> Result<PathBuf, Fault> {
    let checks = "profile.firmware.package.firmware.overflow-checks=true";
    try_built(board, scene, &["--config", checks])?
}

pub(crate) fn build_any_scene(board: Board) -> Result<PathBuf, Fault> {
    kept(board, compiler(board, board.every_part))
}

fn try_built(board: Board, scene: &Path, more: &[&str]) -> Result<Result<PathBuf, String>, Fault> {
    static LINKED: AtomicUsize = AtomicUsize::new(0);
    let scene = find(scene)?;
    let linked = match linked(board, &scene)? {
        Ok(linked) => linked,
        Err(reason) => return Ok(Err(format!("{}: {reason}", scene.display()))),
    };
    let mut compiler = compiler(board, &linked.image.features);
    compiler.args(more);
    let program = kept(board, compiler)?;
    let elf = linked.with(board, &read_bytes(&program)?)?;
    let number = LINKED.fetch_add(1, Ordering::Relaxed);
    let path = target().join(format!("kept/{}-{}-{number}.elf", linked.name, board.name));
    write(&path, elf)?;
    Ok(Ok(path))
}

/// Programs by the arguments of their compiler.
type Built = BTreeMap<Vec<OsString>, PathBuf>;

fn kept(board: Board, mut compiler: Command) -> Result<PathBuf, Fault> {
    static BUILT: Mutex<Built> = Mutex::new(Built::new());
    // A build that has panicked has left nothing that another needs.
    let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    let arguments = compiler.get_args().map(OsStr::to_owned).collect();
    if let Some(kept) = built.get(&arguments) {
        return Ok(kept.clone());
    }
    run(&mut compiler)?;
    let kept = target().join(format!("kept/{}.elf", built.len() + 1));
    write(&kept, read_bytes(&elf_in(board, &target()))?)?;
    built.insert(arguments, kept.clone());
    Ok(kept)
}

pub(crate) fn flash(elf: &Path) -> Result<(), Fault> {
    let mut probe = Command::new("probe-rs");
    run(probe.args(["run", "--chip", "STM32F446RETx"]).arg(elf))
}

pub(crate) struct Linked {
    /// The configuration, and the features that it needs.
    pub(crate) image: Image,
    name: String,
    model: Option<ModelBuf>,
}

impl Linked {
    /// The program's ELF file with the scene and its model.
    pub(crate) fn with(&self, board: Board, program: &[u8]) -> Result<Vec<u8>, Fault> {
        let flash = &board.facts.flash;
        config::linked(program, &self.image, self.model.as_ref(), flash)
            .map_err(|fault| format!("{}: {fault}", self.name))
    }
}

/// Makes what is linked for the scene at `path`; or why the board does not take it.
pub(crate) fn linked(board: Board, path: &Path) -> Result<Result<Linked, String>, Fault> {
    let scene = Scene::load(path).map_err(|error| error.to_string())?;
    let model = model(&scene, path)?;
    let image = match config::image(&scene, model.as_ref(), board.facts, "") {
        Ok(image) => image,
        Err(misfit) => return Ok(Err(misfit.to_string())),
    };
    let name = scene.name;
    Ok(Ok(Linked { image, name, model }))
}

/// The model of the scene at `path`, if it names one.
pub(crate) fn model(scene: &Scene, path: &Path) -> Result<Option<ModelBuf>, Fault> {
    let path = scene.model_path(path.parent().unwrap_or(Path::new("")));
    let read = |path| {
        let path = top().join(path);
        let model = ModelBuf::from_bytes(&read_bytes(&path)?);
        model.map_err(|error| format!("{}: {error}", path.display()))
    };
    path.map(read).transpose()
}

/// A scene, seen from here or from the top of the workspace.
pub(crate) fn find(scene: &Path) -> Result<PathBuf, Fault> {
    let places = [std::path::absolute(scene).ok(), Some(top().join(scene))];
    let found = places.into_iter().flatten().find(|path| path.is_file());
    found.ok_or_else(|| format!("{}: no such scene", scene.display()))
}

fn compiler(board: Board, parts: &[&str]) -> Command {
    let mut command = cargo(&format!("build {}", board.build_arguments(parts)));
    command.env("RUSTFLAGS", "-D warnings");
    command
}

/// Where cargo puts a board's program that builds in this folder.
pub(crate) fn elf_in(board: Board, built: &Path) -> PathBuf {
    let folder = built.join(board.target).join("firmware");
    folder.join(board.program())
}

/// Bytes that a program takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Size {
    /// Code, constants, and the first values of variables; scene and model apart.
    pub(crate) flash: u64,
    /// Variables; the stack apart.
    pub(crate) ram: u64,
}

impl Size {
    /// Sections that stand in flash; `.data` is there too, as first values.
    const FLASH: [&str; 5] = [".vector_table", ".text", ".rodata", ".data", ".gnu.sgstubs"];
    /// Sections that stand in RAM.
    const RAM: [&str; 3] = [".data", ".bss", ".uninit"];
    /// A scene that the program brings with it, and its model.
    const SCENE: [&str; 3] = [".scene", ".model", ".scene_b"];

    pub(crate) fn of(elf: &Path) -> Result<Self, Fault> {
        with_elf(elf, |file| {
            match (sum(file, &Self::FLASH), sum(file, &Self::RAM)) {
                (0, _) => Err("there is no code"),
                (flash, ram) => Ok(Self { flash, ram }),
            }
        })
    }

    pub(crate) fn of_scene(elf: &Path) -> Result<u64, Fault> {
        with_elf(elf, |file| Ok::<_, Fault>(sum(file, &Self::SCENE)))
    }
}

fn sum(file: &object::File<'_>, names: &[&str]) -> u64 {
    file.sections()
        .filter(|section| section.name().is_ok_and(|name| names.contains(&name)))
        .map(|section| section.size())
        .sum()
}

pub(crate) fn with_elf<T, E: Display>(
    elf: &Path,
    ask: impl FnOnce(&object::File<'_>) -> Result<T, E>,
) -> Result<T, Fault> {
    let wrong = |error: &dyn Display| format!("{}: {error}", elf.display());
    let bytes = read_bytes(elf)?;
    let file = object::File::parse(&*bytes).map_err(|error| wrong(&error))?;
    ask(&file).map_err(|error| wrong(&error))
}
