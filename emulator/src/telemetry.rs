//! The link to a PC as a board has it: what it sends of every tick, what it does with
//! requests, what is lost where it is not read, and what all that costs.

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
/// has none. They were 120 and 240 while the scene was part of the types; now that it is data each
/// record asks what there is, and goes by a queue to idle, which makes its frame.
const STREAMING: f64 = 180.0;
const STREAMING_NO_FPU: f64 = 265.0;

/// The same where nothing is asked for: a look at that queue's fellow for requests, and the events
/// of a tick noted for a record.
const QUIET: f64 = 14.0;

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
    part: u32,
    packets: Vec<Packet>,
    /// Of each tick: the angles before the world moved on, and what was so after it.
    worlds: Vec<([f64; 2], Row)>,
    tag: u16,
    asked: Vec<TaggedCommand>,
    is_apart: bool,
}

impl Talk {
    fn board(&mut self) -> &mut Board {
        &mut self.pair.target.module_mut().board
    }

    /// Lets so many ticks pass. Records must say what is so in the world, until a motor was
    /// stopped, after which it is not known where its whisker rests, or what was sent was not read.
    fn pass(&mut self, ticks: u32) -> Result<(), Error> {
        for _ in 0..ticks {
            self.tick()?;
            let packets = self.board().packets()?;
            for packet in &packets {
                if let Packet::Record(record) = packet
                    && !self.is_apart
                {
                    self.same_as_world(record)?;
                }
            }
            self.packets.extend(packets);
        }
        Ok(())
    }

    fn tick(&mut self) -> Result<(), Error> {
        let before = self.pair.target.row().angle_deg;
        self.worlds.push((before, self.pair.target.tick()));
        Ok(self.pair.target.module_mut().check()?)
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
        let answers = self.packets.iter().filter_map(answered);
        let answers: Vec<_> = answers.filter(|answer| answer.tag == self.tag).collect();
        match answers[..] {
            [answer] => Ok(answer),
            _ => Err(Error::Work(format!(
                "request {}: answered {answers:?}",
                self.tag
            ))),
        }
    }

    /// A record must have the angle that the encoder has read in its tick, before the world moved
    /// on, the codes that its sensor has got, and z as a debugger reads it.
    fn same_as_world(&self, record: &TickRecord) -> Result<(), Error> {
        let Some((before, row)) = self.worlds.get(record.sequence.wrapping_sub(1) as usize) else {
            return Err(Error::Work(format!("of a tick to come: {record:?}")));
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
            return Err(Error::Work(format!(
                "at {} degrees with codes {codes:?} and z {z}: {record:?}",
                before[side]
            )));
        }
        Ok(())
    }

    /// The records from this packet on.
    fn records(&self, first: usize) -> impl Iterator<Item = &TickRecord> {
        self.packets
            .iter()
            .skip(first)
            .filter_map(|packet| match packet {
                Packet::Record(record) => Some(record),
                Packet::Answer(_) | Packet::Event(_) => None,
            })
    }
}

/// A scene on a board that is asked for this and that: the answers must be right, the
/// records those of the same module on the PC, and where they are not read whole records be lost,
/// and counted.
fn converse(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    let pair = Pair::new(&mut loaded, &program)?;
    let scene = &loaded.scene;
    let mut talk = Talk {
        pair,
        whiskers: scene.whiskers() as u32,
        part: (PART_S * f64::from(scene.tick_hz)) as u32,
        packets: Vec::new(),
        worlds: Vec::new(),
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
        let expected = [scene.tick_hz as i32, scene.whiskers() as i32];
        if command == Command::Hello && answer.values != expected {
            return wrong(format!("{command:?}: {answer:?}"));
        }
        let driven = talk.records(0).last().map(|record| record.duty != 0);
        if command == Command::Stop && driven != Some(false) {
            return wrong("driven after it was to stop".to_owned());
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
    let lost = lose(&mut talk)?;
    let [records, events] = equal(&mut talk)?;
    Ok(vec![
        format!(
            "{} requests answered, {records} records and {events} events as on the PC",
            talk.asked.len()
        ),
        format!("{lost} records lost while none were read, and counted"),
    ])
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

/// Nothing is read for a part of the time. What is lost must be whole ticks, the board's own
/// count that of the gap, and the record after the gap say so.
fn lose(talk: &mut Talk) -> Result<u32, Error> {
    let before = talk.ask(Command::Status)?.values[0];
    talk.is_apart = true;
    for _ in 0..2 * talk.part {
        talk.tick()?;
    }
    let first = talk.packets.len();
    talk.pass(talk.part)?;
    let after = talk.ask(Command::Status)?.values[0];
    let counted = after.wrapping_sub(before).cast_unsigned();

    let whiskers = talk.whiskers;
    let mut gap = 0;
    let records: Vec<_> = talk.records(first).collect();
    for pair in records.windows(2) {
        let side = |record: &TickRecord| u32::from(record.flags.contains(Flags::RIGHT));
        let place = |record: &TickRecord| record.sequence * whiskers + side(record);
        let missing = place(pair[1]) - place(pair[0]) - 1;
        if pair[1].flags.contains(Flags::LOST) != (missing > 0) {
            return Err(Error::Work(format!("{missing} lost before {:?}", pair[1])));
        }
        gap += missing;
    }
    if gap != counted || gap == 0 {
        return Err(Error::Work(format!(
            "{gap} records lost, {counted} counted"
        )));
    }
    Ok(gap)
}

/// Runs the same on the PC: every record and every event must be the same, but in ticks of which
/// something was lost. Returns how many there were.
fn equal(talk: &mut Talk) -> Result<[usize; 2], Error> {
    let mut requests = Vec::new();
    for answer in talk.packets.iter().filter_map(answered) {
        let asked = talk.asked.iter().filter(|asked| asked.tag == answer.tag);
        requests.extend(asked.map(|asked| (answer.sequence, *asked)));
    }
    let expected = talk.pair.replay(0..talk.worlds.len() as u32, &requests);
    let mut expected = talk.pair.by_tick(&expected);
    let (mut records, mut events) = (0, 0);
    for (tick, found) in talk.pair.by_tick(&talk.packets) {
        let expected = expected.remove(&tick).unwrap_or_default();
        let count = found.iter().filter(|packet| is_record(packet)).count();
        let is_whole = count == talk.whiskers as usize;
        if found != expected && (is_whole || found.iter().any(|found| !expected.contains(found))) {
            return Err(Error::Work(format!(
                "tick {tick}: sent on the PC, on the board\n  {expected:?}\n  {found:?}"
            )));
        }
        records += count;
        events += found.len() - count;
    }
    Ok([records, events])
}

const fn is_record(packet: &Packet) -> bool {
    matches!(packet, Packet::Record(_))
}

const fn answered(packet: &Packet) -> Option<Answer> {
    match packet {
        Packet::Answer(answer) => Some(*answer),
        Packet::Record(_) | Packet::Event(_) => None,
    }
}

/// Mean instructions of the tick's handler without telemetry, with telemetry that is
/// not asked for, with a record a whisker, and with records that find no room; limits hold for the
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
        ("that is not asked for", quiet, QUIET),
        ("with a record a whisker", streaming, streaming_most),
        ("with records that find no room", full, streaming_most),
    ] {
        let more = mean - without;
        said.push(format!(
            "telemetry {what}: {more:.1} instructions a tick beside {without:.1}"
        ));
        if more > most {
            let said = said.join("\n");
            return Err(Error::Work(format!("{said}\nat most {most} are allowed")));
        }
    }
    Ok(said)
}
