//! Models deployed to a board: right ones, wrong ones, and such as were interrupted.

use std::path::Path;

use firmware::Refusal;
use host_sim::Error;
use host_sim::loaded::Loaded;
use tactile::{Axis, CRC_BYTES, ModelBuf, ModelParts, Quantiser, TableParts, checksum};
use wire::{Command, CommandStatus, WhiskerId};

use crate::compare::{Agreement, Circumstances, compare_loaded};
use crate::loading::{ask, load, must};
use crate::program::Program;
use crate::session::Session;

/// How long PC and board are compared, s.
const COMPARED_S: f64 = 8.0;
/// How long a board that has refused a model is watched, s: it whisks and may touch.
const WATCHED_S: f64 = 2.0;
/// How long a whisker takes to come to rest, s.
const TO_REST_S: f64 = 0.3;
/// How long one that has a model may take to decide, s.
const PATIENCE_S: f64 = 6.0;

/// Where the header of a model has its version and its length.
const VERSION: usize = 4;
const LENGTH: usize = 12;

/// A scene without a model, the world that it is in, and what is flashed for it.
#[derive(Debug, Clone, Copy)]
pub struct Deployment<'p> {
    /// The scene.
    pub scene: &'p Path,
    /// That of the world.
    pub world: &'p Path,
    /// The board's program.
    pub program: &'p Path,
}

impl Deployment<'_> {
    fn load(&self) -> Result<Loaded, Error> {
        Loaded::new(self.scene)?.in_world(self.world)
    }

    fn session(&self) -> Result<Session, Error> {
        Session::open(&self.load()?.scene, self.program)
    }
}

/// Deploys the model in `model` to a board that has none: PC and board must then agree to the
/// last bit, in decisions too, as they must before. A model that was interrupted after some
/// words, or that is wrong, must be refused with its reason, and the board must whisk on and
/// decide nothing. Returns what was seen, a line each.
///
/// # Errors
/// [`Error::Work`] says what did not happen.
pub fn deploying(bench: Deployment<'_>, model: &Path) -> Result<Vec<String>, Error> {
    let mut told = Vec::new();
    let program = Program::load(bench.program)?;
    let compared = |loaded: Loaded| {
        let circumstances = Circumstances {
            duration_s: Some(COMPARED_S),
            ..Circumstances::default()
        };
        compare_loaded(loaded, bench.scene, &program, circumstances)
    };
    let without = compared(bench.load()?)?;
    told.push(agreed("no model", without));
    let with = compared(bench.load()?.with_model(model)?)?;
    told.push(agreed("a model", with));
    if without.decisions != 0 || with.decisions == 0 {
        return Err(Error::Work(told.join("\n")));
    }

    let loaded = bench.load()?.with_model(model)?;
    let right = loaded.deployed();
    told.push(refuses_to_load(bench)?);
    let words = right.len() / 4;
    for written in [0, 1, words / 2, words - 2, words - 1] {
        let said = refuses(bench, right, written, Refusal::Absent)?;
        told.push(format!("{written} of {words} words written: {said}"));
    }
    let session = bench.session()?;
    for (what, wrong, why) in wrong_models(right, &session)? {
        let said = refuses(bench, &wrong, usize::MAX, why)?;
        told.push(format!("{what}: {said}"));
    }
    told.push(decides(bench, right)?);
    Ok(told)
}

fn agreed(with: &str, of: Agreement) -> String {
    format!(
        "with {with}: PC and board agree to the last bit in {} ticks, {} decisions",
        of.ticks, of.decisions
    )
}

