//! A head of emulated boards, all with the same bytes, their jumpers apart: the wire between them
//! is host-sim's.
//!
//! Boards run in turn, for less time than the shortest frame takes: so what one sends cannot come
//! to another before that has been there. All begin at the same moment, by clocks that may differ.
//! A board whose cable is cut has a bus of its own, on which nobody hears it.

mod compare;
mod disturbed;
mod relaying;
mod session;

use std::ops::Range;

use firmware::{BusConfig, Event};
use host_sim::Error;
use host_sim::bench::can::Can;
use host_sim::bench::{Bench, Load, Snapshot};
use host_sim::bus::OnWire;
use host_sim::motor::Pins;
use host_sim::run::Run;
use host_sim::world::World;
use physics::Noise;
use scene::Scene;

use crate::board::Board;
use crate::chip::{Arrival, Fault, Ps, Request};
use crate::emulate::pwm_counts;
use crate::program::Program;

pub(crate) use compare::compare;
pub(crate) use relaying::relay;
pub use session::HeadSession;

/// Picoseconds in a microsecond.
const US: f64 = 1e6;

/// Bits of the shortest frame, with the space behind it.
const LEAST_BITS: Ps = 47;

/// The clock of a board beside that of the bus.
#[derive(Debug, Clone, Copy)]
struct Crystal {
    /// By how much it is faster, millionths.
    ppm: i32,
    /// When its board is switched on, by the bus.
    since: Ps,
}

impl Crystal {
    /// What its board takes `time` of the bus for.
    fn own(self, time: Ps) -> Ps {
        let since = time.saturating_sub(self.since);
        scaled(since, self.millionths(), 1_000_000)
    }

    /// When by the bus it is `time` by its board.
    fn of_bus(self, time: Ps) -> Ps {
        self.since + scaled(time, 1_000_000, self.millionths())
    }

    fn millionths(self) -> u128 {
        1_000_000_u32.saturating_add_signed(self.ppm).max(1).into()
    }
}

fn scaled(time: Ps, by: u128, of: u128) -> Ps {
    let scaled = u128::from(time) * by / of;
    Ps::try_from(scaled).unwrap_or(Ps::MAX)
}

#[derive(Debug)]
pub(crate) struct Node {
    pub(crate) board: Board,
    crystal: Crystal,
    own: Range<usize>,
    pub(crate) snapshot: Snapshot,
    /// Its controller takes part in what its bus does.
    is_on: bool,
    /// Which of the head's wires it hangs on.
    wire: usize,
    /// The share of the frames that it sends which are destroyed.
    noise: f64,
    /// Ticks that have ended since it was looked at.
    pub(crate) ended: u32,
}

#[derive(Debug)]
pub(crate) struct Head {
    pub(crate) nodes: Vec<Node>,
    /// The bus, and one for each board that hangs on it while its cable is cut.
    wires: Vec<Can>,
    bit: Ps,
    pub(crate) now: Ps,
    period: Ps,
    each: usize,
    /// When the world moves on, whatever boards do; none: it waits for all of them.
    moves_at: Option<Ps>,
    random: Noise,
    fault: Option<Fault>,
}

