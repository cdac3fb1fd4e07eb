//! The link to a PC as a board has it: what it tells of every tick, what it does with
//! requests, what is lost where nobody reads, and what all that costs.

use std::path::Path;

use firmware::Packet;
use host_sim::Error;
use host_sim::trace::Row;
use scene::{PlantKind, Scene};
use wire::{Answer, Command, CommandStatus, Flags, TaggedCommand, TickRecord, WhiskerId};

use crate::board::Board;
use crate::compare::Pair;
use crate::deployment::{flashed, flashed_for};
use crate::emulate::start;
use crate::tuning::tune;

/// Most instructions of a tick for a whisker's record, where the core has an FPU and where it
/// has none. They were 120 and 240 while the scene was part of the types. Now that it is data
/// each record asks what there is; a program all for speed takes 158 and 259 too.
const STREAMING: f64 = 170.0;
const STREAMING_NO_FPU: f64 = 265.0;

/// The same where nobody asks for any.
const QUIET: f64 = 10.0;

/// For how long each program is measured, and every part of the conversation, s.
const MEASURED_S: f64 = 1.0;
const PART_S: f64 = 0.1;

/// By how much a record may be away from the world, degrees: a step of its numbers, and of
/// the encoder.
const ANGLE_DEG: f64 = 0.25;

/// A step of z.
const Z_STEP: f64 = 1.0 / 8192.0;

/// A value of 1 in Q24.
const ONE: i32 = 1 << 24;

/// Talks with the board that runs the scene in `path`, once with a program that has
/// telemetry and once `without`. Returns what was found.
///
/// # Errors
/// [`Error::Work`] says what is not as it should be.
pub fn talk(path: &Path, program: &Path, without: &Path) -> Result<Vec<String>, Error> {
    let mut said = converse(path, program)?;
    said.extend(tune(path, program)?);
    said.extend(cost(path, program, without)?);
    Ok(said)
}

