//! Lines of the log, by defmt over RTT. Texts stay on the PC; the board sends
//! a number for each.
//!
//! Only idle writes here, and fault handlers. A line that finds no room in the
//! ring is dropped whole; nothing waits for the probe.
#![allow(
    clippy::match_same_arms,
    reason = "arms differ in their texts, which clippy does not see within a macro"
)]

use firmware::{Place, SensorFault};
use mlx90333::{Faults, FrameError};
use whisking::motor;

use super::counters::TICKS;
use super::reset::{Cause, ClockError};
use super::scene::{HEARS_SEVERAL, NAME, TICK_HZ};
use crate::here::CLOCKS;

// Lines begin with the time since the first tick, in seconds to the tick.
defmt::timestamp!("{=u32:ms}", {
    let ticks = TICKS.get();
    let (whole, part) = (ticks / TICK_HZ, ticks % TICK_HZ);
    // Wraps after seven weeks, as a clock of 32 bits in milliseconds does.
    whole
        .wrapping_mul(1_000)
        .wrapping_add(part * 1_000 / TICK_HZ)
});

/// Counts of the clock in a microsecond.
const US: u32 = CLOCKS.counter_hz / 1_000_000;

/// The first lines after a reset.
pub(crate) fn start(cause: Cause) {
    defmt::info!(
        "whisker {=str}: scene {=str}, {=u32} ticks a second",
        env!("CARGO_PKG_VERSION"),
        NAME,
        TICK_HZ
    );
    match cause {
        Cause::Watchdog => {
            defmt::warn!(
                "reset by the watchdog: a fault (logged above), or tick or idle stood still"
            );
        }
        Cause::Software => defmt::info!("reset by software"),
        Cause::Power => defmt::info!("reset by power-up"),
        Cause::Pin => defmt::info!("reset by the reset pin"),
        Cause::Other => defmt::info!("reset, cause unknown"),
    }
}

/// The last line where a clock did not start.
pub(crate) fn clock(error: ClockError) {
    match error {
        ClockError::NoHse => defmt::error!("no 8 MHz clock from the ST-LINK (PH0)"),
        ClockError::NoPll => defmt::error!("the PLL does not run"),
    }
}

/// The last line where the classifier cannot start.
pub(crate) fn model() {
    defmt::error!("the model in flash is damaged: flash again");
}

/// How the ticks keep their time.
#[derive(Default)]
pub(crate) struct Health {
    /// The longest tick since the last line, counts of the clock.
    pub(crate) worst: u32,
    /// Ticks that did not happen in time, since the start.
    pub(crate) missed: u32,
    /// Events that found the queue full, since the start.
    pub(crate) dropped: u32,
}

/// Once a second: the longest tick, and the limits that were passed since `before`.
pub(crate) fn health(now: &Health, before: &Health) {
    // In two steps, lest ten times the worst overflow.
    let tenths = now.worst / US * 10 + now.worst % US * 10 / US;
    defmt::info!(
        "longest tick {=u32}.{=u32} us of {=u32}; missed {=u32}, events dropped {=u32}",
        tenths / 10,
        tenths % 10,
        1_000_000 / TICK_HZ,
        now.missed,
        now.dropped
    );
    if now.missed != before.missed {
        defmt::warn!("limit 32: ticks were missed");
    }
    if now.dropped != before.dropped {
        defmt::warn!("limit 33: events were dropped");
    }
}

/// A line about what a whisker feels; where several are heard it begins with the whisker's
/// side and number, and reads as the second text.
macro_rules! felt_line {
    ($place:ident, $text:literal, $of_several:literal $(, $value:expr)* $(,)?) => {
        if HEARS_SEVERAL {
            defmt::info!($of_several, $place.side_name(), $place.whisker $(, $value)*);
        } else {
            defmt::info!($text $(, $value)*);
        }
    };
}

/// A touch begins.
pub(crate) fn touch(place: Place, number: u16) {
    felt_line!(place, "touch {=u16}", "{=str} {=u8}: touch {=u16}", number);
}

/// A touch has ended.
pub(crate) fn touch_end(place: Place, number: u16) {
    felt_line!(
        place,
        "touch {=u16} has ended",
        "{=str} {=u8}: touch {=u16} has ended",
        number
    );
}

/// A decision for the class `name`.
pub(crate) fn decision(place: Place, name: &str, decided: tactile::Decision) {
    // Percent with four decimals, rounded down: at most 99.9999.
    let posterior = ((u64::from(decided.posterior().q32()) * 1_000_000) >> 32) as u32;
    felt_line!(
        place,
        "decision: {=str}, posterior {=u32}.{=u32:04} %, {=u32} samples",
        "{=str} {=u8}: decision: {=str}, posterior {=u32}.{=u32:04} %, {=u32} samples",
        name,
        posterior / 10_000,
        posterior % 10_000,
        decided.samples()
    );
}

/// The line of a fault: its text begins with the whisker's side and number, and
/// the fault's number.
macro_rules! fault_line {
    ($at:ident, $text:literal $(, $value:expr)* $(,)?) => {
        defmt::error!($text, $at.0, $at.1, $at.2 $(, $value)*)
    };
}

