//! A head of emulated boards, all with the same bytes, their jumpers apart: the wire between them
//! is host-sim's.
//!
//! Boards run in turn, for less time than the shortest frame takes: so what one sends cannot come
//! to another before that has been there. All begin at the same moment, by clocks that may differ.

mod compare;

use std::ops::Range;

use firmware::{BusConfig, Event};
use host_sim::Error;
use host_sim::bench::can::Can;
use host_sim::bench::{Bench, Load, Snapshot};
use host_sim::bus::Slave;
use host_sim::bus::tmag5170::TmagSlave;
use host_sim::motor::Pins;
use host_sim::run::Run;
use host_sim::world::World;
use scene::Scene;

use crate::board::Board;
use crate::chip::{Arrival, Fault, Ps, Request};
use crate::emulate::pwm_counts;
use crate::program::Program;

pub(crate) use compare::compare;

/// Picoseconds in a microsecond.
const US: f64 = 1e6;

/// Bits of the shortest frame, with the space behind it.
const LEAST_BITS: Ps = 47;

/// By how much the clock of a board is faster than that of the bus, millionths.
#[derive(Debug, Clone, Copy)]
struct Crystal(i32);

impl Crystal {
    /// What its board takes `time` of the bus for.
    fn own(self, time: Ps) -> Ps {
        scaled(time, self.millionths(), 1_000_000)
    }

    /// When by the bus it is `time` by its board.
    fn of_bus(self, time: Ps) -> Ps {
        scaled(time, 1_000_000, self.millionths())
    }

    fn millionths(self) -> u128 {
        1_000_000_u32.saturating_add_signed(self.0).max(1).into()
    }
}

/// `time * by / of`.
fn scaled(time: Ps, by: u128, of: u128) -> Ps {
    let scaled = u128::from(time) * by / of;
    Ps::try_from(scaled).unwrap_or(Ps::MAX)
}

/// One of the boards.
#[derive(Debug)]
struct Node {
    board: Board,
    crystal: Crystal,
    own: Range<usize>,
    snapshot: Snapshot,
}

/// A head of boards.
#[derive(Debug)]
pub(crate) struct Head {
    nodes: Vec<Node>,
    can: Can,
    bit: Ps,
    now: Ps,
    period: Ps,
    each: usize,
    fault: Option<Fault>,
}

impl Head {
    /// The boards of `scene`, their motors on `pins`, left side first; started, and before their
    /// first tick. The crystals of the even ones are faster by `ppm` millionths, of the odd ones
    /// slower.
    fn new(
        (program, ppm): (&Program, i32),
        scene: &Scene,
        bus: BusConfig,
        pins: &[Pins],
    ) -> Result<Self, Fault> {
        let BusConfig { nodes, kbit_s } = bus;
        let each = scene.whiskers() / usize::from(nodes).max(1);
        let board = |number: u8| -> Result<Node, Fault> {
            let own = usize::from(number) * each..(usize::from(number) + 1) * each;
            let pins = pins.get(own.clone()).unwrap_or_default().to_vec();
            let sides = scene.head.sides.count();
            Ok(Node {
                board: Board::of_node(program, scene, (number, own.clone()), pins)?,
                crystal: Crystal(if number.is_multiple_of(2) { ppm } else { -ppm }),
                own,
                snapshot: Snapshot {
                    theta_deg: vec![f64::NAN; each],
                    z: [f64::NAN; 2],
                    g: [f64::NAN; 2],
                    contact: [0, 1].map(|side| if side < sides { 0.0 } else { f64::NAN }),
                    touch: [0; 2],
                },
            })
        };
        let nodes = (0..nodes).map(board).collect::<Result<Vec<_>, _>>()?;
        let started = nodes
            .iter()
            .map(|node| node.crystal.of_bus(node.board.machine.now));
        let mut head = Self {
            now: started.max().unwrap_or_default(),
            can: Can::new(nodes.len(), kbit_s),
            nodes,
            bit: 1_000_000_000 / Ps::from(kbit_s),
            period: 1_000_000_000_000 / Ps::from(scene.tick_hz),
            each: scene.head.whiskers_per_side,
            fault: None,
        };
        for node in &mut head.nodes {
            node.board.run_until(node.crystal.own(head.now))?;
        }
        Ok(head)
    }

    pub(crate) const fn load(&self) -> Load {
        self.can.load()
    }

    pub(crate) fn check(&self) -> Result<(), Fault> {
        self.fault.clone().map_or(Ok(()), Err)
    }

