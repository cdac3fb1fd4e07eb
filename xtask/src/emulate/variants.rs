//! Scenes made from others for the emulated board: one with a single whisker a side,
//! which is what a board carries; one in fixed point; one with slow sensors; one with a serial
//! port; one with both sides; one with another seed.

use std::path::{Path, PathBuf};

use scene::Scene;
use toml::{Table, Value};

use crate::run::{self, Fault, absolute};

/// As often as sensors in their slow mode compute a value, about, Hz.
const SLOW_HZ: i64 = 500;

/// Writes the first whisker of each side of `path` as a scene of its own into
/// `folder` and returns its path; `None` if the scene has no more than that.
pub(crate) fn single(path: &Path, folder: &Path) -> Result<Option<PathBuf>, Fault> {
    let (scene, mut table) = read(path)?;
    let whiskers = scene.head.whiskers_per_side;
    if whiskers == 1 {
        return Ok(None);
    }
    set(&mut table, "head", "whiskers_per_side", 1.into());
    keep_first_of(whiskers, &mut table, "whisking", "gain");
    write(path, &scene, table, folder).map(Some)
}

/// Writes `path`, which has the left side alone, as a scene with both sides alike and
/// coupled into `folder` and returns its path.
pub(super) fn on_both_sides(path: &Path, folder: &Path) -> Result<PathBuf, Fault> {
    let (scene, mut table) = read(path)?;
    set(&mut table, "head", "sides", "both".into());
    set(&mut table, "whisking", "coupling", true.into());
    for (part, key) in [("whisking", "start"), ("plant", "obstacle_deg")] {
        double(&mut table, part, key);
    }
    write(path, &scene, table, folder)
}

/// Writes `path` as a scene in fixed point into `folder` and returns its path.
pub(super) fn in_fixed_point(path: &Path, folder: &Path) -> Result<PathBuf, Fault> {
    let (scene, mut table) = read(path)?;
    set(&mut table, "whisking", "numbers", "fixed".into());
    write(path, &scene, table, folder)
}

/// Writes `path` as a scene whose sensors are in their slow mode into `folder` and returns its
/// path. It classifies nothing: models are of another rate.
pub(super) fn with_slow_sensors(path: &Path, folder: &Path) -> Result<PathBuf, Fault> {
    let (scene, mut table) = read(path)?;
    table.insert("tick_hz".to_owned(), SLOW_HZ.into());
    let mode = Table::from_iter([("mode".to_owned(), Value::from("slow"))]);
    table.insert("sensor".to_owned(), mode.into());
    table.remove("classifier");
    write(path, &scene, table, folder)
}

/// Writes `path` as a scene whose sensors find their zeros, which are not at mid-scale, into
/// `folder` and returns its path.
pub(super) fn with_zeros(path: &Path, folder: &Path) -> Result<PathBuf, Fault> {
    let (scene, mut table) = read(path)?;
    let found = Table::from_iter([("zero_after_s".to_owned(), Value::from(0.5))]);
    table.insert("sensor".to_owned(), found.into());
    let pair = |codes: [f64; 2]| Value::from(codes.to_vec());
    let zeros = Value::from(vec![pair([40.0, -60.0]), pair([-90.0, 30.0])]);
    let plant = table.get_mut("plant").and_then(Value::as_table_mut);
    let plant = plant.ok_or("the scene has no plant")?;
    plant.insert("zero_codes".to_owned(), zeros);
    write(path, &scene, table, folder)
}

/// Writes `path` as a scene without telemetry into `folder` and returns its path.
pub(super) fn without_telemetry(path: &Path, folder: &Path) -> Result<PathBuf, Fault> {
    let (scene, mut table) = read(path)?;
    let rtt = Table::from_iter([("rtt".to_owned(), Value::from(false))]);
    table.insert("telemetry".to_owned(), rtt.into());
    write(path, &scene, table, folder)
}

/// The whiskers of the scene in `path`.
pub(super) fn whiskers(path: &Path) -> Result<usize, Fault> {
    read(path).map(|(scene, _)| scene.whiskers())
}

/// Writes `path` as a scene with a serial port at `baud`, and with pins where it classifies,
/// into `folder` and returns its path.
pub(super) fn with_serial(path: &Path, baud: u32, folder: &Path) -> Result<PathBuf, Fault> {
    let (scene, mut table) = read(path)?;
    let telemetry = Table::from_iter([
        ("serial_baud".to_owned(), Value::from(i64::from(baud))),
        ("pins".to_owned(), scene.classifier.is_some().into()),
    ]);
    table.insert("telemetry".to_owned(), telemetry.into());
    write(path, &scene, table, folder)
}

/// Writes `path` as a scene with another seed into `folder` and returns its path.
pub(crate) fn with_seed(path: &Path, seed: u64, folder: &Path) -> Result<PathBuf, Fault> {
    let (scene, mut table) = read(path)?;
    let seed = i64::try_from(seed).map_err(|error| error.to_string())?;
    table.insert("seed".to_owned(), seed.into());
    write(path, &scene, table, folder)
}

fn read(path: &Path) -> Result<(Scene, Table), Fault> {
    let scene = Scene::load(path).map_err(|problems| problems.to_string())?;
    let table = run::read(path)?.parse();
    let table = table.map_err(|error| format!("{}: {error}", path.display()))?;
    Ok((scene, table))
}

/// Writes `table`, made from `scene` in `path`, under the same name into `folder`.
fn write(path: &Path, scene: &Scene, mut table: Table, folder: &Path) -> Result<PathBuf, Fault> {
    let written = folder.join(path.file_name().unwrap_or(path.as_os_str()));
    if let Some(model) = scene.model_path(path.parent().unwrap_or(Path::new("."))) {
        let model = absolute(&model)?;
        let model = model.to_string_lossy().into_owned();
        set(&mut table, "classifier", "model", model.into());
    }
    run::write(&written, table.to_string())?;
    Ok(written)
}

fn set(table: &mut Table, part: &str, key: &str, value: Value) {
    if let Some(part) = table.get_mut(part).and_then(Value::as_table_mut) {
        part.insert(key.to_owned(), value);
    }
}

fn list<'t>(table: &'t mut Table, part: &str, key: &str) -> Option<&'t mut Vec<Value>> {
    table.get_mut(part)?.get_mut(key)?.as_array_mut()
}

/// Leaves the first of every so many `whiskers` of a list that has an element for each.
fn keep_first_of(whiskers: usize, table: &mut Table, part: &str, key: &str) {
    if let Some(list) = list(table, part, key) {
        *list = list.iter().step_by(whiskers).cloned().collect();
    }
}

/// Repeats a list.
fn double(table: &mut Table, part: &str, key: &str) {
    if let Some(list) = list(table, part, key) {
        list.extend_from_within(..);
    }
}
