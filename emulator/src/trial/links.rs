//! What is sent to the board by its serial line and by a probe, and when it has arrived.

use std::collections::VecDeque;

use host_sim::Error;
use scene::Scene;
use wire::text::Spoken;
use wire::{Command, Frame, TaggedCommand};

use super::file::{Change, Event, Scenario, What};
use crate::session::Session;

/// Start, eight bits and stop.
const BITS: f64 = 10.0;
/// More than so many bytes never wait at the other end of the serial line.
const MOST_WAITING: usize = 1 << 16;
/// From one frame of a configuration to the next: it is answered in between, s.
const FRAME_S: f64 = 2e-3;
/// So many requests in a tick are more than the probe's ring holds.
const MOST_A_TICK: usize = 256;

/// What has arrived in a tick that the figures ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Arrived {
    pub(super) stops: u64,
    pub(super) is_arm: bool,
    /// A motor is to be tried again.
    pub(super) is_clear: bool,
}

impl Arrived {
    fn add(&mut self, command: Command) {
        match command {
            Command::Stop => self.stops += 1,
            Command::Arm => self.is_arm = true,
            Command::Clear(_) => self.is_clear = true,
            _ => {}
        }
    }
}

struct Sender<'s> {
    event: &'s Event,
    /// How often it has sent, or would have.
    sent: u64,
    /// It asks for more than the serial line carries.
    is_flood: bool,
    /// A configuration, which is sent again and again.
    frames: Vec<Frame>,
}

impl Sender<'_> {
    /// When it sends next; never once it has ended.
    fn next_s(&self) -> Option<f64> {
        let at_s = match self.event.repeat_hz {
            _ if !self.frames.is_empty() => self.event.at_s + self.sent as f64 * FRAME_S,
            None => (self.sent == 0).then_some(self.event.at_s)?,
            Some(repeat_hz) => self.event.at_s + self.sent as f64 / repeat_hz,
        };
        let is_in_time = self.event.until_s.is_none_or(|until| at_s < until);
        let is_once = self.event.repeat_hz.is_none() && self.frames.is_empty();
        (is_in_time || is_once).then_some(at_s)
    }

    /// What it would have sent before is not sent.
    fn skip_to(&mut self, t_s: f64) {
        if let Some(repeat_hz) = self.event.repeat_hz {
            let due = ((t_s - self.event.at_s) * repeat_hz).ceil().max(0.0) as u64;
            self.sent = self.sent.max(due);
        }
    }
}

#[derive(Default)]
pub(super) struct Links<'s> {
    senders: Vec<Sender<'s>>,
    tick_s: f64,
    /// Bytes of the serial line in a tick.
    tick_bytes: usize,
    /// All bytes that were written so far, and commands in them with the place of their end.
    written: u64,
    on_the_way: VecDeque<(u64, Command)>,
    tag: u16,
    is_pressed: bool,
    presses: Vec<&'s Event>,
    arrived: Arrived,
}

impl<'s> Links<'s> {
    /// `stage` has the frames of a configuration.
    pub(super) fn new(
        scenario: &'s Scenario,
        scene: &Scene,
        stage: impl Fn(Change) -> Result<Vec<Frame>, Error>,
    ) -> Result<Self, Error> {
        let tick_hz = f64::from(scene.tick_hz);
        let bytes_s = f64::from(scene.telemetry.serial_baud.unwrap_or(0)) / BITS;
        let mut senders = Vec::new();
        for event in &scenario.events {
            let asked = |line: &str| event.repeat_hz.unwrap_or(0.0) * (line.len() + 1) as f64;
            let (is_flood, frames) = match &event.what {
                What::Serial { text } => (asked(text) >= bytes_s, Vec::new()),
                What::Probe { .. } => (false, Vec::new()),
                What::Configuration { change } => (false, stage(*change)?),
                _ => continue,
            };
            senders.push(Sender {
                event,
                sent: 0,
                is_flood,
                frames,
            });
        }
        let events = scenario.events.iter();
        Ok(Self {
            senders,
            tick_s: 1.0 / tick_hz,
            tick_bytes: (bytes_s / tick_hz).ceil() as usize,
            presses: events.filter(|event| event.what == What::Button).collect(),
            ..Self::default()
        })
    }

