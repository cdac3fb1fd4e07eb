//! Running other programs from the top of the workspace, and its files.

use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, OnceLock, PoisonError};
use std::{fmt, fs, thread};

use scene::file;

/// What went wrong, for a person to read.
pub(crate) type Fault = String;

/// How much is done at once where each keeps a processor busy: as many as CI's machine has.
pub(crate) const AT_ONCE: usize = 2;

/// Writes to standard output; what keeps a line from it, but a closed pipe, ends all.
pub(crate) fn say(text: fmt::Arguments<'_>) {
    if let Err(fault) = io::stdout().lock().write_fmt(text)
        && fault.kind() != ErrorKind::BrokenPipe
    {
        eprintln!("standard output: {fault}");
        std::process::exit(1);
    }
}

/// The top of the workspace.
pub(crate) fn top() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_owned()
}

pub(crate) fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| top().join("target"), PathBuf::from)
}

/// `path` from the root, so that a program that runs elsewhere finds it.
pub(crate) fn absolute(path: &Path) -> Result<PathBuf, Fault> {
    std::path::absolute(path).map_err(|error| format!("{}: {error}", path.display()))
}

pub(crate) fn read(path: &Path) -> Result<String, Fault> {
    String::from_utf8(read_bytes(path)?).map_err(|error| format!("{}: {error}", path.display()))
}

pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, Fault> {
    file::read(path, file::BINARY_BYTES).map_err(|error| format!("{}: {error}", path.display()))
}

pub(crate) fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<(), Fault> {
    let folder = path.parent().map_or(Ok(()), fs::create_dir_all);
    let written = folder.and_then(|()| fs::write(path, content));
    written.map_err(|error| format!("{}: {error}", path.display()))
}

pub(crate) fn document(name: &str, bytes: &[u8], check: bool) -> Result<(), Fault> {
    let path = top().join(name);
    if !check {
        return write(&path, bytes);
    }
    if read_bytes(&path)? == bytes {
        Ok(())
    } else {
        Err(format!("{name} is out of date: run cargo xtask docs"))
    }
}

pub(crate) fn remove(folder: &Path) -> Result<(), Fault> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(format!("{}: {error}", folder.display()))
        }
        _ => Ok(()),
    }
}

pub(crate) fn no_faults(faults: &[Fault]) -> Result<(), Fault> {
    if faults.is_empty() {
        Ok(())
    } else {
        Err(faults.join("\n"))
    }
}

pub(crate) fn listing(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, Fault> {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let is_wanted = |path: &PathBuf| path.extension().is_some_and(|found| found == extension);
    let mut paths: Vec<PathBuf> = paths.filter(is_wanted).collect();
    paths.sort();
    Ok(paths)
}

/// `cargo` at the top, with arguments that are parted by spaces.
pub(crate) fn cargo(arguments: &str) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments.split(' ')).current_dir(top());
    command
}

/// Lints the workspace's crates while it compiles them, with warnings as errors: clippy's compiler is
/// rustc's, and checks apart would compile all dependencies once more. What is compiled is not
/// taken for what rustc alone compiles.
pub(crate) fn linted(command: &mut Command) -> &mut Command {
    // As `cargo clippy -- -D warnings` says it.
    let warnings = "-D__CLIPPY_HACKERY__warnings__CLIPPY_HACKERY__";
    let compiler = ("RUSTC_WORKSPACE_WRAPPER", "clippy-driver");
    command.envs([compiler, ("CLIPPY_ARGS", warnings)])
}

/// `cargo` with a command for a package outside the workspace, which is built in a folder of its
/// own.
pub(crate) fn cargo_apart(command: &str, package: &str, folder: &str) -> Command {
    let manifest = format!("--manifest-path {package}/Cargo.toml --target-dir");
    let mut command = cargo(&format!("{command} --quiet --locked {manifest}"));
    command.arg(target().join(folder));
    command
}

/// Where the programs are that CI has built, in one build with the tests.
static BUILT: OnceLock<PathBuf> = OnceLock::new();

