//! A head: one board, or several, each with its own whiskers, joined by a simulated CAN bus.

mod bus;

pub use bus::{Bus, Happened};
use firmware::{Command, Event, Motion, NoActiveWhisker, NotDone, Packet, ServoState, Whisker};
use scene::{Deciding, Scene};
use whisking::Number;
use wire::TaggedCommand;

use super::board::{Board, Mock, pins_of};
use super::{Bench, HostModule, Snapshot};
use crate::Error;
use crate::bus::OnWire;
use crate::classifier::{Classifier, Tap};
use crate::motor::Pins;

/// Share of a tick after which a board has computed what it says: the rest of the papers' 500 µs
/// is left for the bus.
const READY_SHARE: f64 = 0.6;

pub(super) struct Head<R: Number> {
    boards: Vec<Board<R>>,
    /// None of a single board.
    bus: Option<Bus>,
    tick_hz: f64,
    done: u64,
    each: usize,
    /// The board that is talked with.
    talking: usize,
}

fn suits_a_head(classifier: &Classifier) -> Result<(), Error> {
    let refused = |found: &str, allowed: &str| {
        let text = format!("classifier.model: found {found}; allowed with head.nodes: {allowed}");
        Err(Error::Input(text))
    };
    if classifier.channels() != 2 {
        return refused("one with tables of each whisker", "one of all whiskers");
    }
    if classifier.deciding() == Deciding::Together && classifier.has_opinion() {
        return refused(
            "one with a second opinion for whiskers that decide together",
            "one without, which host-sim train --expect same makes",
        );
    }
    Ok(())
}

/// As newly made, for boards that are nodes.
fn bus_of<R: Number>(boards: &[Board<R>]) -> Option<Bus> {
    let first = boards.first().filter(|first| first.node.is_some())?;
    let kbit_s = first.config.head.bus.map_or(0, |bus| bus.kbit_s);
    Some(Bus::new(boards.len(), kbit_s))
}

impl<R: Number> Head<R> {
    pub(super) fn new(
        scene: &Scene,
        pins: &[Pins],
        classifier: Option<Classifier>,
    ) -> Result<Self, Error> {
        let nodes = scene.head.nodes;
        if let (Some(classifier), Some(_)) = (&classifier, nodes) {
            suits_a_head(classifier)?;
        }
        let count = nodes.unwrap_or(1);
        let boards = (0..count).zip(std::iter::repeat_n(classifier, count.into()));
        let boards = boards.map(|(number, its)| Board::new(scene, number, pins, its));
        let boards: Vec<_> = boards.collect::<Result<_, Error>>()?;
        Ok(Self {
            bus: bus_of(&boards),
            boards,
            tick_hz: f64::from(scene.tick_hz),
            done: 0,
            each: scene.head.whiskers_per_side,
            talking: 0,
        })
    }

    fn board_of(&mut self, n: usize) -> Option<(&mut Board<R>, usize)> {
        let mut boards = self.boards.iter_mut();
        let board = boards.find(|board| n < board.own.end)?;
        let first = board.own.start;
        Some((board, n - first))
    }

    fn whisker(&self, n: usize) -> Option<&Whisker<R, Mock>> {
        let board = self.boards.iter().find(|board| n < board.own.end)?;
        let whiskers = board.module.whiskers();
        whiskers.get(n - board.own.start)
    }

    fn do_asked(&mut self) {
        let Some(bus) = &mut self.bus else {
            return;
        };
        for (n, board) in self.boards.iter_mut().enumerate() {
            let asked = std::mem::take(&mut bus.asked[n]);
            if asked.reset {
                let motion = board.config.motion.as_ref();
                let seed = motion.map_or(0, |motion| motion.seed);
                // As it could be made once, it can be again.
                let _ = board.restart(seed);
                board.module.arm(false);
                bus.can.clear(n);
            }
            let Some(node) = &mut board.node else {
                continue;
            };
            if asked.arm {
                node.arm();
            }
            if asked.stop {
                node.stop();
            }
        }
    }

    /// Carries what was said until the next tick to who hears it.
    fn carry(&mut self) {
        let Some(bus) = &mut self.bus else {
            return;
        };
        let tick_us = 1e6 / self.tick_hz;
        let end_us = (self.done + 1) as f64 * tick_us;
        bus.begin(self.done as f64 * tick_us);
        // Whole microseconds, as a board counts them.
        let own_us = |board: &Board<R>, at_us: f64| {
            let since_us = end_us - at_us.floor();
            (board.ticks as f64).mul_add(tick_us, -since_us).max(0.0) as u64
        };
        loop {
            let carried = bus.carry(end_us);
            let by = carried.and_then(|sent| Some((self.boards.get_mut(sent.from)?, sent)));
            if let Some((board, sent)) = by {
                let own_us = own_us(board, sent.at_us);
                if let Some(node) = &mut board.node {
                    node.said(&sent.frame, own_us);
                }
            }
            while let Some(sent) = bus.next(end_us) {
                let boards = self.boards.iter_mut().enumerate();
                for (n, board) in boards.filter(|(n, _)| *n != sent.from) {
                    let own_us = own_us(board, sent.at_us);
                    let times = bus.comes_to(n);
                    if let Some(node) = &mut board.node {
                        (0..times).for_each(|_| node.hear(&sent.frame, own_us));
                    }
                }
            }
            if carried.is_none() {
                break;
            }
        }
    }
}

