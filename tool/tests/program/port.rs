//! A board on a serial port: an emulated one, whose port is a pseudo-terminal.
#![cfg(unix)]

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use firmware::Packet;
use firmware::boards::NUCLEO_F446RE;
use host_sim::received::Receiver;
use serial2::SerialPort;
use wire::{Command as Request, CommandStatus, Load, TaggedCommand};

use crate::common::{Place, scenes, words};
use crate::monitor::terminal::Terminal;

/// The scene that all boards here are built with: its program is then built once.
const BOARD: &str = "board @bench.toml --world @textures.toml";

/// A board that is served; it ends when dropped.
struct Served {
    board: Child,
    /// `--port PATH --baud N`.
    port: String,
}

impl Served {
    fn new(place: &Place) -> Self {
        Self::with(place, "")
    }

    fn with(place: &Place, more: &str) -> Self {
        let mut board = Command::new(env!("CARGO_BIN_EXE_whisker"))
            .args(words(BOARD))
            .args(words(more))
            .args(["--link", "port"])
            .current_dir(place.path(""))
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
    // The person at this bench writes down what was done; the board gets it by hand.
    writeln!(served.board.stdin.as_mut().unwrap(), "lay carpet").unwrap();
    let port = &served.port;
    let ran = place.done(&format!("records {port} --seconds 1 --out r.csv"));
    ran.prints(" records at 2000 ticks a second, 0 lost");
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
    let ran = place.fails(&format!("log {port} --seconds 1.5 --script script"));
    for said in [
        "gain left 0.5: done\n",
        "gain left 3: value out of range\n",
        "setpoint left 70: done\n",
        " 500 0 0 0\n",
    ] {
        ran.prints(said);
    }
}

/// No key is lost to whoever would lay samples.
#[test]
fn one_key_stops_a_board_on_a_port() {
    let place = Place::new();
    let served = Served::new(&place);
    let line = format!("monitor {}", served.port);
    for _ in 0..3 {
        let mut seen = Terminal::start(&place, &line, (80, 24), &[]);
        seen.wait_for("live");
        seen.press(b"a");
        seen.wait_for("[ARMED]");
        seen.press(b"x");
        seen.wait_for("stop: done");
        seen.press(b"q");
        assert_eq!(seen.ends(), Some(0));
    }
}

#[test]
fn a_board_that_is_reset_is_asked_for_records_again() {
    let place = Place::new();
    place.write("off.toml", "[[event]]\nat_s = 10.0\nkind = \"power-off\"\n");
    let served = Served::with(&place, "--scenario off.toml");
    let ran = place.done(&format!("records {} --seconds 18 --out r.csv", served.port));
    ran.prints("starts of the module meanwhile: 1");
}

#[test]
fn what_a_board_that_goes_has_said_is_kept() {
    let place = Place::new();
    let mut served = Served::new(&place);
    let mut listening = Command::new(env!("CARGO_BIN_EXE_whisker"))
        .args(words(&format!(
            "records {} --seconds 100 --out r.csv",
            served.port
        )))
        .current_dir(place.path(""))
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_secs(4));
    served.board.kill().unwrap();
    assert_eq!(listening.wait().unwrap().code(), Some(1));
    let rows = place.text("r.csv").lines().count();
    assert!(rows > 1_000, "{rows}");
}

#[test]
fn a_board_on_a_port_is_taught_without_a_probe() {
    let place = Place::new();
    let served = Served::with(&place, "--flash kept.flash");
    let deploy = format!("deploy {} --model @models/textures.model", served.port);
    let ran = place.done(&format!("{deploy} --seconds 3"));
    let model = std::fs::read(scenes("models/textures.model")).unwrap();
    let crc = u32::from_le_bytes(*model.last_chunk().unwrap());
    for said in [
        "before, the module decides by no model: none was deployed".to_owned(),
        format!("now it decides by model {crc:08x}, 4 classes\n"),
    ] {
        ran.prints(&said);
    }
    // No reset arms a motor.
    assert!(!ran.stdout.contains(" touch "), "{}", ran.stdout);
    let armed = place.done(&format!("arm {}", served.port));
    armed.prints("armed, after tick ");
    let log = place.done(&format!("log {} --seconds 3", served.port));
    log.prints(" decision left ");
    let kept = std::fs::read(place.path("kept.flash")).unwrap();
    let [first, second] = NUCLEO_F446RE.flash.slots;
    let of_models = [first, second].map(|slot| {
        let at = (slot.model.start - first.head.start) as usize;
        &kept[at..at + model.len()]
    });
    // In the slot by which the board did not run.
    assert_eq!(of_models.map(|of| of == model), [false, true]);
    // It may be another then.
    let again = place.done(&deploy);
    again.prints("before, the module decides by model");
}

/// Its whiskers are held while it is asked.
#[test]
fn a_board_that_refuses_a_scene_whisks_again_once_it_is_armed() {
    let place = Place::new();
    let served = Served::new(&place);
    let port = &served.port;
    let scene = std::fs::read_to_string(scenes("bench.toml")).unwrap();
    let other = scene.replace("[sensor]", "[sensor]\nmodel = \"tmag5170\"");
    assert_ne!(other, scene);
    place.write("other.toml", &other);
    place.done(&format!("arm {port}"));
    place.fails(&format!("deploy {port} --scene other.toml"));
    place.done(&format!("arm {port}"));
    place.done(&format!("records {port} --seconds 2 --out r.csv"));
    let table = place.text("r.csv");
    let mut rows = table.lines().filter(|line| !line.starts_with('#'));
    let mut names = rows.next().unwrap().split(',');
    let column = names.position(|name| name == "setpoint_deg").unwrap();
    let setpoints = rows.map(|row| row.split(',').nth(column).unwrap().parse::<f64>().unwrap());
    let most = setpoints.fold(0.0, f64::max);
    assert!(most > 80.0, "{most}");
}

