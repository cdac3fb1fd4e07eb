//! The bus of a simulated head, and what can go wrong on it.

use std::collections::VecDeque;

use can::Frame;
use firmware::NodeEvent;
use physics::Noise;

use crate::bench::can::{Can, Load, Sent};

/// Frames that a node which floods the bus has ready in each tick: more than a queue has room for,
/// and than go in one at 250 ticks a second and more.
const FLOOD: usize = 32;

/// What became of a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Happened {
    /// When, s.
    pub t_s: f64,
    /// Of which.
    pub node: u8,
    /// What.
    pub what: NodeEvent,
}

/// What is to be done to a node before the next tick.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Asked {
    pub(super) reset: bool,
    pub(super) arm: bool,
    pub(super) stop: bool,
}

/// The bus of a simulated head: to look at it, and to disturb it.
#[derive(Debug)]
pub struct Bus {
    pub(super) can: Can,
    pub(super) happened: Vec<Happened>,
    pub(super) asked: Vec<Asked>,
    /// Nodes that neither hear nor are heard.
    cut: Vec<bool>,
    pub(super) joined: Vec<bool>,
    pub(super) armed: Vec<bool>,
    /// Share of frames that a node misses.
    missed: f64,
    /// Share of those that come to it twice: of an error that it alone did not see, in the last bit.
    repeated: f64,
    random: Noise,
    /// Share of all that an error destroys, which are sent again.
    corrupted: f64,
    errors: Noise,
    /// How long a frame is on its way after the bus has carried it, µs, and those that are: an age
    /// that no wire has, but a bridge between two might.
    delay_us: f64,
    on_their_way: VecDeque<Sent>,
    /// Who sends frames all the time that mean nothing and go before all others.
    floods: Option<usize>,
}

impl Bus {
    pub(super) fn new(nodes: usize, kbit_s: u16) -> Self {
        Self {
            can: Can::new(nodes, kbit_s),
            happened: Vec::new(),
            asked: vec![Asked::default(); nodes],
            cut: vec![false; nodes],
            joined: vec![false; nodes],
            armed: vec![false; nodes],
            missed: 0.0,
            repeated: 0.0,
            random: Noise::new(0),
            corrupted: 0.0,
            errors: Noise::new(0),
            delay_us: 0.0,
            on_their_way: VecDeque::new(),
            floods: None,
        }
    }

    /// What it has carried.
    pub const fn load(&self) -> Load {
        self.can.load()
    }

    /// What became of its nodes so far.
    pub fn happened(&self) -> &[Happened] {
        &self.happened
    }

    /// Whether a node shares clock and oscillators of the head.
    pub fn is_joined(&self, node: usize) -> bool {
        self.joined.get(node) == Some(&true)
    }

    /// Whether the motors of a node are armed.
    pub fn is_armed(&self, node: usize) -> bool {
        self.armed.get(node) == Some(&true)
    }

    /// Takes a node off the bus, or puts it on again.
    pub fn cut(&mut self, node: usize, is_cut: bool) {
        if let Some(cut) = self.cut.get_mut(node) {
            *cut = is_cut;
        }
    }

    /// Resets a node before the next tick: it begins again, its motors not armed.
    pub fn reset(&mut self, node: usize) {
        if let Some(asked) = self.asked.get_mut(node) {
            asked.reset = true;
        }
    }

    /// Has a node arm the motors of the head, or stop them.
    pub fn arm(&mut self, node: usize, is_armed: bool) {
        if let Some(asked) = self.asked.get_mut(node) {
            (asked.arm, asked.stop) = (is_armed, !is_armed);
        }
    }

    /// From now on each node misses this share of the frames, and an error on the bus destroys
    /// another, which are sent again.
    pub fn disturb(&mut self, missed: f64, corrupted: f64, seed: u64) {
        self.missed = missed;
        self.random = Noise::new(seed);
        self.corrupted = corrupted;
        self.errors = Noise::new(seed.wrapping_add(1));
    }

    /// From now on a node hears this share of the frames twice.
    pub const fn repeat(&mut self, repeated: f64) {
        self.repeated = repeated;
    }

    /// From now on a node leaves no room on the bus for anybody; none: for all.
    pub fn flood(&mut self, by: Option<usize>) {
        if let Some(before) = std::mem::replace(&mut self.floods, by) {
            self.can.clear(before);
        }
    }

    /// From now on others hear a frame so much later than the bus has carried it.
    pub fn delay(&mut self, delay_s: f64) {
        self.delay_us = 1e6 * delay_s;
    }

    /// A tick begins at `begin_us`: who floods the bus has frames ready before all others.
    pub(super) fn begin(&mut self, begin_us: f64) {
        if let Some(node) = self.floods {
            for _ in 0..FLOOD {
                self.can.queue(node, Frame::new(0, &[0; 8]), begin_us);
            }
        }
    }

    /// The next frame of a node on the bus that is carried by `until_us`.
    pub(super) fn carry(&mut self, until_us: f64) -> Option<Sent> {
        loop {
            let share = self.corrupted;
            let is_destroyed = |_| share > 0.0 && self.errors.uniform() < share;
            let (sent, is_destroyed) = self.can.pass(until_us, is_destroyed)?;
            if is_destroyed || self.is_cut(sent.from) {
                continue;
            }
            let at_us = sent.at_us + self.delay_us;
            self.on_their_way.push_back(Sent { at_us, ..sent });
            return Some(sent);
        }
    }

    /// The next of them that others hear by then, in the same order.
    pub(super) fn next(&mut self, until_us: f64) -> Option<Sent> {
        self.on_their_way
            .pop_front_if(|sent| sent.at_us <= until_us)
    }

    /// How often a frame comes to a node.
    pub(super) fn comes_to(&mut self, node: usize) -> usize {
        let mut is_one_of = |share: f64| share > 0.0 && self.random.uniform() < share;
        let [is_missed, comes_twice] = [self.missed, self.repeated].map(&mut is_one_of);
        if is_missed || self.is_cut(node) {
            return 0;
        }
        1 + usize::from(comes_twice)
    }

    fn is_cut(&self, node: usize) -> bool {
        self.cut.get(node) == Some(&true)
    }
}