impl<R: Number> Bench for Head<R> {
    fn tick(&mut self, events: &mut Vec<Event>) {
        self.do_asked();
        for (n, board) in self.boards.iter_mut().enumerate() {
            let (Some(node), Some(bus)) = (&mut board.node, &mut self.bus) else {
                board.tick(events);
                continue;
            };
            let tick_us = 1e6 / self.tick_hz;
            let t_s = self.done as f64 / self.tick_hz;
            let ready_us = (self.done as f64 + READY_SHARE) * tick_us;
            let now_us = board.ticks as f64 * tick_us;
            let parts = (&mut board.module, &board.config);
            node.before(now_us as u64, parts, &mut |event| {
                board.line.note(&event);
                if let Event::Node(node, what) = event {
                    bus.happened.push(Happened { t_s, node, what });
                }
                events.push(event);
            });
            let first = events.len();
            board.tick(events);
            let decided = events.iter().skip(first).find_map(|event| match event {
                Event::Decision(_, decision) => Some(*decision),
                _ => None,
            });
            if let Some(node) = &mut board.node {
                node.after((&board.module, &board.config), decided, &mut |frame| {
                    bus.can.queue(n, frame, ready_us);
                });
                bus.joined[n] = node.is_joined();
            }
            board.ticks += 1;
            bus.armed[n] = board.module.is_armed();
        }
        self.carry();
        self.done += 1;
    }

    fn look(&mut self, snapshot: &mut Snapshot) {
        for pi in snapshot.contact.iter_mut().filter(|pi| !pi.is_nan()) {
            *pi = 0.0;
        }
        for (side, z) in snapshot.z.iter_mut().enumerate() {
            let first = side * self.each;
            let board = self.boards.iter().find(|board| first < board.own.end);
            let Some(board) = board else {
                continue;
            };
            let local = first - board.own.start;
            if let Some(perception) = board.module.perception() {
                snapshot.touch[side] = perception.touching(local).number;
            }
            let state = board.module.motion().map(Motion::state);
            if let Some(of_side) = state.and_then(|state| state.sides.get(side)) {
                *z = of_side.z.value.to_f64();
            }
            if let Some(whisker) = state.and_then(|state| state.whiskers.get(local)) {
                snapshot.g[side] = whisker.gain();
            }
        }
        for board in &self.boards {
            if let Some(places) = snapshot.theta_deg.get_mut(board.own.clone()) {
                board.look_at_setpoints(places);
            }
            let sides = snapshot.contact.iter_mut().zip(board.module.contact());
            for (most, pi) in sides.filter(|(most, _)| !most.is_nan()) {
                *most = most.max(pi.to_f64());
            }
        }
    }

    fn sensor_mut(&mut self, n: usize) -> Option<OnWire<'_>> {
        let (board, n) = self.board_of(n)?;
        Some(board.sensor_mut(n)?.on_wire())
    }

    fn felt_by(&self, n: usize) -> Option<f64> {
        Some(self.whisker(n)?.felt().to_f64())
    }

    fn is_homing(&self, n: usize) -> bool {
        let servo = self.whisker(n).and_then(Whisker::servo);
        servo.is_some_and(|servo| matches!(servo.state(), ServoState::Homing(_)))
    }
}

impl<R: Number> HostModule for Head<R>
where
    Board<R>: Send,
{
    fn restart(&mut self, seed: u64, pins: Vec<Pins>) -> Result<(), Error> {
        self.done = 0;
        for board in &mut self.boards {
            board.pins = pins_of(&board.own, &pins);
            board.restart(seed)?;
        }
        self.bus = bus_of(&self.boards);
        Ok(())
    }

    fn command(&mut self, n: usize, command: Command<f64>) -> Result<(), NotDone> {
        let (board, n) = self.board_of(n).ok_or(NoActiveWhisker)?;
        board.command(n, command)
    }

    fn arm(&mut self, is_armed: bool) {
        match &mut self.bus {
            Some(bus) => bus.arm(0, is_armed),
            None => (self.boards.iter_mut()).for_each(|board| board.module.arm(is_armed)),
        }
    }

    fn tap(&mut self) -> Option<&mut Tap> {
        let perception = self.boards.first_mut()?.module.perception_mut()?;
        Some(perception.classifier_mut())
    }

    fn request(&mut self, request: TaggedCommand) {
        if let Some(board) = self.boards.get_mut(self.talking) {
            board.request(request);
        }
    }

    fn talk_with(&mut self, board: usize) {
        self.talking = board;
    }

    fn request_of(&mut self, board: usize, request: TaggedCommand) -> bool {
        let found = self.boards.get_mut(board);
        found.map(|board| board.request(request)).is_some()
    }

    fn take_packets(&mut self) -> Vec<Packet> {
        let talking = self.talking;
        let boards = self.boards.iter_mut().enumerate();
        let packets = boards.flat_map(|(n, board)| {
            let mut packets = std::mem::take(&mut board.line.sent);
            packets.retain(|packet| n == talking || matches!(packet, Packet::Answer(_)));
            packets
        });
        packets.collect()
    }

    fn bus(&mut self) -> Option<&mut Bus> {
        self.bus.as_mut()
    }
}
