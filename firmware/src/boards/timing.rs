//! What follows from a board's clocks: every rate and duration that its drivers use, each with
//! its derivation. Arithmetic of 32 bits throughout, as a board computes with it too.

use mlx90333::timing::{
    BYTE_GAP_FAST_NS, BYTE_GAP_SAFE_NS, CLOCK_MAX_HZ, CLOCK_SLOW_MAX_HZ, SS_LAG_FAST_NS,
    SS_LAG_SLOW_NS, SS_LEAD_SLOW_NS, START_UP_WAIT_US,
};

/// The clocks of a board, Hz.
#[allow(clippy::struct_field_names, reason = "a unit, not a common name")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Clocks {
    /// The core's.
    pub core_hz: u32,
    /// The clock of every sensor's SPI.
    pub spi_hz: u32,
    /// What every byte timer counts.
    pub byte_timer_hz: u32,
    /// What the tick timer counts.
    pub tick_timer_hz: u32,
    /// What the counter that measures the ticks counts.
    pub counter_hz: u32,
    /// What the timer of the motor's PWM counts.
    pub pwm_hz: u32,
    /// What the serial port divides, and the controller of the bus: the clock of the same bus.
    pub serial_hz: u32,
    /// The watchdog's oscillator: least, nominal, most (the chip's data sheet).
    pub watchdog_hz: [u32; 3],
}

/// A bit of a CAN bus, in quanta of its clock divided by `prescaler`: one to fall in with, so many
/// `before` it is sampled, and so many `after`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CanTiming {
    /// 1 to 1,024.
    pub prescaler: u16,
    /// 1 to 16.
    pub before: u8,
    /// 1 to 8; as many a bit may be lengthened or shortened by.
    pub after: u8,
}

/// Quanta of a bit, least and most: with more than 18 the sample cannot be at seven eighths (CiA
/// 301), as there are 16 before it at most.
const CAN_QUANTA: [u8; 2] = [8, 18];

/// From a byte to the next where the tick leaves no more room, ns: a gap of 18 µs or more, half as
/// much again as the sensor asks for in its fast mode.
pub const SLOT_FAST_NS: u32 = 50_000;
/// Least time for which /SS is high between frames, µs, unless a scene asks for more. The sensor's
/// own need is not known; this is what it needs between bytes.
pub const REST_US: u16 = (BYTE_GAP_SAFE_NS / 1_000) as u16;

/// The lowest tick rate of a board, Hz.
pub const TICK_MIN_HZ: u32 = 200;

/// Motor PWM, Hz: above hearing, and a bridge still switches it with ease.
pub const PWM_HZ: u32 = 20_000;

const WATCHDOG_DIVIDER: u32 = 4;

/// Most error of a baud: 3 in 200, 1.5 %. A receiver bears 4 % over both ends (RM0390, chapter
/// 25.4.5), of which the G071's oscillator takes 1 %.
const BAUD_ERROR: [u32; 2] = [3, 200];

/// Bytes that the serial port holds of what comes, until idle has read it.
pub const RECEIVED_BYTES: usize = 256;

/// The highest baud whose bytes, of ten bits each, find room in two ticks: idle reads after each,
/// and may miss one.
pub(super) const fn serial_most(tick_hz: u32) -> u32 {
    tick_hz.saturating_mul((RECEIVED_BYTES as u32 - 1) * 10 / 2)
}

/// Loops to wait for a clock before giving up: over a second at the 8 or 16 MHz
/// a chip starts with, because the ST-LINK gives its clock only once it is awake.
pub const CLOCK_WAIT_LOOPS: u32 = 4_000_000;

impl Clocks {
    /// These clocks, once it is certain that all that follows from them is in
    /// range. For constants: does not compile otherwise.
    pub(super) const fn checked(self) -> Self {
        assert!(self.spi_hz <= CLOCK_MAX_HZ);
        assert!(self.has_fast_slot() && self.tick_max_hz(REST_US) >= 2_000);
        let halved = self.halved();
        assert!(halved.spi_hz >= 100_000 && halved.spi_hz <= CLOCK_SLOW_MAX_HZ);
        assert!(halved.slot_safe_ns() >= SS_LEAD_SLOW_NS && halved.tick_max_hz(REST_US) >= 500);
        self.in_range();
        halved.in_range();
        self
    }

