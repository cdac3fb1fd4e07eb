//! The serial port of a program that has one: lines of what happens, records, and what somebody
//! asks for as a line or in a frame. docs/protocol.md says what they look like.
//!
//! Idle serves it after every tick; DMA moves the bytes. What finds no room is dropped whole.

#[path = "received.rs"]
mod received;
#[path = "sent.rs"]
mod sent;

use firmware::boards::RECEIVED_BYTES;
use firmware::lines::{self, Context};
use firmware::{Event, NotArmed, Packet, StartCause, Startup};
use heapless::Deque;
use wire::text::{self, Spoken};
use wire::{
    Answer, COMMAND_BYTES, Command, CommandStatus, Field, Frame, Line, Piece, Request, Splitter,
    TaggedCommand,
};

use crate::board::about::About;
use crate::board::counters::TICKS;
use crate::board::pace;
use crate::board::perception::Names;
use crate::board::pin_config::{Mode, PinConfig};
use crate::board::telemetry::{Exchange, Origin};
use crate::board::wiring::SERIAL;
use crate::here::dma::SerialTransfers;
use crate::here::{self, SERIAL_FUNCTION, SERIAL_ROUTE, SERIAL_USART, usart};
use received::Received;
pub(crate) use received::ring;

const VERSION: &str = env!("CARGO_PKG_VERSION");

const WAITING: usize = 4;

#[derive(Clone, Copy)]
struct Asked {
    what: Request,
    origin: Origin,
    /// The bytes that had come with its last one.
    at: u32,
}

fn line() -> Line {
    lines::at(TICKS.get(), pace::tick_hz())
}

#[inline(never)]
pub(crate) fn started(cause: StartCause, start: &Startup, about: &About) {
    if about.links.serial_baud.is_none() {
        return;
    }
    let what = (VERSION, about.name(), pace::tick_hz());
    lines::start(line, what, (start, cause), |said| sent::line(said.ended()));
}

#[inline(never)]
pub(crate) fn not_armed(reason: NotArmed, about: &About) {
    if about.links.serial_baud.is_none() {
        return;
    }
    let mut said = line();
    lines::not_armed(&mut said, reason);
    sent::line(said.ended());
}

pub(crate) fn lost() -> u32 {
    sent::LOST.get()
}

pub(crate) fn send_event(frame: &Frame) {
    sent::line(frame);
}

pub(crate) fn send_record(frame: &Frame) -> bool {
    sent::record(frame)
}

#[inline]
pub(crate) fn writer() -> usize {
    received::writer(SerialTransfers::left(&SERIAL_ROUTE))
}

pub(crate) struct Serial {
    transfers: SerialTransfers,
    received: Received,
    splitter: Splitter<COMMAND_BYTES>,
    /// The tick in which the last byte came.
    last_byte: u32,
    waiting: Deque<Asked, WAITING>,
    sending: u16,
    baud: u32,
    /// Bits a second that records of every tick take.
    records_baud: u32,
    /// Ticks without a byte after which a frame that was begun is none: 0.1 s.
    pause: u32,
    is_loading: bool,
}

impl Serial {
    #[inline(never)]
    pub(crate) fn start(about: &About) -> Option<Self> {
        let baud = about.links.serial_baud?;
        let divider = pace::clocks().serial_divider(baud)?;
        here::clock_serial();
        let transfers = SerialTransfers::start(
            &SERIAL_ROUTE,
            usart::data_registers(SERIAL_USART),
            received::address(),
            RECEIVED_BYTES as u16,
        );
        usart::start(SERIAL_USART, divider);
        let [tx, rx] = SERIAL;
        tx.configure(PinConfig::new(Mode::AlternateOutput(SERIAL_FUNCTION)));
        // An idle line is high; the pull-up keeps it so where nothing is connected.
        rx.configure(PinConfig::new(Mode::AlternateInput(SERIAL_FUNCTION)).pulled_up());
        Some(Self {
            transfers,
            received: Received::new(),
            splitter: Splitter::new(),
            last_byte: 0,
            waiting: Deque::new(),
            sending: 0,
            baud,
            records_baud: about.records_baud(),
            pause: pace::tick_hz() / 10,
            is_loading: false,
        })
    }

    pub(crate) fn say(&mut self, event: &Event, names: &Names) {
        let mut said = line();
        let context = Context {
            class_name: |class| names.class(class),
            period_us: pace::period_us(),
            lost: lost(),
        };
        if lines::event(&mut said, event, context).is_some() {
            sent::line(said.ended());
        }
    }

    /// What is to be done after the tick that is the `now`-th.
    pub(crate) fn serve(
        &mut self,
        now: u32,
        about: &About,
        (exchange, names): (&mut Exchange, &Names),
    ) {
        self.receive(now);
        exchange.answer_stops(|line, answer| reply(line, answer, about));
        if let Some((pending, answer)) = exchange.answer()
            && pending.origin.is_serial()
            && reply(pending.line(), &answer, about)
        {
            exchange.has_answered();
        }
        if exchange.is_free_for_serial() {
            exchange.was_serials_turn();
            let Some(asked) = self.waiting.pop_front() else {
                return;
            };
            exchange.ask(asked.what, (asked.origin, asked.at), names);
        }
    }

