//! What the firmware of each scene takes on each board: flash, static RAM and
//! stack; that it holds what the scene names and nothing else; and that no panic can be
//! reached in it. The table is committed, so that a program cannot grow unseen.

mod parts;
mod stack;
mod table;

use std::path::{Path, PathBuf};

use ::firmware::boards::InHead;
use scene::Scene;

use crate::elf::contents;
use crate::emulate::variants::{with, without_telemetry};
use crate::emulate::{JUDGED, head_of_two, judged_with_options, tilt};
use crate::figures::Figure;
use crate::firmware::{self, Board, Size};
use crate::run::{Fault, listing, no_faults, read_bytes, top};
use crate::{panics, speed};
use parts::{Named, Seen};
pub(crate) use table::{ANY_SCENE, TABLE, beside_goals, limits};

/// Names between them, on one board, what no scene names: not in the table.
const CONTROL: &str = "xtask/src/size/control.toml";

/// Of the scenes, those that are built where time is short: nearly all parts, and none.
const SHORT: [&str; 2] = ["scenes/full.toml", "scenes/passive.toml"];
/// Those that are built without a link too, so that the table says what the link costs.
const SILENT: [&str; 2] = ["scenes/passive.toml", "scenes/rcp.toml"];

/// Measures everything; prints it and writes the table to `csv` (or to the
/// committed one; `-`: prints the table alone), or checks that no program has
/// grown beyond what it says or beyond a limit. Checks in any case that each
/// program holds what its scene names and nothing else.
pub(crate) fn all(csv: Option<&Path>, check: bool) -> Result<(), Fault> {
    let quiet = csv == Some(Path::new("-"));
    let mut measured = Measured::default();
    for path in listing(&top().join("scenes"), "toml")? {
        let path = Path::new("scenes").join(path.file_name().unwrap_or_default());
        let host = Some(speed::ns_per_tick(&top().join(&path))?);
        for board in Board::ALL {
            match measured.take(board, &path, host)? {
                Some(reason) if !quiet => println!("{}: {reason}", board.name),
                _ => {}
            }
        }
    }
    for board in Board::ALL {
        for scene in SILENT {
            let scene = without_telemetry(Path::new(scene))?;
            // A board that does not take it has no line.
            measured.take(board, &scene, None)?;
        }
        measured.take(board, &judging_poses()?, None)?;
        measured.control(board, Path::new(CONTROL))??;
        if board.facts.in_head != InHead::Never {
            measured.control(board, &head_of_two()?)??;
        }
        measured.any_scene(board)?;
    }
    let found = measured.proven()?;
    TABLE.take(&found, csv, check)?;
    if check {
        table::within_limits(&found)
    } else {
        Ok(())
    }
}

/// Prints what a program takes, and where it is.
pub(crate) fn print(board: Board, scene: &str, elf: &Path) -> Result<(), Fault> {
    let Size { flash, ram } = Size::of(elf)?;
    println!(
        "{scene} on {}: flash {flash} bytes, scene and model {} bytes more, static RAM {ram} bytes, \
         stack {} bytes",
        board.name,
        Size::of_scene(elf)?,
        stack::worst(board, elf)?
    );
    println!("{}", elf.display());
    Ok(())
}

fn judging_poses() -> Result<PathBuf, Fault> {
    with(JUDGED, &["classifier.pose=true"])
}

/// Checks what most of CI's other steps run, and a few programs beside it that show of each part
/// that it is found where it is.
pub(crate) fn short() -> Result<(), Fault> {
    let mut measured = Measured::default();
    let [board, _, smallest] = Board::ALL;
    let [most, least] = SHORT.map(Path::new);
    for (board, scene) in [(board, most), (board, least), (smallest, least)] {
        if let Some(reason) = measured.take(board, scene, None)? {
            return Err(reason);
        }
    }
    let together = ["classifier.whiskers=together"];
    for scene in [
        PathBuf::from(CONTROL),
        with(judged_with_options()?, &together)?,
        head_of_two()?,
        tilt(board)?,
    ] {
        measured.control(board, &scene)??;
    }
    for board in Board::ALL {
        measured.any_scene(board)?;
    }
    let found = measured.proven()?;
    TABLE.check_part(&found)?;
    table::within_limits(&found)
}

