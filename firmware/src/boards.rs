//! The boards that a module runs on, as plain facts: for their own programs, and for a PC that
//! makes configurations for them and deploys these.
//!
//! # Glossary
//!
//! - *slot*: flash for a configuration with a [header](SlotHeader) before it. There are two, of
//!   which the newest valid one counts: while one is written, the other is whole.
//! - *slow*: of sensors that are read at half the clock.

mod facts;
mod fits;
mod flash;
mod slot;
mod timing;

pub use facts::{ALL, BoardFacts, InHead, NUCLEO_F103RB, NUCLEO_F446RE, NUCLEO_G071RB};
pub use fits::{Misfit, Needs};
pub use flash::{FlashMap, Region, Slot};
pub use slot::{
    MARK_WORDS, SLOT_HEADER_BYTES, SLOT_HEADER_WORDS, SlotHeader, has_armed, newest_first, next,
};
pub use timing::{
    CLOCK_WAIT_LOOPS, CanTiming, Clocks, PWM_HZ, Pacing, RECEIVED_BYTES, REST_US, SLOT_FAST_NS,
    TICK_MIN_HZ, TickPeriod,
};
