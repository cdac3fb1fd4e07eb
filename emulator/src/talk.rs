//! A conversation of a PC with a board, beside the same module on the PC, which does all that the
//! board does after it.

use std::collections::VecDeque;

use firmware::Packet;
use host_sim::Error;
use host_sim::received::Received;
use host_sim::trace::Row;
use wire::{Answer, Command, TaggedCommand, TickRecord};

use crate::compare::{Pair, Seen};
use crate::session::answer_to;

/// For how long an answer is waited for, and every part of a conversation lasts, s.
const PART_S: f64 = 0.1;

pub(crate) fn wrong<T>(what: impl Into<String>) -> Result<T, Error> {
    Err(Error::Work(what.into()))
}

pub(crate) fn records(packets: &[Packet]) -> impl DoubleEndedIterator<Item = &TickRecord> {
    packets.iter().filter_map(|packet| match packet {
        Packet::Record(record) => Some(record),
        Packet::Answer(_) | Packet::Event(_) => None,
    })
}

pub(crate) struct Talk {
    pub(crate) pair: Pair,
    /// Ticks of the board, and of a part.
    pub(crate) ticks: u32,
    pub(crate) part: u32,
    /// Ticks that an answer may take.
    pub(crate) patience: u32,
    pub(crate) packets: Vec<Packet>,
    pub(crate) lines: Vec<String>,
    /// Of each tick, the angles before the world moved on, and what was so after it.
    pub(crate) worlds: Vec<([f64; 2], Row)>,
    /// What the board did in the ticks that the PC has not made yet.
    ahead: VecDeque<Seen>,
    /// What the PC is to carry out, after so many ticks.
    pub(crate) requests: Vec<(u32, TaggedCommand)>,
    /// The request that is not answered yet.
    waiting: Option<u16>,
}

impl Talk {
    /// A board before its first tick; by its serial line or by a probe.
    pub(crate) fn new(mut pair: Pair, is_by_serial: bool) -> Self {
        if is_by_serial {
            pair.target = pair.target.by_serial();
        }
        let part = pair.target.ticks_of(PART_S);
        Self {
            pair,
            ticks: 0,
            part,
            patience: part,
            packets: Vec::new(),
            lines: Vec::new(),
            worlds: Vec::new(),
            ahead: VecDeque::new(),
            requests: Vec::new(),
            waiting: None,
        }
    }

    pub(crate) fn tick(&mut self) -> Result<(), Error> {
        let before = self.pair.target.run.row().angle_deg;
        let seen = self.pair.tick_board()?;
        self.worlds.push((before, seen.0));
        self.ahead.push_back(seen);
        self.ticks += 1;
        Ok(())
    }

    /// Lets so many ticks pass on the board alone. Each request has one answer.
    pub(crate) fn pass(&mut self, ticks: u32) -> Result<(), Error> {
        for _ in 0..ticks {
            self.tick()?;
            for received in self.pair.target.received()? {
                match received {
                    Received::Packet(Packet::Answer(answer))
                        if self.waiting.take() != Some(answer.tag) =>
                    {
                        return wrong(format!("not asked for: {answer:?}"));
                    }
                    Received::Packet(packet) => self.packets.push(packet),
                    Received::Line(line) => self.lines.push(line),
                    Received::Garbled => {}
                }
            }
        }
        Ok(())
    }

    /// Asks for something, which the PC is to do, too.
    pub(crate) fn ask(&mut self, command: Command) -> Result<Answer, Error> {
        let answer = self.ask_board(command)?;
        let request = TaggedCommand { tag: 0, command };
        self.requests.push((answer.sequence, request));
        Ok(answer)
    }

    pub(crate) fn ask_board(&mut self, command: Command) -> Result<Answer, Error> {
        let TaggedCommand { tag, .. } = self.pair.target.send(command)?;
        self.waiting = Some(tag);
        for _ in 0..self.patience {
            let from = self.packets.len();
            self.pass(1)?;
            let new = self.packets.get(from..).unwrap_or_default();
            if let Some(answer) = answer_to(tag, new) {
                return Ok(answer);
            }
        }
        wrong(format!("{command:?}: no answer"))
    }

    /// The PC makes the ticks that the board was ahead, and what was asked for in them; what it
    /// has sent.
    pub(crate) fn follow(&mut self) -> Result<Vec<Packet>, Error> {
        self.follow_by(|pair, _, _| {
            pair.host.tick();
            Ok(())
        })
    }

    /// The same, where each tick must be as on the board, to the last bit.
    pub(crate) fn follow_exactly(&mut self) -> Result<Vec<Packet>, Error> {
        self.follow_by(|pair, n, seen| pair.follow(n, seen, |touch| touch).map(drop))
    }

    fn follow_by(
        &mut self,
        tick: impl Fn(&mut Pair, u64, Seen) -> Result<(), Error>,
    ) -> Result<Vec<Packet>, Error> {
        let mut sent = Vec::new();
        while let Some(seen) = self.ahead.pop_front() {
            let made = self.ticks - self.ahead.len() as u32 - 1;
            let module = self.pair.host.module_mut();
            for (_, request) in self.requests.iter().filter(|(at, _)| *at == made) {
                module.request(*request);
            }
            tick(&mut self.pair, (made + 1).into(), seen)?;
            sent.extend(self.pair.host.module_mut().take_packets());
        }
        Ok(sent)
    }

    /// Every record and every event must be the same on board and PC, but, where the board may
    /// `lose` some, in ticks of which something was lost. Returns how many there were.
    pub(crate) fn same(
        &self,
        [found, expected]: [&[Packet]; 2],
        whiskers: usize,
        loses: bool,
    ) -> Result<[usize; 2], Error> {
        let [found, mut expected] = [found, expected].map(|packets| self.pair.by_tick(packets));
        if !loses && found.len() != expected.len() {
            let [found, expected] = [found.len(), expected.len()];
            return wrong(format!("packets of {found} ticks, on the PC of {expected}"));
        }
        let (mut records, mut events) = (0, 0);
        for (tick, found) in found {
            let expected = expected.remove(&tick).unwrap_or_default();
            let is_record = |packet: &&Packet| matches!(packet, Packet::Record(_));
            let count = found.iter().filter(is_record).count();
            let is_whole = !loses || count == whiskers;
            if found != expected && (is_whole || found.iter().any(|one| !expected.contains(one))) {
                return wrong(format!(
                    "tick {tick}: sent on the PC, on the board\n  {expected:?}\n  {found:?}"
                ));
            }
            records += count;
            events += found.len() - count;
        }
        Ok([records, events])
    }
}
