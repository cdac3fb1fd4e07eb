//! The serial port of a program that has one: lines of what happens, records, and what somebody
//! asks for as a line or in a frame. docs/serial.md says what they look like.
//!
//! Idle serves it after every tick; DMA moves the bytes. What finds no room is dropped whole.

#[path = "received.rs"]
mod received;
#[path = "sent.rs"]
mod sent;

use firmware::boards::RECEIVED_BYTES;
use firmware::{Event, NotArmed, StartCause, Startup, faults, lines};
use heapless::Deque;
use wire::text::{self, Spoken};
use wire::{
    Answer, Command, CommandStatus, Framed, Line, PACKET_WORDS, Piece, Splitter, TaggedCommand,
};

use crate::board::about::About;
use crate::board::counters::TICKS;
use crate::board::log::Health;
use crate::board::pace;
use crate::board::perception::Names;
use crate::board::pin_config::{Mode, PinConfig};
use crate::board::telemetry::{self, Configs};
use crate::board::wiring::SERIAL;
use crate::here::serial_dma::SerialTransfers;
use crate::here::{self, SERIAL_FUNCTION, SERIAL_ROUTE, SERIAL_USART, usart};
use received::Received;

/// Of the firmware.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Most bytes of a line that is understood.
const SAID_BYTES: usize = 80;

/// Requests that may wait for others.
const WAITING: usize = 4;

/// How something was asked for, and is answered.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    /// By a line, which says this.
    Line(Command),
    Frame,
}

/// What is asked for: the words of a request but for their sum.
#[derive(Clone, Copy)]
struct Asked {
    words: [u32; 2],
    form: Form,
}

/// A line that begins now.
fn line() -> Line {
    lines::at(TICKS.get(), pace::tick_hz())
}

/// The first lines after a reset.
#[inline(never)]
pub(crate) fn started(cause: StartCause, start: &Startup, about: &About) {
    if about.links.serial_baud.is_none() {
        return;
    }
    let mut said = line();
    let named = [VERSION, about.name()];
    lines::start(&mut said, named, pace::tick_hz(), cause, start);
    sent::line(said.ended());
    if start.fault != 0 {
        let mut said = line();
        lines::board_fault(&mut said, start.fault);
        sent::line(said.ended());
    }
}

/// The motors are off until they are armed.
#[inline(never)]
pub(crate) fn not_armed(reason: NotArmed, about: &About) {
    if about.links.serial_baud.is_none() {
        return;
    }
    let mut said = line();
    lines::not_armed(&mut said, reason);
    sent::line(said.ended());
}

/// The port.
pub(crate) struct Serial {
    transfers: SerialTransfers,
    received: Received,
    splitter: Splitter<SAID_BYTES>,
    /// The tick in which the last byte came.
    heard: u32,
    waiting: Deque<Asked, WAITING>,
    /// How that was asked for which the tick has in hand.
    pending: Option<Form>,
    /// Bytes of the piece under way.
    sending: u16,
    /// Bits a second.
    baud: u32,
    /// Bits a second that records of every tick take.
    records_baud: u32,
    /// Ticks without a byte after which a frame that was begun is none: 0.1 s.
    pause: u32,
}

