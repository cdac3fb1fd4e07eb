//! Scenes made from others for the comparison of PC and board: the left half of
//! one with two sides, for a board that carries one whisker; and one in fixed point.

use std::path::{Path, PathBuf};

use scene::Scene;
use toml::{Table, Value};

use crate::run::{self, Fault, absolute};

/// Writes the first whisker on the left of `path` as a scene of its own into
/// `folder` and returns its path; `None` if the scene has no more than that.
///
/// # Errors
/// If the scene is wrong or the half cannot be written.
pub(super) fn half(path: &Path, folder: &Path) -> Result<Option<PathBuf>, Fault> {
    let (scene, mut table) = read(path)?;
    if scene.whiskers() == 1 {
        return Ok(None);
    }
    set(&mut table, "head", "sides", "left".into());
    set(&mut table, "head", "whiskers_per_side", 1.into());
    for (part, key) in [
        ("whisking", "gain"),
        ("whisking", "start"),
        ("plant", "obstacle_deg"),
    ] {
        keep_first(&mut table, part, key);
    }
    write(path, &scene, table, folder).map(Some)
}

/// Writes `path` as a scene in fixed point into `folder` and returns its path.
///
/// # Errors
/// If the scene is wrong or the other cannot be written.
pub(super) fn in_fixed_point(path: &Path, folder: &Path) -> Result<PathBuf, Fault> {
    let (scene, mut table) = read(path)?;
    set(&mut table, "whisking", "numbers", "fixed".into());
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

/// Leaves the first element of a list that has one for each side or whisker.
fn keep_first(table: &mut Table, part: &str, key: &str) {
    let list = table
        .get_mut(part)
        .and_then(|part| part.get_mut(key))
        .and_then(Value::as_array_mut);
    if let Some(list) = list {
        list.truncate(1);
    }
}
