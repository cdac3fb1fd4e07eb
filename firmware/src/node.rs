//! A board of a head: what it hears of the others, and what it says.
//!
//! Every node computes the oscillators of both sides. That of a side is led by the side's lowest
//! node that lives: it says ψ every 2 ms, and the others correct theirs by the difference to what
//! they had at the same tick, turned by its age. So where all compute the same nothing changes,
//! and a node that leads no more leaves oscillators that go on without a step. What whiskers feel
//! is said every 10 ms, and at once where it rises.
//!
//! A message takes effect a fixed number of ticks after its stamp, 4 ms; one that comes later
//! counts as lost. So a head does the same in every simulation and on every chip, however long the
//! bus takes. Nothing here waits for it, and a message is believed only in range and in time.

mod clock;
mod deciding;
mod members;
mod replica;
mod saying;
mod times;

use can::{Contact, Frame, MAX_NODES, Message};
use heapless::Vec;
use tactile::Decision;
use whisking::{MAX_SIDES, Number, Real};

use crate::{
    Config, Event, Hardware, HeadConfig, Module, MotionConfig, NodeEvent, Perception,
    SampleClassifier, Whisker,
};
use clock::Clock;
use deciding::Deciding;
use members::Members;
use replica::Replica;
use times::Times;

/// Most messages that have come and have not taken effect yet.
const MOST_DUE: usize = 64;

/// So many times a stop comes through: it is said until it has.
const STOPS: u8 = 3;

/// A message, as the frame that it came in, which takes less room.
#[derive(Debug, Clone, Copy)]
struct Due {
    /// The tick before which it takes effect.
    at: u32,
    frame: Frame,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Motors {
    May,
    /// A stop came, and no arm since.
    Stopped,
    /// Another node has the same number.
    Twin,
}

const fn bit(node: u8) -> u32 {
    1 << (node & 31)
}

/// A board of a head.
#[derive(Debug)]
pub struct Node {
    number: u8,
    times: Times,
    clock: Clock,
    /// The number of the next tick, by the clock of the head.
    tick: u32,
    /// How late the last tick began, by that clock, µs.
    late_us: i32,
    /// Ticks since the start for which it has joined none.
    alone: u16,
    is_joined: bool,
    motors: Motors,
    /// Stops that have still to come through; one more where none was said.
    stops: u8,
    /// An arm to be said as soon as no stop can be under way.
    arms: bool,
    /// Ticks since a stop was heard, or one of its own came through.
    since_stop: u16,
    members: Members,
    replica: Replica,
    deciding: Deciding,
    decision: Option<Decision>,
    due: Vec<Due, MOST_DUE>,
    /// What was said of contact last, and how long ago.
    said: Contact,
    since_said: u16,
    /// Nodes that were heard first, or again, since the last tick; its own number is a twin's.
    news: u32,
    /// Messages that came too late, were no messages or out of range, or found no room.
    lost: u32,
}

impl Node {
    /// Before its first tick. A head without a bus has no nodes.
    pub fn new(head: &HeadConfig, number: u8) -> Self {
        let times = Times::at(head.tick_hz);
        Self {
            number,
            times,
            clock: Clock::new(),
            tick: 0,
            late_us: 0,
            alone: 0,
            is_joined: false,
            motors: Motors::May,
            stops: 0,
            arms: false,
            since_stop: u16::MAX,
            members: Members::new(head, number, times),
            replica: Replica::new(times),
            deciding: Deciding::new(times),
            decision: None,
            due: Vec::new(),
            said: Contact::default(),
            since_said: 0,
            news: 0,
            lost: 0,
        }
    }

    /// How late the last tick began by the clock of the head, µs; negative: how early, zero where
    /// that clock is its own or not known. Ticks have to be that much shorter for a while.
    pub const fn late_us(&self) -> i32 {
        self.late_us
    }

    /// Whether it shares clock and oscillators of its head.
    pub const fn is_joined(&self) -> bool {
        self.is_joined
    }

    /// Whether motors may run: no stop came after the last arm, and its number is its own.
    pub const fn may_run(&self) -> bool {
        matches!(self.motors, Motors::May)
    }

    /// Whether another board of its head has its number.
    pub const fn is_twin(&self) -> bool {
        matches!(self.motors, Motors::Twin)
    }

    /// Messages that it could not use.
    pub const fn lost(&self) -> u32 {
        self.lost
    }

    /// Whether it leads the oscillator of a side.
    pub fn leads(&self, side: usize) -> bool {
        self.is_joined && self.members.leader(side, true) == Some(self.number)
    }

