//! A board of a head on its bus: the node of `firmware`, its controller, and its number.
//!
//! The interrupts of the controller have the tick's priority: what has come is heard at once,
//! between two ticks, with the time at which it came.

#[path = "bxcan.rs"]
mod bxcan;
#[path = "post.rs"]
mod post;

use can::{Frame, Part};
use firmware::boards::TickPeriod;
use firmware::{Clock, Event, Node, Relay};
use static_cell::StaticCell;
use tactile::Decision;

use crate::board::gpio::{Pin, PinName};
use crate::board::pin_config::PinConfig;
use crate::board::scene::Pace;
use crate::board::types::{Inner, Settings};
use crate::board::{pace, retained, tick_timer};
use crate::here::Counter;
use bxcan::Controller;
pub(crate) use post::Post;
#[cfg(feature = "deploy")]
pub(crate) use post::say_stop;

/// Bits of the board's number, the lowest first: jumpers to ground. A board without one is node
/// 0; a second one without stays off, and is silent, as soon as it hears the first.
const NUMBER: [PinName; 5] = [
    PinName::new('C', 0),
    PinName::new('C', 1),
    PinName::new('C', 2),
    PinName::new('C', 3),
    PinName::new('C', 4),
];

/// Rounds for which pull-ups of some 40 kΩ charge a jumper's pin: more than 10 µs.
const PULL_UP_ROUNDS: u32 = 1_000;

/// By its jumpers; 0 where it has all whiskers.
pub(crate) fn number(settings: &Settings) -> u8 {
    if settings.head.bus.is_none() {
        return 0;
    }
    crate::here::clock_ports();
    for pin in NUMBER {
        Pin::new(pin, PinConfig::INPUT.pulled_up());
    }
    cortex_m::asm::delay(PULL_UP_ROUNDS);
    let bits = NUMBER.iter().rev();
    bits.fold(0, |number, pin| number << 1 | u8::from(pin.is_low()))
}