    /// Sends what is due in the tick that begins at `t_s`, in the order of its times.
    pub(super) fn send(&mut self, t_s: f64, session: &mut Session) -> Result<(), Error> {
        let was_pressed = self.is_pressed;
        self.is_pressed = self.presses.iter().any(|press| press.lasts(t_s));
        self.arrived.is_arm |= self.is_pressed && !was_pressed;
        let end_s = t_s + self.tick_s;
        let (mut held, mut requests) = (vec![false; self.senders.len()], 0);
        while let Some(n) = self.first_due(end_s, &held) {
            let sender = &self.senders[n];
            let (event, is_flood) = (sender.event, sender.is_flood);
            let is_sent = match &event.what {
                What::Serial { text } => self.write(text, is_flood, session),
                What::Probe { request } => {
                    requests += 1;
                    requests <= MOST_A_TICK && self.ask(request.0, session)?
                }
                _ => {
                    let next = sender.sent as usize % sender.frames.len();
                    let frame = &sender.frames[next];
                    self.written += frame.len() as u64;
                    session.serial_write(frame);
                    true
                }
            };
            let sender = &mut self.senders[n];
            if is_sent {
                sender.sent += 1;
            } else {
                // Sent once, it is tried again in the next tick.
                sender.skip_to(end_s);
                held[n] = true;
            }
        }
        Ok(())
    }

    fn first_due(&self, end_s: f64, held: &[bool]) -> Option<usize> {
        let due = self.senders.iter().zip(held).enumerate();
        let due = due.filter(|(_, (_, held))| !**held);
        let due = due.filter_map(|(n, (sender, _))| Some((n, sender.next_s()?)));
        let due = due.filter(|(_, at_s)| *at_s < end_s);
        due.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(n, _)| n)
    }

    /// Writes a line, unless the serial line has enough to do.
    fn write(&mut self, line: &str, is_flood: bool, session: &mut Session) -> bool {
        let waiting = session.machine().chip().serial_waiting();
        let own = if is_flood {
            self.tick_bytes
        } else {
            MOST_WAITING
        };
        if waiting > own {
            return false;
        }
        let text = format!("{line}\n");
        for part in text.split_inclusive('\n') {
            self.written += part.len() as u64;
            if let Ok(Spoken::Command(command)) = wire::text::parse(part.as_bytes()) {
                self.on_the_way.push_back((self.written, command));
            }
        }
        session.serial_write(text.as_bytes());
        true
    }

    /// Writes a request into the probe's ring; whether there was room.
    fn ask(&mut self, command: Command, session: &mut Session) -> Result<bool, Error> {
        let tag = self.tag.wrapping_add(1);
        let request = TaggedCommand { tag, command };
        // Half of one would spoil the next.
        if session.board_mut().request_room()? < wire::frame(&request).len() {
            return Ok(false);
        }
        self.tag = tag;
        session.request(request)?;
        self.arrived.add(command);
        Ok(true)
    }

    /// What has arrived in the tick that was just made; what came while none was, is lost.
    pub(super) fn arrived(&mut self, session: &mut Session) -> Arrived {
        let pending = session.machine().chip().serial_waiting();
        let carried = self.written - pending as u64;
        let mut arrived = std::mem::take(&mut self.arrived);
        let is_heard = !session.board_mut().is_late;
        while let Some((end, command)) = self.on_the_way.front().copied()
            && end <= carried
        {
            self.on_the_way.pop_front();
            if is_heard {
                arrived.add(command);
            }
        }
        arrived
    }
}
