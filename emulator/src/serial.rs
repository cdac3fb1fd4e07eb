//! The serial line as a board has it: what it says, what it does with what is asked for, and
//! that the tick takes no longer for it.

mod cost;
mod lines;
mod talk;

use std::path::Path;

use firmware::Packet;
use host_sim::Error;
use host_sim::loaded::Loaded;
use scene::Scene;
use wire::{Command, CommandStatus, Flags, TaggedCommand, TickRecord, WhiskerId};

use crate::board::packets;
use crate::compare::Pair;
use crate::deployment::{flashed, flashed_for};
use talk::{Talk, replies, wrong};

/// For how long an answer is waited for, and the records of a part are taken, s.
const PART_S: f64 = 0.1;
/// For how long records are compared, s.
const RECORDS_S: f64 = 0.5;

/// A baud that does not carry the records of the scene.
pub const SLOW_BAUD: u32 = 115_200;

/// Talks with a board that runs the scene in `path` by the program that has its serial port,
/// one with [`SLOW_BAUD`] and one without. Returns what was found.
///
/// # Errors
/// [`Error::Work`] says what is not as it should be.
pub fn talk(path: &Path, [program, slow, without]: [&Path; 3]) -> Result<Vec<String>, Error> {
    let mut said = converse(path, program)?;
    said.push(refuse_records(path, slow)?);
    said.extend(cost::cost(path, program, without)?);
    Ok(said)
}

/// All that is said at a baud that carries records.
fn converse(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    let pair = Pair::new(&mut loaded, &program)?;
    let scene = &loaded.scene;
    let mut talk = Talk {
        pair,
        ticks: 0,
        part: (PART_S * f64::from(scene.tick_hz)) as u32,
        tag: 0,
    };
    let mut said = vec![lines::compare(&mut talk, scene)?];
    said.push(compare_packets(&mut talk, scene)?);
    said.push(commands(&mut talk)?);
    said.push(garbage(&mut talk)?);
    Ok(said)
}

/// Records and events by the line are those of the same module on the PC, and none is lost.
fn compare_packets(talk: &mut Talk, scene: &Scene) -> Result<String, Error> {
    // Where the lines were compared both had as many ticks.
    let first = talk.ticks;
    let (hello, _) = talk.ask(Command::Hello)?;
    if hello.values != [scene.tick_hz as i32, scene.whiskers() as i32] {
        return wrong(format!("{hello:?}"));
    }
    let (before, _) = talk.ask(Command::Status)?;
    let mut found = Vec::new();
    let mut requests = Vec::new();
    let left = WhiskerId::default();
    // A command in between leaves no gap.
    for command in [
        Command::Stream(true),
        Command::Gain(left, 1 << 23),
        Command::Stream(false),
    ] {
        let (answer, meanwhile) = talk.ask(command)?;
        requests.push((answer.sequence, TaggedCommand { tag: 0, command }));
        found.extend(meanwhile);
        if command == Command::Stream(true) {
            let ticks = (RECORDS_S * f64::from(scene.tick_hz)) as u32;
            found.extend(packets(&talk.pass(ticks)?));
        }
    }
    let (after, none) = talk.ask(Command::Status)?;
    if before.values[0] != after.values[0] || !none.is_empty() {
        return wrong(format!("lost: {before:?}, {after:?}; too many: {none:?}"));
    }
    let expected = talk.pair.replay(first..talk.ticks, &requests);
    let [found, expected] = [found, expected].map(|packets| talk.pair.by_tick(&packets));
    if let Some((on_board, on_pc)) = found.iter().zip(&expected).find(|(a, b)| a != b) {
        return wrong(format!(
            "sent on the PC, on the board\n  {on_pc:?}\n  {on_board:?}"
        ));
    }
    let (first, last) = (requests[0].0, requests[2].0);
    let ticks = (last - first) as usize;
    if found.len() != expected.len() || found.len() != ticks || ticks == 0 {
        return wrong(format!(
            "packets of {} ticks came, the PC has {}, {ticks} were asked for",
            found.len(),
            expected.len()
        ));
    }
    let events = found.values().flatten().count() - ticks * scene.whiskers();
    Ok(format!(
        "records of {ticks} ticks and {events} events as on the PC, none lost"
    ))
}

