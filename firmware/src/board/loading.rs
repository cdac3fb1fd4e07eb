//! The loader: takes a scene and its model by the serial port, from a probe's memory or from another
//! board of its head, word by word, and writes them into the flash of the slot that is not in use.
//!
//! It has the chip for itself, from [`Command::Load`] to the reset: motors off, interrupts
//! masked, flash read no more. When no request comes any more it resets the board, which starts by
//! the scene before, as the first words of the new one are written last; the watchdog is slow then,
//! and fed by each request. Where both slots have one model, the scene before may have lost it.

use cortex_m::peripheral::{NVIC, SCB};
use firmware::Part;
use firmware::boards::{self, Slot, SlotHeader};
use tactile::Model;
use wire::{Answer, Command, CommandStatus, Load, LoadedWord, Request, TaggedCommand};

use super::bus::{self, Post};
use super::serial::Serial;
use super::slots::{self, SLOTS};
use super::telemetry::ProbeLine;
use super::watchdog::Watchdog;
use super::{outputs, pace, retained, sleep, tick_timer};
use crate::here::TICK_INTERRUPT;
use crate::here::flash::Writer;

/// A part of a second: two bytes at 5,000 baud, which go when the DMA is done.
const LAST_BYTES_PART: u32 = 250;

pub(crate) enum Line<'s> {
    Serial(&'s mut Serial),
    Probe(&'s mut ProbeLine),
    Head(&'s mut Post),
}

impl Line<'_> {
    // Apart, as are words: the stack's check cannot follow the jumps of both together.
    #[inline(never)]
    fn next(&mut self) -> Option<TaggedCommand> {
        let asked = match self {
            Self::Serial(serial) => serial.next(),
            Self::Probe(probe) => probe.next(),
            Self::Head(post) => return post.next_alone(),
        };
        match asked? {
            Request::Here(request) => request.ok(),
            // It asks no other board any more.
            Request::For(_) => None,
        }
    }

    /// Whoever asks waits for it before they ask again: there is room.
    fn reply(&mut self, answer: &Answer) {
        match self {
            Self::Serial(serial) => serial.reply(answer),
            Self::Probe(_) => ProbeLine::reply(answer),
            Self::Head(post) => post.reply_alone(answer),
        }
    }

    fn has_sent(&mut self) -> bool {
        match self {
            Self::Serial(serial) => serial.has_sent(),
            Self::Probe(_) => ProbeLine::has_sent(),
            Self::Head(_) => Post::has_sent(),
        }
    }
}

struct Loading {
    writer: Writer,
    slot: Slot,
    sequence: u32,
    load: Load,
    written: u32,
    last: u32,
}

/// By a module that runs by the scene of the slot `in_use`, or by none.
#[derive(Clone, Copy)]
pub(crate) struct Order {
    pub(crate) load: Load,
    pub(crate) in_use: Option<usize>,
    pub(crate) answer: Answer,
    /// The number of this board in its head.
    pub(crate) node: Option<u8>,
}

pub(crate) fn run(mut line: Line<'_>, order: Order) -> ! {
    cortex_m::interrupt::disable();
    outputs::off();
    leave_the_tick();
    if let Line::Head(post) = &mut line {
        post.begin_loading();
    }
    let mut watchdog = Watchdog::slow();
    let Order {
        load,
        in_use,
        mut answer,
        node,
    } = order;
    let mut loading = Loading::new(load, in_use);
    answer.status = written(loading.erase(&mut watchdog));
    watchdog.feed();
    line.reply(&answer);
    // 2 s, in which no watchdog bites that is slowed down, after which no request is expected.
    let silence = pace::tick_hz().saturating_mul(2);
    let mut silent = 0;
    while silent < silence {
        line.has_sent();
        next_tick();
        silent += 1;
        let Some(request) = line.next() else {
            continue;
        };
        watchdog.feed();
        silent = 0;
        let status = match request.command {
            Command::Word(number, word) => loading.word(number, word),
            Command::Restart => CommandStatus::Done,
            // Its own are off, and stay so after the reset.
            Command::Stop => {
                retained::set_stopped(true);
                bus::say_stop(node);
                CommandStatus::Done
            }
            _ => CommandStatus::NotHere,
        };
        let values = [loading.written, load.words()].map(u32::cast_signed);
        line.reply(&firmware::answer(
            request,
            answer.sequence,
            (status, values),
        ));
        if matches!(request.command, Command::Restart) {
            break;
        }
    }
    // 0.1 s, in which the last answer may be fetched.
    for _ in 0..pace::tick_hz() / 10 {
        if line.has_sent() {
            break;
        }
        next_tick();
    }
    cortex_m::asm::delay(pace::clocks().core_hz / LAST_BYTES_PART);
    SCB::sys_reset();
}

const fn written(well: bool) -> CommandStatus {
    if well {
        CommandStatus::Done
    } else {
        CommandStatus::NotWritten
    }
}

/// No interrupt wakes the core but the tick's: those of frames under way stay pending.
fn leave_the_tick() {
    #[allow(unsafe_code, reason = "the NVIC has an owner in another type")]
    // SAFETY: this is the NVIC, whose registers are set with single stores; interrupts are
    // masked for good, and so no code relies on which of them are enabled.
    unsafe {
        let nvic = &*NVIC::PTR;
        for register in &nvic.icer {
            register.write(u32::MAX);
        }
        NVIC::unmask(TICK_INTERRUPT);
    }
}

/// A masked interrupt wakes the core all the same, and is forgotten.
fn next_tick() {
    sleep::until_interrupt();
    tick_timer::acknowledge();
    NVIC::unpend(TICK_INTERRUPT);
}

impl Loading {
    fn new(load: Load, in_use: Option<usize>) -> Self {
        let (slot, sequence) = boards::next(slots::headers(), in_use);
        Self {
            writer: Writer::new(),
            slot: SLOTS[slot % SLOTS.len()],
            sequence,
            load,
            written: 0,
            last: 0,
        }
    }

    /// Erases the model's place too, where one comes that lies apart; whether all went well.
    fn erase(&mut self, watchdog: &mut Watchdog) -> bool {
        let slot = self.slot;
        let is_well = self.writer.erase(slot.erased);
        watchdog.feed();
        let needs_no_more = slot.has_model() || self.load.model == 0;
        is_well && (needs_no_more || self.writer.erase(slot.model))
    }

    /// The last one may be asked for again, by whoever missed the answer.
    #[inline(never)]
    fn word(&mut self, number: u8, word: u32) -> CommandStatus {
        if number == self.written as u8
            && let Some(next) = self.load.word(self.written)
        {
            if !self.write(next, word) {
                return CommandStatus::NotWritten;
            }
            self.written += 1;
            self.last = word;
            return CommandStatus::Done;
        }
        let is_last = self.written > 0 && number == (self.written - 1) as u8 && word == self.last;
        if is_last {
            CommandStatus::Done
        } else {
            CommandStatus::OutOfRange
        }
    }

    /// Writes a word where it belongs, which nothing else reads any more; whether it stands
    /// there. The header comes between the model and the configuration.
    fn write(&mut self, at: LoadedWord, word: u32) -> bool {
        let (region, at, is_model) = match at {
            LoadedWord::Model(at) => (self.slot.model, at, true),
            LoadedWord::Config(at) => (self.slot.config(), at, false),
        };
        let is_first = !is_model && self.written == self.load.model.into();
        if is_first && !self.write_header() {
            return false;
        }
        let at = u32::from(at);
        at < region.words() && self.writer.write((region.start + 4 * at) as usize, word)
    }

    /// Writes the header, which names the model that was written; whether it stands there.
    fn write_header(&mut self) -> bool {
        let header = SlotHeader {
            sequence: self.sequence,
            model: self.model(),
        };
        let start = self.slot.head.start as usize;
        let words = header.words().into_iter().zip((start..).step_by(4));
        let writer = &mut self.writer;
        words.into_iter().all(|(word, at)| writer.write(at, word))
    }

    /// The CRC of the model that was written; 0: none, or nothing that is one.
    fn model(&self) -> u32 {
        if !Part::Classifier.is_built() || self.load.model == 0 {
            return 0;
        }
        let model = Model::at_start(slots::model(&self.slot));
        model.map_or(0, |model| model.crc())
    }
}
