//! A CAN bus in simulation: arbitration, the time that frames take, and what can go wrong.

use std::fmt;

use can::Frame;

/// Frames that a node has to send at most; more are dropped, the last first.
const MOST_QUEUED: usize = 32;

/// Bits of an error frame with the space behind it, at most (CAN 2.0, 3.1.3).
const ERROR_BITS: u32 = 23;

/// A frame that has come through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sent {
    /// When it ended, µs since the start.
    pub at_us: f64,
    /// Who sent it.
    pub from: usize,
    /// What.
    pub frame: Frame,
}

/// What a bus has carried.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Load {
    /// Frames that came through.
    pub frames: u64,
    /// For how long it was busy, s.
    pub busy_s: f64,
    /// The longest that a frame took from its queueing to its end, s.
    pub worst_s: f64,
    /// Frames for which there was no room.
    pub dropped: u64,
}

impl fmt::Display for Load {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (frames, worst_ms) = (self.frames, self.worst_s * 1e3);
        write!(f, "{frames} frames, each in {worst_ms:.2} ms at most, ")?;
        write!(f, "{} dropped", self.dropped)
    }
}

/// A bus.
#[derive(Debug, Clone)]
pub struct Can {
    bit_us: f64,
    /// Of each node, with the time of its queueing, µs.
    queues: Vec<Vec<(f64, Frame)>>,
    free_us: f64,
    load: Load,
}

impl Can {
    /// Of so many nodes, and thousand bits a second.
    pub fn new(nodes: usize, kbit_s: u16) -> Self {
        Self {
            bit_us: 1e3 / f64::from(kbit_s),
            queues: vec![Vec::new(); nodes],
            free_us: 0.0,
            load: Load::default(),
        }
    }

    /// What it has carried.
    pub const fn load(&self) -> Load {
        self.load
    }

    /// Gives a node a frame to send, at `now_us`.
    pub fn queue(&mut self, from: usize, frame: Frame, now_us: f64) {
        let Some(queue) = self.queues.get_mut(from) else {
            return;
        };
        if queue.len() == MOST_QUEUED {
            self.load.dropped += 1;
        } else {
            queue.push((now_us, frame));
        }
    }

    /// Drops what a node has to send.
    pub fn clear(&mut self, node: usize) {
        if let Some(queue) = self.queues.get_mut(node) {
            queue.clear();
        }
    }

    /// Takes back a frame that a node was to send.
    pub fn withdraw(&mut self, node: usize, frame: &Frame) {
        if let Some(queue) = self.queues.get_mut(node) {
            queue.retain(|(_, one)| one != frame);
        }
    }

    /// Whether nothing is on it at `at_us`, nor waits for it.
    pub fn is_idle(&self, at_us: f64) -> bool {
        let mut all = self.queues.iter().flatten();
        self.free_us <= at_us && all.all(|(queued_us, _)| *queued_us > at_us)
    }

    /// Whether this frame of a node is on the bus at `at_us`.
    pub fn is_under_way(&self, node: usize, frame: &Frame, at_us: f64) -> bool {
        self.first().is_some_and(|(begin_us, from, place)| {
            let found = self.queues.get(from).and_then(|queue| queue.get(place));
            begin_us <= at_us && from == node && found.is_some_and(|(_, one)| one == frame)
        })
    }

    /// The frame that is sent next, by its node and its place there, and when it begins: of those
    /// that are there when the bus is free, the one with the lowest identifier.
    fn first(&self) -> Option<(f64, usize, usize)> {
        let all = self.queues.iter().flatten();
        let first_us = all.map(|(at_us, _)| *at_us).min_by(f64::total_cmp)?;
        let begin_us = self.free_us.max(first_us);
        let waiting = self.queues.iter().enumerate().flat_map(|(from, queue)| {
            let waiting = queue.iter().enumerate();
            let waiting = waiting.filter(move |(_, (at_us, _))| *at_us <= begin_us);
            waiting.map(move |(place, (_, frame))| (from, place, frame.id()))
        });
        let (from, place, _) = waiting.min_by_key(|(.., id)| *id)?;
        Some((begin_us, from, place))
    }

    /// The next frame that ends by `until_us`, and whether an error has destroyed it, as
    /// `is_destroyed` says of one from a node: then it is sent again.
    pub fn pass(
        &mut self,
        until_us: f64,
        mut is_destroyed: impl FnMut(usize) -> bool,
    ) -> Option<(Sent, bool)> {
        let (begin_us, from, place) = self.first()?;
        let queue = self.queues.get_mut(from)?;
        let (queued_us, frame) = *queue.get(place)?;
        let bits = frame.bits();
        let end_us = begin_us + f64::from(bits) * self.bit_us;
        if end_us > until_us {
            return None;
        }
        let is_destroyed = is_destroyed(from);
        let bits = if is_destroyed {
            bits / 2 + ERROR_BITS
        } else {
            queue.remove(place);
            self.load.frames += 1;
            self.load.worst_s = self.load.worst_s.max((end_us - queued_us) * 1e-6);
            bits
        };
        let took_us = f64::from(bits) * self.bit_us;
        self.free_us = begin_us + took_us;
        self.load.busy_s += took_us * 1e-6;
        let at_us = self.free_us;
        Some((Sent { at_us, from, frame }, is_destroyed))
    }
}

#[cfg(test)]
mod tests {
    use super::Can;
    use can::Frame;
    use physics::Noise;

    #[test]
    fn the_lowest_identifier_goes_first_once_the_bus_is_free() {
        let mut can = Can::new(3, 500);
        let [a, b, c] = [0x300, 0x200, 0x100].map(|id| Frame::new(id, &[1, 2, 3]));
        can.queue(0, a, 0.0);
        can.queue(1, b, 10.0);
        can.queue(2, c, 20.0);
        let all = std::iter::from_fn(|| can.pass(1e6, |_| false));
        let sent: Vec<_> = all.map(|(sent, _)| (sent.from, sent.at_us)).collect();
        assert_eq!([0, 1, 2].map(|n: usize| sent[n].0), [0, 2, 1]);
        let bits: u32 = [a, c, b].iter().map(Frame::bits).sum();
        assert!((sent[2].1 - f64::from(2 * bits)).abs() < 1e-9);
        assert_eq!(can.load().frames, 3);
        assert!((can.load().busy_s - f64::from(2 * bits) * 1e-6).abs() < 1e-12);
    }

    #[test]
    fn what_is_destroyed_is_sent_again() {
        let mut can = Can::new(1, 1000);
        for n in 0..20 {
            can.queue(0, Frame::new(n, &[]), 0.0);
        }
        let mut random = Noise::new(3);
        let all = std::iter::from_fn(|| can.pass(1e6, |_| random.uniform() < 0.5));
        assert_eq!(all.filter(|(_, is_destroyed)| !is_destroyed).count(), 20);
        let least: u32 = (0..20).map(|n| Frame::new(n, &[]).bits()).sum();
        assert!(can.load().busy_s > 1.2e-6 * f64::from(least));
    }
}