/// What is wrong with a model, the model, and why a board must refuse it.
type Wrong = (&'static str, Vec<u8>, Refusal);

/// Models that a board must refuse.
fn wrong_models(right: &[u8], session: &Session) -> Result<Vec<Wrong>, Error> {
    let changed = |at: usize, by: &[u8]| {
        let mut model = right.to_vec();
        for (byte, other) in model.iter_mut().skip(at).zip(by) {
            *byte ^= other;
        }
        model
    };
    let mut long = right.to_vec();
    let length = session.model_room() as u32 + 4;
    for (byte, other) in long.iter_mut().skip(LENGTH).zip(length.to_le_bytes()) {
        *byte = other;
    }
    let mut contradictory = right.to_vec();
    // Of the tables of samples none is left, and the sum is right.
    contradictory[8] = 0;
    let (body, sum) = contradictory.split_at_mut(right.len() - CRC_BYTES);
    sum.copy_from_slice(&checksum(body).to_le_bytes());
    let many = session.model_classes() + 1;
    Ok(vec![
        ("something else", changed(0, &[1]), Refusal::Strange),
        ("another version", changed(VERSION, &[1]), Refusal::Version),
        ("too long", long, Refusal::TooLong),
        (
            "a bit flipped",
            changed(right.len() / 2, &[4]),
            Refusal::Damaged,
        ),
        ("no table", contradictory, Refusal::Content),
        ("too many classes", plain(many, 2)?, Refusal::Classes),
        ("three channels", plain(2, 3)?, Refusal::Channels),
    ])
}

/// A model of so many classes and channels, of which all are alike.
fn plain(classes: usize, channels: usize) -> Result<Vec<u8>, Error> {
    let names: Vec<String> = (0..classes).map(|class| format!("class {class}")).collect();
    let quantiser = Quantiser {
        origin: 0.0,
        exponent: 0,
        low: 0,
        high: 16_384,
    };
    let axis = |channel| Axis {
        channel,
        bins: 2,
        low: 0,
        high: 16_384,
    };
    let axes: Vec<Axis> = (0..channels).map(axis).collect();
    let entries = vec![1_024; 2 * classes];
    let tables: Vec<_> = axes
        .iter()
        .map(|axis| TableParts::of_channel(axis, &entries))
        .collect();
    let model = ModelBuf::new(&ModelParts {
        names: &names,
        block: 20,
        channels: &vec![quantiser; channels],
        tables: &tables,
        floors: None,
        touch: None,
    });
    let model = model.map_err(|error| Error::Work(error.to_string()))?;
    Ok(model.as_bytes().to_vec())
}

/// Lets time pass; the lines that the board has logged, and whether a motor was driven.
fn pass(session: &mut Session, seconds: f64) -> Result<(Vec<String>, bool), Error> {
    let begun = session.now_s();
    let (mut lines, mut driven) = (Vec::new(), false);
    while session.now_s() - begun < seconds {
        session.tick()?;
        lines.extend(session.log());
        driven |= session.drives();
    }
    Ok((lines, driven))
}

/// A board whose motor was on, and is off, its whisker at rest.
fn stopped(bench: Deployment<'_>) -> Result<Session, Error> {
    let mut session = bench.session()?;
    let (lines, driven) = pass(&mut session, 0.5)?;
    if !driven || !says(&lines, Refusal::Absent) {
        return Err(missing("a board without a model whisks", &lines));
    }
    // From where it is when it is armed anew.
    ask(&mut session, Command::Setpoint(WhiskerId::default(), 0))?;
    pass(&mut session, TO_REST_S)?;
    ask(&mut session, Command::Stop)?;
    session.tick()?;
    Ok(session)
}

fn missing(what: &str, lines: &[String]) -> Error {
    Error::Work(format!("not so: {what}\n  {}", lines.join("\n  ")))
}

fn says(lines: &[String], refusal: Refusal) -> bool {
    let at = lines.iter().position(|line| line.contains("limit 34"));
    let why = at.and_then(|at| lines.get(at + 1));
    why.is_some_and(|line| line.contains(refusal.text()))
}

/// Nothing is loaded while a motor is armed, nor what there is no room for.
fn refuses_to_load(bench: Deployment<'_>) -> Result<String, Error> {
    let mut session = bench.session()?;
    must(&mut session, Command::Load(4), CommandStatus::Armed)?;
    pass(&mut session, 0.5)?;
    let is_driven = session.drives();
    must(&mut session, Command::Load(4), CommandStatus::Armed)?;
    let mut session = stopped(bench)?;
    let room = session.model_room() as u32 / 4;
    for words in [0, room + 1, u32::MAX] {
        must(
            &mut session,
            Command::Load(words),
            CommandStatus::OutOfRange,
        )?;
    }
    must(&mut session, Command::Word(0, 0), CommandStatus::NotHere)?;
    must(&mut session, Command::Restart, CommandStatus::NotHere)?;
    if !is_driven {
        return Err(missing("a motor is driven", &[]));
    }
    Ok(format!(
        "nothing is loaded while a motor is armed, or of more than {room} words"
    ))
}

/// A board that gets so many words of a model refuses it, whisks on and decides nothing.
fn refuses(
    bench: Deployment<'_>,
    model: &[u8],
    words: usize,
    refusal: Refusal,
) -> Result<String, Error> {
    let mut session = stopped(bench)?;
    load(&mut session, model, words)?;
    let (lines, driven) = pass(&mut session, WATCHED_S)?;
    let has = |what: &str| lines.iter().any(|line| line.contains(what));
    if !driven || !says(&lines, refusal) || !has("touch ") || has("decision") {
        return Err(missing(refusal.text(), &lines));
    }
    let answer = ask(&mut session, Command::Model)?.values;
    if answer != [0, -i32::from(refusal.code())] {
        return Err(Error::Work(format!("{refusal:?}: answered {answer:?}")));
    }
    Ok(refusal.text().to_owned())
}

/// A board that gets a right model decides by it.
fn decides(bench: Deployment<'_>, model: &[u8]) -> Result<String, Error> {
    let mut session = stopped(bench)?;
    load(&mut session, model, usize::MAX)?;
    let buf = ModelBuf::from_bytes(model).map_err(|error| Error::Work(error.to_string()))?;
    let (lines, _) = pass(&mut session, PATIENCE_S)?;
    let [crc, classes] = ask(&mut session, Command::Model)?.values;
    let is_it = crc.cast_unsigned() == buf.crc() && classes as usize == buf.classes();
    let is_named = |line: &&String| {
        let names = buf.names().chain(["unknown"]);
        names
            .into_iter()
            .any(|name| line.contains(&format!("decision: {name},")))
    };
    let by = format!("decides by model {:08x}", buf.crc());
    let has = lines.iter().any(|line| line.contains(&by));
    match lines.iter().find(is_named) {
        Some(line) if is_it && has => Ok(format!("deployed: {by}, first {line}")),
        _ => Err(missing(&by, &lines)),
    }
}
