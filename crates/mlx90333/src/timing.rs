//! Every rate and duration of the MLX90333's serial protocol, with where it
//! comes from and how sure it is.
//!
//! The serial-protocol section of the part's own datasheet is not the source:
//! values are measured on real parts, read from open drivers, or taken from the
//! MLX90316, a sister part with the same core and another frame.

use embedded_hal::spi::{MODE_1, Mode};

/// Clock idle low, data taken on the falling edge, most significant bit first,
/// /SS active low. Three drivers agree.
pub const SPI_MODE: Mode = MODE_1;

/// Highest clock to use, in hertz. Parts were measured to fail above a limit that lay between
/// 320 kHz and 430 kHz in three set-ups; this is the lowest of them. The pull-up and the line's
/// capacitance set the limit as much as the part does.
pub const CLOCK_MAX_HZ: u32 = 320_000;

/// A comfortable clock, in hertz: the upper end of 100–160 kHz, where all three set-ups worked.
pub const CLOCK_COMFORTABLE_HZ: u32 = 160_000;

/// Highest clock in the slow mode, in hertz: that of the MLX90316, whose clock has periods of 7 µs
/// or more there. (A published driver runs a part in the field at up to 240 kHz.)
pub const CLOCK_SLOW_MAX_HZ: u32 = 143_000;

/// How long /SS must be low before the first byte in the slow mode, in nanoseconds. What is safe
/// between bytes is taken for it: one driver waits 3 ms, the others do not wait; not confirmed.
pub const SS_LEAD_SLOW_NS: u32 = BYTE_GAP_SAFE_NS;

/// How long /SS must stay low after the last edge of the clock in the slow mode, in nanoseconds:
/// 6.9 µs in the MLX90316. (A published driver waits 3 µs.)
pub const SS_LAG_SLOW_NS: u32 = 7_000;

/// The same in the fast mode. Drivers wait 1 to 3 µs.
pub const SS_LAG_FAST_NS: u32 = 3_000;

/// Gap between bytes that is safe in either of the part's speeds, in
/// nanoseconds: at least 50 µs. From drivers and the MLX90316.
pub const BYTE_GAP_SAFE_NS: u32 = 50_000;

/// Gap between bytes that the MLX90316 asks for in its fast mode, in
/// nanoseconds: 12.5 µs. Not confirmed on the MLX90333: try it, and watch for
/// [`BadSum`](crate::FrameError::BadSum).
pub const BYTE_GAP_FAST_NS: u32 = 12_500;

/// Time from supply to a first valid value, in microseconds: 16 ms. From the MLX90316 in part.
pub const START_UP_US: u32 = 16_000;

/// Time to wait after supply before the first frame, in microseconds: 20 ms,
/// the start-up with a quarter to spare.
pub const START_UP_WAIT_US: u32 = 20_000;

/// How long /SS must have been high before the first frame, in microseconds: at least 1.5 ms. From
/// the MLX90316 in part. [`START_UP_WAIT_US`] covers it if /SS is high from power-up.
pub const SS_HIGH_US: u32 = 1_500;

/// How often the part computes a new value in its fast mode, in microseconds.
/// From the MLX90316. Between two computations the last value is held: frames
/// read faster than this carry the same value more than once.
pub const UPDATE_FAST_US: u32 = 350;

/// As [`UPDATE_FAST_US`], in the slow mode.
pub const UPDATE_SLOW_US: u32 = 1_500;

/// Time that one frame holds the bus, in nanoseconds, rounded up: 64 bits at
/// `clock_hz` and seven gaps between eight bytes.
///
/// 320 kHz with gaps of 12.5 µs takes 287.5 µs, with gaps of 50 µs 550 µs: more than a 2 kHz tick,
/// so such a read belongs in interrupts or DMA and not in the tick. Add what the master's own
/// handling costs. A clock of 0 Hz never ends: `u64::MAX`.
pub const fn frame_time_ns(clock_hz: u32, gap_ns: u32) -> u64 {
    const BITS_NS: u64 = 64 * 1_000_000_000;
    if clock_hz == 0 {
        return u64::MAX;
    }
    BITS_NS.div_ceil(clock_hz as u64) + 7 * gap_ns as u64
}
