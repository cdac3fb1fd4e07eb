//! The link to a PC as a board has it: what it sends of every tick, what it does with
//! requests, what is lost where it is not read, and what all that costs.

use std::path::Path;

use firmware::boards::BoardFacts;
use host_sim::Error;
use scene::{PlantKind, Scene};
use wire::{Command, CommandStatus, Flags, TickRecord, WhiskerId};

use crate::compare::Pair;
use crate::cost::{Asks, Price, cost};
use crate::deployment::flashed;
use crate::talk::{Talk, records, wrong};
use crate::tuning::tune;

/// Most instructions of a tick for a whisker's record, where the core has an FPU and where it
/// has none. They were 120 and 240 while the scene was part of the types; now that it is data each
/// record asks what there is, and goes by a queue to idle, which makes its frame. They include what
/// is paid where nothing is asked for.
const STREAMING: f64 = 230.0;
const STREAMING_NO_FPU: f64 = 265.0;

/// The same where nothing is asked for: a look at whether something has come in which there may be a
/// stop, one at that queue's fellow for requests, and the events of a tick noted for a record. It was
/// 27.0 before motors were held against a model in the same tick; why it is 62.0 since is not known.
const QUIET: f64 = 65.0;

/// By how much a record may be away from the world, degrees: a step of its numbers, and of
/// the encoder.
const ANGLE_DEG: f64 = 0.25;

const Z_STEP: f64 = 1.0 / 8192.0;

/// A value of 1 in Q24.
const ONE: i32 = 1 << 24;

/// Talks with the board that runs the scene in `path`, once with a program that has
/// telemetry and once `without`. Returns what was found.
pub(crate) fn talk(path: &Path, program: &Path, without: &Path) -> Result<Vec<String>, Error> {
    let mut said = converse(path, program)?;
    said.extend(tune(path, program)?);
    let silence = |scene: &mut Scene| scene.telemetry.rtt = false;
    said.extend(cost(path, [program, without], silence, prices)?);
    Ok(said)
}

fn script(scene: &Scene) -> Vec<(Command, CommandStatus)> {
    let left = WhiskerId::default();
    let nowhere = WhiskerId { side: 5, number: 9 };
    let [done, out_of_range] = [CommandStatus::Done, CommandStatus::OutOfRange].map(|status| {
        if scene.whisking.is_some() {
            status
        } else {
            CommandStatus::NoWhisker
        }
    });
    let mut script = vec![
        (Command::Hello, CommandStatus::Done),
        (Command::Stream(true), CommandStatus::Done),
        (Command::Gain(left, ONE / 2), done),
        (Command::Gain(left, 2 * ONE + ONE / 100), out_of_range),
        (Command::Gain(nowhere, ONE), CommandStatus::NoWhisker),
        (Command::Setpoint(left, ONE / 5), done),
        (Command::Setpoint(left, 3 * ONE), out_of_range),
        (Command::Release(left), done),
        (Command::Clear(left), done),
        (Command::Stop, done),
        (Command::Arm, done),
    ];
    if scene.plant.kind == PlantKind::Ideal {
        // Ideal motors on the pins follow the pattern generator, as a debugger reads it,
        // whatever drives them.
        let moves = |command: &Command| {
            *command == Command::Setpoint(left, ONE / 5)
                || matches!(command, Command::Stop | Command::Arm)
        };
        script.retain(|(command, _)| !moves(command));
    }
    script
}

/// A scene on a board that is asked for this and that: the answers must be right, the records those
/// of the same module on the PC, and where they are not read whole records be lost, and counted.
fn converse(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    let mut talk = Talk::new(Pair::new(&mut loaded, &program)?, false);
    let scene = &loaded.scene;
    talk.pass(talk.part)?;

    // Bytes that are no request, and half of one: the next is understood all the same.
    talk.pair.target.board_mut().request(&[0xA5; 17])?;
    talk.pass(2)?;
    let mut stopped = None;
    for (command, status) in script(scene) {
        if command == Command::Stop {
            stopped = Some(talk.packets.len());
        }
        let answer = talk.ask(command)?;
        talk.pass(talk.part)?;
        let expected = [scene.tick_hz as i32, scene.whiskers() as i32];
        let is_right = answer.status == status
            && answer.command == command.number()
            && (command != Command::Hello || answer.values == expected);
        if !is_right {
            return wrong(format!("{command:?}: {answer:?}"));
        }
        let driven = records(&talk.packets).last();
        if command == Command::Stop && driven.is_none_or(|record| record.duty != 0) {
            return wrong("driven after it was to stop");
        }
    }
    let mut names = vec![name(&mut talk, Command::Name)?];
    let classes = talk.pair.host.classes().to_vec();
    for class in 0..classes.len() {
        names.push(name(&mut talk, |from| Command::Class(class as u8, from))?);
    }
    if names != [vec![scene.name.clone()], classes].concat() {
        return wrong(format!("it says that its scene and classes are {names:?}"));
    }
    // Where a stopped whisker rests is not known, nor what was sent and not read.
    let known = stopped.unwrap_or(talk.packets.len());
    let lost = lose(&mut talk, scene.whiskers() as u32)?;
    for record in records(&talk.packets[..known]) {
        same_as_world(&talk, record)?;
    }
    let expected = talk.follow()?;
    let whiskers = scene.whiskers();
    let [records, events] = talk.same([&talk.packets, &expected], whiskers, true)?;
    let requests = talk.requests.len();
    Ok(vec![
        format!("{requests} requests answered, {records} records and {events} events as on the PC"),
        format!("{lost} records lost while none were read, and counted"),
    ])
}

