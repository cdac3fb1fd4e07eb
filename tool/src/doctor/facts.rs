//! What is found on this PC.

use std::process::Command;

use super::usb::{SerialPort, has_rules, serial_ports};
use crate::probe::{SeenProbe, seen};
use crate::source::{BoardName, workspace};

const PINS: &str = include_str!("../../../rust-toolchain.toml");

#[derive(Debug, Clone)]
pub(crate) struct Facts {
    pub(super) toolchain: String,
    pub(super) targets: Vec<String>,
    pub(super) rustup: Option<String>,
    /// Toolchains, and the targets of the one that is asked for.
    pub(super) toolchains: Vec<String>,
    pub(super) fetched: Vec<String>,
    /// Free on the disk of the workspace, MiB, where that is known.
    pub(super) free_mib: Option<u64>,
    /// Whether devices have owners and rules.
    pub(super) is_linux: bool,
    pub(super) is_root: bool,
    pub(super) has_rules: bool,
    pub(super) probes: Result<Vec<SeenProbe>, String>,
    pub(super) ports: Vec<SerialPort>,
}

impl Facts {
    pub(crate) fn gather(board: BoardName) -> Self {
        let (toolchain, targets) = pinned(PINS);
        let fetched = ["target", "list", "--installed", "--toolchain", &toolchain];
        let is_linux = cfg!(target_os = "linux");
        let version = said("rustup", &["--version"]);
        Self {
            rustup: version.and_then(|said| said.split_whitespace().nth(1).map(str::to_owned)),
            toolchains: words(said("rustup", &["toolchain", "list"])),
            fetched: words(said("rustup", &fetched)),
            free_mib: said("df", &["-Pk", "."]).and_then(|said| free_mib(&said)),
            is_linux,
            is_root: said("id", &["-u"]).is_some_and(|id| id.trim() == "0"),
            has_rules: has_rules(),
            probes: seen(board),
            ports: serial_ports(),
            toolchain,
            targets,
        }
    }
}

/// What a program prints, run in the workspace; none if it is not there, or fails.
fn said(program: &str, arguments: &[&str]) -> Option<String> {
    let mut command = Command::new(program);
    // The folder that this was built in may be gone.
    if let Some(here) = workspace().filter(|here| here.is_dir()) {
        command.current_dir(here);
    }
    let output = command.args(arguments).output().ok()?;
    let done = output.status.success();
    done.then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

fn words(said: Option<String>) -> Vec<String> {
    let said = said.unwrap_or_default();
    let words = said
        .lines()
        .filter_map(|line| line.split_whitespace().next());
    words.map(str::to_owned).collect()
}

fn pinned(file: &str) -> (String, Vec<String>) {
    let quoted = |line: &str| line.split('"').nth(1).map(str::to_owned);
    let channel = file.lines().find(|line| line.starts_with("channel"));
    let targets = file.lines().filter_map(quoted);
    (
        channel.and_then(quoted).unwrap_or_default(),
        targets.filter(|name| name.starts_with("thumb")).collect(),
    )
}

fn free_mib(said: &str) -> Option<u64> {
    let kib: u64 = said
        .lines()
        .nth(1)?
        .split_whitespace()
        .nth(3)?
        .parse()
        .ok()?;
    Some(kib / 1024)
}

#[cfg(test)]
mod tests {
    use super::free_mib;

    #[test]
    fn free_room_is_the_fourth_column() {
        let said = "Filesystem 1024-blocks Used Available Capacity Mounted on\n\
                    /dev/vda 263174212 42880000 10485760 45% /\n";
        assert_eq!(free_mib(said), Some(10_240));
        assert_eq!(free_mib("df: no such file"), None);
    }
}
