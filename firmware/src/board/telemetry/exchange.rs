//! Idle's end of the link: frames of what comes from the tick, and requests on their way there.

use core::sync::atomic::Ordering;

use firmware::{EventRecord, Heard, Packet, Prepared, Relay, letters};
use wire::{Answer, Command, CommandStatus, ForNode, Load, Request, TaggedCommand};

use super::configs::Configs;
use super::probe::ProbeLine;
use super::stops::{By, OWED, STOPPED_IN};
use super::{Asked, IdleEnds};
use crate::board::about::About;
use crate::board::bus::Post;
use crate::board::counters::TICKS;
use crate::board::perception::Names;
use crate::board::{log, retained, serial};

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Origin {
    Probe,
    /// By a frame on the serial line.
    Frame,
    /// By a line of text there.
    Line,
    /// By another board of the head.
    Board(u8),
}

impl Origin {
    const fn link(self) -> By {
        match self {
            Self::Frame | Self::Line => By::Serial,
            // Another board arms none by a request.
            Self::Probe | Self::Board(_) => By::Probe,
        }
    }

    pub(crate) const fn is_serial(self) -> bool {
        matches!(self, Self::Frame | Self::Line)
    }
}

#[derive(Clone, Copy)]
pub(crate) struct Pending {
    pub(crate) origin: Origin,
    /// What it wants of this board: unknown commands want nothing.
    command: Option<Command>,
    is_elsewhere: bool,
}

impl Pending {
    /// What a line of text has asked for.
    pub(crate) fn line(&self) -> Option<Command> {
        self.command.filter(|_| self.origin == Origin::Line)
    }

    fn load(&self, answer: &Answer) -> Option<Load> {
        match self.command {
            Some(Command::Load(load)) if answer.status == CommandStatus::Done => Some(load),
            _ => None,
        }
    }
}

pub(crate) struct Exchange {
    ends: IdleEnds,
    configs: Configs,
    pub(crate) probe: ProbeLine,
    pub(crate) post: Post,
    /// Whoever has asked for records and events last, and whoever has asked another board for them.
    reader: Option<Origin>,
    reader_elsewhere: Option<Origin>,
    pending: Option<Pending>,
    answer: Option<Answer>,
    /// The number of the next request for the tick.
    number: u8,
    /// What was [`OWED`] when it was paid last.
    paid: [u32; 3],
    has_motors: bool,
    has_serial: bool,
    /// The serial line's request comes before the probe's, so that neither link waits for ever.
    is_serials_turn: bool,
}

impl Exchange {
    pub(crate) fn new(ends: IdleEnds, configs: Configs, post: Post, about: &About) -> Self {
        Self {
            ends,
            configs,
            probe: ProbeLine::new(),
            post,
            reader: None,
            reader_elsewhere: None,
            pending: None,
            answer: None,
            number: 0,
            paid: [0; 3],
            has_motors: about.has_motors,
            has_serial: about.links.serial_baud.is_some(),
            is_serials_turn: false,
        }
    }

    pub(crate) const fn is_free(&self) -> bool {
        self.pending.is_none()
    }

    pub(crate) fn is_free_for_serial(&self) -> bool {
        self.is_free() && (self.is_serials_turn || !self.probe.is_waiting())
    }

    pub(crate) const fn was_serials_turn(&mut self) {
        self.is_serials_turn = false;
    }

    pub(crate) fn log_changes(&mut self, now: u32) {
        self.configs.log_changes(now);
    }

    pub(crate) fn take_from_probe(&mut self, names: &Names) {
        if self.is_free()
            && !self.is_serials_turn
            && let Some(asked) = self.probe.next_looked_at()
        {
            // The tick has seen a stop.
            if !asked.is_stop() {
                self.is_serials_turn = self.has_serial;
                self.ask(asked, (Origin::Probe, self.probe.count()), names);
            }
        }
    }

