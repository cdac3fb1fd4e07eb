//! The link of a program that has one: records, requests and answers between the tick and idle,
//! by queues with one writer and one reader each.
//!
//! The tick writes records and carries out requests, each as a value. Idle makes frames of what
//! comes from the tick, takes those of requests apart, and answers what needs no tick
//! ([`Exchange`]).

#[path = "configs.rs"]
mod configs;
#[path = "exchange.rs"]
mod exchange;
#[path = "probe.rs"]
mod probe;
#[path = "stops.rs"]
mod stops;

use firmware::{About, Event, Link, ModelState, Part};
use heapless::spsc::{Consumer, Producer};
use wire::{Answer, Command, CommandStatus, Load, TaggedCommand, TickRecord};

use crate::board::integrity::Changed;
use crate::board::retained;
use crate::board::slots::{self, ROOM};
use crate::board::types::{Inner, Settings};
pub(crate) use configs::Configs;
use configs::{Spare, Ways};
pub(crate) use exchange::Exchange;
#[cfg(any(feature = "deploy", feature = "serial"))]
pub(crate) use exchange::Origin;
#[cfg(feature = "deploy")]
pub(crate) use probe::ProbeLine;
#[cfg(feature = "serial")]
pub(crate) use stops::Looked;
use stops::{By, Stops};

/// Records of as many ticks as idle may be late, of two whiskers, and one more.
const RECORDS: usize = 32;

#[derive(Clone, Copy)]
struct Asked {
    /// Counts up: a flipped bit in an offset of the queue has nothing carried out again.
    number: u8,
    request: TaggedCommand,
    /// The settings that it asks for are on their way.
    takes_over: bool,
    /// The link by which it has come, and what had come by it then.
    by: By,
    at: u32,
}

/// Between idle and the tick, there and back.
pub(crate) struct Queues {
    records: heapless::spsc::Queue<TickRecord, RECORDS>,
    requests: heapless::spsc::Queue<Asked, 2>,
    answers: heapless::spsc::Queue<Answer, 2>,
    settings: configs::Queue,
}

pub(crate) struct TickEnds {
    records: Producer<'static, TickRecord>,
    requests: Consumer<'static, Asked>,
    answers: Producer<'static, Answer>,
    settings: Ways,
}

pub(crate) struct IdleEnds {
    records: Consumer<'static, TickRecord>,
    requests: Producer<'static, Asked>,
    answers: Consumer<'static, Answer>,
}

impl Queues {
    pub(crate) const fn new() -> Self {
        Self {
            records: heapless::spsc::Queue::new(),
            requests: heapless::spsc::Queue::new(),
            answers: heapless::spsc::Queue::new(),
            settings: configs::Queue::new(),
        }
    }

    pub(crate) fn split(&'static mut self) -> (IdleEnds, Ways, TickEnds) {
        let (put_record, take_record) = self.records.split();
        let (ask, take_request) = self.requests.split();
        let (reply, take_answer) = self.answers.split();
        let (idle, tick) = self.settings.split();
        (
            IdleEnds {
                records: take_record,
                requests: ask,
                answers: take_answer,
            },
            idle,
            TickEnds {
                records: put_record,
                requests: take_request,
                answers: reply,
                settings: tick,
            },
        )
    }
}

/// The tick's end of the link.
pub(crate) struct Telemetry {
    link: Link,
    ends: TickEnds,
    about: About,
    changed: Changed,
    stops: Stops,
    /// The number of the next request.
    next: u8,
}

impl Telemetry {
    /// Settings and module stay where they are.
    pub(crate) fn new(
        settings: &Settings,
        inner: &Inner,
        model: ModelState,
        ends: TickEnds,
    ) -> Self {
        Self {
            link: Link::new(),
            ends,
            about: About { model },
            changed: Changed::new(settings, inner),
            stops: Stops::new(settings.links),
            next: 0,
        }
    }

    #[inline]
    pub(crate) fn look_for_stop(&mut self, tick: u32) -> bool {
        self.stops.look(tick)
    }

    /// What has come by now came before a stop.
    pub(crate) fn stop(&mut self) {
        self.stops.stop();
    }

    pub(crate) fn note(&mut self, event: &Event) {
        self.link.note(event);
    }

    #[inline]
    pub(crate) fn is_busy(&self) -> bool {
        self.link.streams() || self.waits()
    }

    #[inline]
    pub(crate) fn waits(&self) -> bool {
        self.ends.requests.ready()
    }

    pub(crate) fn send(&mut self, module: &Inner, settings: &Settings, tick: u32) {
        let records = &mut self.ends.records;
        let put = &mut |record| records.enqueue(record).is_ok();
        self.link.send(module, settings, tick, put);
    }

    /// Carries out what was asked for; whether that was to arm the motors.
    pub(crate) fn talk(&mut self, module: &mut Inner, settings: &mut Spare, tick: u32) -> bool {
        let Some(asked) = self.ends.requests.dequeue() else {
            return false;
        };
        if asked.number != self.next {
            return false;
        }
        self.next = self.next.wrapping_add(1);
        let request = asked.request;
        let answer = match request.command {
            _ if asked.takes_over && Part::Set.is_built() => {
                let Some(answer) = self.take_over(module, settings, request, tick) else {
                    return false;
                };
                answer
            }
            Command::Arm if self.stops.is_before(asked.at, asked.by) => {
                firmware::answer(request, tick, (CommandStatus::Stopped, [0; 2]))
            }
            Command::Load(load) if Part::Deploy.is_built() => {
                let status = may_load(load, module.is_armed());
                firmware::answer(request, tick, (status, [load.words().cast_signed(), 0]))
            }
            _ => self
                .link
                .carry_out(module, settings, request, self.about, tick),
        };
        let is_done = answer.status == CommandStatus::Done;
        let arms = is_done && matches!(request.command, Command::Arm);
        if arms {
            retained::set_stopped(false);
        }
        // Idle asks for no more before it has this.
        let _ = self.ends.answers.enqueue(answer);
        arms
    }

    #[cold]
    #[inline(never)]
    fn take_over(
        &mut self,
        module: &mut Inner,
        settings: &mut Spare,
        request: TaggedCommand,
        tick: u32,
    ) -> Option<Answer> {
        // Otherwise the last thing that is asked for: idle resets the board.
        if !self.changed.holds() {
            return None;
        }
        let mut next = self.ends.settings.receive.dequeue()?;
        let taken = firmware::take_over(module, settings, next);
        if taken.is_ok() {
            core::mem::swap(settings, &mut next);
            self.changed.after(settings);
        }
        // There is room for one.
        let _ = self.ends.settings.send.enqueue(next);
        Some(firmware::answer(request, tick, firmware::applied(taken)))
    }
}

fn may_load(load: Load, is_armed: bool) -> CommandStatus {
    match firmware::may_load(load, ROOM, is_armed) {
        Ok(()) if slots::is_paired(load) => CommandStatus::Done,
        Ok(()) => CommandStatus::OutOfRange,
        Err(status) => status,
    }
}
