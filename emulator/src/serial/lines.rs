//! Touches and decisions that a board says by lines, and its pins, beside those of the same
//! module on the PC.

use firmware::lines::Context;
use firmware::{Event, Place};
use host_sim::Error;
use scene::Scene;

use crate::talk::{Talk, wrong};

/// For how long, s: some touches of every texture.
const LINES_S: f64 = 3.0;

/// For how long the pin of decisions is high, s.
const PULSE_S: f64 = 0.01;

/// How late a line may be complete after its tick: most of a health line of the same tick
/// before it, and it itself, at any baud that carries records.
const LATE_S: f64 = 0.003;

struct Due {
    tick: u32,
    line: String,
    /// The tick after which it had come.
    came: Option<u32>,
}

/// Lets both run; every touch and decision on the PC must be a line of the board, in time, and
/// shown by its pins.
pub(super) fn compare(talk: &mut Talk, scene: &Scene) -> Result<String, Error> {
    let [ticks, pulse, late] = [LINES_S, PULSE_S, LATE_S].map(|s| talk.pair.target.ticks_of(s));
    let mut due: Vec<Due> = Vec::new();
    let (mut at, mut healths) = (0, 0);
    let mut shown = [false; 2];
    let (mut touching, mut decided) = (Vec::new(), None);
    let mut raised = 0;
    for _ in 0..ticks {
        let from = talk.lines.len();
        talk.pass(1)?;
        talk.follow()?;
        let tick = talk.ticks;
        due.extend(expected(talk, scene, tick));
        if let Some(packet) = talk.packets.first() {
            return wrong(format!("not asked for: {packet:?}"));
        }
        for line in &talk.lines[from..] {
            let (_, text) = line.split_once(' ').unwrap_or_default();
            if text.starts_with("start ") || text.starts_with("health ") {
                healths += u32::from(text.starts_with("health "));
                first_or_healthy(text, scene)?;
                continue;
            }
            let Some(next) = due.get_mut(at) else {
                return wrong(format!("not so on the PC: {line:?}"));
            };
            if *line != next.line {
                return wrong(format!("said {line:?}, on the PC {:?}", next.line));
            }
            next.came = Some(tick);
            at += 1;
        }
        // Idle, which follows the tick, had brought the pins to what was so in the last one.
        if scene.telemetry.pins {
            let found = talk.pair.target.machine().chip().signals();
            if found != shown {
                return wrong(format!(
                    "in tick {tick} the pins are {found:?}, not {shown:?}"
                ));
            }
            note(talk.pair.host.events(), tick, &mut touching, &mut decided);
            let is_decided = decided.is_some_and(|then| tick - then < pulse);
            shown = [!touching.is_empty(), is_decided];
            raised += u32::from(is_decided);
        }
    }
    let is_overdue = |line: &&Due| line.came.unwrap_or(talk.ticks) > line.tick + late;
    if let Some(line) = due.iter().find(is_overdue) {
        return wrong(format!(
            "{:?} of tick {}: {:?}",
            line.line, line.tick, line.came
        ));
    }
    let of = |word: &str| due.iter().filter(|line| line.line.contains(word)).count();
    let (touches, decisions) = (of(" touch "), of(" decision "));
    if touches == 0 || decisions == 0 || healths + 1 < LINES_S as u32 {
        return wrong(format!(
            "{touches} touches, {decisions} decisions, {healths} times health"
        ));
    }
    let took = due.iter().filter_map(|line| Some(line.came? - line.tick));
    let took = took.max();
    let pins = if scene.telemetry.pins {
        format!("; pins as on the PC, {raised} ticks with a decision")
    } else {
        String::new()
    };
    Ok(format!(
        "{touches} touches and {decisions} decisions as on the PC, each within {} ticks{pins}",
        took.unwrap_or(0)
    ))
}

/// The lines of the PC's last tick.
fn expected(talk: &Talk, scene: &Scene, tick: u32) -> Vec<Due> {
    let host = &talk.pair.host;
    let names = host.classes();
    let due = host.events().iter().filter_map(|event| {
        let mut line = firmware::lines::at(tick, scene.tick_hz);
        let context = Context {
            class_name: |class: usize| names.get(class).map_or("", String::as_str),
            period_us: 1_000_000 / scene.tick_hz,
            lost: 0,
        };
        firmware::lines::event(&mut line, event, context)?;
        let line = String::from_utf8_lossy(line.ended()).trim_end().to_owned();
        let came = None;
        Some(Due { tick, line, came })
    });
    due.collect()
}

fn note(events: &[Event], tick: u32, touching: &mut Vec<Place>, decided: &mut Option<u32>) {
    for event in events {
        match event {
            Event::Touch { place, .. } => touching.push(*place),
            Event::TouchEnd { place, .. } => touching.retain(|touched| touched != place),
            Event::Decision(..) => *decided = Some(tick),
            _ => {}
        }
    }
}

/// The line of the start names version, scene and rate; that of health misses nothing.
fn first_or_healthy(text: &str, scene: &Scene) -> Result<(), Error> {
    let fields: Vec<&str> = text.split(' ').collect();
    let (version, hz) = (env!("CARGO_PKG_VERSION"), scene.tick_hz.to_string());
    let period = (1_000_000 / scene.tick_hz).to_string();
    let is_right = match fields[..] {
        ["start", found, name, rate, "power-up", "1", "0"] => {
            (found, name, rate) == (version, &*scene.name, &*hz)
        }
        ["health", worst, found, "0", "0", "0"] => {
            let is_within = |worst: f64| worst > 1.0 && worst < 500.0;
            found == period && worst.parse().is_ok_and(is_within)
        }
        _ => false,
    };
    if !is_right {
        return wrong(format!("{text:?}"));
    }
    Ok(())
}
