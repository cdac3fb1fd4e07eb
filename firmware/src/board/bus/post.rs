//! Letters to and from other boards of a head, as idle has them: it makes requests, answers and
//! packets of what the interrupts of the controller bring, and back.

use can::{Frame, Message, PARTS};
use firmware::{Frames, Heard, Packet, Relay};
use heapless::spsc::{Consumer, Producer, Queue};
use wire::{Answer, ForNode, TaggedCommand, UnknownCommand};

use super::bxcan;
use crate::board::counters::TICKS;
use crate::board::pace;

/// Frames that may wait for idle, and for the tick: those of five letters.
const FRAMES: usize = 5 * PARTS + 1;

pub(super) struct Queues {
    heard: Queue<Frame, FRAMES>,
    said: Queue<Frame, FRAMES>,
}

pub(super) struct Ends {
    pub(super) heard: Producer<'static, Frame>,
    pub(super) said: Consumer<'static, Frame>,
}

struct Link {
    relay: Relay,
    heard: Consumer<'static, Frame>,
    said: Producer<'static, Frame>,
}

/// Nothing where one board has all whiskers.
pub(crate) struct Post(Option<Link>);

/// Says a stop of the whole head as a board would, where no tick does. Whoever misses it, and is
/// armed, hears it again from others.
pub(crate) fn say_stop(number: Option<u8>) {
    if let Some(number) = number {
        bxcan::say_alone(&[Message::Stop.frame(number, 0)]);
    }
}

impl Queues {
    pub(super) const fn new() -> Self {
        Self {
            heard: Queue::new(),
            said: Queue::new(),
        }
    }

    pub(super) fn split(&'static mut self, relay: Relay) -> (Ends, Post) {
        let (put_heard, heard) = self.heard.split();
        let (put_said, said) = self.said.split();
        let ends = Ends {
            heard: put_heard,
            said,
        };
        let said = put_said;
        (ends, Post(Some(Link { relay, heard, said })))
    }
}

impl Link {
    /// Whether there was room for all.
    fn say(&mut self, frames: Option<Frames>) -> bool {
        let Some(frames) = frames else {
            return false;
        };
        let has_room = self.said.capacity() - self.said.len() >= PARTS;
        if has_room {
            for frame in frames {
                let _ = self.said.enqueue(frame);
            }
        }
        has_room
    }
}

impl Post {
    pub(super) const fn none() -> Self {
        Self(None)
    }

    pub(crate) fn number(&self) -> Option<u8> {
        self.0.as_ref().map(|link| link.relay.number())
    }

    pub(crate) fn has(&self, number: u8) -> bool {
        self.0.as_ref().is_some_and(|link| link.relay.has(number))
    }

    /// Whether there is a board of that number. Where there is no room it is asked later.
    pub(crate) fn ask(&mut self, request: ForNode) -> bool {
        let Some(link) = &mut self.0 else {
            return false;
        };
        let frames = link.relay.ask(request, TICKS.get());
        link.say(frames);
        frames.is_some()
    }

    pub(crate) fn next(&mut self) -> Option<Heard> {
        let link = self.0.as_mut()?;
        while let Some(frame) = link.heard.dequeue() {
            match link.relay.hear(&frame) {
                Some(Heard::Say(frames)) => _ = link.say(Some(frames)),
                None => {}
                heard => return heard,
            }
        }
        match link.relay.pass(TICKS.get()) {
            Some(Heard::Say(frames)) => {
                link.say(Some(frames));
                None
            }
            heard => heard,
        }
    }

    pub(crate) fn take_request(&mut self) -> Option<(u8, Result<TaggedCommand, UnknownCommand>)> {
        self.0.as_mut()?.relay.take_request()
    }

    /// Answers another board; whether there was room.
    pub(crate) fn answer(&mut self, answer: &Answer) -> bool {
        let Some(link) = &mut self.0 else {
            return true;
        };
        let frames = link.relay.answer(answer);
        frames.is_none() || link.say(frames)
    }

    pub(crate) fn packet(&mut self, to: u8, packet: &Packet) {
        if let Some(link) = &mut self.0 {
            let frames = link.relay.packet(to, packet);
            link.say(Some(frames));
        }
    }

    pub(crate) fn every(&self) -> u32 {
        Relay::every(pace::tick_hz())
    }
}

/// What a loader uses, which has the controller for itself.
impl Post {
    pub(crate) fn begin_loading(&mut self) {
        bxcan::accept_requests();
    }

    pub(crate) fn next_alone(&mut self) -> Option<TaggedCommand> {
        while let Some(frame) = bxcan::take() {
            let relay = &mut self.0.as_mut()?.relay;
            if let Some(Heard::Say(frames)) = relay.hear(&frame) {
                bxcan::say_alone(&frames);
            }
            match relay.take_request() {
                Some((_, Ok(request))) => return Some(request),
                // It would keep all others waiting.
                Some((_, Err(unknown))) => self.reply_alone(&unknown.answer(TICKS.get())),
                None => {}
            }
        }
        None
    }

    pub(crate) fn reply_alone(&mut self, answer: &Answer) {
        if let Some(link) = &mut self.0
            && let Some(frames) = link.relay.answer(answer)
        {
            bxcan::say_alone(&frames);
        }
    }

    pub(crate) fn has_sent() -> bool {
        bxcan::has_sent()
    }
}