    /// All at the core's clock, but for the SPIs, whose largest divider is 256.
    pub(super) const fn undivided(core_hz: u32, watchdog_hz: [u32; 3]) -> Self {
        Self {
            core_hz,
            spi_hz: core_hz / 256,
            byte_timer_hz: core_hz,
            tick_timer_hz: core_hz,
            counter_hz: core_hz,
            pwm_hz: core_hz,
            serial_hz: core_hz,
            watchdog_hz,
        }
    }

    /// What holds with the core's clock halved or not.
    const fn in_range(&self) {
        // Divided without a rest, and without a product of 64 bits.
        assert!(self.spi_hz.is_multiple_of(125) && self.core_hz.is_multiple_of(1_000_000));
        assert!(self.byte_timer_hz.is_multiple_of(1_000_000));
        assert!(self.counter_hz.is_multiple_of(self.tick_timer_hz));
        assert!(self.byte_timer_hz / 1_000_000 * self.slot_safe_ns() / 1_000 < u16::MAX as u32);
        assert!(matches!(self.slot_counts(TICK_MIN_HZ, REST_US), Some(1..)));
        assert!(self.pwm_hz / PWM_HZ < u16::MAX as u32);
        // The motor drivers rest one tick at a reversal, which must cover a PWM period.
        assert!(PWM_HZ >= self.tick_max_hz(REST_US));
        // Idle feeds after every tick. Even at the slowest tick and the fastest
        // watchdog one tick may be missing, and idle has time left for its logging.
        let bites_ms =
            self.watchdog_counts() as u32 * WATCHDOG_DIVIDER * 1_000 / self.watchdog_hz[2];
        assert!(bites_ms >= 2 * 1_000 / TICK_MIN_HZ + 2);
        assert!(self.tick(TICK_MIN_HZ).is_some() && self.tick(self.tick_max_hz(REST_US)).is_some());
    }

