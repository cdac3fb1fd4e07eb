//! The counters of a board's program that wrap around after hours or weeks, each started
//! just below its wrap.
//!
//! Not here: counts that stop at their limit (ticks missed, events dropped, starts, repeats of
//! a reading, ticks of guards), and what wraps in every run anyway (the tick timer, `SysTick`'s
//! 24 bits, the log's ring, blocks of the touch detector).

mod started;

pub(crate) use started::{Started, bare};

#[derive(Debug, Clone, Copy)]
enum Place {
    /// In RAM: how the names end that lead to it.
    Ram(&'static str),
    /// The count of the timer to which a word in RAM points.
    TimerOf(&'static str),
    /// The count of the F446's TIM5, by which it measures its ticks.
    Tim5,
}

const CNT: u32 = 0x24;
/// TIM5 of the F446, which has no variable; on the other boards one stands for it.
const TIM5: u32 = 0x4000_0C00;

/// A counter that wraps, or what has to begin in step with one.
struct Counter {
    /// What it counts; nothing: it is in step with another.
    what: &'static str,
    place: Place,
    /// Where in RAM the wrap is to be seen, if it is not another's.
    seen: &'static str,
    width: u32,
    /// Whether it wraps from the largest number with a sign.
    is_signed: bool,
    /// Where it starts, counts after its wrap, at so many ticks a second.
    start: fn(i64) -> i64,
}

const fn counter(
    what: &'static str,
    path: &'static str,
    width: u32,
    start: fn(i64) -> i64,
) -> Counter {
    Counter {
        what,
        place: Place::Ram(path),
        seen: path,
        width,
        is_signed: false,
        start,
    }
}

const fn total(what: &'static str, path: &'static str) -> Counter {
    Counter {
        is_signed: true,
        ..counter(what, path, 32, |_| -100)
    }
}

impl Counter {
    /// Whether it wraps by itself, and is not in step with another.
    const fn is_seen(&self) -> bool {
        !self.what.is_empty()
    }

    const fn mask(&self) -> u32 {
        u32::MAX >> (32 - self.width)
    }

    const fn wrap(&self) -> u32 {
        if self.is_signed {
            1 << (self.width - 1)
        } else {
            0
        }
    }

    fn first(&self, tick_hz: u32) -> u32 {
        let after = (self.start)(tick_hz.into()) as u32;
        self.wrap().wrapping_add(after) & self.mask()
    }

    const fn is_beyond(&self, count: u32) -> bool {
        count.wrapping_sub(self.wrap()) & self.mask() <= self.mask() / 2
    }
}

const TOUCHES: &str = "touches";

/// Three quarters of a second before the wrap.
const TICKS: fn(i64) -> i64 = |tick_hz| -(tick_hz * 3 / 4);
/// Half a second of a clock of 80 MHz before it.
const CLOCK: fn(i64) -> i64 = |_| -40_000_000;
/// Where a whisker that protracts soon goes.
const ENCODER: fn(i64) -> i64 = |_| -50;

const COUNTERS: [Counter; 14] = [
    counter("ticks", "TICKS.v", 32, TICKS),
    counter("", "IDLE.fed", 32, TICKS),
    counter("", "IDLE.logged", 32, TICKS),
    // The next full second.
    counter("", "module.second", 32, |tick_hz| tick_hz / 4),
    counter(TOUCHES, "touches.last", 16, |_| -4),
    Counter {
        place: Place::Tim5,
        ..counter(
            "the clock that measures the ticks",
            "INNER.timing.begun",
            32,
            CLOCK,
        )
    },
    counter("", "INNER.clock.now", 32, CLOCK),
    Counter {
        place: Place::TimerOf("servo.angle.timer.ptr"),
        ..counter("the encoder's timer", "servo.angle.last", 16, ENCODER)
    },
    counter("", "servo.angle.last", 16, ENCODER),
    total("the encoder's total", "servo.angle.counts"),
    total("", "servo.counts"),
    // Where rest is.
    total("", "servo.home.first"),
    total("", "servo.home.second"),
    total("", "servo.home.third"),
];

/// What each counts, its bits, and how many counts before its wrap it starts, at 2,000 ticks
/// a second.
pub(crate) fn described() -> impl Iterator<Item = (&'static str, u32, i64)> {
    let wrap = COUNTERS.iter().filter(|counter| counter.is_seen());
    wrap.map(|counter| (counter.what, counter.width, -(counter.start)(2_000)))
}