#[derive(Default)]
struct Measured {
    figures: Vec<Figure>,
    seen: Seen,
    wrong: Vec<String>,
}

impl Measured {
    /// Builds the scene at `path` and measures it; gives the reason if the board does
    /// not take it.
    fn take(
        &mut self,
        board: Board,
        path: &Path,
        host: Option<u64>,
    ) -> Result<Option<String>, Fault> {
        let elf = match self.control(board, path)? {
            Ok(elf) => elf,
            Err(reason) => return Ok(Some(reason)),
        };
        self.check_panics(board, &path.display().to_string(), &elf);
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        self.figures.push(measured(board, &name, &elf, host)?);
        Ok(None)
    }

    fn check_panics(&mut self, board: Board, scene: &str, elf: &Path) {
        if let Err(fault) = panics::check(elf) {
            self.wrong
                .push(format!("{scene} on {}: {fault}", board.name));
        }
    }

    fn any_scene(&mut self, board: Board) -> Result<(), Fault> {
        let elf = firmware::build_any_scene(board)?;
        self.check_panics(board, ANY_SCENE, &elf);
        self.figures.push(measured(board, ANY_SCENE, &elf, None)?);
        Ok(())
    }

    /// Builds a scene, which gets no line in the table; or why the board does not take it.
    fn control(&mut self, board: Board, path: &Path) -> Result<Result<PathBuf, String>, Fault> {
        let elf = firmware::try_build(board, path)?;
        if let Ok(elf) = &elf {
            let misfits = misfits(&mut self.seen, board, path, elf)?;
            self.wrong.extend(misfits);
        }
        Ok(elf)
    }

    /// The lines, if every program holds what its scene names and nothing else, and
    /// every part was once there and once absent.
    fn proven(mut self) -> Result<Vec<Figure>, Fault> {
        let unproven = self
            .seen
            .unproven()
            .map(|part| format!("{part}: never there, or never absent"));
        self.wrong.extend(unproven);
        no_faults(&self.wrong).map(|()| self.figures)
    }
}

fn measured(board: Board, scene: &str, elf: &Path, host: Option<u64>) -> Result<Figure, Fault> {
    let Size { flash, ram } = Size::of(elf)?;
    let numbers = [flash, ram, stack::worst(board, elf)?].map(|bytes| bytes as f64);
    let host = host.map_or_else(String::new, |ns| format!(", host-sim {ns} ns a tick"));
    let note = format!("scene and model {}{host}", Size::of_scene(elf)?);
    Ok(Figure {
        note,
        ..Figure::new(&[scene, board.name], &numbers)
    })
}

/// What a program holds against its scene, or lacks.
fn misfits(seen: &mut Seen, board: Board, path: &Path, elf: &Path) -> Result<Vec<String>, Fault> {
    let (functions, at) = (contents::functions(elf)?, top().join(path));
    let scene = &Scene::load(&at).map_err(|error| error.to_string())?;
    let held = firmware::model(scene, &at)?;
    let model = held.as_ref();
    let mut wrong = seen.compare(&functions, Named { scene, model }, board.facts)?;
    for path in listing(&top().join("scenes/models"), "model")? {
        let (name, model) = (path.display(), read_bytes(&path)?);
        let found = contents::occurrences(elf, &model)?;
        let expected = usize::from(held.as_ref().is_some_and(|held| held.as_bytes() == model));
        if found != expected {
            wrong.push(format!("{name}: {found} times in flash, not {expected}"));
        }
    }
    for what in &mut wrong {
        *what = format!("{} on {}: {what}", path.display(), board.name);
    }
    Ok(wrong)
}