    /// With the core's clock halved, and so all but the watchdog's: for sensors in their slow
    /// mode, as the SPIs have no divider left.
    #[must_use]
    pub const fn halved(&self) -> Self {
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

    const fn has_fast_slot(&self) -> bool {
        self.byte_ns() + BYTE_GAP_FAST_NS <= SLOT_FAST_NS
    }

    /// One byte on the wire, ns, rounded up.
    pub const fn byte_ns(&self) -> u32 {
        // Eight bits, both numbers divided by 125.
        match self.spi_hz / 125 {
            0 => u32::MAX,
            hz => 64_000_000_u32.div_ceil(hz),
        }
    }

    /// The same with the gap that is safe in either of the sensor's modes, ns.
    const fn slot_safe_ns(&self) -> u32 {
        self.byte_ns() + BYTE_GAP_SAFE_NS
    }

    /// From /SS low to /SS high, ns: one slot before the first byte, eight bytes in their slots, of
    /// which the last needs no gap, and the longer of both waits after it.
    const fn frame_ns(&self, slot_ns: u32) -> u32 {
        8 * slot_ns + self.byte_ns() + SS_LAG_SLOW_NS
    }

    /// The shortest frame, ns.
    pub const fn frame_least_ns(&self) -> u32 {
        if self.has_fast_slot() {
            self.frame_ns(SLOT_FAST_NS)
        } else {
            self.frame_ns(self.slot_safe_ns())
        }
    }

    /// The highest tick rate that a frame fits into, and so many microseconds of rest, Hz.
    pub const fn tick_max_hz(&self, rest_us: u16) -> u32 {
        1_000_000_000 / (self.frame_least_ns() + rest_us as u32 * 1_000)
    }

    /// The slot for a tick rate, ns: the safe one if its frame and a rest of so many microseconds fit
    /// into a tick, the fast one otherwise; `None` above the rate at which that fits, and for 0.
    pub const fn slot_ns(&self, tick_hz: u32, rest_us: u16) -> Option<u32> {
        let rest_ns = rest_us as u32 * 1_000;
        let Some(tick_ns) = 1_000_000_000_u32.checked_div(tick_hz) else {
            return None;
        };
        if self.frame_ns(self.slot_safe_ns()) + rest_ns <= tick_ns {
            Some(self.slot_safe_ns())
        } else if self.has_fast_slot() && self.frame_least_ns() + rest_ns <= tick_ns {
            Some(SLOT_FAST_NS)
        } else {
            None
        }
    }

    /// For how long /SS is high between two frames, ns, where the rate of ticks leaves that.
    pub const fn rest_ns(&self, tick_hz: u32, rest_us: u16) -> Option<u32> {
        match (
            self.slot_ns(tick_hz, rest_us),
            1_000_000_000_u32.checked_div(tick_hz),
        ) {
            (Some(slot_ns), Some(tick_ns)) => Some(tick_ns - self.frame_ns(slot_ns)),
            _ => None,
        }
    }

    /// Counts of the byte timer in the slot for a tick rate, rounded up, where there is one.
    pub const fn slot_counts(&self, tick_hz: u32, rest_us: u16) -> Option<u16> {
        match self.slot_ns(tick_hz, rest_us) {
            // At most 90 µs of 80 MHz, which is certain of every board.
            Some(slot_ns) => {
                Some((slot_ns * (self.byte_timer_hz / 1_000_000)).div_ceil(1_000) as u16)
            }
            None => None,
        }
    }

    /// How a driver that waits paces its readings, as near to those of a tick as can be: with the
    /// gaps of its slot, and with what nine of these leave of it, of which a millisecond is enough.
    pub const fn pacing(&self, slot_counts: u16, tick_us: u32, rest_us: u16) -> Pacing {
        let counts = 1_000 * slot_counts as u32;
        let slot_ns = match counts.checked_div(self.byte_timer_hz / 1_000_000) {
            Some(slot_ns) => slot_ns,
            // No clocks that are checked.
            None => 0,
        };
        let left_us = tick_us.saturating_sub(9 * slot_ns / 1_000);
        let least_us = rest_us as u32;
        // What is left beyond the least.
        let more_us = left_us.saturating_sub(least_us);
        Pacing {
            gap_ns: slot_ns.saturating_sub(self.byte_ns()),
            rest_us: least_us + if more_us < 1_000 { more_us } else { 1_000 },
        }
    }

    /// Prescaler and period of the tick timer; `None` below [`TICK_MIN_HZ`].
    pub const fn tick(&self, tick_hz: u32) -> Option<TickPeriod> {
        TickPeriod::new(tick_hz, self.tick_timer_hz)
    }

    /// A tick in counts of the counter.
    pub const fn tick_counts(&self, tick: TickPeriod) -> u32 {
        match self.counter_hz.checked_div(self.tick_timer_hz) {
            Some(each) => tick.counts() * each,
            // No clocks that are checked.
            None => 0,
        }
    }

    /// Counts of the PWM's timer in a period; the duty has this many steps.
    pub const fn pwm_counts(&self) -> u16 {
        (self.pwm_hz / PWM_HZ) as u16
    }

    /// What divides the serial port's clock for `baud` bits a second: at least 16, as each
    /// bit is sampled so often; `None` if that is more than 1.5 % off.
    pub const fn serial_divider(&self, baud: u32) -> Option<u16> {
        let Some(divider) = self.serial_hz.saturating_add(baud / 2).checked_div(baud) else {
            return None;
        };
        if divider < 16 || divider > u16::MAX as u32 {
            return None;
        }
        // Half a baud more than the clock at most.
        let wanted = divider * baud;
        let most = wanted / BAUD_ERROR[1] * BAUD_ERROR[0];
        if self.serial_hz.abs_diff(wanted) <= most {
            Some(divider as u16)
        } else {
            None
        }
    }

    /// How a bus makes `kbit_s` thousand bits a second; `None`: it cannot make them exactly.
    pub const fn can_timing(&self, kbit_s: u16) -> Option<CanTiming> {
        let bit_hz = kbit_s as u32 * 1_000;
        if bit_hz == 0 || !self.serial_hz.is_multiple_of(bit_hz) {
            return None;
        }
        let counts = self.serial_hz / bit_hz;
        let mut quanta = CAN_QUANTA[1];
        while quanta >= CAN_QUANTA[0] {
            let prescaler = counts / quanta as u32;
            if counts.is_multiple_of(quanta as u32) && prescaler <= 1_024 {
                let after = (quanta + 3) / 8;
                return Some(CanTiming {
                    prescaler: prescaler as u16,
                    before: quanta - 1 - after,
                    after,
                });
            }
            quanta -= 1;
        }
        None
    }

    /// Counts of the watchdog until it bites: 20 ms nominally. A motor that is left on for the
    /// longest over the spread of its oscillator does no harm: a stall is tolerated for 200 ms.
    pub const fn watchdog_counts(&self) -> u16 {
        (self.watchdog_hz[1] / WATCHDOG_DIVIDER / 50) as u16
    }

    /// Rounds of `cortex_m::asm::delay`, of two cycles or more, from the last byte to /SS high.
    pub const fn lag_rounds(&self, is_slow: bool) -> u32 {
        let lag_ns = if is_slow {
            SS_LAG_SLOW_NS
        } else {
            SS_LAG_FAST_NS
        };
        self.core_hz / 2_000_000 * lag_ns / 1_000
    }

    /// Cycles of the core to wait for the sensor after power-up, with /SS high.
    pub const fn start_up_cycles(&self) -> u32 {
        self.core_hz / 1_000_000 * START_UP_WAIT_US
    }
}

/// How a driver that waits paces its readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pacing {
    /// Between two bytes, ns.
    pub gap_ns: u32,
    /// Between two frames, for which /SS is high, µs.
    pub rest_us: u32,
}

