//! What follows from a board's clocks: every rate and duration that its
//! drivers use, each with its derivation. The clocks themselves stand in the
//! board's own file.
//!
//! The build script reads this file too, to refuse scenes that a board cannot
//! keep up with; so it holds constants and functions of constants only.

use mlx90333::timing::{
    BYTE_GAP_FAST_NS, BYTE_GAP_SAFE_NS, CLOCK_MAX_HZ, CLOCK_SLOW_MAX_HZ, SS_LAG_SLOW_NS,
    SS_LEAD_SLOW_NS, START_UP_WAIT_US,
};

/// The clocks of a board, Hz.
#[allow(clippy::struct_field_names, reason = "a unit, not a common name")]
#[derive(Clone, Copy)]
pub(crate) struct Clocks {
    /// The core's.
    pub(crate) core_hz: u32,
    /// The clock of every sensor's SPI.
    pub(crate) spi_hz: u32,
    /// What every byte timer counts.
    pub(crate) byte_timer_hz: u32,
    /// What the tick timer counts.
    pub(crate) tick_timer_hz: u32,
    /// What the counter that measures the ticks counts.
    pub(crate) counter_hz: u32,
    /// What the timer of the motor's PWM counts.
    pub(crate) pwm_hz: u32,
    /// What the serial port divides.
    pub(crate) serial_hz: u32,
    /// The watchdog's oscillator: least, nominal, most (the chip's data sheet).
    pub(crate) watchdog_hz: [u32; 3],
}

/// From the start of a byte to that of the next where the tick leaves no more
/// room, ns: a gap of 18 µs or more, half as much again as the sensor asks for
/// in its fast mode.
pub(crate) const SLOT_FAST_NS: u32 = 50_000;
/// Least time for which /SS is high between frames, ns. The sensor's own need
/// is not known; this is what it needs between bytes.
pub(crate) const REST_NS: u32 = BYTE_GAP_SAFE_NS;

/// The lowest tick rate of a scene, Hz.
pub(crate) const TICK_MIN_HZ: u32 = 200;

/// Motor PWM, Hz: above hearing, and a bridge still switches it with ease.
pub(crate) const PWM_HZ: u32 = 20_000;

/// The watchdog's divider.
const WATCHDOG_DIVIDER: u32 = 4;

/// How far the serial port may be from its baud, thousandths: an asynchronous receiver bears
/// 4 % over both ends (RM0390, chapter 25.4.5), and the G071's oscillator takes 1 % of it.
const BAUD_ERROR_PERMILLE: u64 = 15;

/// Bytes that the serial port holds of what comes, until idle has read it.
pub(crate) const RECEIVED_BYTES: usize = 256;

/// Whether what comes in two ticks finds room: idle reads after each, and may miss one.
pub(crate) const fn serial_keeps_up(baud: u32, tick_hz: u32) -> bool {
    let bytes = (2 * baud).div_ceil(10 * tick_hz);
    bytes < RECEIVED_BYTES as u32
}

/// Loops to wait for a clock before giving up: over a second at the 8 or 16 MHz
/// a chip starts with, because the ST-LINK gives its clock only once it is awake.
pub(crate) const CLOCK_WAIT_LOOPS: u32 = 4_000_000;

impl Clocks {
    /// These clocks, once it is certain that all that follows from them is in
    /// range. For constants: does not compile otherwise.
    pub(crate) const fn checked(self) -> Self {
        assert!(self.spi_hz <= CLOCK_MAX_HZ);
        assert!(self.has_fast_slot() && self.tick_max_hz() >= 2_000);
        let halved = self.halved();
        assert!(halved.spi_hz >= 100_000 && halved.spi_hz <= CLOCK_SLOW_MAX_HZ);
        assert!(halved.slot_safe_ns() >= SS_LEAD_SLOW_NS && halved.tick_max_hz() >= 500);
        self.in_range();
        halved.in_range();
        self
    }

    /// What holds with the core's clock halved or not.
    const fn in_range(&self) {
        assert!(self.slot_counts(TICK_MIN_HZ) > 0);
        assert!(self.pwm_hz / PWM_HZ < u16::MAX as u32);
        // The motor drivers rest one tick at a reversal, which must cover a PWM period.
        assert!(PWM_HZ >= self.tick_max_hz());
        // Idle feeds after every tick. Even at the slowest tick and the fastest
        // watchdog one tick may be missing, and idle has time left for its logging.
        let bites_ms =
            self.watchdog_counts() as u32 * WATCHDOG_DIVIDER * 1_000 / self.watchdog_hz[2];
        assert!(bites_ms >= 2 * 1_000 / TICK_MIN_HZ + 2);
        assert!(TickPeriod::new(TICK_MIN_HZ, self.tick_timer_hz).counts() > 0);
    }

    /// With the core's clock halved, and so all but the watchdog's: for sensors in their slow
    /// mode, as the SPIs have no divider left.
    pub(crate) const fn halved(&self) -> Self {
        Self {
            core_hz: self.core_hz / 2,
            spi_hz: self.spi_hz / 2,
            byte_timer_hz: self.byte_timer_hz / 2,
            tick_timer_hz: self.tick_timer_hz / 2,
            counter_hz: self.counter_hz / 2,
            pwm_hz: self.pwm_hz / 2,
            serial_hz: self.serial_hz / 2,
            watchdog_hz: self.watchdog_hz,
        }
    }

    /// Whether bytes are short enough for the fast slot.
    const fn has_fast_slot(&self) -> bool {
        self.byte_ns() + BYTE_GAP_FAST_NS <= SLOT_FAST_NS
    }

