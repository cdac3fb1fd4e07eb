//! Scenes made from others, most for the emulated board, each in a file of its own in target/variants.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use scene::Scene;
use toml::{Table, Value};

use crate::firmware::find;
use crate::run::{Fault, absolute, read, target, write};

/// As often as sensors in their slow mode compute a value, about, Hz.
const SLOW_HZ: &str = "tick_hz=500";

/// The scene at `path` with one whisker a side, the first, which is what a board carries.
pub(crate) fn single(path: &Path) -> Result<PathBuf, Fault> {
    let whiskers = load(path)?.head.whiskers_per_side;
    if whiskers == 1 {
        return Ok(path.to_owned());
    }
    variant(path, "single", |table| {
        set(table, "head", "whiskers_per_side", 1);
        if let Some(gains) = list(table, "whisking", "gain") {
            *gains = gains.iter().step_by(whiskers).cloned().collect();
        }
    })
}

/// The scene, which has the left side alone, with both sides alike and coupled.
pub(crate) fn on_both_sides(path: &Path) -> Result<PathBuf, Fault> {
    variant(path, "both", |table| {
        set(table, "head", "sides", "both");
        set(table, "whisking", "coupling", true);
        for (part, key) in [("whisking", "start"), ("plant", "obstacle_deg")] {
            if let Some(list) = list(table, part, key) {
                list.extend_from_within(..);
            }
        }
    })
}

/// The scene with sensors in their slow mode. It classifies nothing: models are of another rate.
pub(super) fn with_slow_sensors(path: &Path) -> Result<PathBuf, Fault> {
    let path = variant(path, "undecided", |table| drop(table.remove("classifier")))?;
    with(&path, &[SLOW_HZ, "sensor.mode=slow"])
}

pub(crate) fn without_telemetry(path: &Path) -> Result<PathBuf, Fault> {
    variant(path, "silent", |table| {
        let silent = Table::from_iter([("rtt".to_owned(), false.into())]);
        table.insert("telemetry".to_owned(), silent.into());
    })
}

pub(super) fn with_serial(path: &Path, baud: u32) -> Result<PathBuf, Fault> {
    let pins = load(path)?.classifier.is_some();
    let keys = [format!("serial_baud={baud}"), format!("pins={pins}")];
    with(path, &keys.map(|key| format!("telemetry.{key}")))
}

/// Most letters that a file is named by keys with: with the rest, file systems take 255.
const MOST_NAME: usize = 200;

/// The scene with other values, each `KEY=VALUE`: a key with its sections, and TOML or a word.
/// Its path may be seen from the top.
pub(crate) fn with(path: impl AsRef<Path>, keys: &[impl AsRef<str>]) -> Result<PathBuf, Fault> {
    let path = path.as_ref();
    let keys: Vec<&str> = keys.iter().map(AsRef::as_ref).collect();
    if keys.is_empty() {
        return Ok(path.to_owned());
    }
    let path = &find(path).unwrap_or_else(|_| path.to_owned());
    let mut values = Vec::new();
    for &key in &keys {
        let allowed = || format!("--set {key}: allowed: KEY=VALUE, such as motor.kp=0.04");
        let (key, value) = key.split_once('=').ok_or_else(allowed)?;
        let parsed = format!("value = {value}").parse::<Table>().ok();
        let parsed = parsed.and_then(|mut table| table.remove("value"));
        values.push((key, parsed.unwrap_or_else(|| value.into())));
    }
    let mut name = keys
        .join("-")
        .replace(|c: char| !c.is_ascii_alphanumeric(), "-");
    if name.len() > MOST_NAME {
        let mut sum = DefaultHasher::new();
        name.hash(&mut sum);
        name.truncate(MOST_NAME);
        name = format!("{name}-{:x}", sum.finish());
    }
    variant(path, &name, |table| {
        for (key, value) in values {
            let (parts, key) = key.rsplit_once('.').unwrap_or(("", key));
            let mut parts = parts.split('.').filter(|part| !part.is_empty());
            let place = parts.try_fold(&mut *table, |place, part| {
                let inner = place.entry(part).or_insert_with(|| Table::new().into());
                inner.as_table_mut()
            });
            if let Some(place) = place {
                place.insert(key.to_owned(), value);
            }
        }
    })
}

pub(crate) fn load(path: &Path) -> Result<Scene, Fault> {
    Scene::load(path).map_err(|problems| problems.to_string())
}

/// Writes the scene at `path` after a `change`, which its file's name gets added, and gives the
/// new path.
fn variant(path: &Path, name: &str, change: impl FnOnce(&mut Table)) -> Result<PathBuf, Fault> {
    let scene = load(path)?;
    let table = read(path)?.parse();
    let mut table: Table = table.map_err(|error| format!("{}: {error}", path.display()))?;
    change(&mut table);
    // The model stands beside the first scene.
    if let Some(model) = scene.model_path(path.parent().unwrap_or(Path::new("."))) {
        let model = absolute(&model)?;
        set(&mut table, "classifier", "model", &*model.to_string_lossy());
    }
    let stem = path.file_stem().unwrap_or_default().display();
    let written = target().join(format!("variants/{stem}-{name}.toml"));
    write(&written, table.to_string())?;
    Ok(written)
}

/// Sets a key of a part, if the scene has the part.
fn set(table: &mut Table, part: &str, key: &str, value: impl Into<Value>) {
    if let Some(part) = table.get_mut(part).and_then(Value::as_table_mut) {
        part.insert(key.to_owned(), value.into());
    }
}

fn list<'t>(table: &'t mut Table, part: &str, key: &str) -> Option<&'t mut Vec<Value>> {
    table.get_mut(part)?.get_mut(key)?.as_array_mut()
}