/// Prescaler and period of a 16-bit timer; their product is the tick in counts of its clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TickPeriod {
    /// Counts of the timer's clock a count of the timer.
    pub prescaler: u16,
    /// Counts of the timer a tick.
    pub period: u16,
}

impl TickPeriod {
    /// Exact where one of the prescalers divides the tick, else within 2e-5.
    const fn new(tick_hz: u32, timer_hz: u32) -> Option<Self> {
        if tick_hz < TICK_MIN_HZ {
            return None;
        }
        let counts = timer_hz.saturating_add(tick_hz / 2) / tick_hz;
        let least = counts.div_ceil(u16::MAX as u32);
        let mut prescaler = least;
        while prescaler < least + 32 && !counts.is_multiple_of(prescaler) {
            prescaler += 1;
        }
        if !counts.is_multiple_of(prescaler) {
            prescaler = least;
        }
        match counts.checked_div(prescaler) {
            Some(period) => Some(Self {
                prescaler: prescaler as u16,
                period: period as u16,
            }),
            None => None,
        }
    }

    /// The tick in counts of the timer's clock.
    pub const fn counts(self) -> u32 {
        self.prescaler as u32 * self.period as u32
    }
}

#[cfg(test)]
mod tests {
    use super::{Clocks, Pacing, RECEIVED_BYTES, REST_US, TICK_MIN_HZ, TickPeriod, serial_most};
    use crate::boards::{ALL, BoardFacts, NUCLEO_F103RB, NUCLEO_F446RE, NUCLEO_G071RB};

    #[test]
    fn a_serial_port_keeps_up_while_two_ticks_of_bytes_find_room() {
        for tick_hz in [200_u32, 1_000, 2_000] {
            let bytes = |baud: &u32| (2 * baud).div_ceil(10 * tick_hz);
            let fit = |baud: &u32| bytes(baud) < RECEIVED_BYTES as u32;
            let most = (1..3_000_000).rev().find(fit).unwrap();
            assert_eq!(serial_most(tick_hz), most, "at {tick_hz}");
        }
    }

    #[test]
    fn every_rate_of_a_board_has_a_timer_and_no_other_has_a_slot() {
        for board in ALL {
            for clocks in [board.clocks, board.clocks.halved()] {
                let most = clocks.tick_max_hz(REST_US);
                for tick_hz in TICK_MIN_HZ..=most {
                    let tick = clocks.tick(tick_hz).unwrap();
                    let exact = f64::from(clocks.tick_timer_hz) / f64::from(tick_hz);
                    let error = f64::from(tick.counts()) / exact - 1.0;
                    assert!(error.abs() < 2.5e-5, "{}: {tick_hz} Hz", board.name);
                    assert!(clocks.slot_counts(tick_hz, REST_US).is_some());
                }
                assert_eq!(clocks.slot_counts(most + 1, REST_US), None);
                assert_eq!(clocks.slot_counts(0, REST_US), None);
                assert_eq!(clocks.tick(TICK_MIN_HZ - 1), None);
            }
        }
        let exact = |tick_hz, prescaler, period| {
            let tick = TickPeriod { prescaler, period };
            assert_eq!(TickPeriod::new(tick_hz, 80_000_000), Some(tick));
        };
        exact(2_000, 1, 40_000);
        exact(TICK_MIN_HZ, 8, 50_000);
        // A fast slot of 50 µs at 2 kHz; a safe one of 78.4 µs at 1 kHz, or 82 µs.
        let slots = |board: BoardFacts| {
            [2_000, 1_000].map(|tick_hz| board.clocks.slot_counts(tick_hz, REST_US).unwrap())
        };
        let counts = [[3_600, 5_649], [3_600, 5_649], [3_200, 5_248]];
        assert_eq!(
            [NUCLEO_F446RE, NUCLEO_F103RB, NUCLEO_G071RB].map(slots),
            counts
        );
    }

