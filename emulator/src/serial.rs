//! The serial line as a board has it: what it says, what it does with what is asked for, and
//! that the tick takes no longer for it.

mod lines;

use std::path::Path;

use firmware::Packet;
use host_sim::Error;
use host_sim::loaded::Loaded;
use scene::Scene;
use wire::{Command, CommandStatus, Flags, TaggedCommand, TickRecord, WhiskerId};

use crate::compare::Pair;
use crate::cost::{Asks, Price, cost};
use crate::deployment::{flashed, flashed_for};
use crate::talk::{Talk, records, wrong};

/// For how long records are compared, s.
const RECORDS_S: f64 = 0.5;

/// A baud that does not carry the records of the scene.
const SLOW_BAUD: u32 = 115_200;

/// By how many instructions a tick may be longer for the port: a look at whether something has come
/// in which there may be a stop, and what the compiler does otherwise where another part of the
/// program differs.
const MORE: f64 = 15.0;

/// Talks with a board that runs the scene in `path` by the program that has its serial port,
/// one with [`SLOW_BAUD`] and one without. Returns what was found.
pub(crate) fn talk(
    path: &Path,
    [program, slow, without]: [&Path; 3],
) -> Result<Vec<String>, Error> {
    let mut said = converse(path, program)?;
    said.push(refuse_records(path, slow)?);
    let silence = |scene: &mut Scene| scene.telemetry.serial_baud = None;
    said.extend(cost(path, [program, without], silence, |_, _| {
        PRICES.to_vec()
    })?);
    Ok(said)
}

fn converse(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    let mut talk = Talk::new(Pair::new(&mut loaded, &program)?, true);
    let scene = &loaded.scene;
    Ok(vec![
        lines::compare(&mut talk, scene)?,
        compare_packets(&mut talk, scene)?,
        commands(&mut talk)?,
        garbage(&mut talk)?,
    ])
}

fn say(talk: &mut Talk, line: &str) -> Result<Vec<String>, Error> {
    write(talk, format!("{line}\n").as_bytes(), talk.part)
}

/// Sends bytes, and lets so many ticks pass; the lines that came and begin with no time: replies.
fn write(talk: &mut Talk, bytes: &[u8], ticks: u32) -> Result<Vec<String>, Error> {
    let from = talk.lines.len();
    talk.pair.target.serial_write(bytes);
    talk.pass(ticks)?;
    let is_reply = |line: &&String| !line.starts_with(|first: char| first.is_ascii_digit());
    let new = talk.lines.iter().skip(from);
    Ok(new.filter(is_reply).cloned().collect())
}

fn exchange(talk: &mut Talk, exchanges: &[(&str, &str)]) -> Result<(), Error> {
    for (line, expected) in exchanges {
        let replies = say(talk, line)?;
        if replies != [*expected] {
            return wrong(format!(
                "{line:?} was answered by {replies:?}, not {expected:?}"
            ));
        }
    }
    Ok(())
}

/// Records and events by the line are those of the same module on the PC, and none is lost.
fn compare_packets(talk: &mut Talk, scene: &Scene) -> Result<String, Error> {
    let hello = talk.ask(Command::Hello)?;
    if hello.values != [scene.tick_hz as i32, scene.whiskers() as i32] {
        return wrong(format!("{hello:?}"));
    }
    let lost = talk.ask(Command::Status)?.values[0];
    let from = talk.packets.len();
    let first = talk.ask(Command::Stream(true))?.sequence;
    talk.pass(talk.pair.target.ticks_of(RECORDS_S))?;
    // A command in between leaves no gap.
    talk.ask(Command::Gain(WhiskerId::default(), 1 << 23))?;
    talk.pass(talk.part)?;
    let last = talk.ask(Command::Stream(false))?.sequence;
    talk.pass(talk.part)?;
    let until = talk.packets.len();
    if talk.ask(Command::Status)?.values[0] != lost {
        return wrong("records were lost");
    }
    talk.pass(talk.part)?;
    let is_answer = |packet: &Packet| matches!(packet, Packet::Answer(_));
    if !talk.packets[until..].iter().all(is_answer) {
        return wrong("records after the last");
    }
    let expected = talk.follow()?;
    let found = &talk.packets[from..until];
    let [records, events] = talk.same([found, &expected], scene.whiskers(), false)?;
    let ticks = (last - first) as usize;
    if records != ticks * scene.whiskers() || ticks == 0 {
        return wrong(format!("{records} records of {ticks} ticks"));
    }
    Ok(format!(
        "records of {ticks} ticks and {events} events as on the PC, none lost"
    ))
}