    /// Lets all run on; how many ticks of each have ended.
    fn run_on(&mut self, ended: &mut [u32]) -> Result<(), Fault> {
        let until = self.now + (LEAST_BITS - 1) * self.bit;
        while let Some(sent) = self.can.next(until as f64 / US) {
            let at = (sent.at_us * US).round() as Ps;
            for (n, node) in self.nodes.iter_mut().enumerate() {
                let what = if n == sent.from {
                    Arrival::Sent(sent.frame)
                } else {
                    Arrival::Heard(sent.frame)
                };
                let at = node.crystal.own(at);
                node.board.machine.disturb(|chip| chip.expect(at, what));
            }
        }
        for ((n, node), ended) in self.nodes.iter_mut().enumerate().zip(ended) {
            *ended += node.board.run_until(node.crystal.own(until))?;
            let requests = node
                .board
                .machine
                .with_chip(|chip| chip.take_requests(self.bit))?;
            for (at, request) in requests {
                let at_us = node.crystal.of_bus(at) as f64 / US;
                match request {
                    Request::Send(frame) => self.can.queue(n, frame, at_us),
                    Request::Withdraw(frame) => self.can.withdraw(n, &frame),
                }
            }
        }
        self.now = until;
        Ok(())
    }

    /// One tick of all: until the last has ended.
    fn pass_tick(&mut self, events: &mut Vec<Event>) -> Result<(), Fault> {
        for node in &mut self.nodes {
            node.board.begin()?;
        }
        let mut ended = vec![0; self.nodes.len()];
        let limit = self.now + 2 * self.period;
        while ended.contains(&0) && self.now < limit {
            self.run_on(&mut ended)?;
        }
        if ended.iter().any(|ended| *ended != 1) {
            return Err(Fault::Unequal);
        }
        for node in &mut self.nodes {
            node.board.end(events, &mut node.snapshot)?;
        }
        Ok(())
    }

    fn find(&mut self, n: usize) -> Option<(&mut Board, usize)> {
        let mut all = self.nodes.iter_mut();
        let node = all.find(|node| node.own.contains(&n))?;
        Some((&mut node.board, n - node.own.start))
    }
}

impl Bench for Head {
    fn tick(&mut self, events: &mut Vec<Event>) {
        if self.fault.is_none() {
            self.fault = self.pass_tick(events).err();
        }
    }

    fn look(&mut self, snapshot: &mut Snapshot) {
        for (side, most) in snapshot.contact.iter_mut().enumerate() {
            let felt = self.nodes.iter().map(|node| node.snapshot.contact[side]);
            *most = felt.fold(f64::NAN, f64::max);
        }
        for side in 0..2 {
            let first = side * self.each;
            let mut all = self.nodes.iter();
            let Some(node) = all.find(|node| node.own.contains(&first)) else {
                continue;
            };
            snapshot.z[side] = node.snapshot.z[side];
            // Of the first two whiskers of a board, which are on its sides.
            let local = (first - node.own.start).min(1);
            snapshot.g[side] = node.snapshot.g[local];
            snapshot.touch[side] = node.snapshot.touch[local];
        }
        for node in &self.nodes {
            if let Some(places) = snapshot.theta_deg.get_mut(node.own.clone()) {
                places.copy_from_slice(&node.snapshot.theta_deg);
            }
        }
    }

    fn slave_mut(&mut self, n: usize) -> Option<&mut Slave> {
        let (board, n) = self.find(n)?;
        board.slave_mut(n)
    }

    fn tmag_mut(&mut self, n: usize) -> Option<&mut TmagSlave> {
        let (board, n) = self.find(n)?;
        board.tmag_mut(n)
    }

    fn bend(&mut self, n: usize, deflection: [f64; 2]) {
        if let Some((board, n)) = self.find(n) {
            board.bend(n, deflection);
        }
    }

    fn tells_faults(&self) -> bool {
        false
    }
}

/// The head of a scene in its world, before its first tick; the crystals of its boards by so many
/// millionths faster and slower.
pub(crate) fn start(
    scene: &Scene,
    bus: BusConfig,
    classes: Vec<String>,
    (program, ppm): (&Program, i32),
) -> Result<Run<Head>, Error> {
    let model = program.model()?;
    let (world, pins) = World::wired(scene, pwm_counts(scene, model))?;
    let head = Head::new((program, ppm), scene, bus, &pins)?;
    Ok(Run::of(scene, Box::new(head), classes, world))
}