    #[test]
    fn a_driver_that_waits_paces_a_sensor_as_a_tick_does() {
        for board in ALL {
            for (clocks, most_hz) in [(board.clocks, 2_000), (board.clocks.halved(), 500)] {
                for tick_hz in 200..=most_hz {
                    for rest_us in [REST_US, 200] {
                        let Some(slot_ns) = clocks.slot_ns(tick_hz, rest_us) else {
                            continue;
                        };
                        let slot_counts = clocks.slot_counts(tick_hz, rest_us).unwrap();
                        let pacing = clocks.pacing(slot_counts, 1_000_000 / tick_hz, rest_us);
                        // To a count.
                        let gap_ns = slot_ns - clocks.byte_ns();
                        let most_ns = gap_ns + 1_000_000_000 / clocks.byte_timer_hz;
                        assert!((gap_ns..=most_ns).contains(&pacing.gap_ns), "{pacing:?}");
                        let left_ns = 1_000_000_000 / tick_hz - clocks.frame_ns(slot_ns);
                        let rest_us = u32::from(rest_us);
                        let most_us = (left_ns / 1_000).clamp(rest_us, rest_us + 1_000);
                        assert!((rest_us..=most_us).contains(&pacing.rest_us), "{pacing:?}");
                    }
                }
            }
        }
        let [fast, slow] = [NUCLEO_F446RE.clocks, NUCLEO_F446RE.clocks.halved()];
        let pacing = |clocks: Clocks, tick_hz| {
            let slot = clocks.slot_counts(tick_hz, REST_US).unwrap();
            let Pacing { gap_ns, rest_us } = clocks.pacing(slot, 1_000_000 / tick_hz, REST_US);
            [gap_ns / 1_000, rest_us]
        };
        assert_eq!(pacing(fast, 2_000), [21, 50]);
        assert_eq!(pacing(fast, 1_000), [50, 294]);
        assert_eq!(pacing(slow, 500), [50, 1_038]);
    }

    /// The register of an online calculator for the bxCAN (bittiming.can-wiki.info, 36 MHz), whose
    /// fields count from 0; and samples near seven eighths of a bit.
    #[test]
    fn bits_of_a_bus_are_as_long_as_they_should_be() {
        let register = |timing: super::CanTiming| {
            let [before, after] = [timing.before, timing.after].map(|n| u32::from(n) - 1);
            after << 20 | before << 16 | (u32::from(timing.prescaler) - 1)
        };
        let of = |kbit_s| NUCLEO_F446RE.clocks.can_timing(kbit_s).map(register);
        assert_eq!([1_000, 500].map(of), [Some(0x001e_0001), Some(0x001e_0003)]);
        assert_eq!([0, 999].map(of), [None; 2]);
        for clocks in [NUCLEO_F446RE.clocks, NUCLEO_F446RE.clocks.halved()] {
            for kbit_s in 125..=1_000 {
                let Some(timing) = clocks.can_timing(kbit_s) else {
                    let rest = clocks.serial_hz % (u32::from(kbit_s) * 8_000);
                    assert_ne!(rest, 0, "{kbit_s}");
                    continue;
                };
                let quanta = 1 + u32::from(timing.before + timing.after);
                let counts = u32::from(timing.prescaler) * quanta;
                assert_eq!(counts * u32::from(kbit_s) * 1_000, clocks.serial_hz);
                let sampled = f64::from(1 + timing.before) / f64::from(quanta);
                assert!((sampled - 0.875).abs() < 0.045, "{kbit_s}: {timing:?}");
                assert!(timing.before <= 16 && timing.after <= 8);
            }
        }
    }

    #[test]
    fn a_baud_is_had_to_within_its_error() {
        for board in ALL {
            for baud in [9_600, 115_200, 921_600] {
                let divider = board.clocks.serial_divider(baud).unwrap();
                let found = f64::from(board.clocks.serial_hz) / f64::from(divider);
                assert!((found / f64::from(baud) - 1.0).abs() < 0.015);
            }
            let none = [0, 1, u32::MAX].map(|baud| board.clocks.serial_divider(baud));
            assert_eq!(none, [None; 3]);
        }
    }
}