/// A motor was switched off.
pub(crate) fn motor_fault(place: Place, fault: motor::Fault) {
    let at = (place.side_name(), place.whisker, fault.code());
    match fault {
        motor::Fault::Pin => fault_line!(at, "{=str} {=u8}: fault {=u8}, a motor pin"),
        motor::Fault::Pwm => fault_line!(at, "{=str} {=u8}: fault {=u8}, PWM"),
        motor::Fault::InvalidHall(hall) => fault_line!(
            at,
            "{=str} {=u8}: fault {=u8}, impossible Hall code {=u8} (supply or cable of the Halls?)",
            hall
        ),
        motor::Fault::SkippedSector => fault_line!(
            at,
            "{=str} {=u8}: fault {=u8}, Hall sectors skipped (too fast, noise, lines exchanged?)"
        ),
        motor::Fault::Stall => fault_line!(
            at,
            "{=str} {=u8}: fault {=u8}, driven but not moving (blocked, or encoder not connected?)"
        ),
        motor::Fault::Following => fault_line!(
            at,
            "{=str} {=u8}: fault {=u8}, does not follow its setpoint (held, or encoder slipping?)"
        ),
        motor::Fault::Runaway => fault_line!(
            at,
            "{=str} {=u8}: fault {=u8}, runs away (motor or encoder wired the wrong way round?)"
        ),
        motor::Fault::Encoder => fault_line!(
            at,
            "{=str} {=u8}: fault {=u8}, driven both ways without a count (encoder not connected?)"
        ),
        motor::Fault::Travel => fault_line!(
            at,
            "{=str} {=u8}: fault {=u8}, beyond its travel (not at rest at the start?)"
        ),
        motor::Fault::Heat => fault_line!(
            at,
            "{=str} {=u8}: fault {=u8}, winding too hot (pressing against something, friction?)"
        ),
    }
}

/// A motor is tried again after its rest.
pub(crate) fn motor_retry(place: Place) {
    defmt::info!(
        "{=str} {=u8}: motor is tried again",
        place.side_name(),
        place.whisker
    );
}

/// A motor stays off until the board is reset.
pub(crate) fn motor_given_up(place: Place) {
    defmt::error!(
        "{=str} {=u8}: three faults in a minute: motor off until reset",
        place.side_name(),
        place.whisker
    );
}

/// A sensor is trusted again.
pub(crate) fn sensor_back(place: Place) {
    defmt::info!(
        "{=str} {=u8}: sensor is back",
        place.side_name(),
        place.whisker
    );
}

/// A sensor has a fault; the motor is off.
pub(crate) fn sensor_lost(place: Place, fault: SensorFault) {
    let at = (place.side_name(), place.whisker, fault.code());
    match fault {
        SensorFault::NoFrame => fault_line!(at, "{=str} {=u8}: fault {=u8}, no frame in time"),
        SensorFault::Bus => fault_line!(at, "{=str} {=u8}: fault {=u8}, SPI or its DMA"),
        SensorFault::Frame(FrameError::NoSensor) => fault_line!(
            at,
            "{=str} {=u8}: fault {=u8}, no sensor answers (/SS or data line open, no supply?)"
        ),
        SensorFault::Frame(FrameError::LineLow) => fault_line!(
            at,
            "{=str} {=u8}: fault {=u8}, data line stuck low (no pull-up, short?)"
        ),
        SensorFault::Frame(FrameError::BadStart(found)) => fault_line!(
            at,
            "{=str} {=u8}: fault {=u8}, frame begins with {=u8:#04x} (slow edges, SPI mode?)",
            found
        ),
        SensorFault::Frame(FrameError::BadSum { expected, found }) => fault_line!(
            at,
            "{=str} {=u8}: fault {=u8}, sum {=u8:#04x} instead of {=u8:#04x} (noise, pull-up?)",
            found,
            expected
        ),
        SensorFault::Frame(FrameError::Sensor(faults)) => {
            fault_line!(
                at,
                "{=str} {=u8}: fault {=u8}, the sensor reports {=u16:#06x}",
                faults.bits()
            );
            sensor_reports(faults);
        }
    }
}

/// One line for each bit set of the sensor's error word.
fn sensor_reports(faults: Faults) {
    macro_rules! lines {
        ($($bit:ident: $text:literal;)*) => {
            $(if faults.contains(Faults::$bit) {
                defmt::error!($text);
            })*
        };
    }
    lines! {
        ADC_MONITOR: "- converter self-test failed (supply?)";
        ADC_SATURATED: "- converter saturated (magnet too close?)";
        GAIN_TOO_LOW: "- gain at its lower end (magnet too strong?)";
        GAIN_TOO_HIGH: "- gain at its upper end (magnet too weak or missing?)";
        NORM_TOO_LOW: "- field norm too low (magnet off axis?)";
        FIELD_TOO_LOW: "- field too low (magnet missing?)";
        FIELD_TOO_HIGH: "- field too high (magnet or motor too close?)";
        ROUGH_OFFSET_CLAMP: "- rough offset at its limit (a strong constant field?)";
        DEAD_ZONE_ALPHA: "- alpha in its dead zone (deflected too far?)";
        DEAD_ZONE_BETA: "- beta in its dead zone (deflected too far?)";
    }
}
