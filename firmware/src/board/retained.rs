//! The record of resets, in RAM that no start clears.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicU32, Ordering};

use firmware::{RECORD_WORDS, Record, StartCause, Started, Startup};

use super::counters::Request;
use super::pace;
use crate::here::power;

/// Words that a reset leaves as they are.
struct Retained(UnsafeCell<MaybeUninit<[u32; RECORD_WORDS]>>);

#[allow(unsafe_code, reason = "start, tick and fault handlers share it")]
// SAFETY: one core. The start is over before the tick begins, and a fault handler does not
// return to a tick that it has interrupted. What that had half written has a wrong sum.
unsafe impl Sync for Retained {}

#[allow(unsafe_code, reason = "the section has a meaning")]
// SAFETY: cortex-m-rt neither clears nor fills this section, of which nothing else has need.
#[unsafe(link_section = ".uninit.RECORD")]
static RETAINED: Retained = Retained(UnsafeCell::new(MaybeUninit::uninit()));

impl Retained {
    fn load(&self) -> Option<Record> {
        #[allow(unsafe_code, reason = "RAM as the last run has left it")]
        // SAFETY: the words are in RAM, and any bits are words. Volatile, because the compiler
        // does not see who wrote them; the record's sum tells whether it was the last run.
        let words = unsafe { self.0.get().cast::<[u32; RECORD_WORDS]>().read_volatile() };
        Record::load(words)
    }

    fn store(&self, record: &Record) {
        #[allow(unsafe_code, reason = "RAM for the next run")]
        // SAFETY: see `load`; there is no reference to the words.
        unsafe {
            let words = self.0.get().cast::<[u32; RECORD_WORDS]>();
            words.write_volatile(record.words());
        }
    }
}

/// The two values of [`Started`], but for its flags.
static STARTED: [AtomicU32; 2] = [const { AtomicU32::new(0) }; 2];

pub(crate) fn started() -> Started {
    let found = Started::of(
        STARTED
            .each_ref()
            .map(|of| of.load(Ordering::Relaxed).cast_signed()),
    );
    Started {
        is_internal: pace::is_internal(),
        browns_out_late: power::brown_out_is_low(),
        ..found
    }
}

pub(crate) fn start(cause: StartCause) -> Startup {
    let (record, start) = Record::start(RETAINED.load(), cause);
    RETAINED.store(&record);
    let started = Started {
        number: start.number,
        cause,
        fault: start.fault,
        is_internal: false,
        browns_out_late: false,
    };
    for (of, value) in STARTED.iter().zip(started.values()) {
        of.store(value.cast_unsigned(), Ordering::Relaxed);
    }
    start
}

pub(crate) fn note(fault: u8) {
    let mut record = RETAINED.load().unwrap_or_default();
    record.note(fault);
    RETAINED.store(&record);
}

/// From whoever stops motors to idle, which notes it in flash: RAM forgets it where power is lost.
pub(crate) static STOPPED: Request = Request::none();

/// For the tick, and a loader in its place.
#[cold]
#[inline(never)]
pub(crate) fn set_stopped(is_stopped: bool) {
    if is_stopped {
        STOPPED.make();
    }
    let mut record = RETAINED.load().unwrap_or_default();
    record.set_stopped(is_stopped);
    RETAINED.store(&record);
}

/// For the tick.
pub(crate) fn second() {
    let mut record = RETAINED.load().unwrap_or_default();
    record.second();
    RETAINED.store(&record);
}
