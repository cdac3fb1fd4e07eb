//! What Linux says of devices on USB; elsewhere they need no permission, and nothing is found.

use std::fs;
use std::path::{Path, PathBuf};

/// Who makes ST-LINKs, as USB has it.
const ST: &str = "0483";

/// A serial port of an ST-LINK.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct SerialPort {
    pub(crate) path: PathBuf,
    pub(crate) may_open: bool,
}

pub(super) fn serial_ports() -> Vec<SerialPort> {
    ports_in(Path::new("/sys/class/tty"), Path::new("/dev"))
}

fn ports_in(class: &Path, devices: &Path) -> Vec<SerialPort> {
    let Ok(entries) = fs::read_dir(class) else {
        return Vec::new();
    };
    let mut names: Vec<_> = entries
        .filter_map(|entry| Some(entry.ok()?.file_name()))
        .collect();
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
    let may_open = |path: &Path| {
        fs::File::options()
            .read(true)
            .write(true)
            .open(path)
            .is_ok()
    };
    let ports = ports.map(|path| SerialPort {
        may_open: may_open(&path),
        path,
    });
    ports.collect()
}

/// Whether rules of udev are there that let a user open an ST-LINK.
pub(super) fn has_rules() -> bool {
    let folders = [
        "/etc/udev/rules.d",
        "/usr/lib/udev/rules.d",
        "/lib/udev/rules.d",
    ];
    folders.iter().any(|folder| rules_in(Path::new(folder)))
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

    use super::{ports_in, rules_in};

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
        for (rule, gives) in [
            (
                "ATTRS{idVendor}==\"0483\", MODE=\"660\", TAG+=\"uaccess\"",
                true,
            ),
            ("# ATTRS{idVendor}==\"0483\", MODE=\"660\"", false),
            (
                "ATTRS{idVendor}==\"0483\", ENV{ID_MM_DEVICE_IGNORE}=\"1\"",
                false,
            ),
            ("ATTRS{idVendor}==\"2341\", MODE=\"666\"", false),
        ] {
            let folder = tempfile::tempdir().unwrap();
            fs::write(folder.path().join("69-some.rules"), format!("{rule}\n")).unwrap();
            assert_eq!(rules_in(folder.path()), gives, "{rule}");
        }
    }
}
