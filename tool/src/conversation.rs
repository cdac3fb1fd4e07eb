//! Requests to a module, and their answers from among all that it tells.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

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

/// For how long a board of a head that sends records may be silent, s.
const ELSEWHERE_S: f64 = 3.0;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct AboutModule {
    pub(crate) scene: String,
    pub(crate) tick_hz: u32,
    pub(crate) whiskers: usize,
}

pub(crate) struct Conversation {
    source: Box<dyn Source>,
    /// The board of a head that is asked by way of the one that is connected.
    node: Option<u8>,
    begun: Instant,
    /// When something has come of that board last, s, while it is to send records.
    came_s: Option<f64>,
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
        Self::with(source, None)
    }

    /// With that board of a head, by way of the one that is connected.
    pub(crate) fn with(source: Box<dyn Source>, node: Option<u8>) -> Self {
        Self {
            source,
            node,
            begun: Instant::now(),
            came_s: None,
            tag: 0,
            kept: VecDeque::new(),
            logs: None,
            streams: None,
        }
    }

    pub(crate) const fn node(&self) -> Option<u8> {
        self.node
    }

    /// The time where the module is, s.
    pub(crate) fn now_s(&mut self) -> f64 {
        match self.node {
            // The source's is by the clock of the board between.
            Some(_) if !self.source.has_clock() => self.begun.elapsed().as_secs_f64(),
            _ => self.source.now_s(),
        }
    }

    fn next(&mut self) -> Result<Incoming, Error> {
        let incoming = self.source.next()?;
        let Some(node) = self.node else {
            return Ok(incoming);
        };
        let now_s = self.now_s();
        if let Some(came_s) = &mut self.came_s {
            if !incoming.packets.is_empty() {
                *came_s = now_s;
            }
            if now_s - *came_s > ELSEWHERE_S {
                return Err(Error::Work(format!(
                    "board {node} has sent nothing for {ELSEWHERE_S} s: has it lost its supply or \
                     its bus, or started again?"
                )));
            }
        }
        // Lines and restarts are those of the board between.
        Ok(Incoming {
            packets: incoming.packets,
            ..Incoming::default()
        })
    }

    pub(crate) fn source(&mut self) -> &mut dyn Source {
        &mut *self.source
    }

    /// What comes next; what came while an answer was waited for comes first.
    pub(crate) fn receive(&mut self) -> Result<Incoming, Error> {
        let mut incoming = match self.kept.pop_front() {
            Some(incoming) => incoming,
            None => self.next()?,
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
        let now_s = self.now_s();
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
        if self.node.is_none() {
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
        match self.node {
            Some(_) => Relay::every(tick_hz),
            None => 1,
        }
    }

    pub(crate) fn print_log(&mut self, seconds: f64) -> Result<(), Error> {
        if seconds <= 0.0 {
            return Ok(());
        }
        if self.node.is_some() {
            self.follow_log()?;
        }
        let begun = self.now_s();
        while self.now_s() - begun < seconds {
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
        if let (None, Command::Stream(on)) = (node, command) {
            // Asked again, it has been silent for as long.
            let now_s = self.now_s();
            self.came_s = on.then(|| self.came_s.unwrap_or(now_s));
        }
        let request = TaggedCommand { tag, command };
        self.source.request(node.or(self.node), request)?;
        Ok(tag)
    }

    /// Asks for something and waits so long for the answer, by the PC's clock; drops what else comes.
    pub(crate) fn ask_within(
        &mut self,
        command: Command,
        patience: Duration,
    ) -> Result<Option<Answer>, Error> {
        let tag = self.send(command)?;
        let begun = Instant::now();
        while begun.elapsed() < patience {
            let found = answer_of(&mut self.next()?, tag);
            if found.is_some() {
                return Ok(found);
            }
        }
        Ok(None)
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
        let name = command.name();
        match answer.status {
            CommandStatus::Done => Ok(answer),
            status @ CommandStatus::NotHere => Err(Error::Work(format!(
                "{name}: {status}, scene or simulation"
            ))),
            status => Err(Error::Work(format!("{name}: {status}"))),
        }
    }

    pub(crate) fn answer(&mut self, command: Command) -> Result<Answer, Error> {
        let tag = self.send(command)?;
        let answer = self.await_answer(tag, command)?;
        if let Command::Stream(on) = command {
            let streams = on && answer.status == CommandStatus::Done;
            self.streams = streams.then(|| [self.now_s(); 2]);
        }
        Ok(answer)
    }

    /// Motors are off from here on, where there are any.
    pub(crate) fn stop(&mut self) -> Result<(), Error> {
        match self.answer(Command::Stop)?.status {
            CommandStatus::Done | CommandStatus::NoWhisker => Ok(()),
            status => Err(Error::Work(format!("stop: {status}"))),
        }
    }

    fn await_answer(&mut self, tag: u16, command: Command) -> Result<Answer, Error> {
        let begun = self.now_s();
        while self.now_s() - begun < PATIENCE_S {
            let mut incoming = self.next()?;
            let found = answer_of(&mut incoming, tag);
            self.kept.push_back(incoming);
            if let Some(answer) = found {
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
        let origin = self.source.origin();
        let origin = match self.node {
            Some(node) => origin.with("node", node),
            None => origin,
        };
        Ok(origin.with("firmware", version))
    }

    pub(crate) fn about(&mut self) -> Result<AboutModule, Error> {
        let [tick_hz, whiskers] = self.ask(Command::Hello)?.values;
        let tick_hz = tick_hz.cast_unsigned();
        if tick_hz == 0 {
            let fault = "the module says that it does not tick";
            return Err(Error::Work(fault.to_owned()));
        }
        Ok(AboutModule {
            scene: self.name(Command::Name)?,
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

/// Takes the answer to a request from among what has come.
pub(crate) fn answer_of(incoming: &mut Incoming, tag: u16) -> Option<Answer> {
    let is_it = |packet: &mut Packet| matches!(packet, Packet::Answer(answer) if answer.tag == tag);
    match incoming.packets.extract_if(.., is_it).next() {
        Some(Packet::Answer(answer)) => Some(answer),
        _ => None,
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

#[cfg(test)]
mod tests {
    use wire::{Command, CommandStatus};

    use super::{Conversation, ELSEWHERE_S};
    use crate::source::Scripted;

    #[test]
    fn a_board_that_was_to_send_records_and_is_silent_has_gone() {
        let source = Scripted::new(|_| Some((CommandStatus::Done, [0; 2])));
        let mut module = Conversation::with(Box::new(source), Some(1));
        let mut send = |command| {
            module.send(command).unwrap();
            let begun_s = module.now_s();
            while module.now_s() - begun_s < 10.0 {
                if let Err(error) = module.receive() {
                    return Some((module.now_s() - begun_s, error.to_string()));
                }
            }
            None
        };
        assert_eq!(send(Command::Stream(false)), None);
        let (after_s, fault) = send(Command::Stream(true)).unwrap();
        let expected_s = ELSEWHERE_S..ELSEWHERE_S + 0.4;
        assert!(expected_s.contains(&after_s), "{after_s}");
        assert!(fault.contains("board 1 has sent nothing"), "{fault}");
        // What asks for something else waits for that by itself.
        assert_eq!(send(Command::Stream(false)), None);
    }
}
