//! What the firmware of each scene takes on each board: flash, static RAM and
//! stack; and that it holds what the scene names and nothing else. The table is
//! committed, so that a program cannot grow unseen.

mod contents;
mod host;
mod parts;
mod stack;
mod table;
mod thumb;

use std::fs;
use std::path::{Path, PathBuf};

use scene::Scene;

use crate::firmware::{self, Board, Size};
use crate::run::{Fault, top};
use parts::Seen;
use table::Row;

/// The committed table.
const TABLE: &str = "docs/measured/sizes.csv";

/// Names between them, on one board, what no scene names: not in the table.
const CONTROL: &str = "xtask/src/size/control.toml";

/// Measures everything; prints it and writes the table to `csv` (or to the
/// committed one; `-`: prints the table alone), or checks that no program has
/// grown beyond what it says or beyond its goal. Checks in any case that each
/// program holds what its scene names and nothing else.
///
/// # Errors
/// If something cannot be built or read, or, checking, differs.
pub(crate) fn all(csv: Option<&Path>, check: bool) -> Result<(), Fault> {
    let quiet = csv == Some(Path::new("-"));
    let mut rows = Vec::new();
    let mut seen = Seen::default();
    let mut wrong = Vec::new();
    for path in scenes()? {
        let scene = Scene::load(top().join(&path)).map_err(|error| error.to_string())?;
        let host = host::ns_per_tick(&path, &scene)?;
        for board in Board::ALL {
            match firmware::try_build(board, &path)? {
                Ok(elf) => {
                    wrong.extend(misfits(&mut seen, board, &path, &scene, &elf)?);
                    rows.push(measured(board, &scene, &elf, host)?);
                }
                Err(reason) if !quiet => println!("{}: {reason}", board.name),
                Err(_) => {}
            }
        }
        if !quiet {
            println!("host-sim: {host} ns a tick of {}", scene.name);
        }
    }
    let control = Scene::load(top().join(CONTROL)).map_err(|error| error.to_string())?;
    for board in Board::ALL {
        let elf = firmware::build(board, Path::new(CONTROL))?;
        let control = &control;
        wrong.extend(misfits(
            &mut seen,
            board,
            Path::new(CONTROL),
            control,
            &elf,
        )?);
    }
    let unproven = seen.unproven().into_iter();
    wrong.extend(unproven.map(|part| format!("{part}: never there, or never absent")));
    if !wrong.is_empty() {
        return Err(wrong.join("\n"));
    }

    if quiet {
        print!("{}", table::csv(&rows));
        return Ok(());
    }
    print!("{}", table::columns(&rows));
    let path = csv.map_or_else(|| top().join(TABLE), Path::to_owned);
    let wrong = |error| format!("{}: {error}", path.display());
    if check {
        let known = fs::read_to_string(&path).map_err(wrong)?;
        return table::compare(&table::read(&known)?, &rows);
    }
    fs::write(&path, table::csv(&rows)).map_err(wrong)
}

/// The scenes of the project, seen from its top.
fn scenes() -> Result<Vec<PathBuf>, Fault> {
    let directory = top().join("scenes");
    let wrong = |error| format!("{}: {error}", directory.display());
    let mut paths = Vec::new();
    for entry in fs::read_dir(&directory).map_err(wrong)? {
        let name = PathBuf::from(entry.map_err(wrong)?.file_name());
        if name
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            paths.push(Path::new("scenes").join(name));
        }
    }
    paths.sort();
    Ok(paths)
}

fn measured(board: Board, scene: &Scene, elf: &Path, host: u64) -> Result<Row, Fault> {
    let size = Size::of(elf)?;
    Ok(Row {
        scene: scene.name.clone(),
        board: board.name.to_owned(),
        size,
        stack: Some(stack::worst(board, elf)?),
        model: model_bytes(scene)?.map_or(0, |model| model.len() as u64),
        is_active: scene.whisking.is_some(),
        host_ns: host,
    })
}

/// The model that a scene names.
fn model_bytes(scene: &Scene) -> Result<Option<Vec<u8>>, Fault> {
    let Some(path) = scene.model_path(&top().join("scenes")) else {
        return Ok(None);
    };
    let path = top().join(path);
    let bytes = fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(Some(bytes))
}

/// What a program holds against its scene, or lacks.
fn misfits(
    seen: &mut Seen,
    board: Board,
    path: &Path,
    scene: &Scene,
    elf: &Path,
) -> Result<Vec<String>, Fault> {
    let functions = contents::functions(elf)?;
    let mut wrong = seen.compare(&functions, scene, board.has_fpu);
    let sides = contents::sides(elf)?;
    if sides != [scene.head.sides.count()] {
        wrong.push(format!("code for {sides:?} sides"));
    }
    let named = model_bytes(scene)?;
    for (name, model) in models()? {
        let found = contents::occurrences(elf, &model)?;
        let expected = usize::from(named.as_ref() == Some(&model));
        if found != expected {
            wrong.push(format!("{name}: {found} times in flash, not {expected}"));
        }
    }
    let place = format!("{} on {}", path.display(), board.name);
    Ok(wrong
        .into_iter()
        .map(|what| format!("{place}: {what}"))
        .collect())
}

/// Every model of the project, by name.
fn models() -> Result<Vec<(String, Vec<u8>)>, Fault> {
    let directory = top().join("scenes/models");
    let wrong = |error| format!("{}: {error}", directory.display());
    let mut models = Vec::new();
    for entry in fs::read_dir(&directory).map_err(wrong)? {
        let path = entry.map_err(wrong)?.path();
        models.push((path.display().to_string(), fs::read(&path).map_err(wrong)?));
    }
    Ok(models)
}
