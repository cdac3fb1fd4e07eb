//! Scenes made from others, most for the emulated board, each in a file of its own in target/variants.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use scene::Scene;
use toml::{Table, Value};

use crate::run::{Fault, absolute, read, target, write};

/// As often as sensors in their slow mode compute a value, about, Hz.
const SLOW_HZ: i64 = 500;

/// The scene at `path` with one whisker a side, the first, which is what a board carries.
pub(crate) fn single(path: &Path) -> Result<PathBuf, Fault> {
    let whiskers = load(path)?.head.whiskers_per_side;
    if whiskers == 1 {
        return Ok(path.to_owned());
    }
    variant(path, "single", |_, table| {
        set(table, "head", "whiskers_per_side", 1);
        if let Some(gains) = list(table, "whisking", "gain") {
            *gains = gains.iter().step_by(whiskers).cloned().collect();
        }
    })
}

/// The scene, which has the left side alone, with both sides alike and coupled.
pub(crate) fn on_both_sides(path: &Path) -> Result<PathBuf, Fault> {
    variant(path, "both", |_, table| {
        set(table, "head", "sides", "both");
        set(table, "whisking", "coupling", true);
        for (part, key) in [("whisking", "start"), ("plant", "obstacle_deg")] {
            if let Some(list) = list(table, part, key) {
                list.extend_from_within(..);
            }
        }
    })
}

pub(crate) fn in_fixed_point(path: &Path) -> Result<PathBuf, Fault> {
    variant(path, "fixed", |_, table| {
        set(table, "whisking", "numbers", "fixed");
    })
}

/// The scene with sensors in their slow mode. It classifies nothing: models are of another rate.
pub(super) fn with_slow_sensors(path: &Path) -> Result<PathBuf, Fault> {
    variant(path, "slow", |_, table| {
        table.insert("tick_hz".to_owned(), SLOW_HZ.into());
        replace(table, "sensor", [("mode", "slow".into())]);
        table.remove("classifier");
    })
}

/// The scene with what no scene of `scenes/` asks for: sensors that find their zeros, which are not
/// at mid-scale, contact without self-motion, priors and thresholds of the model's classes, and poses.
pub(super) fn with_options(path: &Path) -> Result<PathBuf, Fault> {
    variant(path, "options", |_, table| {
        let keys = [("zero_after_s", 0.5.into()), ("self_motion_s", 1.0.into())];
        replace(table, "sensor", keys);
        let pairs = [[40.0, -60.0], [-90.0, 30.0]].map(|codes| Value::from(codes.to_vec()));
        set(table, "plant", "zero_codes", pairs.to_vec());
        set(table, "classifier", "pose", true);
        for (key, class, value) in [("prior", "smooth", 0.6), ("thresholds", "carpet", 0.999)] {
            let of_class = Table::from_iter([(class.to_owned(), value.into())]);
            set(table, "classifier", key, of_class);
        }
    })
}

pub(crate) fn without_telemetry(path: &Path) -> Result<PathBuf, Fault> {
    variant(path, "silent", |_, table| {
        replace(table, "telemetry", [("rtt", false.into())]);
    })
}

pub(super) fn with_serial(path: &Path, baud: u32) -> Result<PathBuf, Fault> {
    variant(path, &format!("{baud}-baud"), |scene, table| {
        let pins = scene.classifier.is_some();
        let keys = [("serial_baud", baud.into()), ("pins", pins.into())];
        replace(table, "telemetry", keys);
    })
}

pub(crate) fn with_seed(path: &Path, seed: u32) -> Result<PathBuf, Fault> {
    variant(path, &format!("seed-{seed}"), |_, table| {
        table.insert("seed".to_owned(), seed.into());
    })
}

pub(crate) fn with_ticks(path: &Path, ticks: u32) -> Result<PathBuf, Fault> {
    variant(path, "long", |scene, table| {
        let duration_s = f64::from(ticks) / f64::from(scene.tick_hz);
        table.insert("duration_s".to_owned(), duration_s.into());
    })
}

/// Most letters that a file is named by keys with: with the rest, file systems take 255.
const MOST_NAME: usize = 200;

/// The scene with other values, each `KEY=VALUE`: a key with its sections, and TOML or a word.
pub(crate) fn with(path: &Path, keys: &[impl AsRef<str>]) -> Result<PathBuf, Fault> {
    let keys: Vec<&str> = keys.iter().map(AsRef::as_ref).collect();
    if keys.is_empty() {
        return Ok(path.to_owned());
    }
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
    variant(path, &name, |_, table| {
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

pub(super) fn whiskers(path: &Path) -> Result<usize, Fault> {
    load(path).map(|scene| scene.whiskers())
}

fn load(path: &Path) -> Result<Scene, Fault> {
    Scene::load(path).map_err(|problems| problems.to_string())
}

/// Writes the scene at `path` after a `change`, which its file's name gets added, and gives the
/// new path.
fn variant(
    path: &Path,
    name: &str,
    change: impl FnOnce(&Scene, &mut Table),
) -> Result<PathBuf, Fault> {
    let scene = load(path)?;
    let table = read(path)?.parse();
    let mut table: Table = table.map_err(|error| format!("{}: {error}", path.display()))?;
    change(&scene, &mut table);
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

fn replace<const N: usize>(table: &mut Table, part: &str, keys: [(&str, Value); N]) {
    let keys = keys.map(|(key, value)| (key.to_owned(), value));
    table.insert(part.to_owned(), Table::from_iter(keys).into());
}

fn list<'t>(table: &'t mut Table, part: &str, key: &str) -> Option<&'t mut Vec<Value>> {
    table.get_mut(part)?.get_mut(key)?.as_array_mut()
}