impl Serial {
    /// Opens it; `None` where the scene has none.
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
        // A line rests high; pulled up, it does so too where nobody is at its other end.
        rx.configure(PinConfig::new(Mode::AlternateInput(SERIAL_FUNCTION)).pulled_up());
        Some(Self {
            transfers,
            received: Received::new(),
            splitter: Splitter::new(),
            heard: 0,
            waiting: Deque::new(),
            pending: None,
            sending: 0,
            baud,
            records_baud: about.records_baud(),
            pause: pace::tick_hz() / 10,
        })
    }

    /// The line of an event. What the scene cannot do has none.
    pub(crate) fn tell(&mut self, event: &Event, names: &Names) {
        let mut said = line();
        lines::event(&mut said, event, |class| names.class(class));
        sent::line(said.ended());
    }

    /// The user button was pressed.
    pub(crate) fn armed(&mut self) {
        sent::line(line().word("armed").ended());
    }

    /// Once a second: how ticks and lines have fared, and the limits passed since `before`.
    pub(crate) fn health(&mut self, now: &Health, before: &Health) {
        let mut said = line();
        let fared = lines::Fared {
            worst_tenths: now.worst_tenths(),
            period_us: 1_000_000 / pace::tick_hz(),
            missed: now.missed,
            dropped: now.dropped,
            lost: sent::LOST.get(),
        };
        lines::health(&mut said, &fared);
        sent::line(said.ended());
        for (number, passed) in [
            (faults::number::MISSED, now.missed != before.missed),
            (faults::number::DROPPED, now.dropped != before.dropped),
        ] {
            if passed {
                let mut said = line();
                lines::limit(&mut said, number);
                sent::line(said.ended());
            }
        }
    }

    /// What is to be done after the tick that is the `now`-th.
    pub(crate) fn serve(&mut self, now: u32, about: &About, configs: &mut Configs) {
        self.hear(now);
        self.answer(about);
        if self.pending.is_none()
            && let Some(asked) = self.waiting.front()
            && telemetry::ask_by_serial(asked.words, configs)
        {
            self.pending = Some(asked.form);
            self.waiting.pop_front();
        }
        // Records stay where they are while there is no room, and are lost and counted there.
        while let Some(words) = telemetry::packet_for_serial() {
            if !sent::record(Framed::packet(words).bytes()) {
                break;
            }
            telemetry::has_taken_packet();
        }
        self.send();
    }

    /// Takes what has come.
    #[inline(never)]
    fn hear(&mut self, now: u32) {
        let left = self.transfers.left();
        while let Some(byte) = self.received.next(left) {
            self.heard = now;
            match self.splitter.push(byte) {
                None => {}
                Some(Piece::Line(said)) => match text::parse(said) {
                    Ok(Spoken::Nothing) => {}
                    Ok(Spoken::Help) => {
                        sent::line(Line::new().text("ok help: ").text(text::ALLOWED).ended());
                    }
                    Ok(Spoken::Command(command)) => {
                        let words = TaggedCommand { tag: 0, command }.plain_words();
                        let form = Form::Line(command);
                        self.take(Asked { words, form });
                    }
                    Err((first, fault)) => refuse(first, fault.text()),
                },
                Some(Piece::Frame(bytes)) => {
                    let words = bytes.as_array().and_then(wire::summed);
                    match words {
                        Some(words) => {
                            let form = Form::Frame;
                            self.take(Asked { words, form });
                        }
                        None => refuse(b"", "a frame that is no request"),
                    }
                }
                Some(Piece::Garbled(_)) => refuse(b"", "too long, or cut short"),
            }
        }
        if now.wrapping_sub(self.heard) > self.pause {
            self.splitter.pause();
        }
    }

    /// Has a request wait for its turn, unless it cannot be carried out here.
    fn take(&mut self, asked: Asked) {
        if let Ok(request) = TaggedCommand::from_words(asked.words)
            && request.command == Command::Stream(true)
            && !self.carries_records()
        {
            self.is_too_slow(asked.form, request);
        } else if self.waiting.push_back(asked).is_err() {
            refuse(b"", "too much at once, wait for answers");
        }
    }

    /// Whether the line carries records of every tick, with a twentieth left for lines and
    /// answers.
    const fn carries_records(&self) -> bool {
        self.records_baud / 20 * 21 <= self.baud
    }

    /// Refuses records.
    fn is_too_slow(&self, form: Form, request: TaggedCommand) {
        if form == Form::Frame {
            let answer = Answer {
                sequence: TICKS.get(),
                tag: request.tag,
                command: request.command.number(),
                status: CommandStatus::TooSlow,
                values: [0; 2],
            };
            sent::line(Framed::packet(answer.words()).bytes());
        } else {
            let mut said = Line::new();
            said.text("refused stream: records of every tick take")
                .field(self.records_baud);
            said.text(" baud and a twentieth, found").field(self.baud);
            sent::line(said.ended());
        }
    }

    /// Passes the tick's answer on.
    fn answer(&mut self, about: &About) {
        let Some(form) = self.pending else {
            return;
        };
        if let Some(words) = telemetry::answer_for_serial()
            && reply(form, words, about)
        {
            telemetry::has_taken_answer();
            self.pending = None;
        }
    }

    /// Sends the next piece once the last is sent.
    fn send(&mut self) {
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
    /// The next request.
    pub(crate) fn next(&mut self) -> Option<TaggedCommand> {
        // No time passes that would end a frame.
        self.hear(self.heard);
        let asked = self.waiting.pop_front()?;
        TaggedCommand::from_words(asked.words).ok()
    }

    /// Sends an answer.
    pub(crate) fn reply(&mut self, answer: &Answer) {
        sent::answer(Framed::packet(answer.words()).bytes());
    }

    /// Goes on sending; whether nothing is left.
    pub(crate) fn has_sent(&mut self) -> bool {
        self.send();
        !self.transfers.is_sending() && sent::piece().is_none()
    }
}

/// The line of what is refused.
fn refuse(what: &[u8], why: &str) {
    let mut said = Line::new();
    said.text("refused");
    if !what.is_empty() {
        said.word("").shown(what);
    }
    sent::line(said.text(": ").text(why).ended());
}

/// Passes an answer on; whether there was room.
fn reply(form: Form, words: [u32; PACKET_WORDS], about: &About) -> bool {
    let Form::Line(command) = form else {
        return sent::answer(Framed::packet(words).bytes());
    };
    let answer = Answer::from_words(words);
    let mut said = Line::new();
    if answer.status == CommandStatus::Done {
        said.text("ok").word(command.name());
        let [first, second] = answer.values.map(i32::cast_unsigned);
        match command {
            Command::Zero(_) => answer
                .values
                .into_iter()
                .for_each(|code| _ = said.signed(code)),
            Command::Hello => {
                said.word(about.name()).field(first).field(second);
                said.word(VERSION);
            }
            Command::Status => _ = said.field(first).field(second).field(sent::LOST.get()),
            _ => {}
        }
    } else {
        said.text("refused").word(command.name());
        said.text(": ").text(answer.status.text());
    }
    sent::answer(said.ended())
}
