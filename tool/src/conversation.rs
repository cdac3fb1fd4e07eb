//! Requests to a module, and their answers from among all that it tells.

use std::collections::VecDeque;

use firmware::{Packet, Relay};
use host_sim::origin::Origin;
use host_sim::{Error, report};
use wire::{Answer, Command, CommandStatus, TaggedCommand, WhiskerId};

use crate::source::{Incoming, Source};

const PATIENCE_S: f64 = 2.0;

/// After how long without a record they are asked for again: a module that was reset sends none. And
/// for how long none may come, s.
const ASKED_AGAIN_S: f64 = 1.0;
const SILENCE_S: f64 = 20.0;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct AboutModule {
    pub(crate) scene: String,
    pub(crate) tick_hz: u32,
    pub(crate) whiskers: usize,
}

pub(crate) struct Conversation {
    source: Box<dyn Source>,
    tag: u16,
    /// What has come while an answer was waited for.
    kept: VecDeque<Incoming>,
    /// Ticks a second and the classes of a module whose log is made of its events.
    logs: Option<(u32, Vec<String>)>,
    /// When the last record came, or records were asked for first and last, while they are to.
    streams: Option<[f64; 2]>,
}

impl Conversation {
    pub(crate) fn new(source: Box<dyn Source>) -> Self {
        Self {
            source,
            tag: 0,
            kept: VecDeque::new(),
            logs: None,
            streams: None,
        }
    }

    pub(crate) fn source(&mut self) -> &mut dyn Source {
        &mut *self.source
    }

    /// What comes next; what came while an answer was waited for comes first.
    pub(crate) fn receive(&mut self) -> Result<Incoming, Error> {
        let mut incoming = match self.kept.pop_front() {
            Some(incoming) => incoming,
            None => self.source.next()?,
        };
        self.stream_again(&incoming)?;
        if let Some((tick_hz, classes)) = &self.logs {
            let packets = incoming.packets.iter();
            let lines = packets.filter_map(|packet| line(packet, *tick_hz, classes));
            incoming.lines.extend(lines);
        }
        Ok(incoming)
    }

    fn stream_again(&mut self, incoming: &Incoming) -> Result<(), Error> {
        let now_s = self.source.now_s();
        let Some([since_s, asked_s]) = &mut self.streams else {
            return Ok(());
        };
        if incoming.records().next().is_some() {
            [*since_s, *asked_s] = [now_s; 2];
        } else if now_s - *since_s > SILENCE_S {
            let fault = format!("no record has come for {SILENCE_S} s");
            return Err(Error::Work(fault));
        } else if now_s - *asked_s > ASKED_AGAIN_S {
            *asked_s = now_s;
            self.send(Command::Stream(true))?;
        }
        Ok(())
    }

    /// Has its log come with what else does. That of a board which another one asks is made of the
    /// events that it sends.
    pub(crate) fn follow_log(&mut self) -> Result<(), Error> {
        if self.source.node().is_none() {
            return self.source.has_log();
        }
        self.ask(Command::Stream(true))?;
        self.logs = Some((self.about()?.tick_hz, self.classes()?));
        Ok(())
    }

    /// What [`Self::follow_log`] has begun ends.
    pub(crate) fn leave_log(&mut self) -> Result<(), Error> {
        match self.logs.take() {
            Some(_) => self.ask(Command::Stream(false)).map(drop),
            None => Ok(()),
        }
    }

    /// Of how many of its ticks one has its records sent.
    pub(crate) fn every(&self, tick_hz: u32) -> u32 {
        match self.source.node() {
            Some(_) => Relay::every(tick_hz),
            None => 1,
        }
    }

    pub(crate) fn print_log(&mut self, seconds: f64) -> Result<(), Error> {
        if seconds <= 0.0 {
            return Ok(());
        }
        if self.source.node().is_some() {
            self.follow_log()?;
        }
        let begun = self.source.now_s();
        while self.source.now_s() - begun < seconds {
            self.receive()?.lines.iter().for_each(report::say);
        }
        self.leave_log()
    }

    pub(crate) fn take_kept(&mut self) -> VecDeque<Incoming> {
        std::mem::take(&mut self.kept)
    }

    /// Asks for something, without waiting; the answer has the tag that is returned.
    pub(crate) fn send(&mut self, command: Command) -> Result<u16, Error> {
        self.send_to(None, command)
    }

    /// The same of another board of its head, if there is a `node`.
    pub(crate) fn send_to(&mut self, node: Option<u8>, command: Command) -> Result<u16, Error> {
        self.tag = self.tag.wrapping_add(1);
        let tag = self.tag;
        self.source.request(node, TaggedCommand { tag, command })?;
        Ok(tag)
    }

