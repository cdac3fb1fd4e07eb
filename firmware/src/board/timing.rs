//! Every clock, rate and duration of this board, each with its derivation.
//!
//! The build script reads this file too, to refuse scenes that the board
//! cannot keep up with; so it holds constants and functions of constants only.

use mlx90333::timing::{BYTE_GAP_FAST_NS, BYTE_GAP_SAFE_NS, CLOCK_MAX_HZ, START_UP_WAIT_US};

/// The clock that the ST-LINK puts on the HSE input, Hz.
pub(crate) const HSE_HZ: u32 = 8_000_000;
/// PLL input divider: 2 MHz, the upper end of what the PLL takes, for least jitter.
pub(crate) const PLL_M: u8 = 4;
/// PLL multiplier: 320 MHz, inside the oscillator's 100 to 432 MHz.
pub(crate) const PLL_N: u16 = 160;
/// PLL output divider, towards the core.
pub(crate) const PLL_P: u32 = 2;
/// Core clock, Hz. Not the chip's 180 MHz: with 160 MHz the SPI clock below is
/// just under the sensor's limit, and the supply needs no over-drive.
pub(crate) const CORE_HZ: u32 = HSE_HZ / PLL_M as u32 * PLL_N as u32 / PLL_P;
/// Clock of the slow peripheral bus APB1, Hz: a quarter of the core's.
pub(crate) const APB1_HZ: u32 = CORE_HZ / 4;
/// Clock of the fast peripheral bus APB2, Hz: half the core's.
pub(crate) const APB2_HZ: u32 = CORE_HZ / 2;
/// Clock of the timers on APB1 (TIM2, TIM3, TIM5), Hz: twice the bus clock.
pub(crate) const APB1_TIMER_HZ: u32 = 2 * APB1_HZ;
/// Clock of the timers on APB2 (TIM1, TIM8), Hz: twice the bus clock.
pub(crate) const APB2_TIMER_HZ: u32 = 2 * APB2_HZ;
/// Wait states of the flash: one for each 30 MHz begun after the first, at 2.7
/// to 3.6 V.
pub(crate) const FLASH_WAIT_STATES: u8 = ((CORE_HZ - 1) / 30_000_000) as u8;

const _: () = assert!(CORE_HZ == 160_000_000 && CORE_HZ <= 168_000_000);
const _: () = assert!(APB1_HZ <= 45_000_000 && APB2_HZ <= 90_000_000);

/// Loops to wait for a clock before giving up: over a second at the 16 MHz the
/// chip starts with, because the ST-LINK gives its clock only once it is awake.
pub(crate) const CLOCK_PATIENCE: u32 = 4_000_000;

/// Divider of the SPI clock, the largest there is.
const SPI_DIVIDER: u32 = 256;
/// SPI clock, Hz: 312.5 kHz.
pub(crate) const SPI_HZ: u32 = APB2_HZ / SPI_DIVIDER;
/// One byte on the wire, ns: 25.6 µs.
pub(crate) const BYTE_NS: u32 = (8_000_000_000_u64 / SPI_HZ as u64) as u32;

const _: () = assert!(SPI_HZ <= CLOCK_MAX_HZ);

/// From the start of a byte to that of the next where the tick leaves no more
/// room, ns: a gap of 24.4 µs, twice what the sensor asks for in its fast mode.
pub(crate) const SLOT_FAST_NS: u32 = 50_000;
/// The same with the gap that is safe in either of the sensor's modes, ns.
pub(crate) const SLOT_SAFE_NS: u32 = BYTE_NS + BYTE_GAP_SAFE_NS;
/// Least time for which /SS is high between frames, ns. The sensor's own need
/// is not known; this is what it needs between bytes.
pub(crate) const REST_NS: u32 = BYTE_GAP_SAFE_NS;

const _: () = assert!(SLOT_FAST_NS - BYTE_NS >= BYTE_GAP_FAST_NS);

/// A frame from /SS low to /SS high, ns: one slot before the first byte, eight
/// bytes in their slots, of which the last needs no gap.
pub(crate) const fn frame_ns(slot_ns: u32) -> u32 {
    8 * slot_ns + BYTE_NS
}

/// The slot for a tick rate, ns: the safe one if its frame fits into a tick,
/// the fast one otherwise; `None` above the rate at which that fits.
pub(crate) const fn slot_ns(tick_hz: u32) -> Option<u32> {
    let tick_ns = 1_000_000_000 / tick_hz;
    if frame_ns(SLOT_SAFE_NS) + REST_NS <= tick_ns {
        Some(SLOT_SAFE_NS)
    } else if frame_ns(SLOT_FAST_NS) + REST_NS <= tick_ns {
        Some(SLOT_FAST_NS)
    } else {
        None
    }
}