    pub(crate) fn take_from_head(&mut self, names: &Names) {
        while let Some(heard) = self.post.next() {
            match heard {
                Heard::Answered(answer) => {
                    if self.pending.is_some_and(|pending| pending.is_elsewhere) {
                        self.answer = Some(answer);
                    }
                }
                Heard::Packet(packet) => {
                    // What another board asks goes to a third by itself.
                    match self.reader_elsewhere {
                        Some(Origin::Probe) => _ = ProbeLine::put(&wire::frame_of(&packet)),
                        Some(Origin::Board(_)) | None => {}
                        Some(_) => serial::send_event(&wire::frame_of(&packet)),
                    }
                }
                Heard::Say(_) => {}
            }
        }
        if self.is_free()
            && let Some((from, request)) = self.post.take_request()
        {
            self.ask(Request::Here(request), (Origin::Board(from), 0), names);
        }
    }

    /// So many bytes had come with its last one.
    pub(crate) fn ask(&mut self, asked: Request, (origin, at): (Origin, u32), names: &Names) {
        let request = match asked {
            Request::Here(request) => request,
            // A whole head is armed, by whichever of its boards.
            Request::For(request)
                if self.post.number() == Some(request.node)
                    || request.number() == Command::Arm.number() && self.post.has(request.node) =>
            {
                request.here()
            }
            Request::For(request) => return self.ask_elsewhere(request, origin),
        };
        self.pending = Some(Pending {
            origin,
            command: request.ok().map(|request| request.command),
            is_elsewhere: false,
        });
        let request = match request {
            Ok(request) => request,
            Err(unknown) => {
                self.answer = Some(unknown.answer(TICKS.get()));
                return;
            }
        };
        log::requested(request.command);
        let prepared = match request.command {
            Command::Class(class, from) => Some(class_name(names, class, from)),
            Command::Started => {
                let values = retained::started().values();
                Some(Prepared::Done(CommandStatus::Done, values))
            }
            // That is a message of the head, which no stop can come before.
            Command::Arm | Command::Stop if matches!(origin, Origin::Board(_)) => {
                Some(Prepared::Done(CommandStatus::NotHere, [0; 2]))
            }
            command => self.configs.prepare(command),
        };
        if let Some(Prepared::Done(status, values)) = prepared {
            let answer = firmware::answer(request, TICKS.get(), (status, values));
            self.answer = Some(answer);
            return;
        }
        let asked = Asked {
            number: self.number,
            request,
            takes_over: prepared == Some(Prepared::Next),
            by: origin.link(),
            at,
        };
        // There is room for one.
        if self.ends.requests.enqueue(asked).is_ok() {
            self.number = self.number.wrapping_add(1);
        }
    }

    fn ask_elsewhere(&mut self, request: ForNode, origin: Origin) {
        self.pending = Some(Pending {
            origin,
            command: None,
            is_elsewhere: true,
        });
        if request.number() == Command::Stream(true).number() {
            self.reader_elsewhere = Some(origin);
        }
        if !self.post.ask(request) {
            self.answer = Some(Relay::no_board(&request, TICKS.get()));
        }
    }

    fn answered(&mut self) -> Option<(Pending, Answer)> {
        if self.answer.is_none() {
            self.answer = self.ends.answers.dequeue();
        }
        Some((self.pending?, self.answer?))
    }

    pub(crate) fn answer(&mut self) -> Option<(Pending, Answer)> {
        // A loader has an answer of its own.
        let found = self.answered();
        found.filter(|(pending, answer)| pending.load(answer).is_none())
    }

    /// Once it may be loaded.
    pub(crate) fn load_due(&mut self) -> Option<(Load, Answer, Origin)> {
        // The loader answers no stop that was before it.
        if !self.has_answered_stops() {
            return None;
        }
        let (pending, answer) = self.answered()?;
        let load = pending.load(&answer)?;
        Some((load, answer, pending.origin))
    }