fn commands(talk: &mut Talk) -> Result<String, Error> {
    const BEGIN: [(&str, &str); 9] = [
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
    const END: [(&str, &str); 3] = [
        ("arm", "ok arm"),
        ("release left", "ok release"),
        ("stream off", "ok stream"),
    ];
    let last = |talk: &mut Talk| -> Result<TickRecord, Error> {
        let from = talk.packets.len();
        talk.pass(talk.part)?;
        let last = records(&talk.packets[from..]).next_back().copied();
        last.map_or_else(|| wrong("no record after `stream on`"), Ok)
    };
    exchange(talk, &BEGIN)?;
    let held = last(talk)?;
    // 70 degrees are θ = 0.2.
    if (wire::unit(held.setpoint) - 0.2).abs() > 2e-4 || !held.flags.contains(Flags::ARMED) {
        return wrong(format!("armed, to be held at 70 degrees: {held:?}"));
    }
    say(talk, "stop")?;
    let stopped = last(talk)?;
    if stopped.flags.contains(Flags::ARMED) || stopped.duty != 0 {
        return wrong(format!("stopped: {stopped:?}"));
    }
    exchange(talk, &END)?;
    Ok(format!(
        "{} commands by line answered and carried out",
        BEGIN.len() + 1 + END.len()
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
        let replies = write(talk, bytes, talk.part / 4)?;
        let refused = replies.iter().filter(|reply| reply.starts_with("refused"));
        if refused.count() != refusals {
            return wrong(format!("{bytes:?} was answered by {replies:?}"));
        }
    }
    let hello = talk.ask(Command::Hello)?;
    let replies = say(talk, "status")?;
    let is_status = |reply: &String| reply.starts_with("ok status ");
    if hello.status != CommandStatus::Done || !replies.iter().any(is_status) {
        return wrong(format!("after garbage: {hello:?}, {replies:?}"));
    }
    Ok("garbage refused, and what follows it understood".to_owned())
}

fn refuse_records(path: &Path, program: &Path) -> Result<String, Error> {
    let mut loaded = Loaded::new(path)?;
    loaded.scene.telemetry.serial_baud = Some(SLOW_BAUD);
    let program = flashed_for(&loaded, program)?;
    let mut talk = Talk::new(Pair::new(&mut loaded, &program)?, true);
    talk.pass(talk.part)?;
    let replies = say(&mut talk, "stream on")?;
    let is_refused = |reply: &String| reply.starts_with("refused stream: records of every tick");
    if replies.len() != 1 || !replies.iter().all(is_refused) {
        return wrong(format!("at {SLOW_BAUD} baud: {replies:?}"));
    }
    let answer = talk.ask(Command::Stream(true))?;
    talk.pass(talk.part)?;
    if answer.status != CommandStatus::TooSlow || talk.packets.len() != 1 {
        return wrong(format!("at {SLOW_BAUD} baud: {answer:?}"));
    }
    exchange(&mut talk, &[("arm", "ok arm")])?;
    Ok(format!("records are refused at {SLOW_BAUD} baud"))
}

/// What the serial port costs a tick, without records and with records that go there in place of
/// to a probe: that look.
const PRICES: [Price; 2] = [
    ("a serial port", [Asks::Nothing, Asks::Nothing], MORE),
    (
        "a serial port with records",
        [Asks::Serial, Asks::Probe],
        MORE,
    ),
];