/// Commands as lines: what is answered, and what the records then say.
fn commands(talk: &mut Talk) -> Result<String, Error> {
    let exchanges = [
        ("arm", "ok arm"),
        ("gain left 0.5", "ok gain"),
        ("gain left 2.01", "refused gain: value out of range"),
        ("gain left", "refused gain: needs a number such as 0.5"),
        ("setpoint left 70", "ok setpoint"),
        ("setpoint left 999", "refused setpoint: value out of range"),
        ("clear left", "ok clear"),
        ("jump", "refused jump: unknown command, try help"),
        ("stream on", "ok stream"),
    ];
    for (line, expected) in exchanges {
        let replies = talk.say(line)?;
        if replies != [expected] {
            return wrong(format!(
                "{line:?} was answered by {replies:?}, not {expected:?}"
            ));
        }
    }
    let last = |talk: &mut Talk| -> Result<TickRecord, Error> {
        let received = packets(&talk.pass(talk.part)?);
        let last = received.iter().rev().find_map(|packet| match packet {
            Packet::Record(record) => Some(*record),
            _ => None,
        });
        last.map_or_else(|| wrong("no record after `stream on`"), Ok)
    };
    let held = last(talk)?;
    // 70 degrees are θ = 0.2.
    if (wire::unit(held.setpoint) - 0.2).abs() > 2e-4 || !held.flags.contains(Flags::ARMED) {
        return wrong(format!("armed, to be held at 70 degrees: {held:?}"));
    }
    talk.say("stop")?;
    let stopped = last(talk)?;
    if stopped.flags.contains(Flags::ARMED) || stopped.duty != 0 {
        return wrong(format!("stopped: {stopped:?}"));
    }
    for (line, expected) in [
        ("arm", "ok arm"),
        ("release left", "ok release"),
        ("stream off", "ok stream"),
    ] {
        let replies = talk.say(line)?;
        if replies != [expected] {
            return wrong(format!("{line:?} was answered by {replies:?}"));
        }
    }
    Ok(format!(
        "{} commands by line answered and carried out",
        exchanges.len() + 4
    ))
}

/// What is no command costs an answer, and nothing else.
fn garbage(talk: &mut Talk) -> Result<String, Error> {
    let whole = wire::frame(&TaggedCommand {
        tag: 7,
        command: Command::Hello,
    });
    let mut flipped = whole.clone();
    flipped[6] ^= 2;
    let (line, binary) = ([b'a'; 300], [0xA5; 64]);
    for (bytes, refusals) in [
        (&line[..], 0),
        (b"\n", 1),
        (&binary[..], 0),
        (b"\0", 1),
        (&whole[..5], 0),
        (&flipped[..], 2),
    ] {
        talk.write(bytes);
        let replies = replies(&talk.pass(talk.part / 4)?);
        let refused = replies.iter().filter(|reply| reply.starts_with("refused"));
        if refused.count() != refusals {
            return wrong(format!("{bytes:?} was answered by {replies:?}"));
        }
    }
    let (hello, _) = talk.ask(Command::Hello)?;
    let replies = talk.say("status")?;
    let is_status = |reply: &String| reply.starts_with("ok status ");
    if hello.status != CommandStatus::Done || !replies.iter().any(is_status) {
        return wrong(format!("after garbage: {hello:?}, {replies:?}"));
    }
    Ok("garbage refused, and what follows it understood".to_owned())
}

/// At [`SLOW_BAUD`] records are refused, and all else is as before.
fn refuse_records(path: &Path, program: &Path) -> Result<String, Error> {
    let mut loaded = Loaded::new(path)?;
    loaded.scene.telemetry.serial_baud = Some(SLOW_BAUD);
    let program = flashed_for(&loaded.scene, path, program)?;
    let pair = Pair::new(&mut loaded, &program)?;
    let part = (PART_S * f64::from(loaded.scene.tick_hz)) as u32;
    let mut talk = Talk {
        pair,
        ticks: 0,
        part,
        tag: 0,
    };
    talk.pass(part)?;
    let replies = talk.say("stream on")?;
    let is_refused = |reply: &String| reply.starts_with("refused stream: records of every tick");
    if replies.len() != 1 || !replies.iter().all(is_refused) {
        return wrong(format!("at {SLOW_BAUD} baud: {replies:?}"));
    }
    let (answer, packets) = talk.ask(Command::Stream(true))?;
    if answer.status != CommandStatus::TooSlow || !packets.is_empty() {
        return wrong(format!("at {SLOW_BAUD} baud: {answer:?}"));
    }
    if talk.say("arm")? != ["ok arm"] {
        return wrong(format!("at {SLOW_BAUD} baud `arm` is not answered"));
    }
    Ok(format!("records are refused at {SLOW_BAUD} baud"))
}