    pub(crate) fn has_answered(&mut self) {
        let answer = self.answer.take();
        let is_done = answer.is_some_and(|answer| answer.status == CommandStatus::Done);
        let pending = self.pending.take();
        if let (true, Some(pending)) = (is_done, pending)
            && let Some(Command::Stream(on)) = pending.command
        {
            self.reader = on.then_some(pending.origin);
        }
    }

    /// Answers stops, which wait for no other answer, but for room; those that have come by one
    /// link since the last answer have one. `reply` says whether there was room.
    pub(crate) fn answer_stops(&mut self, reply: impl Fn(Option<Command>, &Answer) -> bool) {
        for (way, line) in [(1, None), (2, Some(Command::Stop))] {
            self.answer_stop(way, |answer| reply(line, answer));
        }
    }

    fn answer_stop(&mut self, way: usize, reply: impl Fn(&Answer) -> bool) {
        let (Some(owed), Some(paid)) = (OWED.get(way), self.paid.get_mut(way)) else {
            return;
        };
        let now = owed.get();
        let sequence = STOPPED_IN.load(Ordering::Relaxed);
        // A tick that comes between both has another stop: that is answered next.
        if now == *paid || owed.get() != now {
            return;
        }
        let status = if self.has_motors {
            CommandStatus::Done
        } else {
            CommandStatus::NoWhisker
        };
        let request = TaggedCommand {
            tag: now as u16,
            command: Command::Stop,
        };
        if reply(&firmware::answer(request, sequence, (status, [0; 2]))) {
            *paid = now;
            log::requested(Command::Stop);
        }
    }

    pub(crate) fn has_answered_stops(&self) -> bool {
        OWED.iter()
            .zip(&self.paid)
            .all(|(owed, paid)| owed.get() == *paid)
    }

    pub(crate) fn answer_probe(&mut self) {
        self.answer_stop(0, |answer| {
            ProbeLine::put(&wire::frame_of(&Packet::Answer(*answer).bytes()))
        });
        if let Some((pending, answer)) = self.answer()
            && pending.origin == Origin::Probe
            && ProbeLine::put(&wire::frame_of(&Packet::Answer(answer).bytes()))
        {
            self.has_answered();
        }
    }

    pub(crate) fn answer_head(&mut self) {
        if let Some((pending, answer)) = self.answer()
            && matches!(pending.origin, Origin::Board(_))
            && self.post.answer(&answer)
        {
            self.has_answered();
        }
    }

    /// Sends an event if there is room for it.
    pub(crate) fn send_event(&mut self, event: EventRecord) {
        let packet = Packet::Event(event);
        match self.reader {
            None => {}
            Some(Origin::Probe) => _ = ProbeLine::put(&wire::frame_of(&packet.bytes())),
            Some(Origin::Board(to)) => self.post.packet(to, &packet),
            Some(_) => serial::send_event(&wire::frame_of(&packet.bytes())),
        }
    }

    /// Sends records while there is room for them. Those that find none stay in their queue,
    /// and are lost and counted where that is full.
    pub(crate) fn send_records(&mut self) {
        while let Some(record) = self.ends.records.peek() {
            let packet = Packet::Record(*record);
            let is_sent = match self.reader {
                Some(Origin::Probe) => ProbeLine::record(&wire::frame_of(&packet.bytes())),
                Some(Origin::Board(to)) => {
                    if record.sequence.is_multiple_of(self.post.every()) {
                        self.post.packet(to, &packet);
                    }
                    true
                }
                Some(_) => serial::send_record(&wire::frame_of(&packet.bytes())),
                None => false,
            };
            // Those that came before the answer to who has asked for them wait for it.
            if !is_sent && (self.reader.is_some() || self.pending.is_some()) {
                return;
            }
            _ = self.ends.records.dequeue();
        }
    }
}

fn class_name(names: &Names, class: u8, from: u8) -> Prepared {
    match names.find(class.into()) {
        Some(name) => Prepared::Done(CommandStatus::Done, letters(name, from)),
        None => Prepared::Done(CommandStatus::OutOfRange, [0; 2]),
    }
}
