//! What is found on this PC. On USB only Linux says what there is: elsewhere devices need no
//! permission, and none is found.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

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
    let kib = said.lines().nth(1)?.split_whitespace().nth(3)?;
    Some(kib.parse::<u64>().ok()? / 1024)
}

/// Who makes ST-LINKs, as USB has it.
const ST: &str = "0483";

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct SerialPort {
    pub(crate) path: PathBuf,
    pub(crate) may_open: bool,
}

fn serial_ports() -> Vec<SerialPort> {
    ports_in(Path::new("/sys/class/tty"), Path::new("/dev"))
}

fn ports_in(class: &Path, devices: &Path) -> Vec<SerialPort> {
    let entries = fs::read_dir(class).into_iter().flatten().flatten();
    let mut names: Vec<_> = entries.map(|entry| entry.file_name()).collect();
    names.sort();
    let is_st = |name: &std::ffi::OsString| {
        // The port is of an interface, whose parent is the device.
        let Ok(interface) = fs::canonicalize(class.join(name).join("device")) else {
            return false;
        };
        let maker = interface.parent().map(|device| device.join("idVendor"));
        let maker = maker.and_then(|file| fs::read_to_string(file).ok());
        maker.is_some_and(|maker| maker.trim() == ST)
    };
    let ports = names.iter().filter(|name| is_st(name));
    let ports = ports.map(|name| devices.join(name));
    let both = fs::File::options().read(true).write(true).clone();
    let ports = ports.map(|path| SerialPort {
        may_open: both.open(&path).is_ok(),
        path,
    });
    ports.collect()
}

/// Whether rules of udev are there that let a user open an ST-LINK.
fn has_rules() -> bool {
    let folders = ["/etc", "/usr/lib", "/lib"].map(|folder| Path::new(folder).join("udev/rules.d"));
    folders.iter().any(|folder| rules_in(folder))
}

/// Whether one of the folder's files has a rule for devices of that maker that gives them away.
fn rules_in(folder: &Path) -> bool {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut texts = entries.filter_map(|entry| fs::read_to_string(entry.path()).ok());
    let gives = |line: &str| {
        let line = line.trim();
        !line.starts_with('#')
            && line.contains("idVendor")
            && line.contains(ST)
            && (line.contains("uaccess") || line.contains("MODE") || line.contains("GROUP"))
    };
    texts.any(|text| text.lines().any(gives))
}

#[cfg(all(test, unix))]
mod tests {
    use std::fs;
    use std::os::unix::fs::symlink;

    use super::{free_mib, ports_in, rules_in};

    #[test]
    fn a_port_is_found_by_the_maker_of_its_device() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for (device, port, maker) in [("1-1", "ttyACM0", "0483"), ("1-2", "ttyACM1", "2341")] {
            let interface = at(&format!("usb/{device}/{device}:1.2"));
            fs::create_dir_all(&interface).unwrap();
            fs::write(at(&format!("usb/{device}/idVendor")), format!("{maker}\n")).unwrap();
            fs::create_dir_all(at(&format!("class/{port}"))).unwrap();
            symlink(&interface, at(&format!("class/{port}/device"))).unwrap();
        }
        // A console, which has no device.
        fs::create_dir_all(at("class/tty0")).unwrap();
        fs::create_dir_all(at("dev")).unwrap();
        let found = ports_in(&at("class"), &at("dev"));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].path, at("dev/ttyACM0"));
        assert!(!found[0].may_open, "there is no such file");
        fs::write(at("dev/ttyACM0"), "").unwrap();
        assert!(ports_in(&at("class"), &at("dev"))[0].may_open);
        assert_eq!(ports_in(&at("none"), &at("dev")), []);
    }

    #[test]
    fn a_rule_must_give_devices_of_that_maker_away() {
        let gives = |rule: &str| {
            let folder = tempfile::tempdir().unwrap();
            fs::write(folder.path().join("69-some.rules"), format!("{rule}\n")).unwrap();
            rules_in(folder.path())
        };
        assert!(gives(
            r#"ATTRS{idVendor}=="0483", MODE="660", TAG+="uaccess""#
        ));
        assert!(!gives(r#"# ATTRS{idVendor}=="0483", MODE="660""#));
        assert!(!gives(
            r#"ATTRS{idVendor}=="0483", ENV{ID_MM_DEVICE_IGNORE}="1""#
        ));
        assert!(!gives(r#"ATTRS{idVendor}=="2341", MODE="666""#));
    }

    #[test]
    fn free_room_is_the_fourth_column() {
        let said = "Filesystem 1024-blocks Used Available Capacity Mounted on\n\
                    /dev/vda 263174212 42880000 10485760 45% /\n";
        assert_eq!(free_mib(said), Some(10_240));
        assert_eq!(free_mib("df: no such file"), None);
    }
}