/// The highest tick rate that a frame fits into, Hz.
pub(crate) const TICK_MAX_HZ: u32 = 1_000_000_000 / (frame_ns(SLOT_FAST_NS) + REST_NS);
/// The lowest tick rate of a scene, Hz.
pub(crate) const TICK_MIN_HZ: u32 = 200;

const _: () = assert!(TICK_MAX_HZ >= 2_000);

/// Counts of TIM8 in the slot for a tick rate. For constants: does not compile
/// for a rate that the build script refuses.
pub(crate) const fn slot_counts(tick_hz: u32) -> u16 {
    let Some(slot_ns) = slot_ns(tick_hz) else {
        panic!("the tick is shorter than a sensor frame");
    };
    let counts = slot_ns as u64 * (APB2_TIMER_HZ / 1_000_000) as u64 / 1_000;
    assert!(counts <= u16::MAX as u64);
    counts as u16
}

const _: () = assert!(slot_counts(2_000) == 8_000 && slot_counts(1_000) == 12_096);

/// Prescaler and period of TIM3, whose product is the tick in counts of
/// [`APB1_TIMER_HZ`].
#[derive(Clone, Copy)]
pub(crate) struct TickPeriod {
    /// Counts of the timer's clock a count of the timer.
    pub(crate) prescaler: u16,
    /// Counts of the timer a tick.
    pub(crate) period: u16,
}

impl TickPeriod {
    /// For a tick rate of [`TICK_MIN_HZ`] and more: exact where one of the
    /// prescalers divides the tick, else within 2e-5.
    pub(crate) const fn new(tick_hz: u32) -> Self {
        let counts = (APB1_TIMER_HZ + tick_hz / 2) / tick_hz;
        let least = counts.div_ceil(u16::MAX as u32);
        let mut prescaler = least;
        while prescaler < least + 32 && !counts.is_multiple_of(prescaler) {
            prescaler += 1;
        }
        if !counts.is_multiple_of(prescaler) {
            prescaler = least;
        }
        Self {
            prescaler: prescaler as u16,
            period: (counts / prescaler) as u16,
        }
    }

    /// The tick in counts of [`APB1_TIMER_HZ`].
    pub(crate) const fn counts(self) -> u32 {
        self.prescaler as u32 * self.period as u32
    }
}

const _: () = {
    let two_kilohertz = TickPeriod::new(2_000);
    assert!(two_kilohertz.prescaler == 1 && two_kilohertz.period == 40_000);
    assert!(TickPeriod::new(TICK_MIN_HZ).counts() == 400_000);
};

/// Motor PWM, Hz: above hearing, and a bridge still switches it with ease.
pub(crate) const PWM_HZ: u32 = 20_000;
/// Counts of TIM1 in a PWM period; the duty has this many steps.
pub(crate) const PWM_COUNTS: u16 = (APB2_TIMER_HZ / PWM_HZ) as u16;

const _: () = assert!(APB2_TIMER_HZ / PWM_HZ < u16::MAX as u32);
// The motor drivers rest one tick at a reversal, which must cover a PWM period.
const _: () = assert!(PWM_HZ >= TICK_MAX_HZ);

/// The watchdog's oscillator, Hz: least, nominal, most (STM32F446 data sheet).
const LSI_HZ: [u32; 3] = [17_000, 32_000, 47_000];
/// Its divider.
const WATCHDOG_DIVIDER: u32 = 4;
/// Counts of the watchdog until it bites: 20 ms nominally, 13.6 to 37.6 ms over
/// the spread of its oscillator. A motor that is left on for as long does no
/// harm: a stalled one is borne for 200 ms.
pub(crate) const WATCHDOG_COUNTS: u16 = (LSI_HZ[1] / WATCHDOG_DIVIDER / 50) as u16;

// Idle feeds after every tick. Even at the slowest tick and the fastest
// watchdog one tick may be missing, and idle has time left for its logging.
const _: () = assert!(
    WATCHDOG_COUNTS as u32 * WATCHDOG_DIVIDER * 1_000 / LSI_HZ[2] >= 2 * 1_000 / TICK_MIN_HZ + 2
);

/// Cycles of the core to wait for the sensor after power-up, with /SS high.
pub(crate) const START_UP_CYCLES: u32 = CORE_HZ / 1_000_000 * START_UP_WAIT_US;