    /// Whether it is a board of a head: then that has a first one.
    pub(crate) fn is_of_head(&mut self) -> Result<bool, Error> {
        let tag = self.send_to(Some(0), Command::Hello)?;
        let answer = self.await_answer(tag, Command::Hello)?;
        Ok(answer.status == CommandStatus::Done)
    }

    /// Asks for something and waits for the answer, which must be that it is done.
    pub(crate) fn ask(&mut self, command: Command) -> Result<Answer, Error> {
        let answer = self.answer(command)?;
        match answer.status {
            CommandStatus::Done => Ok(answer),
            CommandStatus::NotHere => Err(Error::Work(format!(
                "{}: {}, scene or simulation",
                command.name(),
                CommandStatus::NotHere
            ))),
            status => Err(Error::Work(format!("{}: {status}", command.name()))),
        }
    }

    pub(crate) fn answer(&mut self, command: Command) -> Result<Answer, Error> {
        let tag = self.send(command)?;
        let answer = self.await_answer(tag, command)?;
        if let Command::Stream(on) = command {
            let streams = on && answer.status == CommandStatus::Done;
            self.streams = streams.then(|| [self.source.now_s(); 2]);
        }
        Ok(answer)
    }

    fn await_answer(&mut self, tag: u16, command: Command) -> Result<Answer, Error> {
        let begun = self.source.now_s();
        while self.source.now_s() - begun < PATIENCE_S {
            let mut incoming = self.source.next()?;
            let is_it =
                |packet: &Packet| matches!(packet, Packet::Answer(answer) if answer.tag == tag);
            let found = incoming.packets.iter().position(is_it);
            let found = found.map(|at| incoming.packets.remove(at));
            self.kept.push_back(incoming);
            if let Some(Packet::Answer(answer)) = found {
                return Ok(answer);
            }
        }
        Err(Error::Work(format!(
            "{command:?}: no answer in {PATIENCE_S} s; is the module's program older than this one, \
             or of a scene with telemetry.rtt = false?"
        )))
    }

    /// The zero of a whisker's sensor, codes from mid-scale, where the module finds it.
    pub(crate) fn zero(&mut self, whisker: WhiskerId) -> Result<Option<[i32; 2]>, Error> {
        let answer = self.answer(Command::Zero(whisker))?;
        // Older firmware does not know the command, as it knows no zero.
        Ok((answer.status == CommandStatus::Done).then_some(answer.values))
    }

    pub(crate) fn origin(&mut self) -> Result<Origin, Error> {
        let [version, patch] = self.ask(Command::Version)?.values;
        let (major, minor) = (version >> 16, version & 0xFFFF);
        let version = format!("{major}.{minor}.{patch}");
        Ok(self.source.origin().with("firmware", version))
    }

    pub(crate) fn about(&mut self) -> Result<AboutModule, Error> {
        let [tick_hz, whiskers] = self.ask(Command::Hello)?.values;
        let tick_hz = tick_hz.cast_unsigned();
        if tick_hz == 0 {
            return Err(Error::Work(
                "the module says that it does not tick".to_owned(),
            ));
        }
        let scene = self.name(Command::Name)?;
        Ok(AboutModule {
            scene,
            tick_hz,
            whiskers: usize::try_from(whiskers).unwrap_or(1),
        })
    }

    pub(crate) fn classes(&mut self) -> Result<Vec<String>, Error> {
        let answer = self.answer(Command::Model)?;
        let count = match answer.status {
            CommandStatus::Done => u8::try_from(answer.values[1]).unwrap_or(0),
            _ => 0,
        };
        let mut name = |class| self.name(|from| Command::Class(class, from));
        (0..count).map(&mut name).collect()
    }

    /// A name, letters of which `command` asks for.
    fn name(&mut self, command: impl Fn(u8) -> Command) -> Result<String, Error> {
        let mut letters: Vec<u8> = Vec::new();
        while let Ok(from) = u8::try_from(letters.len()) {
            let answer = self.ask(command(from))?;
            letters.extend(answer.values.map(i32::to_le_bytes).as_flattened());
            if letters.last() == Some(&0) {
                break;
            }
        }
        letters.retain(|letter| *letter != 0);
        // A board of another version may have others in its names than are allowed.
        let name = String::from_utf8_lossy(&letters);
        Ok(name.replace(tactile::name::is_hidden, "\u{fffd}"))
    }
}

fn line(packet: &Packet, tick_hz: u32, classes: &[String]) -> Option<String> {
    let Packet::Event(event) = packet else {
        return None;
    };
    let tick_hz = tick_hz.max(1);
    let t_s = f64::from(event.sequence) / f64::from(tick_hz);
    report::logged(t_s, &event.event, classes, Some(1_000_000 / tick_hz))
}