#[test]
fn a_board_on_a_port_runs_the_scene_that_is_deployed() {
    let place = Place::new();
    let served = Served::new(&place);
    let port = &served.port;
    let scene = std::fs::read_to_string(scenes("bench.toml")).unwrap();
    let other = scene.replace("\"bench\"", "\"other\"");
    place.write("other.toml", &other.replace("= 0.7", "= 0.9"));
    let silent = other.replace("serial_baud = 921600", "rtt = true");
    place.write("silent.toml", &silent);
    place.refuses(
        &format!("deploy {port} --scene silent.toml"),
        "telemetry.serial_baud: found none",
    );

    let ran = place.done(&format!("deploy {port} --scene other.toml"));
    let lines: Vec<&str> = ran.stdout.lines().collect();
    let [before, _, now, _] = lines[..] else {
        panic!("{lines:?}");
    };
    assert!(before.starts_with("before, the module runs scene bench ("));
    assert!(now.starts_with("now it runs scene other ("), "{now}");

    // What is set there stays until the next reset; it is read back.
    place.done(&format!(
        "set {port} --scene other.toml rcp.gain=1.5 whisking.frequency_hz=3"
    ));
    let get = place.done(&format!("get {port} --scene other.toml")).stdout;
    assert!(get.contains(", with keys that were set"), "{get}");
    assert_eq!(get.matches("differs").count(), 2, "{get}");
    place.done(&format!("save {port} --scene other.toml --all"));
    let saved = place.text("other.toml");
    assert!(
        saved.contains("gain  = 1.5") && saved.contains("frequency_hz = 3"),
        "{saved}"
    );
    let get = place.done(&format!("get {port} --scene other.toml")).stdout;
    assert!(!get.contains("differs"), "{get}");
}

/// The sensor hangs on the board as before, whatever scene the board has.
#[test]
fn a_sensor_that_sums_otherwise_than_the_scene_has_it_is_found() {
    let place = Place::new();
    let served = Served::new(&place);
    let bringup = format!(
        "bringup {} --frames 60 --yes --steps frames --json seen.json",
        served.port
    );
    let ran = place.done(&bringup);
    ran.prints("means: the sensor answers, as the scene has it\n");
    let scene = std::fs::read_to_string(scenes("bench.toml")).unwrap();
    let keys = "[sensor]\nsum_rule = \"not-b1-b6\"";
    place.write("other.toml", &scene.replacen("[sensor]", keys, 1));
    place.done(&format!("deploy {} --scene other.toml", served.port));
    let ran = place.fails(&bringup);
    ran.prints(
        "frames left: the sum is another than the scene has: set sensor.sum_rule = \"b1-b6\"\n",
    );
    let seen = place.text("seen.json");
    assert!(seen.contains("\"sum_rule\": \"b1-b6\""), "{seen}");
}

#[test]
fn a_deployment_that_is_cut_off_leaves_the_scene_before() {
    let place = Place::new();
    let served = Served::new(&place);
    let status = || place.done(&format!("status {}", served.port)).stdout;
    let runs = |status: &str| {
        let line = status
            .lines()
            .find(|line| line.starts_with("runs scene bench ("));
        line.unwrap().to_owned()
    };
    let before = status();
    let line = SerialPort::open(place.path("port"), 921_600).unwrap();
    let mut receiver = Receiver::default();
    let mut ask = |tag, command| {
        let request = TaggedCommand { tag, command };
        line.write_all(&wire::frame(&request)).unwrap();
        loop {
            let mut bytes = [0; 1024];
            let count = line.read(&mut bytes).unwrap();
            for packet in receiver.packets(&bytes[..count]) {
                if let Packet::Answer(answer) = packet
                    && answer.tag == tag
                {
                    return answer.status;
                }
            }
        }
    };
    // Whoever deploys has switched the motors off.
    assert_eq!(ask(1, Request::Stop), CommandStatus::Done);
    let load = Load {
        config: 80,
        model: 0,
    };
    assert_eq!(ask(2, Request::Load(load)), CommandStatus::Done);
    for number in 0..20 {
        let word = Request::Word(number, 0x1234_5678);
        assert_eq!(ask(3 + u16::from(number), word), CommandStatus::Done);
    }
    drop(line);
    let after = status();
    assert_eq!(runs(&after), runs(&before));
    let ticks = |status: &str| -> u32 {
        let line = status.lines().nth(2).unwrap();
        line.split(' ').next().unwrap().parse().unwrap()
    };
    // It has started again.
    assert!(ticks(&after) < 20_000, "{after}");
}

#[test]
fn ports_and_scenes_that_are_none_are_refused() {
    let place = Place::new();
    place.refuses("log --port no-such-port --seconds 1", "no-such-port");
    place.refuses(
        "board bench.toml",
        "it has no serial port; allowed: [telemetry] serial_baud",
    );
    place.refuses("log --port a --sim bench.toml", "cannot be used with");
}
