//! Where it writes: regular files alone, whole or not at all.
#![cfg(unix)]

use std::os::unix::fs::{FileTypeExt, symlink};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{Place, RECORDING, SEQUENTIAL, TEXTURED, decisions, model};

/// Every command that writes, up to the name of its output.
const COMMANDS: [&str; 5] = [
    "record s.toml --out",
    "train --tables single --data r.csv --out",
    "train --data r.csv --out m --plot",
    "classify --model m --data r.csv --rule window --window 20 --out",
    "evaluate --model m --data r.csv --plot",
];

/// A scene that would take hours.
fn long() -> String {
    format!("{TEXTURED}{SEQUENTIAL}").replace("duration_s = 0.5", "duration_s = 1e5")
}

fn fifo(place: &Place, name: &str) -> PathBuf {
    let path = place.path(name);
    let made = Command::new("mkfifo").arg(&path).status().unwrap();
    assert!(made.success());
    path
}

/// Refused with these words, and the names in the folder stay what they are. (A pipe must
/// not be read, as [`Place::refuses`] reads all.)
#[track_caller]
fn refused(place: &Place, line: &str, naming: &str) {
    let ran = place.run(line);
    assert_eq!(ran.status, Some(2), "{line}: {ran:?}");
    assert!(ran.stderr.contains(naming), "{line}: {ran:?}");
}

/// A recording that took hours is not to become a model by a slip.
#[test]
fn no_command_writes_over_what_it_reads() {
    let place = Place::usual();
    place.write("m.svg", place.bytes("m"));
    for line in [
        "train --tables single --data r.csv --out ./r.csv",
        "train --data r.csv --out same.svg --plot same.svg",
        "classify --model m --data r.csv --rule window --window 20 --out r.csv",
        "classify --model m --data r.csv --rule window --window 20 --out m",
        "evaluate --model m.svg --data r.csv --plot m.svg",
        "record s.toml --out s.toml",
        "sweep s.toml --key rcp.gain=0.5 --out s.toml",
    ] {
        place.refuses(line, &["is another file of this command"]);
    }
}

/// Whoever reads the first line of a long table has read enough.
#[test]
fn a_reader_that_stops_is_no_fault() {
    let place = Place::usual();
    let mut command = place.command("record s.toml --set duration_s=5 --out -");
    let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    drop(child.stdout.take());
    let ended = child.wait_with_output().unwrap();
    assert!(ended.status.success(), "{ended:?}");
}

/// The same of what is said, as of figures and warnings, and of a table.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_a_fault() {
    let place = Place::usual();
    for line in ["columns", "record s.toml --out -"] {
        let full = std::fs::File::create("/dev/full").unwrap();
        let ended = place.command(line).stdout(full).output().unwrap();
        let said = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(ended.status.code(), Some(1), "{line}: {said}");
        assert!(said.contains("standard output: No space left"), "{said}");
    }
}

#[test]
fn pipes_links_folders_and_devices_are_refused_and_stay_what_they_are() {
    let place = Place::usual();
    let pipe = fifo(&place, "pipe.svg");
    symlink(place.path("r.csv"), place.path("link.svg")).unwrap();
    symlink(place.path("nowhere"), place.path("dangling.svg")).unwrap();
    std::fs::create_dir(place.path("folder.svg")).unwrap();
    for (name, what) in [
        ("pipe.svg", "is a pipe"),
        ("link.svg", "is a symbolic link"),
        ("dangling.svg", "is a symbolic link"),
        ("folder.svg", "is a folder"),
        ("/dev/null", "is a device"),
    ] {
        // What draws looks at the ending first.
        let fits = |command: &&str| !name.starts_with('/') || !command.ends_with("--plot");
        for command in COMMANDS.into_iter().filter(fits) {
            let naming = format!("{name}: {what}");
            refused(&place, &format!("{command} {name}"), &naming);
        }
    }
    let run = "run s.toml --out /dev/null";
    refused(&place, run, "a file is where its folder would be");
    let is = |path: &Path| std::fs::symlink_metadata(path).unwrap().file_type();
    assert!(is(&pipe).is_fifo());
    assert!(is(Path::new("/dev/null")).is_char_device());
    for link in ["link.svg", "dangling.svg"] {
        assert!(is(&place.path(link)).is_symlink());
    }
    assert!(!place.path("nowhere").exists());
    assert_eq!(place.text("r.csv"), RECORDING);
}

