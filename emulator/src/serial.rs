//! The serial line as a board has it: what it tells, what it does with what is asked for, and
//! that the tick takes no longer for it.

mod cost;
mod talk;
mod told;

use std::path::Path;

use firmware::Packet;
use host_sim::Error;
use host_sim::loaded::Loaded;
use scene::Scene;
use wire::{Command, CommandStatus, Flags, TaggedCommand, TickRecord, WhiskerId};

use crate::compare::Pair;
use crate::deployment::{flashed, flashed_for};
use talk::{Talk, records, replies, wrong};

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
    let mut said = vec![told::compare(&mut talk, scene)?];
    said.push(compare_records(&mut talk, scene)?);
    said.push(commands(&mut talk)?);
    said.push(garbage(&mut talk)?);
    Ok(said)
}

/// Records by the line are those of the same module on the PC, and none is lost.
fn compare_records(talk: &mut Talk, scene: &Scene) -> Result<String, Error> {
    // Where the lines were compared both had as many ticks.
    let first = talk.ticks;
    let (hello, _) = talk.ask(Command::Hello)?;
    if hello.values != [scene.tick_hz as i32, scene.whiskers() as i32] {
        return wrong(format!("{hello:?}"));
    }
    let (before, _) = talk.ask(Command::Status)?;
    let (begun, mut found) = talk.ask(Command::Stream(true))?;
    let ticks = (RECORDS_S * f64::from(scene.tick_hz)) as u32;
    let heard = talk.pass(ticks)?;
    found.extend(records(&heard));
    let left = WhiskerId::default();
    // A command in between leaves no gap.
    let (gain, between) = talk.ask(Command::Gain(left, 1 << 23))?;
    found.extend(between);
    let (ended, last) = talk.ask(Command::Stream(false))?;
    found.extend(last);
    let (after, none) = talk.ask(Command::Status)?;
    if before.values[0] != after.values[0] || !none.is_empty() {
        return wrong(format!(
            "lost: {before:?}, {after:?}; {} too many",
            none.len()
        ));
    }

    let requests = [
        (begun.sequence, Command::Stream(true)),
        (gain.sequence, Command::Gain(left, 1 << 23)),
        (ended.sequence, Command::Stream(false)),
    ];
    let host = &mut talk.pair.host;
    let mut expected = Vec::new();
    for tick in first..talk.ticks {
        for (_, command) in requests.iter().filter(|(at, _)| *at == tick) {
            let request = TaggedCommand {
                tag: 0,
                command: *command,
            };
            host.module_mut().request(request);
        }
        host.tick();
        let packets = host.module_mut().take_packets();
        expected.extend(packets.iter().filter_map(|packet| match packet {
            Packet::Record(record) => Some(*record),
            Packet::Answer(_) | Packet::Event(_) => None,
        }));
    }
    let feels = talk.pair.feels;
    // The lower bits of a word are no measurement; contact nobody uses is not computed.
    let plain = |record: &TickRecord| TickRecord {
        x: record.codes()[0],
        y: record.codes()[1],
        contact: if feels { record.contact } else { 0 },
        ..*record
    };
    let same = |a: &TickRecord, b: &TickRecord| plain(a) == plain(b);
    let differs = found.iter().zip(&expected).find(|(a, b)| !same(a, b));
    if let Some((on_board, on_pc)) = differs {
        return wrong(format!(
            "a record on the PC, on the board\n  {on_pc:?}\n  {on_board:?}"
        ));
    }
    let needed = (ended.sequence - begun.sequence) as usize * scene.whiskers();
    if found.len() != expected.len() || found.len() != needed || needed == 0 {
        return wrong(format!(
            "{} records came, {} are on the PC, {needed} ticks' were asked for",
            found.len(),
            expected.len()
        ));
    }
    Ok(format!("{needed} records as on the PC, none lost"))
}

/// Commands as lines: what is answered, and what the records then tell.
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
        let heard = talk.pass(talk.part)?;
        let last = records(&heard).pop();
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
    let (answer, records) = talk.ask(Command::Stream(true))?;
    if answer.status != CommandStatus::TooSlow || !records.is_empty() {
        return wrong(format!("at {SLOW_BAUD} baud: {answer:?}"));
    }
    if talk.say("arm")? != ["ok arm"] {
        return wrong(format!("at {SLOW_BAUD} baud `arm` is not answered"));
    }
    Ok(format!("records are refused at {SLOW_BAUD} baud"))
}