    /// Stops all motors of the head, its own before the next tick.
    pub fn stop(&mut self) {
        self.stops = STOPS + 1;
        self.hear_stop();
    }

    fn hear_stop(&mut self) {
        self.arms = false;
        self.since_stop = 0;
        let is_arm = |frame: &Frame| matches!(Message::of(frame), Ok((_, _, Message::Arm)));
        self.due.retain(|due| !is_arm(&due.frame));
        if self.motors == Motors::May {
            self.motors = Motors::Stopped;
        }
    }

    /// Arms all motors of the head, which ends a stop that came before: its own may run at once.
    pub const fn arm(&mut self) {
        self.arms = true;
        self.stops = 0;
        if matches!(self.motors, Motors::Stopped) {
            self.motors = Motors::May;
        }
    }

    /// A frame has come; `at_us`: when it ended, by the node's own clock.
    pub fn hear(&mut self, frame: &Frame, at_us: u64) {
        let Ok((from, stamp, message)) = Message::of(frame) else {
            self.lost = self.lost.saturating_add(1);
            return;
        };
        if from == self.number {
            if !self.is_twin() {
                self.motors = Motors::Twin;
                self.news |= bit(from);
            }
            return;
        }
        match message {
            Message::Stop => {
                self.hear_stop();
                return;
            }
            Message::Time { number, last_us } => {
                if self.members.leader_of_time(false) == Some(from) {
                    self.clock.hear(from, number, last_us, at_us);
                }
                return;
            }
            _ => {}
        }
        if let Message::Contact(contact) = message
            && self.members.heard(from, contact.is_joined)
        {
            self.news |= bit(from);
            // It was off the bus as the stop was said.
            if contact.is_armed && self.motors == Motors::Stopped {
                self.stops = self.stops.max(1);
            }
        }
        // One, where this node has done the same tick as the one that says it.
        let late = (self.tick as u8).wrapping_sub(stamp);
        let made = self.tick.wrapping_sub(late.into());
        let is_of_round = match message {
            Message::Contact(contact) => contact.round == Contact::round(made),
            // It has waited for the bus, and was made before the stop.
            Message::Arm if u16::from(late) >= self.since_stop => return,
            _ => true,
        };
        let is_in_time = is_of_round && u16::from(late) <= self.times.delay;
        self.members.fits(from, is_in_time);
        let left = self.times.delay.saturating_sub(late.into());
        let at = self.tick.wrapping_add(left.into());
        let due = Due { at, frame: *frame };
        if !is_in_time || self.due.push(due).is_err() {
            self.lost = self.lost.saturating_add(1);
        }
    }

    /// A frame of this node has come through; `at_us`: when it ended, by the node's own clock.
    pub fn said(&mut self, frame: &Frame, at_us: u64) {
        match Message::of(frame) {
            Ok((_, _, Message::Time { .. })) => self.clock.said(at_us),
            Ok((_, _, Message::Stop)) => {
                self.stops = self.stops.saturating_sub(1);
                self.since_stop = 0;
            }
            _ => {}
        }
    }

    /// Before a tick, which begins at `now_us` by its own clock. What becomes of the node, and what
    /// the head has decided by what others have felt, are events of this tick.
    pub fn before<R: Number, H: Hardware>(
        &mut self,
        now_us: u64,
        (module, config): (&mut Module<R, H>, &Config<R>),
        events: &mut impl FnMut(Event),
    ) {
        let own = self.number;
        let place = module.whiskers().first().map(Whisker::place);
        let mut decided = None;
        self.pass(now_us, (module, config), &mut decided, &mut |what| {
            events(Event::Node(own, what));
        });
        if let (Some(decision), Some(place)) = (decided, place) {
            events(Event::Decision(place, decision));
        }
    }

