//! Faults from files: what tests/scenarios lists befalls a board's own program, and what became of
//! it must be within the bounds of `xtask/scenarios.toml`.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::Command;

use serde::Deserialize;
use serde_json::Value;

use crate::emulate::{BENCH, Emulated, trial, variants};
use crate::firmware::Board;
use crate::run::{AT_ONCE, Fault, no_faults, read, run_at_once, target, top, write};

/// As the file says of each.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    file: String,
    #[serde(default)]
    set: Vec<String>,
    #[serde(default)]
    head: bool,
    bounds: Vec<String>,
    #[serde(default)]
    open: bool,
    #[serde(default)]
    short: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    rows: Vec<Row>,
    bounds: BTreeMap<String, Vec<String>>,
}

const BOARD: Board = Board::ALL[0];

/// A simulated motor, and nothing within reach.
const PLANT: [&str; 5] = [
    "plant.kind=textured",
    "plant.obstacle_deg=[300.0]",
    "plant.stiffness=0.01",
    "plant.textures=['smooth']",
    "plant.present_s=1000.0",
];
/// Two boards, a whisker each.
const HEAD: [&str; 5] = [
    "head.nodes=2",
    "head.sides=both",
    "whisking.coupling=true",
    "whisking.start=[[1.0, 0.0], [1.0, 0.0]]",
    "plant.obstacle_deg=[300.0, 300.0]",
];
/// Whiskers with the other sensor, which a program of its own reads.
const TILT: &str = "sensor.model=tmag5170";

/// What was found in place of a bound, if that is broken.
fn broken(bound: &str, json: &Value) -> Result<Option<String>, Fault> {
    let wrong = || format!("no bound: {bound}");
    let number = |text: &str| text.parse::<f64>().map_err(|_| wrong());
    let value = |key: &str| {
        let value = json.pointer(&format!("/{key}"));
        value.and_then(Value::as_f64).unwrap_or(0.0)
    };
    for (sign, breaks) in [(" <= ", Ordering::Greater), (" >= ", Ordering::Less)] {
        if let Some((key, limit)) = bound.split_once(sign) {
            let found = value(key);
            let is_broken = found.partial_cmp(&number(limit)?) == Some(breaks);
            return Ok(is_broken.then(|| format!("{bound}: found {found:.4}")));
        }
    }
    if let Some((node, bound)) = bound.split_once(' ')
        && node.starts_with("nodes/")
    {
        let of_node = json.pointer(&format!("/{node}"));
        return broken(bound, of_node.unwrap_or(&Value::Null));
    }
    let mut events = json["events"].as_array().into_iter().flatten();
    let first = &json["first_fault"];
    let is_so = match bound.split(' ').collect::<Vec<_>>()[..] {
        ["fault"] => !first.is_null(),
        ["no", "fault"] => first.is_null(),
        ["off", "at", "the", "end"] => json["armed_at_end"] == false,
        ["never", kind] => !events.any(|event| event["kind"] == kind),
        [kind, "number", wanted] => {
            let wanted = number(wanted)?;
            events.any(|event| event["kind"] == kind && event["number"].as_f64() == Some(wanted))
        }
        [kinds, "after", after_s] => {
            let after_s = Some(number(after_s)?);
            let is_it = |kind| kinds.split('|').any(|wanted| wanted == kind);
            events.any(|event| {
                event["kind"].as_str().is_some_and(is_it) && event["t_s"].as_f64() > after_s
            })
        }
        _ => return Err(wrong()),
    };
    Ok((!is_so).then(|| format!("not so: {bound}; first fault: {first}")))
}

impl Table {
    fn load() -> Result<Self, Fault> {
        let table = read(&top().join("xtask/scenarios.toml"))?;
        toml::from_str(&table).map_err(|error| error.to_string())
    }

    fn broken(&self, row: &Row, json: &Value) -> Result<Vec<String>, Fault> {
        let bounds = row.bounds.iter().flat_map(|bound| {
            let named = self.bounds.get(bound).map(Vec::as_slice);
            named.unwrap_or(std::slice::from_ref(bound))
        });
        let broken = bounds.map(|bound| broken(bound, json));
        broken.filter_map(Result::transpose).collect()
    }
}

