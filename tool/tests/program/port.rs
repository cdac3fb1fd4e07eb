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

use crate::common::{Place, contains, scene, scenes, words};
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
    place.holds("r.csv", "# scene = bench\n");
    place.holds("r.csv", "# firmware = 0.1.0\n");
    let sequences = place.column("r.csv", "sequence");
    assert!(sequences.len() >= 1_900, "{}", sequences.len());
    assert!(sequences.is_sorted_by(|a, b| a + 1.0 == *b));

    // The board is the next client's as it was the first's.
    let script = "0 gain left 0.5\n0.1 gain left 3\n0.2 setpoint left 70\n";
    place.write("script", script);
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
    place.write("off.toml", "[[event]]\nat_s = 4.0\nkind = \"power-off\"\n");
    let served = Served::with(&place, "--scenario off.toml");
    let ran = place.done(&format!("records {} --seconds 9 --out r.csv", served.port));
    ran.prints("starts of the module meanwhile: 1");
}

#[test]
fn what_a_board_that_goes_has_said_is_kept() {
    let place = Place::new();
    let mut served = Served::new(&place);
    let records = format!("records {} --seconds 100 --out r.csv", served.port);
    let mut listening = Command::new(env!("CARGO_BIN_EXE_whisker"))
        .args(words(&records))
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
    ran.prints("before, the module decides by no model: none was deployed");
    ran.prints(&format!("now it decides by model {crc:08x}, 4 classes\n"));
    // No reset arms a motor.
    assert!(!ran.stdout.contains(" touch "), "{}", ran.stdout);
    let armed = place.done(&format!("arm {}", served.port));
    armed.prints("armed, after tick ");
    let log = place.done(&format!("log {} --seconds 3", served.port));
    log.prints(" decision left ");
    let kept = place.bytes("kept.flash");
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
    let other = scene("bench.toml").replace("[sensor]", "[sensor]\nmodel = \"tmag5170\"");
    place.write("other.toml", &other);
    place.done(&format!("arm {port}"));
    place.fails(&format!("deploy {port} --scene other.toml"));
    place.done(&format!("arm {port}"));
    place.done(&format!("records {port} --seconds 2 --out r.csv"));
    let setpoints = place.column("r.csv", "setpoint_deg").into_iter();
    let most = setpoints.fold(0.0, f64::max);
    assert!(most > 80.0, "{most}");
}

#[test]
fn a_board_on_a_port_runs_the_scene_that_is_deployed() {
    let place = Place::new();
    let served = Served::new(&place);
    let port = &served.port;
    let other = scene("bench.toml").replace("\"bench\"", "\"other\"");
    place.write("other.toml", &other.replace("= 0.7", "= 0.9"));
    let silent = other.replace("serial_baud = 921600", "rtt = true");
    place.write("silent.toml", &silent);
    let silent = format!("deploy {port} --scene silent.toml");
    place.refuses(&silent, "telemetry.serial_baud: found none");

    let ran = place.done(&format!("deploy {port} --scene other.toml"));
    let lines: Vec<&str> = ran.stdout.lines().collect();
    assert_eq!(lines.len(), 4, "{lines:?}");
    assert!(lines[0].starts_with("before, the module runs scene bench ("));
    assert!(lines[2].starts_with("now it runs scene other ("));

    // What is set there stays until the next reset; it is read back.
    let port = format!("{port} --scene other.toml");
    let get = || place.done(&format!("get {port}")).stdout;
    place.done(&format!("set {port} rcp.gain=1.5 whisking.frequency_hz=3"));
    contains(&get(), ", with keys that were set");
    assert_eq!(get().matches("differs").count(), 2);
    place.done(&format!("save {port} --all"));
    place.holds("other.toml", "gain  = 1.5");
    place.holds("other.toml", "frequency_hz = 3");
    assert!(!get().contains("differs"));
}

#[test]
fn a_deployment_that_is_cut_off_leaves_the_scene_before() {
    let place = Place::new();
    let served = Served::new(&place);
    let status = || place.done(&format!("status {}", served.port)).stdout;
    let runs = |status: &str| {
        let mut lines = status.lines().map(str::to_owned);
        lines
            .find(|line| line.starts_with("runs scene bench ("))
            .unwrap()
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
    let (config, model) = (80, 0);
    let load = Load { config, model };
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
    let none = "it has no serial port; allowed: [telemetry] serial_baud";
    place.refuses("board bench.toml", none);
    place.refuses("log --port a --sim bench.toml", "cannot be used with");
}