/// What a PC wants of the board, in this order, a part of the time each.
fn script(scene: &Scene) -> Vec<(Command, CommandStatus)> {
    let whisks = scene.whisking.is_some();
    let left = WhiskerId::default();
    let nowhere = WhiskerId { side: 5, number: 9 };
    let motor = |status| {
        if whisks {
            status
        } else {
            CommandStatus::NoWhisker
        }
    };
    let mut script = vec![
        (Command::Hello, CommandStatus::Done),
        (Command::Stream(true), CommandStatus::Done),
        (Command::Gain(left, ONE / 2), motor(CommandStatus::Done)),
        (
            Command::Gain(left, 2 * ONE + ONE / 100),
            motor(CommandStatus::OutOfRange),
        ),
        (Command::Gain(nowhere, ONE), CommandStatus::NoWhisker),
        (Command::Setpoint(left, ONE / 5), motor(CommandStatus::Done)),
        (
            Command::Setpoint(left, 3 * ONE),
            motor(CommandStatus::OutOfRange),
        ),
        (Command::Release(left), motor(CommandStatus::Done)),
        (Command::Clear(left), motor(CommandStatus::Done)),
        (Command::Stop, motor(CommandStatus::Done)),
        (Command::Arm, motor(CommandStatus::Done)),
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

/// The board, and all it has sent.
struct Talk {
    pair: Pair,
    whiskers: u32,
    ticks: u32,
    part: u32,
    packets: Vec<Packet>,
    tag: u16,
    asked: Vec<TaggedCommand>,
    is_apart: bool,
}

impl Talk {
    fn board(&mut self) -> &mut Board {
        &mut self.pair.target.module_mut().board
    }

    /// Lets so many ticks pass. Records must tell what is so in the world, until a motor was
    /// stopped, after which nobody knows where its whisker rests, or nobody has read for long.
    fn pass(&mut self, ticks: u32) -> Result<(), Error> {
        for _ in 0..ticks {
            let before = self.pair.target.row().angle_deg;
            let row = self.pair.target.tick();
            self.ticks += 1;
            self.pair.target.module_mut().check()?;
            let packets = self.board().packets()?;
            for packet in &packets {
                if let Packet::Record(record) = packet
                    && !self.is_apart
                {
                    same_as_world(record, before, &row)?;
                }
            }
            self.packets.extend(packets);
        }
        Ok(())
    }

    /// Asks for something, and lets a part of the time pass.
    fn ask(&mut self, command: Command) -> Result<Answer, Error> {
        self.tag += 1;
        self.is_apart |= command == Command::Stop;
        let request = TaggedCommand {
            tag: self.tag,
            command,
        };
        if !self.board().request(&wire::frame(&request))? {
            return Err(Error::Work("no room for a request".to_owned()));
        }
        self.asked.push(request);
        self.pass(self.part)?;
        self.answer()
    }

    /// The answer to the last request.
    fn answer(&self) -> Result<Answer, Error> {
        let answers = self.packets.iter().filter_map(|packet| match packet {
            Packet::Answer(answer) if answer.tag == self.tag => Some(*answer),
            _ => None,
        });
        let mut answers = answers.collect::<Vec<_>>();
        match (answers.pop(), answers.pop()) {
            (Some(answer), None) => Ok(answer),
            (None, _) => Err(Error::Work(format!("request {} is not answered", self.tag))),
            _ => Err(Error::Work(format!(
                "request {} is answered twice",
                self.tag
            ))),
        }
    }

    fn records(&self) -> impl Iterator<Item = &TickRecord> {
        self.packets.iter().filter_map(|packet| match packet {
            Packet::Record(record) => Some(record),
            Packet::Answer(_) | Packet::Event(_) => None,
        })
    }
}

/// A scene on a board that is asked for this and that: the answers must be right, the
/// records those of the same module on the PC, and where nobody reads whole records be lost,
/// and counted.
fn converse(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    let pair = Pair::new(&mut loaded, &program)?;
    let scene = &loaded.scene;
    let mut talk = Talk {
        pair,
        whiskers: scene.whiskers() as u32,
        ticks: 0,
        part: (PART_S * f64::from(scene.tick_hz)) as u32,
        packets: Vec::new(),
        tag: 0,
        asked: Vec::new(),
        is_apart: false,
    };
    talk.pass(talk.part)?;
    let wrong = |what: String| Err(Error::Work(what));

    // Bytes that are no request, and half of one: the next is understood all the same.
    talk.board().request(&[0xA5; 17])?;
    talk.pass(2)?;
    for (command, status) in script(scene) {
        let answer = talk.ask(command)?;
        if answer.status != status || answer.command != command.number() {
            return wrong(format!("{command:?}: {answer:?}"));
        }
        if command == Command::Hello {
            let expected = [scene.tick_hz as i32, scene.whiskers() as i32];
            if answer.values != expected {
                return wrong(format!("{command:?}: {answer:?}"));
            }
        }
        let driven = talk.records().last().map(|record| record.duty != 0);
        if command == Command::Stop && driven != Some(false) {
            return wrong("driven after it was told to stop".to_owned());
        }
    }
    let name = name(&mut talk)?;
    if name != scene.name {
        return wrong(format!("it says that its scene is {name}"));
    }
    let lost = lose(&mut talk)?;
    let compared = equal(&mut talk)?;
    Ok(vec![
        format!(
            "{} requests answered, {} records as on the PC",
            talk.asked.len(),
            compared
        ),
        format!("{lost} records lost while nobody read, and counted"),
    ])
}

/// The name of the scene, as the board tells it.
fn name(talk: &mut Talk) -> Result<String, Error> {
    let mut letters = Vec::new();
    loop {
        let answer = talk.ask(Command::Name(letters.len() as u8))?;
        letters.extend(answer.values.map(i32::to_le_bytes).as_flattened());
        if letters.last() == Some(&0) {
            letters.retain(|letter| *letter != 0);
            return Ok(String::from_utf8_lossy(&letters).into_owned());
        }
    }
}

/// Nobody reads for a part of the time. What is lost must be whole ticks, the board's own
/// count that of the gap, and the record after the gap say so.
fn lose(talk: &mut Talk) -> Result<u32, Error> {
    let before = talk.ask(Command::Status)?.values[0];
    talk.is_apart = true;
    for _ in 0..2 * talk.part {
        talk.pair.target.tick();
        talk.ticks += 1;
    }
    let first = talk.packets.len();
    talk.pass(talk.part)?;
    let after = talk.ask(Command::Status)?.values[0];
    let told = after.wrapping_sub(before).cast_unsigned();

    let whiskers = talk.whiskers;
    let mut gap = 0;
    let records: Vec<TickRecord> = talk.packets[first..]
        .iter()
        .filter_map(|packet| match packet {
            Packet::Record(record) => Some(*record),
            Packet::Answer(_) | Packet::Event(_) => None,
        })
        .collect();
    for pair in records.windows(2) {
        let side = |record: &TickRecord| u32::from(record.flags.contains(Flags::RIGHT));
        let place = |record: &TickRecord| record.sequence * whiskers + side(record);
        let missing = place(&pair[1]) - place(&pair[0]) - 1;
        if pair[1].flags.contains(Flags::LOST) != (missing > 0) {
            return Err(Error::Work(format!("{missing} lost before {:?}", pair[1])));
        }
        gap += missing;
    }
    if gap != told || gap == 0 {
        return Err(Error::Work(format!("{gap} records lost, {told} counted")));
    }
    Ok(gap)
}

/// Runs the same on the PC: every record that was not lost must be the same. Returns how many
/// there were.
fn equal(talk: &mut Talk) -> Result<usize, Error> {
    let answers: Vec<Answer> = talk.packets.iter().filter_map(answered).collect();
    let mut expected = Vec::new();
    for tick in 0..talk.ticks {
        for request in &talk.asked {
            let is_now = |answer: &&Answer| answer.tag == request.tag && answer.sequence == tick;
            if answers.iter().any(|answer| is_now(&answer)) {
                talk.pair.host.module_mut().request(*request);
            }
        }
        talk.pair.host.tick();
        expected.extend(talk.pair.host.module_mut().take_packets());
    }
    let feels = talk.pair.feels;
    let plain = |record: &TickRecord| TickRecord {
        x: record.codes()[0],
        y: record.codes()[1],
        contact: if feels { record.contact } else { 0 },
        flags: record.flags.without(Flags::LOST),
        ..*record
    };
    let mut expected = expected.iter().filter_map(|packet| match packet {
        Packet::Record(record) => Some(plain(record)),
        Packet::Answer(_) | Packet::Event(_) => None,
    });
    let mut compared = 0;
    for record in talk.records().map(plain) {
        // Those before it were lost.
        let place = |of: &TickRecord| (of.sequence, of.flags.contains(Flags::RIGHT));
        let on_pc = expected.find(|on_pc| place(on_pc) == place(&record));
        if on_pc != Some(record) {
            return Err(Error::Work(format!(
                "a record on the PC, on the board\n  {on_pc:?}\n  {record:?}"
            )));
        }
        compared += 1;
    }
    Ok(compared)
}

fn answered(packet: &Packet) -> Option<Answer> {
    match packet {
        Packet::Answer(answer) => Some(*answer),
        Packet::Record(_) | Packet::Event(_) => None,
    }
}

/// Mean instructions of the tick's handler without telemetry, with telemetry that nobody
/// asks for, with a record a whisker, and with records that find no room; limits hold for the
/// last three.
fn cost(path: &Path, program: &Path, without: &Path) -> Result<Vec<String>, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    let scene = &mut loaded.scene;
    scene.duration_s = MEASURED_S;
    let mut silent = scene.clone();
    silent.telemetry.rtt = false;
    let without = flashed_for(&silent, path, without)?;
    let mut means = Vec::new();
    for (elf, streams, reads) in [
        (&without, false, true),
        (&program, false, true),
        (&program, true, true),
        (&program, true, false),
    ] {
        let mut run = start(scene, Vec::new(), elf)?;
        if streams {
            let command = Command::Stream(true);
            let bytes = wire::frame(&TaggedCommand { tag: 1, command });
            run.module_mut().board.request(&bytes)?;
        }
        for _ in 0..run.ticks() {
            run.tick();
            let emulated = run.module_mut();
            emulated.check()?;
            drop(emulated.take_log());
            if reads {
                emulated.board.packets()?;
            }
        }
        means.push(run.module_mut().meter.figures.tick.mean());
    }
    let has_fpu = program.model()?.facts.has_fpu;
    let each = if has_fpu { STREAMING } else { STREAMING_NO_FPU };
    let streaming_most = each * scene.whiskers() as f64;
    let [without, quiet, streaming, full] = means[..] else {
        return Err(Error::Work("four programs".to_owned()));
    };
    let mut said = Vec::new();
    for (what, mean, most) in [
        ("that nobody asks for", quiet, QUIET),
        ("with a record a whisker", streaming, streaming_most),
        ("with records that find no room", full, streaming_most),
    ] {
        let more = mean - without;
        said.push(format!(
            "telemetry {what}: {more:.1} instructions a tick beside {without:.1}"
        ));
        if more > most {
            let told = said.join("\n");
            return Err(Error::Work(format!("{told}\nat most {most} are allowed")));
        }
    }
    Ok(said)
}

/// A record must tell the angle that the encoder has read in its tick, `before` the world
/// moved on, the codes that its sensor has got, and z as a debugger reads it.
fn same_as_world(record: &TickRecord, before: [f64; 2], row: &Row) -> Result<(), Error> {
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
        return Err(Error::Work(format!(
            "at {} degrees with codes {codes:?} and z {z}: {record:?}",
            before[side]
        )));
    }
    Ok(())
}
