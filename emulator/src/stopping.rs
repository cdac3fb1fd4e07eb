//! Motors that are stopped while the links are flooded: the tick after the one in which a stop has
//! come must drive none, and each stop must be answered.

use std::path::Path;

use firmware::Packet;
use host_sim::Error;
use wire::{Command, CommandStatus, TaggedCommand, WhiskerId};

use crate::deployment::flashed;
use crate::program::Program;
use crate::session::{Session, answer_to};
use crate::talk::wrong;

/// What comes by the serial line meanwhile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Line {
    Quiet,
    /// So many of this line a second.
    Paced(&'static str, u32),
    /// As many bytes as the line carries, of these again and again.
    Full(&'static [u8]),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum By {
    Line,
    SerialFrame,
    Probe,
    Button,
}

struct Flood {
    what: &'static str,
    line: Line,
    /// What a probe asks for in every tick in which there is room.
    probe: Option<Command>,
    by: By,
}

const GAIN: Option<Command> = Some(Command::Gain(WhiskerId { side: 0, number: 0 }, 1 << 24));
const ARM: Option<Command> = Some(Command::Arm);

const STATUS: Line = Line::Full(b"status\n");
const ARMS: Line = Line::Full(b"arm\n");
/// Text in which a line could not begin: it would make another of it.
const TEXT: Line = Line::Full(b"gain ");
const GARBAGE: Line = Line::Full(b"\xA5\xFF stop");
const GAINS: Line = Line::Paced("gain left 1\n", 3_000);

const FLOODS: [Flood; 11] = [
    Flood::new("nothing else comes", Line::Quiet, None, By::Line),
    Flood::new("3,000 gain lines a second", GAINS, None, By::Line),
    Flood::new("status at line rate", STATUS, None, By::Line),
    Flood::new(
        "status at line rate, a frame",
        STATUS,
        None,
        By::SerialFrame,
    ),
    Flood::new("garbage without an end", GARBAGE, None, By::Line),
    Flood::new("text without an end", TEXT, None, By::Line),
    Flood::new("arm lines at line rate", ARMS, None, By::Line),
    Flood::new("a probe that arms each tick", Line::Quiet, ARM, By::Line),
    Flood::new("status and a busy probe", STATUS, GAIN, By::Probe),
    Flood::new("arm lines and an arming probe", ARMS, ARM, By::Probe),
    Flood::new("status and a busy probe", STATUS, GAIN, By::Button),
];

impl Flood {
    const fn new(what: &'static str, line: Line, probe: Option<Command>, by: By) -> Self {
        Self {
            what,
            line,
            probe,
            by,
        }
    }

    fn arms(&self) -> bool {
        self.line == ARMS || self.probe == ARM
    }
}

/// Bytes that wait at the other end of a line that is full, at most: a tick has half of them.
const AHEAD: usize = 100;

/// Ticks in which motors must be driven once they are armed, in which a stop must be answered, and
/// in which they stay off after it.
const DRIVEN: u32 = 2_000;
const ANSWERED: u32 = 400;
const OFF: u32 = 20;

struct Flooded<'f> {
    session: Session,
    flood: &'f Flood,
    ticks: u32,
    /// Bytes sent by the other end, and written for it.
    written: usize,
    /// Of what is sent again and again, the next byte.
    next: usize,
    lines: u32,
    received: Vec<u8>,
    packets: Vec<Packet>,
    log: Vec<String>,
    random: u32,
}

pub(crate) fn stopping(path: &Path, program: &Path, stops: u32) -> Result<Vec<String>, Error> {
    let (loaded, program) = flashed(path, program)?;
    let mut said = Vec::new();
    for flood in &FLOODS {
        let in_flood = |error| Error::Work(format!("{}, by {:?}: {error}", flood.what, flood.by));
        let found = flooded(&loaded.scene, &program, flood, stops).map_err(in_flood)?;
        said.push(found);
    }
    said.push(together(&loaded.scene, &program)?);
    Ok(said)
}

/// A stop and an arming that come in one tick: the later one holds.
fn together(scene: &scene::Scene, program: &Program) -> Result<String, Error> {
    const REFUSED: &str = "ok stop\r\nrefused arm: a stop has come since\r\n";
    let mut session = Session::of(scene, Vec::new(), program)?;
    for (said, answers, is_driven) in [
        ("stop\narm\n", "ok stop\r\nok arm\r\n", true),
        ("arm\nstop\n", REFUSED, false),
    ] {
        session.serial_read();
        session.serial_write(said.as_bytes());
        let mut driven = false;
        for tick in 0..ANSWERED {
            session.tick()?;
            driven |= tick > OFF && session.drives();
        }
        let received = session.serial_read();
        if !has(&received, answers.as_bytes()) || driven != is_driven {
            let received = String::from_utf8_lossy(&received).into_owned();
            return wrong(format!(
                "{said:?}: driven: {driven}, answered by {received:?}"
            ));
        }
    }
    Ok("of a stop and an arming that come in one tick the later one holds".to_owned())
}

fn flooded(
    scene: &scene::Scene,
    program: &Program,
    flood: &Flood,
    stops: u32,
) -> Result<String, Error> {
    let mut on = Flooded {
        session: Session::of(scene, Vec::new(), program)?,
        flood,
        ticks: 0,
        written: 0,
        next: 0,
        lines: 0,
        received: Vec::new(),
        packets: Vec::new(),
        log: Vec::new(),
        random: 1,
    };
    let (mut latest, mut slowest) = (0, 0);
    for stop in 0..stops {
        on.arm(stop)?;
        for _ in 0..on.drawn(20) {
            on.tick()?;
        }
        on.until_driven()?;
        let (late, answered) = on.stop(stop)?;
        latest = latest.max(late);
        slowest = slowest.max(answered);
    }
    Ok(format!(
        "{}: {stops} of {stops} stops by {:?} obeyed, off {latest} ticks after the last byte at \
         most, answered within {slowest} ticks",
        flood.what, flood.by
    ))
}