/// The programs that steps of CI and commands of the book call.
const CALLED: [&str; 3] = ["emulator", "host-sim", "whisker"];

/// From now on, [`workspace_program`] takes what is built, in copies: cargo would build each again,
/// as dependencies have other features where a program is built alone, and puts it in the place of
/// what another step runs.
pub(crate) fn take_built_programs() -> Result<(), Fault> {
    let kept = target().join("kept/programs");
    for program in CALLED {
        write(&kept.join(program), "")?;
        fs::copy(target().join("debug").join(program), kept.join(program))
            .map_err(|error| format!("{program}: {error}"))?;
    }
    BUILT.get_or_init(|| kept);
    Ok(())
}

/// A program of the workspace that is built, if CI has built all.
pub(crate) fn built(package: &str) -> Option<PathBuf> {
    BUILT.get().map(|folder| folder.join(package))
}

/// A program of the workspace, to be run at the top.
pub(crate) fn workspace_program(package: &str) -> Command {
    let Some(path) = built(package) else {
        return cargo(&format!("run --quiet -p {package} --"));
    };
    let mut command = Command::new(path);
    command.current_dir(top());
    command
}

/// The emulator, with its first arguments, which are parted by spaces.
pub(crate) fn emulator(arguments: &str) -> Command {
    let mut command = workspace_program("emulator");
    command.args(arguments.split(' '));
    command
}

pub(crate) fn run(command: &mut Command) -> Result<(), Fault> {
    let text = line(command);
    println!("$ {text}");
    let status = command
        .status()
        .map_err(|error| format!("{text}: {error}"))?;
    if status.success() {
        Ok(())
    } else {
        Err(format!("{text}: {status}"))
    }
}

pub(crate) fn run_at_once(commands: Vec<Command>, at_once: usize) -> Result<(), Fault> {
    each(commands, at_once, |mut command| run(&mut command))
}

/// Works on `items`, so many at once, to the last, whichever fail.
pub(crate) fn each<T: Send>(
    items: Vec<T>,
    at_once: usize,
    work: impl Fn(T) -> Result<(), Fault> + Sync,
) -> Result<(), Fault> {
    let left = Mutex::new(items.into_iter());
    let faults = Mutex::new(Vec::new());
    let next = || left.lock().ok()?.next();
    let lane = || {
        while let Some(item) = next() {
            if let (Err(fault), Ok(mut faults)) = (work(item), faults.lock()) {
                faults.push(fault);
            }
        }
    };
    thread::scope(|scope| {
        for _ in 0..at_once {
            scope.spawn(lane);
        }
    });
    no_faults(&faults.into_inner().unwrap_or_default())
}

/// What `make` made when it was done first: several steps use it.
pub(crate) fn once(
    made: &Mutex<Option<PathBuf>>,
    make: impl FnOnce() -> Result<PathBuf, Fault>,
) -> Result<PathBuf, Fault> {
    // Making that has panicked has left none.
    let mut made = made.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(path) = &*made {
        return Ok(path.clone());
    }
    let path = make()?;
    Ok(made.insert(path).clone())
}

/// Installs a subcommand of cargo, unless it is there.
pub(crate) fn installed(subcommand: &str) -> Result<(), Fault> {
    if output(&mut cargo(&format!("{subcommand} --version"))).is_ok() {
        return Ok(());
    }
    run(&mut cargo(&format!("install --locked cargo-{subcommand}")))
}

pub(crate) fn output(command: &mut Command) -> Result<String, Fault> {
    let text = line(command);
    let output = command
        .output()
        .map_err(|error| format!("{text}: {error}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{text}: {}\n{said}", output.status));
    }
    String::from_utf8(output.stdout).map_err(|error| format!("{text}: {error}"))
}

fn line(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let name = program.file_name().unwrap_or(command.get_program());
    std::iter::once(name)
        .chain(command.get_args())
        .map(|part| part.to_string_lossy())
        .collect::<Vec<_>>()
        .join(" ")
}
