//! What befalls the boards of a head and their wires, and what passes on these.

use super::{Head, Node, US};
use crate::board::Board;
use crate::chip::{Arrival, Fault, Ps};

/// So many recessive bits are a silence that a controller counts which comes back to the bus.
const SILENCE_BITS: Ps = 11;

impl Node {
    /// Something comes to its controller when it is `at` by the bus.
    pub(super) fn expect(&mut self, at: Ps, what: Arrival) {
        let at = self.crystal.own(at);
        self.board.machine.disturbed().expect(at, what);
    }
}

impl Head {
    /// From now on boards may be reset, and the world moves on once a period, in the middle between
    /// two ticks of the first.
    pub(crate) fn bear(&mut self) {
        for node in &mut self.nodes {
            node.board.bears_resets = true;
        }
        self.moves_at = Some(self.now + self.period / 2);
    }

    /// Resets a board, or lets it lose its supply, which the next call may bring back.
    pub(crate) fn strike(
        &mut self,
        n: usize,
        strike: impl FnOnce(&mut Board) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let Some(node) = self.nodes.get_mut(n) else {
            return Ok(());
        };
        strike(&mut node.board)?;
        node.is_on = false;
        self.wires.iter_mut().for_each(|wire| wire.clear(n));
        Ok(())
    }

    pub(crate) fn cut(&mut self, n: usize, is_cut: bool) {
        let now_us = self.now as f64 / US;
        self.wires.iter_mut().for_each(|wire| wire.clear(n));
        let Some(node) = self.nodes.get_mut(n) else {
            return;
        };
        node.wire = if is_cut { n + 1 } else { 0 };
        if let Some(wire) = self.wires.get_mut(node.wire).filter(|_| node.is_on) {
            let pending = node.board.machine.chip().can.pending();
            for frame in pending {
                wire.queue(n, frame, now_us);
            }
        }
    }

    pub(crate) fn disturb(&mut self, n: usize, share: f64) {
        if let Some(node) = self.nodes.get_mut(n) {
            node.noise = share;
        }
    }

    pub(super) fn carry(&mut self, wire: usize, until: Ps) {
        let there = self.nodes.iter_mut().enumerate();
        let mut there: Vec<_> = there.filter(|(_, node)| node.wire == wire).collect();
        let Some(wire) = self.wires.get_mut(wire).filter(|_| !there.is_empty()) else {
            return;
        };
        let is_heard = there.iter().filter(|(_, node)| node.is_on).count() > 1;
        let noises: Vec<_> = there.iter().map(|(n, node)| (*n, node.noise)).collect();
        let mut is_destroyed = |from: usize| {
            let noise = noises.iter().find(|(n, _)| *n == from);
            let share = noise.map_or(0.0, |(_, share)| *share);
            !is_heard || share > 0.0 && self.random.uniform() < share
        };
        let (was_idle, mut passed) = (wire.is_idle(self.now as f64 / US), 0);
        while let Some((sent, is_lost)) = wire.pass(until as f64 / US, &mut is_destroyed) {
            passed += 1;
            let (at, frame) = ((sent.at_us * US).round() as Ps, sent.frame);
            for (n, node) in there.iter_mut().filter(|(_, node)| node.is_on) {
                let what = match (*n == sent.from, is_lost) {
                    (true, false) => Arrival::Sent(frame),
                    (false, false) => Arrival::Heard(frame),
                    (true, true) => Arrival::Failed {
                        frame,
                        is_unheard: !is_heard,
                    },
                    (false, true) => Arrival::Missed,
                };
                node.expect(at, what);
            }
        }
        // Behind each frame there is one; a whole span without any has more.
        if passed == 0 && was_idle && wire.is_idle(until as f64 / US) {
            passed = ((until - self.now) / self.bit / SILENCE_BITS) as u32;
        }
        let off = there.iter_mut().filter(|(_, node)| !node.is_on);
        for (_, node) in off.filter(|_| passed > 0) {
            node.expect(until, Arrival::Silent(passed));
        }
    }
}