    /// One byte on the wire, ns, rounded up.
    pub(crate) const fn byte_ns(&self) -> u32 {
        8_000_000_000_u64.div_ceil(self.spi_hz as u64) as u32
    }

    /// From the start of a byte to that of the next with the gap that is safe
    /// in either of the sensor's modes, ns.
    const fn slot_safe_ns(&self) -> u32 {
        self.byte_ns() + BYTE_GAP_SAFE_NS
    }

    /// A frame from /SS low to /SS high, ns: one slot before the first byte,
    /// eight bytes in their slots, of which the last needs no gap.
    const fn frame_ns(&self, slot_ns: u32) -> u32 {
        8 * slot_ns + self.byte_ns()
    }

    /// The shortest frame, ns.
    pub(crate) const fn frame_least_ns(&self) -> u32 {
        if self.has_fast_slot() {
            self.frame_ns(SLOT_FAST_NS)
        } else {
            self.frame_ns(self.slot_safe_ns())
        }
    }

    /// The highest tick rate that a frame fits into, Hz.
    pub(crate) const fn tick_max_hz(&self) -> u32 {
        1_000_000_000 / (self.frame_least_ns() + REST_NS)
    }

    /// The slot for a tick rate, ns: the safe one if its frame fits into a tick,
    /// the fast one otherwise; `None` above the rate at which that fits.
    pub(crate) const fn slot_ns(&self, tick_hz: u32) -> Option<u32> {
        let tick_ns = 1_000_000_000 / tick_hz;
        if self.frame_ns(self.slot_safe_ns()) + REST_NS <= tick_ns {
            Some(self.slot_safe_ns())
        } else if self.has_fast_slot() && self.frame_least_ns() + REST_NS <= tick_ns {
            Some(SLOT_FAST_NS)
        } else {
            None
        }
    }

    /// Counts of the byte timer in the slot for a tick rate, rounded up. For constants: does not
    /// compile for a rate that the build script refuses.
    pub(crate) const fn slot_counts(&self, tick_hz: u32) -> u16 {
        let Some(slot_ns) = self.slot_ns(tick_hz) else {
            panic!("the tick is shorter than a sensor frame");
        };
        let counts = (slot_ns as u64 * (self.byte_timer_hz / 1_000_000) as u64).div_ceil(1_000);
        assert!(counts <= u16::MAX as u64);
        counts as u16
    }

    /// Prescaler and period of the tick timer.
    pub(crate) const fn tick(&self, tick_hz: u32) -> TickPeriod {
        TickPeriod::new(tick_hz, self.tick_timer_hz)
    }

    /// The tick in counts of the counter.
    pub(crate) const fn tick_counts(&self, tick_hz: u32) -> u32 {
        let counts = self.tick(tick_hz).counts() as u64;
        (counts * self.counter_hz as u64 / self.tick_timer_hz as u64) as u32
    }

    /// Counts of the PWM's timer in a period; the duty has this many steps.
    pub(crate) const fn pwm_counts(&self) -> u16 {
        (self.pwm_hz / PWM_HZ) as u16
    }

    /// What divides the serial port's clock for `baud` bits a second: at least 16, as each
    /// bit is sampled so often; `None` if that is more than [`BAUD_ERROR_PERMILLE`] off.
    pub(crate) const fn serial_divider(&self, baud: u32) -> Option<u16> {
        let divider = (self.serial_hz + baud / 2) / baud;
        let (hz, wanted) = (self.serial_hz as u64, divider as u64 * baud as u64);
        let is_near = hz.abs_diff(wanted) * 1_000 <= BAUD_ERROR_PERMILLE * wanted;
        if is_near && divider >= 16 && divider <= u16::MAX as u32 {
            Some(divider as u16)
        } else {
            None
        }
    }

    /// The same for a baud that the build script takes. For constants: does not compile for
    /// another.
    pub(crate) const fn serial_divider_of(&self, baud: u32) -> u16 {
        let Some(divider) = self.serial_divider(baud) else {
            panic!("the serial port's clock cannot be divided for this baud");
        };
        divider
    }

    /// Counts of the watchdog until it bites: 20 ms nominally. A motor that is
    /// left on for as long, or for the longest over the spread of the watchdog's
    /// oscillator, does no harm: a stall is tolerated for 200 ms.
    pub(crate) const fn watchdog_counts(&self) -> u16 {
        (self.watchdog_hz[1] / WATCHDOG_DIVIDER / 50) as u16
    }

    /// Cycles of the core from the last byte to /SS high in the sensor's slow mode.
    pub(crate) const fn lag_cycles(&self) -> u32 {
        self.core_hz / 1_000_000 * SS_LAG_SLOW_NS / 1_000
    }

    /// Cycles of the core to wait for the sensor after power-up, with /SS high.
    pub(crate) const fn start_up_cycles(&self) -> u32 {
        self.core_hz / 1_000_000 * START_UP_WAIT_US
    }
}

/// Prescaler and period of a 16-bit timer, whose product is the tick in counts
/// of its clock.
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
    const fn new(tick_hz: u32, timer_hz: u32) -> Self {
        let counts = (timer_hz + tick_hz / 2) / tick_hz;
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

    /// The tick in counts of the timer's clock.
    const fn counts(self) -> u32 {
        self.prescaler as u32 * self.period as u32
    }
}

const _: () = {
    let two_kilohertz = TickPeriod::new(2_000, 80_000_000);
    assert!(two_kilohertz.prescaler == 1 && two_kilohertz.period == 40_000);
    assert!(TickPeriod::new(TICK_MIN_HZ, 80_000_000).counts() == 400_000);
};