/// A board of a head; nothing where one board has all whiskers.
pub(crate) struct Head(Option<&'static mut OnBus>);

static ON_BUS: StaticCell<OnBus> = StaticCell::new();
static LETTERS: StaticCell<post::Queues> = StaticCell::new();

struct OnBus {
    node: Node,
    number: u8,
    letters: post::Ends,
    controller: Controller,
    own: Time,
    decided: Option<Decision>,
}

/// At most this share of a tick: ten times what crystals differ by, and nothing to a sensor's
/// frame.
const FOLLOWS_MOST: i32 = 1_024;
/// A tick makes good this part of what it is late by.
const FOLLOWS: i32 = 16;

struct Time {
    clock: Counter,
    per_us: u32,
    /// The last tick, by the clock, and µs since the first.
    tick: u32,
    tick_us: u64,
    /// Of the next tick, and what was rounded off of it, µs by ticks a second.
    next_us: u64,
    rest: u32,
    period: TickPeriod,
    /// Counts of the tick timer in a microsecond, and those by which ticks were longer than their
    /// period and which are no microsecond yet.
    timer_per_us: i32,
    longer: i32,
    next_longer: i32,
}

impl Time {
    fn new(period: TickPeriod) -> Self {
        let clocks = pace::clocks();
        let per_us = |hz: u32| (hz / 1_000_000).max(1);
        Self {
            clock: Counter::running(),
            per_us: per_us(clocks.counter_hz),
            tick: 0,
            tick_us: 0,
            next_us: 0,
            rest: 0,
            period,
            timer_per_us: per_us(clocks.tick_timer_hz).cast_signed(),
            longer: 0,
            next_longer: 0,
        }
    }

    /// The tick that has begun is late by the clock of the head: the next becomes shorter.
    fn follow(&mut self, late_us: i32) {
        let TickPeriod { prescaler, period } = self.period;
        let (prescaler, period) = (i32::from(prescaler.max(1)), i32::from(period));
        let most = period / FOLLOWS_MOST;
        let late = late_us.saturating_mul(self.timer_per_us) / prescaler;
        let counts = (period - (late / FOLLOWS).clamp(-most, most)).min(u16::MAX.into());
        tick_timer::set_next(counts as u16);
        self.longer += self.next_longer;
        self.next_longer = (counts - period) * prescaler;
        let us = self.longer.checked_div_euclid(self.timer_per_us);
        let us = us.unwrap_or(0);
        self.longer -= us * self.timer_per_us;
        self.next_us = self.next_us.wrapping_add_signed(us.into());
    }

    fn tick(&mut self, tick_hz: u32) -> u64 {
        self.tick = self.clock.now();
        self.tick_us = self.next_us;
        let us = self.rest + 1_000_000;
        self.next_us += u64::from(us / tick_hz.max(1));
        self.rest = us % tick_hz.max(1);
        self.tick_us
    }

    fn now(&mut self) -> u64 {
        let since = self.clock.now().wrapping_sub(self.tick);
        self.tick_us + u64::from(since.checked_div(self.per_us).unwrap_or(0))
    }
}

impl Head {
    /// One whose number is none of the head's is silent, as it has no whiskers.
    // Apart: a node is made on the stack, which another part of the start needs.
    #[inline(never)]
    pub(crate) fn start(settings: &Settings, pace: &Pace, number: u8) -> (Self, Post) {
        let none = || (Self(None), Post::none());
        let bus = settings.head.bus.filter(|bus| number < bus.nodes);
        let (Some(bus), Some(timing)) = (bus, pace.bus) else {
            return none();
        };
        let Some(queues) = LETTERS.try_init_with(post::Queues::new) else {
            return none();
        };
        let (letters, post) = queues.split(Relay::new(number, bus, settings.head.tick_hz));
        let on_bus = ON_BUS.try_init_with(|| OnBus {
            node: Node::new(&settings.head, number),
            number,
            letters,
            controller: Controller::start(timing),
            own: Time::new(pace.tick),
            decided: None,
        });
        (Self(on_bus), post)
    }

    pub(crate) fn before(
        &mut self,
        inner: &mut Inner,
        settings: &Settings,
        events: &mut impl FnMut(Event),
    ) {
        let Some(on_bus) = &mut self.0 else {
            return;
        };
        let now_us = on_bus.own.tick(settings.head.tick_hz);
        on_bus.decided = None;
        let was_armed = inner.is_armed();
        on_bus.node.before(now_us, (inner, settings), events);
        on_bus.own.follow(on_bus.node.late_us());
        let is_armed = inner.is_armed();
        if is_armed != was_armed {
            // A reset does not undo what another board has asked for.
            retained::set_stopped(!is_armed);
            events(if is_armed {
                Event::Armed
            } else {
                Event::Stopped
            });
        }
    }

    #[inline]
    pub(crate) fn note(&mut self, event: &Event) {
        if let (Some(on_bus), Event::Decision(_, decision)) = (&mut self.0, event) {
            on_bus.decided.get_or_insert(*decision);
        }
    }

    pub(crate) fn after(&mut self, inner: &Inner, settings: &Settings) {
        let Some(on_bus) = &mut self.0 else {
            return;
        };
        let (node, controller) = (&mut on_bus.node, &mut on_bus.controller);
        controller.tick(settings.head.tick_hz);
        node.after((inner, settings), on_bus.decided, &mut |frame| {
            controller.say(frame);
        });
        // One a tick, so that they keep no message of the head from its place.
        let letter = on_bus.letters.said.dequeue();
        if let Some(frame) = letter.filter(|_| !node.is_twin()) {
            controller.say(frame);
        }
    }

    pub(crate) fn hear(&mut self) {
        let Some(on_bus) = &mut self.0 else {
            return bxcan::ignore();
        };
        let at_us = on_bus.own.now();
        while let Some(frame) = bxcan::take() {
            match Part::of(&frame) {
                None => on_bus.node.hear(&frame, at_us),
                // What finds no room comes again.
                Some(part) if part.to == on_bus.number => _ = on_bus.letters.heard.enqueue(frame),
                Some(_) => {}
            }
        }
    }

    pub(crate) fn said(&mut self) {
        let Some(on_bus) = &mut self.0 else {
            return bxcan::ignore();
        };
        let (node, at_us) = (&mut on_bus.node, on_bus.own.now());
        let said = &mut |frame: &Frame| node.said(frame, at_us);
        on_bus.controller.go_on(said);
    }

    pub(crate) fn stop(&mut self) {
        if let Some(on_bus) = &mut self.0 {
            on_bus.node.stop();
        }
    }

    pub(crate) fn arm(&mut self) {
        if let Some(on_bus) = &mut self.0 {
            on_bus.node.arm();
        }
    }
}
