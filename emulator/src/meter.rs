//! How the ticks keep their time: latency, length, and what the core executes
//! from one tick to the next.

use crate::chip::Ps;
use crate::machine::Spent;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Tally {
    count: u64,
    sum: u64,
    pub(crate) worst: u64,
}

impl Tally {
    pub(crate) const fn add(&mut self, value: u64) {
        self.count += 1;
        self.sum += value;
        if value > self.worst {
            self.worst = value;
        }
    }

    pub(crate) fn mean(&self) -> f64 {
        self.sum as f64 / self.count.max(1) as f64
    }
}

/// A whole tick is from the first instruction of its handler to that of the next; idle's sleep
/// executes nothing.
#[derive(Debug, Default)]
pub(crate) struct Meter {
    /// From the timer's update to the first instruction of the tick's handler, ps.
    pub latency: Tally,
    /// From there to the handler's return, ps.
    pub length: Tally,
    /// From the first instruction of a handler to that of the next, ps.
    pub period: Tally,
    /// Instructions of the tick's handler.
    pub tick: Tally,
    /// Instructions of the handlers beside it, a whole tick.
    pub handlers: Tally,
    /// Instructions of idle in whole ticks in which it logs nothing.
    pub idle: Tally,
    /// Instructions of idle in whole ticks in which it logs.
    pub logging: Tally,
    /// Instructions of a whole tick but for the log: where idle logs, its mean
    /// without logging stands for it.
    pub whole: Tally,
    began: Option<(Ps, Spent)>,
    /// The whole tick that has ended last, until it is known whether it logged.
    ended: Option<Spent>,
    writer: u32,
}

impl Meter {
    /// Where the log's writer stands after a tick: idle has moved it, if at all,
    /// before that tick began.
    pub(crate) fn logged(&mut self, writer: u32) {
        let moved = writer != self.writer;
        self.writer = writer;
        let Some(spent) = self.ended.take() else {
            return;
        };
        let handlers = spent.frame + spent.other;
        self.tick.add(spent.tick);
        self.handlers.add(handlers);
        let idle = if moved {
            self.logging.add(spent.thread);
            self.idle.mean().round() as u64
        } else {
            self.idle.add(spent.thread);
            spent.thread
        };
        self.whole.add(spent.tick + handlers + idle);
    }

    pub(crate) fn tick_begins(&mut self, now: Ps, latency: Ps, spent: &Spent) {
        self.latency.add(latency);
        if let Some((began, before)) = self.began.replace((now, *spent)) {
            self.period.add(now - began);
            self.ended = Some(Spent {
                tick: spent.tick - before.tick,
                frame: spent.frame - before.frame,
                thread: spent.thread - before.thread,
                other: spent.other - before.other,
            });
        }
    }

    pub(crate) const fn tick_ends(&mut self, now: Ps) {
        if let Some((began, _)) = self.began {
            self.length.add(now - began);
        }
    }
}