impl Flooded<'_> {
    fn drawn(&mut self, most: u32) -> u32 {
        let product = self.random.wrapping_mul(1_664_525);
        self.random = product.wrapping_add(1_013_904_223);
        (self.random >> 16) % most
    }

    fn write(&mut self, bytes: &[u8]) {
        self.session.serial_write(bytes);
        self.written += bytes.len();
    }

    /// Bytes that the other end has sent.
    fn sent(&mut self) -> usize {
        self.written - self.session.machine().chip().serial_waiting()
    }

    fn tick(&mut self) -> Result<(), Error> {
        match self.flood.line {
            Line::Quiet => {}
            Line::Paced(line, hz) => {
                let due = u64::from(self.ticks) * u64::from(hz) / u64::from(self.session.tick_hz);
                while u64::from(self.lines) < due {
                    self.write(line.as_bytes());
                    self.lines += 1;
                }
            }
            Line::Full(again) => {
                let waiting = self.written - self.sent();
                let rest = again.iter().copied().cycle().skip(self.next);
                let bytes: Vec<u8> = rest.take(AHEAD.saturating_sub(waiting)).collect();
                self.next = (self.next + bytes.len()) % again.len();
                self.write(&bytes);
            }
        }
        if let Some(command) = self.flood.probe {
            self.session.request(TaggedCommand { tag: 0, command })?;
        }
        self.session.tick()?;
        self.ticks += 1;
        self.received.extend(self.session.serial_read());
        self.packets.extend(self.session.packets()?);
        self.log.extend(self.session.log());
        Ok(())
    }

    fn request(&mut self, request: TaggedCommand) -> Result<(), Error> {
        for _ in 0..ANSWERED {
            if self.session.request(request)? {
                return Ok(());
            }
            self.tick()?;
        }
        wrong("there is no room for a request")
    }

    fn until_driven(&mut self) -> Result<(), Error> {
        for _ in 0..DRIVEN {
            if self.session.drives() {
                return Ok(());
            }
            self.tick()?;
        }
        wrong("no motor is driven once they are armed")
    }

    fn arm(&mut self, stop: u32) -> Result<(), Error> {
        let command = Command::Arm;
        let tag = 0x8000 | stop as u16;
        self.request(TaggedCommand { tag, command })?;
        self.packets.clear();
        for _ in 0..ANSWERED {
            self.tick()?;
            if let Some(answer) = answer_to(tag, &self.packets) {
                return match answer.status {
                    CommandStatus::Done => Ok(()),
                    _ => wrong(format!("not armed: {answer:?}")),
                };
            }
        }
        wrong("arming is not answered")
    }

    /// Stops the motors: how many ticks later they were off, and how many later it was answered.
    fn stop(&mut self, stop: u32) -> Result<(u32, u32), Error> {
        let tag = stop as u16 & 0x7FFF | 1;
        let request = TaggedCommand {
            tag,
            command: Command::Stop,
        };
        self.received.clear();
        self.packets.clear();
        self.log.clear();
        match self.flood.by {
            By::Line => {
                if ![TEXT, GARBAGE].contains(&self.flood.line) {
                    self.end_line();
                }
                self.write(b"stop\n");
            }
            By::SerialFrame => self.write(&wire::frame(&request)),
            By::Probe => self.request(request)?,
            By::Button => self.session.machine().chip().set_button(true),
        }
        // What a probe writes, and a button, is there at once.
        let end = match self.flood.by {
            By::Line | By::SerialFrame => self.written,
            By::Probe | By::Button => 0,
        };
        let late = self.until_off(end)?;
        if self.flood.by == By::Button {
            self.session.machine().chip().set_button(false);
        }
        let mut answered = 0;
        while !self.is_answered(tag) {
            if answered > ANSWERED {
                return wrong("a stop is not answered");
            }
            self.tick()?;
            answered += 1;
        }
        for _ in 0..OFF {
            self.tick()?;
            if !self.flood.arms() && self.session.drives() {
                return wrong("a motor is driven after a stop");
            }
        }
        Ok((late, answered))
    }

    fn end_line(&mut self) {
        if let Line::Full(again) = self.flood.line
            && self.next != 0
        {
            self.write(&again[self.next..]);
            self.next = 0;
        }
    }

    /// How many ticks after the one in whose time byte `end` has come motors are off.
    fn until_off(&mut self, end: usize) -> Result<u32, Error> {
        let mut come = None;
        for n in 0..ANSWERED {
            self.tick()?;
            if come.is_none() && self.sent() >= end {
                come = Some(n);
            }
            if let Some(come) = come {
                if !self.session.drives() {
                    return Ok(n - come);
                }
                if n > come {
                    return wrong("a motor is driven in the tick after a stop");
                }
            }
        }
        wrong("the stop does not come")
    }

    fn is_answered(&self, tag: u16) -> bool {
        match self.flood.by {
            By::Line => has(&self.received, b"ok stop\r\n"),
            By::SerialFrame => {
                let mut receiver = host_sim::received::Receiver::default();
                answer_to(tag, &receiver.packets(&self.received)).is_some()
            }
            By::Probe => answer_to(tag, &self.packets).is_some(),
            // It waits for no answer; the log has it.
            By::Button => self.log.iter().any(|line| line.ends_with(" stopped")),
        }
    }
}

fn has(bytes: &[u8], what: &[u8]) -> bool {
    bytes.windows(what.len()).any(|found| found == what)
}