impl Row {
    fn name(&self) -> String {
        [std::slice::from_ref(&self.file), &self.set]
            .concat()
            .join(" ")
    }

    fn json(&self) -> PathBuf {
        let name = self.name().replace([' ', '.', '='], "-");
        target().join(format!("scenarios/{name}.json"))
    }

    fn command(&self, on: &Emulated) -> Result<Command, Fault> {
        let head = if self.head { &HEAD[..] } else { &[] };
        let set = self.set.iter().map(String::as_str);
        let keys: Vec<&str> = PLANT.iter().chain(head).copied().chain(set).collect();
        let scene = variants::with(BENCH, &keys)?;
        let file = top().join(format!("tests/scenarios/{}.toml", self.file));
        let linked = Emulated::linked(BOARD);
        let on = if self.set == [TILT] { &linked } else { on };
        let mut command = trial(&scene, &file, &self.json())?;
        command.arg("--program").arg(on.program(&scene)?);
        Ok(command)
    }
}

/// What CI runs each time.
pub(crate) fn short() -> Result<(), Fault> {
    run(|row| row.short)
}

pub(crate) fn all() -> Result<(), Fault> {
    run(|_| true)
}

fn run(is_wanted: fn(&Row) -> bool) -> Result<(), Fault> {
    let table = Table::load()?;
    let rows: Vec<&Row> = table.rows.iter().filter(|row| is_wanted(row)).collect();
    let on = Emulated::deployed(BOARD)?;
    write(&target().join("scenarios/.here"), "")?;
    let commands = rows.iter().map(|row| row.command(&on));
    run_at_once(commands.collect::<Result<_, _>>()?, AT_ONCE)?;
    let mut faults = Vec::new();
    for row in rows {
        let name = row.name();
        let json = serde_json::from_str(&read(&row.json())?);
        let json = json.map_err(|error| format!("{name}: {error}"))?;
        let broken = table.broken(row, &json)?.join("; ");
        match (broken.is_empty(), row.open) {
            (true, false) => println!("as it should be: {name}"),
            (false, true) => println!("open: {name}: {broken}"),
            (false, false) => faults.push(format!("{name}: {broken}")),
            (true, true) => faults.push(format!("{name}: within its bounds, but called open")),
        }
    }
    no_faults(&faults)
}

#[cfg(test)]
mod tests {
    use super::{Table, Value, broken};
    use crate::run::{listing, top};
    use serde_json::json;

    #[test]
    fn every_file_has_a_row_whose_bounds_can_be_read() {
        let table = Table::load().unwrap();
        for file in listing(&top().join("tests/scenarios"), "toml").unwrap() {
            let name = file.file_stem().unwrap().to_string_lossy().into_owned();
            assert!(table.rows.iter().any(|row| row.file == name), "{name}");
        }
        for row in &table.rows {
            assert!(table.broken(row, &Value::Null).is_ok(), "{}", row.name());
        }
    }

    #[test]
    fn a_bound_is_broken_or_not() {
        let event = json!({"kind": "fault", "number": 24, "t_s": 1.5});
        let node = json!({"events": [event]});
        let json = json!({
            "a": {"b": 2.0}, "first_fault": "24", "armed_at_end": false, "events": [event],
            "nodes": [node],
        });
        for (bound, is_so) in [
            ("a/b <= 2", true),
            ("a/b <= 1.9", false),
            ("a/b >= 2", true),
            ("a/b >= 2.1", false),
            ("fault", true),
            ("no fault", false),
            ("off at the end", true),
            ("never fault", false),
            ("never off", true),
            ("fault number 24", true),
            ("fault number 21", false),
            ("off|fault after 1.0", true),
            ("off|fault after 1.5", false),
            ("nodes/0 fault number 24", true),
            ("nodes/0 never fault", false),
            ("nodes/1 fault number 24", false),
        ] {
            let found = broken(bound, &json).map(|found| found.is_none());
            assert_eq!(found, Ok(is_so), "{bound}");
        }
        assert!(broken("soonest", &json).is_err());
    }
}
