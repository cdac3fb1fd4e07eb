//! Every rate and duration of the sensor, with where it comes from.
//!
//! SBAS934A and SBASAF4 are TI's data sheets of the TMAG5170-Q1 and the TMAG5170, SLYS052A
//! that of the two-die TMAG5170D-Q1; their tables were read as published on the web, without
//! the columns' alignment. TI's example code names maxima of its own.

use embedded_hal::spi::{MODE_0, Mode};

use crate::config::{Average, Channels};

/// Clock idle low, data taken on the rising edge, most significant bit first, /CS active low.
/// SBASAF4 7.5.2.1, as quoted by a driver that names the section; the Arduino libraries use it.
pub const SPI_MODE: Mode = MODE_0;

/// Highest clock, in hertz, with 25 pF on SDO. SBAS934A 6.8; the title page of SBASAF4.
pub const CLOCK_MAX_HZ: u32 = 10_000_000;

/// How long /CS must be low before the first clock, and after the last, in nanoseconds.
/// SBAS934A 6.8.
pub const CS_SETUP_NS: u32 = 45;

/// How long /CS must be high between two frames, in nanoseconds. SBAS934A 6.8.
pub const CS_HIGH_NS: u32 = 100;

/// Time from supply to the first command, in microseconds, at 2.3 V, where it is longest:
/// 260 µs. SLYS052A 5.7, typical; TI's example code has the same figure.
pub const START_UP_US: u32 = 260;

/// Time to wait after supply before the first command, in microseconds: 500 µs, which TI's
/// example code names as the most that a start out of deep sleep takes.
pub const START_UP_WAIT_US: u32 = 500;

/// Time from configuration mode to one that measures, in microseconds, before a conversion
/// starts: 150 µs to stand by (SLYS052A 5.7) and 35 µs to begin (SBAS934A table 7-3).
pub const START_MEASURING_US: u32 = 185;

/// How often a set of the channels is new, in microseconds, while the sensor measures one set
/// after the other: `25 · (channels · average + 1)`; 0 without channels.
///
/// The temperature counts as a channel. The rule gives each of the 18 rates in the data
/// sheet's table (SBASAF4, 7.3.4) as rounded there, and is not in it; an application note
/// (SBAA463A) has the highest rates up to 11 % higher.
pub const fn conversion_time_us(channels: Channels, temperature: bool, average: Average) -> u32 {
    match channels.count() + temperature as u32 {
        0 => 0,
        count => 25 * (count * average.count() + 1),
    }
}

/// Time that one frame holds the bus, in nanoseconds, rounded up: 32 bits at `clock_hz`, and
/// /CS about them. 10 MHz takes 3.39 µs. A clock of 0 Hz never ends: `u64::MAX`.
pub const fn frame_time_ns(clock_hz: u32) -> u64 {
    const BITS_NS: u64 = 32 * 1_000_000_000;
    if clock_hz == 0 {
        return u64::MAX;
    }
    BITS_NS.div_ceil(clock_hz as u64) + 2 * CS_SETUP_NS as u64 + CS_HIGH_NS as u64
}