/// A record must have the angle that the encoder has read in its tick, before the world moved
/// on, the codes that its sensor has got, and z as a debugger reads it.
fn same_as_world(talk: &Talk, record: &TickRecord) -> Result<(), Error> {
    let Some((before, row)) = talk.worlds.get(record.sequence.wrapping_sub(1) as usize) else {
        return wrong(format!("of a tick to come: {record:?}"));
    };
    let side = usize::from(record.flags.contains(Flags::RIGHT));
    let off = (f64::from(wire::degrees(record.measured)) - before[side]).abs();
    let codes = [row.x[side], row.y[side]];
    let are_codes = record.codes().map(f64::from) == codes;
    // A scene that does not whisk has none.
    let z = if row.z[side].is_nan() {
        0.0
    } else {
        row.z[side]
    };
    let is_z = (f64::from(wire::unit(record.z)) - z).abs() <= Z_STEP;
    if (record.flags.contains(Flags::RUNNING) && off > ANGLE_DEG) || !are_codes || !is_z {
        return wrong(format!(
            "at {} degrees with codes {codes:?} and z {z}: {record:?}",
            before[side]
        ));
    }
    Ok(())
}

/// A name, as the board says it where eight letters from one on are asked for so.
fn name(talk: &mut Talk, command: impl Fn(u8) -> Command) -> Result<String, Error> {
    let mut letters = Vec::new();
    loop {
        let answer = talk.ask(command(letters.len() as u8))?;
        letters.extend(answer.values.map(i32::to_le_bytes).as_flattened());
        if letters.last() == Some(&0) {
            letters.retain(|letter| *letter != 0);
            return Ok(String::from_utf8_lossy(&letters).into_owned());
        }
    }
}

/// Nothing is read for two parts. What is lost must be whole ticks, the board's own
/// count that of the gap, and the record after the gap say so.
fn lose(talk: &mut Talk, whiskers: u32) -> Result<u32, Error> {
    let before = talk.ask(Command::Status)?.values[0];
    talk.pass(talk.part)?;
    for _ in 0..2 * talk.part {
        talk.tick()?;
    }
    let first = talk.packets.len();
    talk.pass(talk.part)?;
    let after = talk.ask(Command::Status)?.values[0];
    talk.pass(talk.part)?;
    let counted = after.wrapping_sub(before).cast_unsigned();

    let mut gap = 0;
    let records: Vec<_> = records(&talk.packets[first..]).collect();
    for pair in records.windows(2) {
        let side = |record: &TickRecord| u32::from(record.flags.contains(Flags::RIGHT));
        let place = |record: &TickRecord| record.sequence * whiskers + side(record);
        let missing = place(pair[1]) - place(pair[0]) - 1;
        if pair[1].flags.contains(Flags::LOST) != (missing > 0) {
            return wrong(format!("{missing} lost before {:?}", pair[1]));
        }
        gap += missing;
    }
    if gap != counted || gap == 0 {
        return wrong(format!("{gap} records lost, {counted} counted"));
    }
    Ok(gap)
}

/// What telemetry costs that is not asked for, with a record a whisker, and with records that
/// find no room.
fn prices(scene: &Scene, board: &BoardFacts) -> Vec<Price> {
    let each = if board.has_fpu {
        STREAMING
    } else {
        STREAMING_NO_FPU
    };
    let streaming = each * scene.whiskers() as f64;
    let prices = [
        ("telemetry that is not asked for", Asks::Nothing, QUIET),
        ("with a record a whisker", Asks::Probe, streaming),
        (
            "with records that find no room",
            Asks::ProbeInVain,
            streaming,
        ),
    ];
    let prices = prices.map(|(what, asks, most)| (what, [asks, Asks::Nothing], most));
    prices.to_vec()
}