impl Head {
    /// Started, and before the first tick; `pins` have the left side first. The crystals of even
    /// boards are faster by `ppm` millionths, of odd ones slower.
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
                board: Board::new(program, scene, (number, own.clone()), pins)?,
                crystal: Crystal {
                    ppm: if number.is_multiple_of(2) { ppm } else { -ppm },
                    since: 0,
                },
                own,
                snapshot: Snapshot {
                    theta_deg: vec![f64::NAN; each],
                    z: [f64::NAN; 2],
                    g: [f64::NAN; 2],
                    contact: [0, 1].map(|side| if side < sides { 0.0 } else { f64::NAN }),
                    touch: [0; 2],
                },
                is_on: false,
                wire: 0,
                noise: 0.0,
                ended: 0,
            })
        };
        let mut nodes = (0..nodes).map(board).collect::<Result<Vec<_>, _>>()?;
        let took = |node: &Node| node.crystal.of_bus(node.board.machine.now);
        let longest = nodes.iter().map(took).max().unwrap_or_default();
        // Who reads no model is ready sooner.
        for node in &mut nodes {
            node.crystal.since = longest - took(node);
        }
        let mut head = Self {
            now: longest,
            wires: vec![Can::new(nodes.len(), kbit_s); nodes.len() + 1],
            nodes,
            bit: 1_000_000_000 / Ps::from(kbit_s),
            period: 1_000_000_000_000 / Ps::from(scene.tick_hz),
            each: scene.head.whiskers_per_side,
            moves_at: None,
            random: Noise::new(scene.seed),
            fault: None,
        };
        for node in &mut head.nodes {
            node.board.run_until(node.crystal.own(head.now))?;
            node.is_on = node.board.machine.chip().is_on_bus();
        }
        Ok(head)
    }

    pub(crate) fn load(&self) -> Load {
        self.wires.first().map(Can::load).unwrap_or_default()
    }

    pub(crate) fn check(&self) -> Result<(), Fault> {
        self.fault.clone().map_or(Ok(()), Err)
    }

    fn run_on(&mut self) -> Result<(), Fault> {
        let until = self.now + (LEAST_BITS - 1) * self.bit;
        (0..self.wires.len()).for_each(|wire| self.carry(wire, until));
        for (n, node) in self.nodes.iter_mut().enumerate() {
            node.ended += node.board.run_until(node.crystal.own(until))?;
            let mut chip = node.board.machine.chip();
            let requests = chip.take_requests(self.bit)?;
            let (is_on, pending) = (chip.is_on_bus(), chip.can.pending());
            drop(chip);
            let Some(wire) = self.wires.get_mut(node.wire) else {
                continue;
            };
            let was_on = std::mem::replace(&mut node.is_on, is_on);
            if !is_on {
                wire.clear(n);
                continue;
            }
            if !was_on {
                for frame in pending {
                    wire.queue(n, frame, until as f64 / US);
                }
                continue;
            }
            for (at, request) in requests {
                let at_us = node.crystal.of_bus(at) as f64 / US;
                match request {
                    Request::Send(frame) => wire.queue(n, frame, at_us),
                    Request::Withdraw(frame) if !wire.is_under_way(n, &frame, at_us) => {
                        wire.withdraw(n, &frame);
                        node.expect(until, Arrival::Withdrawn(frame));
                    }
                    Request::Withdraw(_) => {}
                    Request::Drop(frame) => wire.withdraw(n, &frame),
                }
            }
        }
        self.now = until;
        Ok(())
    }

    /// One tick of all: until the last has ended, or the world moves on.
    fn pass_tick(&mut self, events: &mut Vec<Event>) -> Result<(), Fault> {
        for node in &mut self.nodes {
            node.board.begin()?;
            node.ended = 0;
        }
        if let Some(moves_at) = self.moves_at {
            let until = moves_at + self.period;
            while self.now < until {
                self.run_on()?;
            }
            self.moves_at = Some(until);
        } else {
            let limit = self.now + 2 * self.period;
            while self.nodes.iter().any(|node| node.ended == 0) && self.now < limit {
                self.run_on()?;
            }
            if self.nodes.iter().any(|node| node.ended != 1) {
                return Err(Fault::Unequal);
            }
        }
        for node in self.nodes.iter_mut().filter(|node| node.ended > 0) {
            node.board.end(events, &mut node.snapshot)?;
        }
        Ok(())
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

    fn sensor_mut(&mut self, n: usize) -> Option<OnWire<'_>> {
        let mut all = self.nodes.iter_mut();
        let node = all.find(|node| node.own.contains(&n))?;
        node.board.sensor_mut(n - node.own.start)
    }

    fn tells_faults(&self) -> bool {
        false
    }
}

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
