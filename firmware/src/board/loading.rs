//! The loader: takes a model by the serial port or from a probe's memory, word by word, and
//! writes it into its flash.
//!
//! It has the chip for itself, from [`Command::Load`] to the reset: motors off, interrupts
//! masked, the old model read no more. When no request comes any more it starts the board anew,
//! without a model, as the first words are written last; the watchdog is slow then, and fed by
//! each request.

use cortex_m::peripheral::{NVIC, SCB};
use wire::{Answer, Command, CommandStatus, TaggedCommand, load_order};

use super::scene::{HAS_SERIAL, TICK_HZ};
use super::serial::Serial;
use super::telemetry::ProbeLine;
use super::watchdog::Watchdog;
use super::{CLOCKS, model_place, outputs, tick_timer};
use crate::here::TICK_INTERRUPT;
use crate::here::flash::Writer;

/// Ticks without a request after which nobody asks any more: 2 s, in which no watchdog bites
/// that is slowed down.
const SILENCE: u32 = 2 * TICK_HZ;

/// Ticks in which the last answer may be fetched: 0.1 s.
const LAST_TICKS: u32 = TICK_HZ / 10;

/// What a serial port still sends when its DMA is done: 4 ms, two bytes at 5,000 baud.
const LAST_BYTES_CYCLES: u32 = CLOCKS.core_hz / 250;

/// By which requests come, and answers go.
pub(crate) struct Line<'s> {
    serial: &'s mut Serial,
    probe: ProbeLine,
    is_by_serial: bool,
}

impl<'s> Line<'s> {
    /// By the serial port, or by what a probe reads and writes.
    pub(crate) fn new(serial: &'s mut Serial, is_by_serial: bool) -> Self {
        Self {
            serial,
            probe: ProbeLine::new(),
            is_by_serial: HAS_SERIAL && is_by_serial,
        }
    }

    /// The next request.
    // Apart, as are words: together they are a function whose jumps the stack's check cannot
    // follow.
    #[inline(never)]
    fn next(&mut self) -> Option<TaggedCommand> {
        if self.is_by_serial {
            self.serial.next()
        } else {
            self.probe.next()
        }
    }

    /// Sends an answer. Whoever asks waits for it before they ask again: there is room.
    fn reply(&mut self, answer: &Answer) {
        if self.is_by_serial {
            self.serial.reply(answer);
        } else {
            self.probe.reply(answer);
        }
    }

    /// Goes on sending; whether nothing is left.
    fn has_sent(&mut self) -> bool {
        if self.is_by_serial {
            self.serial.has_sent()
        } else {
            self.probe.has_sent()
        }
    }
}

/// A model of so many words, and how many of them are written.
struct Loading {
    writer: Writer,
    words: u32,
    written: u32,
    last: u32,
}

/// Erases, writes what comes, and starts the chip anew. `answer` is that to the request for it,
/// which says how many words there are.
pub(crate) fn run(mut line: Line<'_>, mut answer: Answer) -> ! {
    cortex_m::interrupt::disable();
    outputs::off();
    leave_the_tick();
    let mut watchdog = Watchdog::slow();
    let mut loading = Loading {
        writer: Writer::new(),
        words: answer.values[0].cast_unsigned(),
        written: 0,
        last: 0,
    };
    answer.status = written(loading.writer.erase_model());
    watchdog.feed();
    line.reply(&answer);
    let mut silent = 0;
    while silent < SILENCE {
        line.has_sent();
        sleep();
        silent += 1;
        let Some(request) = line.next() else {
            continue;
        };
        watchdog.feed();
        silent = 0;
        let status = match request.command {
            Command::Word(number, word) => loading.word(number, word),
            Command::Restart => CommandStatus::Done,
            _ => CommandStatus::NotHere,
        };
        line.reply(&Answer {
            sequence: answer.sequence,
            tag: request.tag,
            command: request.command.number(),
            status,
            values: [loading.written.cast_signed(), loading.words.cast_signed()],
        });
        if request.command == Command::Restart {
            break;
        }
    }
    // Lets the last answer be fetched.
    for _ in 0..LAST_TICKS {
        if line.has_sent() {
            break;
        }
        sleep();
    }
    cortex_m::asm::delay(LAST_BYTES_CYCLES);
    SCB::sys_reset();
}

const fn written(well: bool) -> CommandStatus {
    if well {
        CommandStatus::Done
    } else {
        CommandStatus::NotWritten
    }
}

/// Has no interrupt wake the core but that of the tick: those of frames that were under way stay
/// pending.
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

/// Sleeps until the next tick would be. A masked interrupt wakes the core all the same, and is
/// forgotten.
fn sleep() {
    cortex_m::asm::wfi();
    tick_timer::acknowledge();
    NVIC::unpend(TICK_INTERRUPT);
}

impl Loading {
    /// Writes the next word. The last one may be asked for again, by whoever missed the answer.
    #[inline(never)]
    fn word(&mut self, number: u8, word: u32) -> CommandStatus {
        if number == self.written as u8 && self.written < self.words {
            if !self.write(load_order(self.written, self.words), word) {
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

    /// Writes the `at`-th word of the model's place, which nothing else reads any more; whether
    /// it stands there.
    fn write(&mut self, at: u32, word: u32) -> bool {
        let place = model_place::model_place().as_ptr().addr();
        let address = place + size_of::<u32>() * at as usize;
        at < model_place::words() && self.writer.write(address, word)
    }
}
