//! Faults from files: what tests/scenarios lists befalls a board's own program, and what became of
//! it must be within bounds.

use std::path::PathBuf;
use std::process::Command;

use serde_json::Value;

use crate::emulate::{Emulated, variants};
use crate::firmware::Board;
use crate::run::{AT_ONCE, Fault, no_faults, read, run_at_once, target, top};

/// What must be so.
enum Bound {
    /// The number under this key is at most, or at least, so much.
    Most(&'static str, f64),
    Least(&'static str, f64),
    /// There is a fault, or none.
    Fault(bool),
    /// An event of one of these kinds comes after so many seconds.
    Said(&'static [&'static str], f64),
    Numbered(&'static str, u64),
    NeverSaid(&'static str),
    Off,
}

use Bound::{Fault as Faults, Least, Most, NeverSaid, Numbered, Off, Said};

/// A file of tests/scenarios, the keys of [`SCENE`] that are set for it, and what must be so.
struct Row {
    file: &'static str,
    set: &'static [&'static str],
    bounds: &'static [Bound],
}

/// What a lab flashes, which names no model.
const SCENE: &str = crate::emulate::BENCH;

const BOARD: Board = Board::ALL[0];

/// A simulated motor, and nothing within reach.
const PLANT: &[&str] = &[
    "plant.kind=textured",
    "plant.obstacle_deg=[300.0]",
    "plant.stiffness=0.01",
    "plant.textures=['smooth']",
    "plant.present_s=1000.0",
];
/// It never leaves its whisk by more than this, degrees.
const INSIDE: Bound = Most("worst_outside_deg", 20.0);
/// It is off so soon after 5 degrees between its angle and its setpoint, s.
const SOON: Bound = Most("off_after_5deg_s", 0.1);
/// Nothing but what the protocol of the fault allows.
const STAYS_OFF: Bound = Most("driven_with_fault_s", 0.0);
const STOPPED: &[Bound] = &[
    Least("stops", 1.0),
    Most("stops_late", 0.0),
    Most("driven_after_stop_s", 0.0),
    Most("stop_to_off_ticks", 1.0),
    Least("answers/ok stop", 1.0),
    Off,
];
/// What is no fault of the module, and what it must bear.
const WHISKS_ON: &[Bound] = &[Faults(false), INSIDE, Least("driven_s", 3.0)];

/// Rows that are not within their bounds yet. One that is, must not stand here.
const OPEN: &[&str] = &["scaled-encoder", "slipping-encoder"];

const fn row(file: &'static str, set: &'static [&'static str], bounds: &'static [Bound]) -> Row {
    Row { file, set, bounds }
}

/// Whiskers with the other sensor, which a program of its own reads.
const TILT: &[&str] = &["sensor.model=tmag5170"];

const fn tilt(file: &'static str, bounds: &'static [Bound]) -> Row {
    row(file, TILT, bounds)
}

/// Two boards, a whisker each.
const HEAD: &[&str] = &[
    "head.nodes=2",
    "head.sides=both",
    "whisking.coupling=true",
    "whisking.start=[[1.0, 0.0], [1.0, 0.0]]",
    "plant.obstacle_deg=[300.0, 300.0]",
];
/// A setpoint moves a quarter more a tick than the 0.3046 degrees of whiskers that nothing befalls.
const NO_STEP: Bound = Most("largest_step_deg", 0.381);
/// Phases are the same again within two whisks.
const RELOCKS: Bound = Most("relocked_s", 1.0);
/// A board waits for 100 ms and for 128 times eleven bits, which a bus that is half busy has in ten.
const COMES_BACK: Bound = Most("nodes/1/longest_off_s", 0.12);

const fn head(file: &'static str, bounds: &'static [Bound]) -> Row {
    row(file, HEAD, bounds)
}

const ROWS: &[Row] = &[
    row("whisking", &[], WHISKS_ON),
    row("whisking", &["whisking.frequency_hz=0.2"], WHISKS_ON),
    row(
        "stuck-encoder",
        &[],
        &[Faults(true), INSIDE, SOON, STAYS_OFF],
    ),
    row(
        "stuck-encoder",
        &["motor.on_fault=stop-all"],
        &[Faults(true), INSIDE, SOON, STAYS_OFF],
    ),
    row(
        "jittering-encoder",
        &[],
        &[Faults(true), INSIDE, SOON, STAYS_OFF],
    ),
    row(
        "jittering-encoder",
        &["whisking.frequency_hz=0.5"],
        &[Faults(true), INSIDE, SOON],
    ),
    row(
        "jittering-encoder",
        &["whisking.frequency_hz=8.0"],
        &[Faults(true), INSIDE, SOON],
    ),
    row(
        "jittering-encoder",
        &["motor.driver=six-step"],
        &[Faults(true), INSIDE, SOON],
    ),
    row(
        "opened-limits",
        &[],
        &[
            Least(
                "answers/refused apply: guards of the motor: out of range",
                2.0,
            ),
            Most("answers/ok apply", 0.0),
            Faults(true),
            INSIDE,
            SOON,
            STAYS_OFF,
        ],
    ),
    row(
        "widened-limits",
        &[],
        &[
            Least(
                "answers/refused apply: guards of the motor: changes only while no motor is armed",
                5.0,
            ),
            Faults(true),
            INSIDE,
            SOON,
            STAYS_OFF,
        ],
    ),
    row(
        "wild-gains",
        &[],
        &[
            Least("answers/refused apply: motor.kp: out of range", 5.0),
            Faults(false),
            INSIDE,
            Least("driven_s", 3.0),
        ],
    ),
    row("noisy-encoder", &[], WHISKS_ON),
    row(
        "reversed-encoder",
        &[],
        &[Faults(true), INSIDE, SOON, STAYS_OFF],
    ),
    row(
        "scaled-encoder",
        &[],
        &[Faults(true), Most("at_stop_s", 0.0)],
    ),
    row(
        "slipping-encoder",
        &[],
        &[Faults(true), INSIDE, Most("at_stop_s", 0.0)],
    ),
    row(
        "creeping-encoder",
        &["motor.rest=find"],
        // To the end stop it is 90 degrees. At the other one it rests once it has found that.
        &[
            Said(&["fault", "limit"], 1.0),
            Most("max_following_deg", 45.0),
            Said(&["off"], 1.0),
        ],
    ),
    row("stop-under-gains", &[], STOPPED),
    row("stop-under-flood", &[], STOPPED),
    row("probe-stop-under-flood", &[], STOPPED),
    row("stop-beside-arming", &[], &[Least("answers/ok stop", 20.0)]),
    row(
        "reset-after-stop",
        &[],
        &[Most("driven_after_stop_s", 0.0), Off],
    ),
    row(
        "summed-otherwise",
        &[],
        &[
            Faults(true),
            Said(&["fault"], 0.0),
            Said(&["frame"], 0.0),
            Most("driven_s", 0.1),
        ],
    ),
    row(
        "summed-otherwise",
        &["sensor.sum_rule=not-b0-b6", "sensor.byte_order=high-first"],
        WHISKS_ON,
    ),
    row(
        "restarts-otherwise",
        &[],
        &[
            Numbered("self-test", 16),
            Numbered("self-test", 0),
            Numbered("fault", 21),
        ],
    ),
    row("rested-longer", &[], &[Faults(true), Most("driven_s", 0.1)]),
    row("rested-longer", &["tick_hz=1000"], WHISKS_ON),
    row(
        "power-lost-after-stop",
        &[],
        &[Most("driven_after_stop_s", 0.0), Off],
    ),
    row(
        "power-lost",
        &[],
        &[INSIDE, Least("driven_s", 0.5), Most("at_stop_s", 0.0), Off],
    ),
    row("arming-again", &[], &[INSIDE, Most("at_stop_s", 0.0)]),
    row(
        "hand-while-homing",
        &["motor.rest=find", "motor.arm=on-command"],
        // It rests where it met what it should not, and whisks nowhere but about its setpoint.
        &[Faults(true), Most("max_following_deg", 25.0)],
    ),
    row("friction", &["whisking.frequency_hz=0.5"], WHISKS_ON),
    row("much-friction", &["whisking.frequency_hz=0.5"], WHISKS_ON),
    row("much-friction", &[], WHISKS_ON),
    row(
        "finger",
        &[],
        &[INSIDE, NeverSaid("off"), Least("driven_s", 2.5)],
    ),
    row(
        "touches",
        &[],
        &[INSIDE, NeverSaid("off"), Least("driven_s", 4.0)],
    ),
    row("low-supply", &[], &[INSIDE, Most("at_stop_s", 0.0)]),
    row("magnet-gone", &[], &[Said(&["fault", "limit"], 1.0)]),
    row("sensor-gone", &[], &[Faults(true), INSIDE, STAYS_OFF]),
    row(
        "sensor-frozen",
        &[],
        &[Numbered("fault", 24), INSIDE, STAYS_OFF],
    ),
    row(
        "sensor-garbled",
        &[],
        &[Numbered("fault", 21), INSIDE, STAYS_OFF],
    ),
    tilt("sensor-gone", &[Numbered("fault", 27), INSIDE, STAYS_OFF]),
    tilt("sensor-frozen", &[Numbered("fault", 24), INSIDE, STAYS_OFF]),
    tilt(
        "sensor-garbled",
        &[Numbered("fault", 29), INSIDE, STAYS_OFF],
    ),
    tilt("sensor-restart", WHISKS_ON),
    tilt("magnet-gone", &[Numbered("fault", 31), INSIDE, STAYS_OFF]),
    tilt(
        "magnet-near",
        &[Numbered("limit", 36), Faults(false), INSIDE],
    ),
    head(
        "head-reset",
        &[
            NO_STEP,
            RELOCKS,
            Least("nodes/1/resets", 1.0),
            Least("nodes/0/driven_s", 2.95),
            // Of the first 1.3 s and the last 0.7.
            Least("nodes/1/driven_s", 1.95),
            Most("nodes/1/driven_s", 2.0),
        ],
    ),
    head(
        "head-cut",
        &[
            NO_STEP,
            RELOCKS,
            Least("nodes/1/most_transmit_errors", 128.0),
            Most("nodes/1/bus_offs", 0.0),
            Most("nodes/0/unused_messages", 4.0),
            Least("nodes/0/driven_s", 2.55),
            Least("nodes/1/driven_s", 2.55),
        ],
    ),
    head(
        "head-noise",
        &[
            NO_STEP,
            RELOCKS,
            COMES_BACK,
            Least("nodes/1/bus_offs", 2.0),
            Most("nodes/1/errors_at_end/0", 8.0),
            Most("nodes/0/unused_messages", 4.0),
            Least("nodes/0/driven_s", 2.55),
            Least("nodes/1/driven_s", 2.55),
        ],
    ),
    head(
        "head-stop",
        &[
            Least("nodes/0/driven_s", 0.95),
            Most("stop_to_off_ticks", 4.0),
            Off,
        ],
    ),
    // For 600 ticks it is cut off, and a stop is said again every 20.
    head("head-stop-cut", &[Most("stop_to_off_ticks", 624.0), Off]),
    head("head-lost", &[NO_STEP, Least("nodes/1/driven_s", 2.45)]),
    row("two-faults", &[], &[Faults(true), INSIDE, STAYS_OFF]),
];

impl Bound {
    fn broken(&self, json: &Value) -> Option<String> {
        let number = |key: &str| {
            let value = json.pointer(&format!("/{key}"));
            value.and_then(Value::as_f64).unwrap_or(0.0)
        };
        let events = || json["events"].as_array().into_iter().flatten();
        let first = &json["first_fault"];
        match *self {
            Most(key, most) => {
                let found = number(key);
                (found > most).then(|| format!("{key}: found {found:.4}, at most {most}"))
            }
            Least(key, least) => {
                let found = number(key);
                (found < least).then(|| format!("{key}: found {found:.4}, at least {least}"))
            }
            Faults(true) => first.is_null().then(|| "no fault".to_owned()),
            Faults(false) => (!first.is_null()).then(|| format!("fault {first}")),
            Said(kinds, after_s) => {
                let is_it = |event: &Value| {
                    let kind = event["kind"].as_str().unwrap_or_default();
                    kinds.contains(&kind) && event["t_s"].as_f64() > Some(after_s)
                };
                let is_said = events().any(is_it);
                (!is_said).then(|| format!("nothing of {} after {after_s} s", kinds.join(", ")))
            }
            Numbered(kind, number) => {
                let is_it = |event: &Value| event["kind"] == kind && event["number"] == number;
                let is_said = events().any(is_it);
                (!is_said).then(|| format!("no {kind} {number}"))
            }
            NeverSaid(kind) => {
                let is_said = events().any(|event| event["kind"] == kind);
                is_said.then(|| format!("an event \"{kind}\""))
            }
            Off => (json["armed_at_end"] != false).then(|| "armed at the end".to_owned()),
        }
    }
}

impl Row {
    fn name(&self) -> String {
        if self.set == HEAD {
            return self.file.to_owned();
        }
        [&[self.file], self.set].concat().join(" ")
    }

    fn json(&self) -> PathBuf {
        let name = self.name().replace([' ', '.', '='], "-");
        target().join(format!("scenarios/{name}.json"))
    }

    fn command(&self, on: &Emulated) -> Result<Command, Fault> {
        let set: Vec<String> = [PLANT, self.set]
            .concat()
            .iter()
            .map(|&key| key.to_owned())
            .collect();
        let scene = variants::with(&top().join(SCENE), &set)?;
        let file = top().join(format!("tests/scenarios/{}.toml", self.file));
        let linked = Emulated::linked(BOARD);
        let on = if self.set == TILT { &linked } else { on };
        crate::emulate::trying(on, &scene, &file, None, &self.json())
    }

    fn judged(&self) -> Result<Option<String>, Fault> {
        let path = self.json();
        let json = serde_json::from_str(&read(&path)?);
        let json: Value = json.map_err(|error| format!("{}: {error}", path.display()))?;
        let broken: Vec<String> = self
            .bounds
            .iter()
            .filter_map(|bound| bound.broken(&json))
            .collect();
        Ok((!broken.is_empty()).then(|| broken.join("; ")))
    }
}

/// What CI runs each time: one row of each kind, which takes a minute in all.
const SHORT: &[&str] = &[
    "stuck-encoder",
    "jittering-encoder whisking.frequency_hz=0.5",
    "reversed-encoder",
    "opened-limits",
    "wild-gains",
    "summed-otherwise",
    "restarts-otherwise",
    "stop-under-flood",
    "probe-stop-under-flood",
    "reset-after-stop",
    "finger",
    "magnet-gone",
    "magnet-near sensor.model=tmag5170",
    "sensor-garbled sensor.model=tmag5170",
    "sensor-restart sensor.model=tmag5170",
    "head-stop-cut",
    "head-noise",
];

pub(crate) fn short() -> Result<(), Fault> {
    rows(
        ROWS.iter()
            .filter(|row| SHORT.contains(&&*row.name()))
            .collect(),
    )
}

pub(crate) fn all() -> Result<(), Fault> {
    rows(ROWS.iter().collect())
}

fn rows(rows: Vec<&Row>) -> Result<(), Fault> {
    let on = Emulated::deployed(BOARD)?;
    crate::run::write(&target().join("scenarios/.here"), "")?;
    let commands = rows.iter().map(|row| row.command(&on));
    run_at_once(commands.collect::<Result<_, _>>()?, AT_ONCE)?;
    let mut faults = Vec::new();
    for row in rows {
        let name = row.name();
        match (row.judged()?, OPEN.contains(&&*name)) {
            (None, false) => println!("as it should be: {name}"),
            (Some(broken), true) => println!("open: {name}: {broken}"),
            (Some(broken), false) => faults.push(format!("{name}: {broken}")),
            (None, true) => faults.push(format!(
                "{name}: within its bounds, but in the list of open rows"
            )),
        }
    }
    no_faults(&faults)
}

#[cfg(test)]
mod tests {
    use super::{OPEN, ROWS, SHORT};
    use crate::run::{listing, top};

    #[test]
    fn every_file_has_a_row_and_every_open_row_is_one() {
        let files = listing(&top().join("tests/scenarios"), "toml").unwrap();
        for file in files {
            let name = file.file_stem().unwrap().to_string_lossy().into_owned();
            assert!(ROWS.iter().any(|row| row.file == name), "{name}");
        }
        for name in OPEN.iter().chain(SHORT) {
            assert!(ROWS.iter().any(|row| row.name() == *name), "{name}");
        }
    }
}