#[test]
fn files_of_a_run_are_refused_before_it() {
    let place = Place::usual();
    place.write("s.toml", long());
    place.write("the.model", model(2, 20, true));
    for name in ["trace.csv", "decisions.csv", "trace.png", "trace.svg"] {
        let folder = name.replace('.', "-");
        std::fs::create_dir(place.path(&folder)).unwrap();
        fifo(&place, &format!("{folder}/{name}"));
        let naming = format!("{folder}/{name}: is a pipe");
        refused(&place, &format!("run s.toml --out {folder}"), &naming);
        let left = std::fs::read_dir(place.path(&folder)).unwrap();
        assert_eq!(left.count(), 1);
    }
    refused(&place, "run s.toml --out -", "-: a run has several files");
}

#[test]
fn standard_output_has_a_table_and_nothing_else() {
    let place = Place::usual();
    place.done("record s.toml --out recorded.csv");
    let ran = place.run("record s.toml --out -");
    assert_eq!(ran.status, Some(0));
    assert_eq!(ran.stdout, place.text("recorded.csv"));
    assert!(ran.stderr.contains("200 samples"), "{ran:?}");
    place.done("train --tables single --data r.csv --block 2 --out two");
    let classify = "classify --model two --data r.csv --rule window --window 2 --out";
    let ran = place.run(&format!("{classify} -"));
    assert_eq!(decisions(&ran.stdout).len(), 4);
    assert!(ran.stderr.contains("4 decisions"), "{ran:?}");
    assert!(!place.path("-").exists());
    // A file of that name is a file.
    place.done(&format!("{classify} ./-"));
    assert_eq!(place.text("-"), ran.stdout);
    std::fs::remove_file(place.path("-")).unwrap();
    let train = "train --tables single --data r.csv --out -";
    place.refuses(train, &["-: standard output is not for this"]);
}

/// Those in a folder that are not complete, with their sizes.
fn partial(place: &Place) -> Vec<(PathBuf, u64)> {
    let entries = std::fs::read_dir(place.path("out")).into_iter().flatten();
    let files = entries.map(|entry| entry.unwrap());
    let partial = files.filter(|file| file.file_name().to_string_lossy().ends_with(".partial"));
    // One may go while it is looked at.
    let sized = partial.filter_map(|file| Some((file.path(), file.metadata().ok()?.len())));
    sized.collect()
}

/// Whether the process ignores a signal: a hang-up, where the tests themselves run under nohup.
fn ignores(id: &str, signal: i32) -> bool {
    let status = std::fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok());
    ignored.unwrap_or(0) >> (signal - 1) & 1 == 1
}

#[test]
fn an_interrupt_leaves_what_was_there_and_nothing_half_written() {
    for (signal, number) in [("HUP", 1), ("INT", 2), ("TERM", 15)] {
        let place = Place::with(&[("s.toml", &long()), ("out/trace.csv", "older")]);
        place.write("the.model", model(2, 20, true));
        let before = place.content();
        let mut command = place.command("run s.toml --out out");
        let command = command.stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let id = child.id().to_string();
        // In mid-run: some of the trace is on the disk.
        let since = Instant::now();
        while !partial(&place).iter().any(|(_, size)| *size > 1_000_000) {
            assert!(since.elapsed().as_secs() < 60, "nothing is written");
            std::thread::sleep(Duration::from_millis(10));
        }
        if ignores(&id, number) {
            println!("{signal} is ignored here, and by what is run");
            child.kill().unwrap();
            child.wait().unwrap();
            continue;
        }
        let killed = Command::new("kill").args(["-s", signal, &id]).status();
        assert!(killed.unwrap().success());
        let ended = child.wait_with_output().unwrap();
        assert_eq!(ended.status.signal(), Some(number), "{ended:?}");
        // The size of the trace is announced beforehand.
        let announced = String::from_utf8(ended.stderr).unwrap();
        let size = "textured: 100000 s to simulate, 200000000 ticks; the trace will have about ";
        assert!(announced.starts_with(size), "{announced}");
        assert_eq!(partial(&place), []);
        assert!(place.content() == before, "{signal}");
    }
}