    #[inline(never)]
    fn receive(&mut self, now: u32) {
        while let Some(byte) = self.received.next() {
            self.last_byte = now;
            let at = self.received.count();
            match self.splitter.push(byte) {
                None => {}
                Some(Piece::Line(said)) => match text::parse(said) {
                    Ok(Spoken::Nothing) => {}
                    Ok(Spoken::Help) => {
                        sent::line(Line::new().text("ok help: ").text(text::ALLOWED).ended());
                    }
                    Ok(Spoken::Command(command)) => {
                        self.take(Asked {
                            what: Request::Here(Ok(TaggedCommand { tag: 0, command })),
                            origin: Origin::Line,
                            at,
                        });
                    }
                    Err((first, fault)) => refuse(first, fault.text()),
                },
                Some(Piece::Frame(content)) => match Request::read(content) {
                    Some(what) => self.take(Asked {
                        what,
                        origin: Origin::Frame,
                        at,
                    }),
                    None => refuse(b"", "a frame that is no request"),
                },
                Some(Piece::Garbled(_)) => refuse(b"", "too long, or cut short"),
            }
        }
        if now.wrapping_sub(self.last_byte) > self.pause {
            self.splitter.pause();
        }
    }

    /// Has a request wait for its turn, unless the line is too slow, or the tick has seen it as a
    /// stop.
    fn take(&mut self, asked: Asked) {
        if asked.what.is_stop() && !self.is_loading {
            return;
        }
        // Another board sends fewer.
        if let Request::Here(Ok(request)) = asked.what
            && matches!(request.command, Command::Stream(true))
            && !self.carries_records()
        {
            self.refuse_records(asked.origin, request);
        } else if self.waiting.push_back(asked).is_err() {
            refuse(b"", "too much at once, wait for answers");
        }
    }

    /// With a twentieth left for lines and answers.
    const fn carries_records(&self) -> bool {
        self.records_baud / 20 * 21 <= self.baud
    }

    fn refuse_records(&self, origin: Origin, request: TaggedCommand) {
        if origin == Origin::Frame {
            let status = CommandStatus::TooSlow;
            let answer = firmware::answer(request, TICKS.get(), (status, [0; 2]));
            sent::line(&wire::frame_of(&Packet::Answer(answer).bytes()));
        } else {
            let mut said = Line::new();
            said.text("refused stream: records of every tick take")
                .field(self.records_baud);
            said.text(" baud and a twentieth, found").field(self.baud);
            sent::line(said.ended());
        }
    }

    pub(crate) fn send(&mut self) {
        if self.transfers.is_sending() {
            return;
        }
        sent::has_sent(core::mem::take(&mut self.sending));
        if let Some((address, bytes)) = sent::piece() {
            self.transfers.send(address, bytes);
            self.sending = bytes;
        }
    }
}

/// What a loader uses, which has the port for itself.
impl Serial {
    /// No tick looks for stops any more.
    pub(crate) fn next(&mut self) -> Option<Request> {
        let (ring, looked) = ring();
        looked.is_at(writer(), ring.len());
        self.is_loading = true;
        // No time passes that would end a frame.
        self.receive(self.last_byte);
        Some(self.waiting.pop_front()?.what)
    }

    pub(crate) fn reply(&mut self, answer: &Answer) {
        sent::answer(&wire::frame_of(&Packet::Answer(*answer).bytes()));
    }

    pub(crate) fn has_sent(&mut self) -> bool {
        self.send();
        !self.transfers.is_sending() && sent::piece().is_none()
    }
}

fn refuse(what: &[u8], why: &str) {
    let mut said = Line::new();
    said.text("refused");
    if !what.is_empty() {
        said.word("").shown(what);
    }
    sent::line(said.text(": ").text(why).ended());
}

/// Answers what a line has asked for, or a frame; whether there was room.
fn reply(line: Option<Command>, answer: &Answer, about: &About) -> bool {
    let Some(command) = line else {
        return sent::answer(&wire::frame_of(&Packet::Answer(*answer).bytes()));
    };
    let mut said = Line::new();
    if answer.status == CommandStatus::Done {
        said.text("ok").word(command.name());
        let [first, second] = answer.values.map(i32::cast_unsigned);
        match command {
            Command::Zero(_) => answer
                .values
                .into_iter()
                .for_each(|code| _ = said.signed(code)),
            Command::Frame(_) => {
                let fields = [Field::from(first), Field::from(second)];
                said.form(" {=u32:08x}{=u32:08x}", &fields);
            }
            Command::Hello => {
                said.word(about.name()).field(first).field(second);
                said.word(VERSION);
            }
            Command::Status => _ = said.field(first).field(second).field(lost()),
            _ => {}
        }
    } else {
        said.text("refused").word(command.name());
        said.text(": ").text(answer.status.text());
    }
    sent::answer(said.ended())
}
