//! A board on a serial port: an emulated one, whose port is a pseudo-terminal.
#![cfg(unix)]

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use crate::common::{BENCH, Place, scenes, textures};

/// A board that is served; it ends when dropped.
struct Served {
    board: Child,
    /// `--port PATH --baud N`.
    port: String,
}

impl Served {
    fn new(place: &Place) -> Self {
        let scene = format!("{BENCH}[telemetry]\nserial_baud = 921600\n");
        place.write("serial.toml", &scene);
        Self::of(place, &place.path("serial.toml"), "")
    }

    /// Of a scene, with `more` arguments.
    fn of(place: &Place, scene: &Path, more: &str) -> Self {
        let mut board = Command::new(env!("CARGO_BIN_EXE_whisker"))
            .arg("board")
            .arg(scene)
            .args(more.split_whitespace())
            .current_dir(place.path(""))
            .arg("--link")
            .arg(place.path("port"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let mut said = BufReader::new(board.stdout.take().unwrap());
        said.read_line(&mut line).unwrap();
        let (path, baud) = line.trim().split_once(' ').unwrap();
        assert!(path.starts_with("/dev/"), "{path}");
        let port = format!("--port port --baud {baud}");
        Self { board, port }
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.board.kill();
        let _ = self.board.wait();
    }
}

#[test]
fn a_board_on_a_port_is_talked_with_as_any_other() {
    let place = Place::new();
    let mut served = Served::new(&place);
    // The person at this bench writes down what was done; the board is told by hand.
    writeln!(served.board.stdin.as_mut().unwrap(), "lay carpet").unwrap();
    let port = &served.port;
    let ran = place.done(&format!("records {port} --seconds 1 --out r.csv"));
    assert!(
        ran.stdout
            .contains(" records at 2000 ticks a second, 0 lost"),
        "{}",
        ran.stdout
    );
    let table = place.text("r.csv");
    assert!(table.contains("# scene = bench\n"), "{table}");
    assert!(table.contains("# firmware = 0.1.0\n"), "{table}");
    let rows = table
        .lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    let sequences = rows.map(|row| row.split(',').next().unwrap().parse::<u32>().unwrap());
    let sequences: Vec<u32> = sequences.collect();
    assert!(sequences.len() >= 1_900, "{}", sequences.len());
    assert!(sequences.is_sorted_by(|a, b| a + 1 == *b));

    // The board is the next client's as it was the first's.
    place.write(
        "script",
        "0 gain left 0.5\n0.1 gain left 3\n0.2 setpoint left 70\n",
    );
    let ran = place.run(&format!("log {port} --seconds 1.5 --script script"));
    assert_eq!(ran.status, Some(1), "{}", ran.stderr);
    for said in [
        "gain left 0.5: done\n",
        "gain left 3: value out of range\n",
        "setpoint left 70: done\n",
        " us of 500; missed 0, events dropped 0\n",
    ] {
        assert!(ran.stdout.contains(said), "{said}{}", ran.stdout);
    }
}

#[test]
fn a_board_on_a_port_is_taught_without_a_probe() {
    let place = Place::new();
    let scene = scenes("bench.toml");
    let world = textures();
    let more = [
        &*format!("--world {}", world.display()),
        "--flash kept.flash",
    ];
    let served = Served::of(&place, &scene, &more.join(" "));
    let model = scenes("models/textures.model");
    let deploy = format!("deploy {} --model {}", served.port, model.display());
    let ran = place.done(&format!("{deploy} --seconds 3"));
    let crc = std::fs::read(&model).unwrap();
    let crc = u32::from_le_bytes(*crc.last_chunk().unwrap());
    for said in [
        "before, the module decides by no model: none was deployed".to_owned(),
        format!("now it decides by model {crc:08x}, 4 classes\n"),
        "decision: ".to_owned(),
    ] {
        assert!(ran.stdout.contains(&said), "{said}{}", ran.stdout);
    }
    let kept = std::fs::read(place.path("kept.flash")).unwrap();
    assert!(kept.starts_with(&std::fs::read(&model).unwrap()));
    // It may be another then.
    let again = place.done(&deploy);
    assert!(again.stdout.contains("before, the module decides by model"));
}

#[test]
fn ports_and_scenes_that_are_none_are_refused() {
    let place = Place::new();
    let told = place.refused("log --port no-such-port --seconds 1");
    assert!(told.contains("no-such-port"), "{told}");
    let told = place.refused("board bench.toml");
    assert!(
        told.contains("it has no serial port; allowed: [telemetry] serial_baud"),
        "{told}"
    );
    let told = place.refused("log --port a --sim bench.toml");
    assert!(told.contains("cannot be used with"), "{told}");
}
