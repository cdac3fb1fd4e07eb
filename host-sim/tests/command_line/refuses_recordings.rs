//! Recordings that are wrong, for training and for classifying: status 2, file
//! and line, and nothing written.

use crate::common::{Place, RECORDING, model};

const TRAIN: &str = "train --data r.csv";
const CLASSIFY: &str = "classify --model m --data r.csv --rule window --window 20";

#[track_caller]
fn refused_by_both(recording: impl AsRef<[u8]>, naming: &[&str]) {
    let place = Place::usual();
    place.write("r.csv", recording);
    let naming = [&["r.csv: "], naming].concat();
    place.refuses_to_write(TRAIN, &naming);
    place.refuses_to_write(CLASSIFY, &naming);
}

fn with_row(row: &[u8]) -> Vec<u8> {
    let rows: Vec<&[u8]> = RECORDING.lines().map(str::as_bytes).collect();
    let rows = [&rows[..3], &[row], &rows[4..]].concat();
    rows.join(&b'\n')
}

#[test]
fn files_that_are_no_recording() {
    let place = Place::usual();
    place.write("folder/file", "");
    for name in ["none.csv", "folder"] {
        for command in [TRAIN, CLASSIFY] {
            let command = command.replace("r.csv", name);
            place.refuses_to_write(&command, &[&format!("{name}: ")]);
        }
    }
    refused_by_both("", &["line 1", "label"]);
    refused_by_both("\n\n\n", &["line 1", "label"]);
    refused_by_both(model(2, 20, true), &[]);
}

/// What can be classified but teaches nothing.
#[test]
fn lessons_without_content() {
    let refused = |recording: &str, naming: &[&str]| {
        let place = Place::usual();
        place.write("r.csv", recording);
        place.refuses_to_write(TRAIN, &[&["r.csv: "], naming].concat());
        place.done(&format!("{CLASSIFY} --out d.csv"));
    };
    let replaced = |from: &str, to: &str| RECORDING.replace(from, to);
    refused(&replaced("high", "low"), &["one class"]);
    let many: Vec<String> = (0..33).map(|n| format!("class{n},0,{n},0")).collect();
    let many = format!("label,trial,x,y\n{}", many.join("\n"));
    refused(&many, &["more than 32 classes"]);
    refused(&replaced("low", &"l".repeat(256)), &["class name of 256"]);
    // What a decision for none of the classes says.
    refused(&replaced("low", "unknown"), &["unknown", "--unknown"]);
    let wide = replaced("9000", "1e308").replace("100,8000", "-1e308,8000");
    refused(&wide, &["x: its range"]);
    let narrow = replaced("8000", "0").replace("8100", "1e-300");
    refused(&narrow, &["y: its range"]);
}

#[test]
fn labels_that_could_forge_a_line_or_a_formula() {
    let red = r#"line 4: label "\u{1b}[31mred" has the character '\u{1b}'"#;
    refused_by_both(with_row(b"\x1b[31mred,0,1,2"), &[red]);
    let formula = "line 4: trial \"=cmd|' /C calc'!A0\" begins with '='";
    refused_by_both(with_row(b"low,=cmd|' /C calc'!A0,1,2"), &[formula]);
}

#[cfg(unix)]
#[test]
fn nothing_of_others_commands_the_terminal() {
    let place = Place::new();
    for line in [
        "run \x1b[2J\u{9b}.toml",
        "train --data \x1b[2J.csv --out \u{202e}m",
        "classify --rule \x1b[2J",
        "run s.toml --set \x1b[2J=1 --out o",
    ] {
        let ran = place.run(line);
        assert_eq!(ran.status, Some(2), "{line:?}");
        let seen = ran.stderr.replace('\n', "");
        assert!(!seen.contains(tactile::name::is_hidden), "{seen:?}");
    }
}

#[cfg(unix)]
#[test]
fn devices_pipes_and_what_is_too_large_are_refused_at_once() {
    let place = Place::usual();
    let made = std::process::Command::new("mkfifo")
        .arg(place.path("fifo"))
        .status();
    assert!(made.unwrap().success());
    let large = std::fs::File::create(place.path("large")).unwrap();
    large.set_len(1 << 40).unwrap();
    for (name, why) in [
        ("/dev/zero", "not a regular file"),
        ("fifo", "not a regular file"),
        ("large", "larger than "),
    ] {
        for line in [
            "run FILE --out o",
            "record FILE --out o",
            "train --data FILE --out o",
            "classify --model m --data FILE --rule window --window 20 --out o",
            "classify --model FILE --data r.csv --rule window --window 20 --out o",
            "evaluate --model m --data FILE",
        ] {
            let line = line.replace("FILE", name);
            let ran = place.run(&line);
            assert_eq!(ran.status, Some(2), "{line}: {ran:?}");
            assert!(ran.stderr.contains(&format!("{name}: ")), "{line}: {ran:?}");
            assert!(ran.stderr.contains(why), "{line}: {ran:?}");
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_recording_may_come_through_a_pipe_of_the_shell() {
    let place = Place::new();
    place.write("r.csv", RECORDING);
    place.done("train --tables single --data r.csv --out m --block 2");
    let line = format!(
        "cat r.csv | {} train --tables single --data /dev/stdin --out piped --block 2",
        env!("CARGO_BIN_EXE_host-sim")
    );
    let mut shell = std::process::Command::new("sh");
    let done = shell.args(["-c", &line]).current_dir(place.path("."));
    assert!(done.output().unwrap().status.success());
    assert_eq!(place.bytes("piped"), place.bytes("m"));
}
