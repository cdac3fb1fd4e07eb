//! Running other programs from the top of the workspace.

use std::path::{Path, PathBuf};
use std::process::Command;

/// What went wrong, for a person to read.
pub(crate) type Fault = String;

/// The top of the workspace.
pub(crate) fn top() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_owned()
}

/// Where cargo builds.
pub(crate) fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| top().join("target"), PathBuf::from)
}

/// `cargo` with `arguments`, to be run at the top.
pub(crate) fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments).current_dir(top());
    command
}

/// Runs `command` and prints it first.
///
/// # Errors
/// If it cannot be started or does not end well.
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

/// What `command` prints.
///
/// # Errors
/// If it cannot be started or does not end well.
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