    fn pass<R: Number, H: Hardware>(
        &mut self,
        now_us: u64,
        (module, config): (&mut Module<R, H>, &Config<R>),
        decided: &mut Option<Decision>,
        events: &mut impl FnMut(NodeEvent),
    ) {
        self.say_news(events);
        self.keep_time(now_us, config.head.tick_hz, events);
        let now = self.tick;
        let mut is_armed = false;
        // One by one, as all together would take a thousand bytes of stack.
        for n in 0..self.due.len() {
            let Some(one) = self.due.get(n).copied() else {
                break;
            };
            match one.at.wrapping_sub(now).cast_signed() {
                0 => {}
                1.. => continue,
                // The clock was set since.
                _ => {
                    self.lost = self.lost.saturating_add(1);
                    continue;
                }
            }
            let Ok((from, _, message)) = Message::of(&one.frame) else {
                continue;
            };
            match message {
                Message::Contact(contact) => self.members.feels(from, contact.pi),
                Message::Psi { side, psi } => {
                    let leader = self.members.leader(side.into(), self.is_joined);
                    if leader == Some(from)
                        && let (Some(motion), Some(config)) = (module.motion_mut(), &config.motion)
                    {
                        let of = (&config.whisking.oscillators, &mut motion.state.oscillators);
                        self.replica
                            .correct(of, (side.into(), psi), now, self.is_joined);
                    }
                }
                Message::Arm => is_armed = self.is_joined,
                Message::Evidence(evidence) => {
                    let made = now.wrapping_sub(self.times.delay.into());
                    let decision = module.perception_mut().and_then(|perception| {
                        let classifier = perception.classifier_mut();
                        self.deciding.hear(from, made, evidence, classifier)
                    });
                    if let Some(decision) = decision {
                        self.decision = Some(decision);
                        *decided = Some(decision);
                    }
                }
                Message::Decision { .. } => {
                    if self.members.leader_of_time(self.is_joined) == Some(from)
                        && let Some(perception) = module.perception_mut()
                    {
                        perception.classifier_mut().forget();
                        self.deciding.decided(now);
                    }
                }
                Message::Stop | Message::Time { .. } => {}
            }
        }
        self.due
            .retain(|one| one.at.wrapping_sub(now).cast_signed() > 0);
        let is_led = self.members.leader_of_time(self.is_joined) != Some(self.number);
        let mut classifier = module.perception_mut().map(Perception::classifier_mut);
        if let Some(classifier) = &mut classifier {
            classifier.set_led(is_led);
        }
        self.members.pass(&mut |event| {
            if let (NodeEvent::Lost(number), Some(classifier)) = (event, &mut classifier) {
                let _ = classifier.hear(number.into(), None);
            }
            events(event);
        });
        self.join(config.motion.as_ref(), events);
        module.feel_elsewhere(self.members.contact());
        if is_armed && !self.is_twin() {
            self.motors = Motors::May;
            self.stops = 0;
            module.arm(true);
        }
        if !self.may_run() {
            module.arm(false);
        }
    }

    fn say_news(&mut self, events: &mut impl FnMut(NodeEvent)) {
        let news = core::mem::take(&mut self.news);
        for node in (0..MAX_NODES as u8).filter(|node| news & bit(*node) != 0) {
            events(if node == self.number {
                NodeEvent::Twin
            } else {
                NodeEvent::Heard(node)
            });
        }
    }

    fn keep_time(&mut self, now_us: u64, tick_hz: u32, events: &mut impl FnMut(NodeEvent)) {
        let Some((tick, late_us)) = self.clock.tick(now_us, tick_hz) else {
            self.late_us = 0;
            return;
        };
        self.late_us = late_us;
        let off = tick.wrapping_sub(self.tick).cast_signed();
        if !self.is_joined {
            self.tick = tick;
        } else if !(-1..=1).contains(&off) {
            self.leave(events);
        }
    }

    fn leave(&mut self, events: &mut impl FnMut(NodeEvent)) {
        self.is_joined = false;
        self.alone = 0;
        self.clock = Clock::new();
        self.replica.forget();
        self.due.clear();
        events(NodeEvent::Left);
    }

    /// Joins the head as soon as it shares its clock and oscillators, or begins one if it is the
    /// lowest that lives.
    fn join<R: Real>(
        &mut self,
        motion: Option<&MotionConfig<R>>,
        events: &mut impl FnMut(NodeEvent),
    ) {
        if self.is_joined && (self.members.is_strange() || self.is_twin()) {
            self.leave(events);
        }
        if self.is_joined || self.is_twin() {
            return;
        }
        self.alone = self.alone.saturating_add(1);
        let is_found = match self.members.leader_of_time(false) {
            Some(_) => {
                let is_led = |side| self.members.leader(side, false).is_some();
                let lacks = |side| is_led(side) && !self.replica.is_led(side);
                self.clock.is_set() && (motion.is_none() || !(0..MAX_SIDES).any(lacks))
            }
            None => self.alone >= self.times.drop && self.members.is_lowest(),
        };
        if is_found {
            self.is_joined = true;
            events(NodeEvent::Joined);
        }
    }
}
