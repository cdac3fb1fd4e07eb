//! Lines of the log, by defmt over RTT. Texts stay on the PC; the board sends
//! a number for each.
//!
//! Only the start writes here, idle, and fault handlers. A line that finds no room in the
//! ring is dropped whole, on a Cortex-M0+ it takes the place of older ones; nothing waits for
//! a probe, not even for one that asked for it and was pulled.
#![allow(
    clippy::match_same_arms,
    reason = "arms differ in their texts, which clippy does not see within a macro"
)]

use firmware::faults::number;
use firmware::{ConfigError, ModelState, NotArmed, Part, Place, SensorFault, StartCause, Startup};
use mlx90333::{Faults, FrameError};
use whisking::motor;

use super::counters::TICKS;
use super::pace;
use super::reset::ClockError;
use super::scene::Scene;

// Lines begin with the time since the first tick, in seconds to the tick.
defmt::timestamp!("{=u32:ms}", {
    let (ticks, tick_hz) = (TICKS.get(), pace::tick_hz());
    let (whole, part) = (ticks / tick_hz, ticks % tick_hz);
    // Begins anew with the count of ticks: at 2 kHz after 24.8 days.
    whole
        .wrapping_mul(1_000)
        .wrapping_add(part * 1_000 / tick_hz)
});

/// The first lines after a reset.
#[inline(never)]
pub(crate) fn start(cause: StartCause, start: &Startup, found: &Scene) {
    let version = env!("CARGO_PKG_VERSION");
    if found.deployed.is_some() {
        defmt::info!(
            "whisker {=str}: scene {=str}, {=u32} ticks a second",
            version,
            found.settings.head.name.as_str(),
            pace::tick_hz()
        );
    } else {
        defmt::warn!(
            "whisker {=str}: no scene, {=u32} ticks a second: whisker deploy brings one",
            version,
            pace::tick_hz()
        );
    }
    scene(found);
    match cause {
        StartCause::Watchdog => fatal(number::WATCHDOG),
        StartCause::Software if start.follows(number::SUPPLY_LOW) => fatal(number::SUPPLY_LOW),
        StartCause::Software => defmt::info!("reset by software"),
        StartCause::Power => defmt::info!("reset by power-up"),
        StartCause::BrownOut => fatal(number::SUPPLY),
        StartCause::Pin => defmt::info!("reset by the reset pin"),
        StartCause::Other => defmt::warn!("reset, cause unknown"),
    }
    let (starts, fault) = (start.number, start.fault);
    if fault == 0 {
        defmt::info!("start {=u32} since power-up, no fault", starts);
    } else {
        defmt::warn!(
            "start {=u32} since power-up, last fault {=u8}",
            starts,
            fault
        );
    }
}

/// Which scene runs, and why a slot does not count; an empty one has a line only where there is
/// no scene.
fn scene(found: &Scene) {
    if let Some(deployed) = &found.deployed {
        let name = slot_name(deployed.slot);
        defmt::info!(
            "configuration {=u32:08x} of slot {=str}",
            deployed.crc,
            name
        );
    }
    for (slot, refused) in found.refused.iter().enumerate() {
        match refused {
            None => {}
            Some(ConfigError::Absent) if found.deployed.is_some() => {}
            Some(error) => slot_refused(slot_name(slot), *error),
        }
    }
}

/// How a slot is called.
const fn slot_name(slot: usize) -> &'static str {
    if slot == 0 { "A" } else { "B" }
}

/// Why the scene of a slot does not count.
fn slot_refused(slot: &str, error: ConfigError) {
    match error {
        ConfigError::Absent => defmt::warn!(
            "slot {=str}: there is none: none was deployed, or writing it was interrupted",
            slot
        ),
        ConfigError::Strange => {
            defmt::warn!("slot {=str}: what lies there is no configuration", slot);
        }
        ConfigError::Version(found) => defmt::warn!(
            "slot {=str}: its layout has version {=u16}, which this program does not read",
            slot,
            found
        ),
        ConfigError::Board(found) => defmt::warn!(
            "slot {=str}: it was made for another board ({=u8})",
            slot,
            found
        ),
        ConfigError::Format(found) => defmt::warn!(
            "slot {=str}: it has another number format ({=u8}) than this program",
            slot,
            found
        ),
        ConfigError::TooLong => defmt::warn!("slot {=str}: it is longer than its place", slot),
        ConfigError::Damaged => {
            defmt::warn!(
                "slot {=str}: it is damaged: its checksum does not match",
                slot
            );
        }
        ConfigError::Unreadable(part) => {
            defmt::warn!("slot {=str}: {=str}: it cannot be read", slot, part.text());
        }
        ConfigError::NotBuilt(part) => defmt::warn!(
            "slot {=str}: {=str}: this image was built without it",
            slot,
            part.text()
        ),
        ConfigError::Range(field) => {
            defmt::warn!("slot {=str}: {=str}: out of range", slot, field.text());
        }
        ConfigError::Room(field) => defmt::warn!(
            "slot {=str}: {=str}: more than this board has",
            slot,
            field.text()
        ),
        // Of a configuration for a module that runs.
        ConfigError::Shape(_) | ConfigError::Armed(_) => {}
    }
}

/// The start goes on once the supply is high enough.
pub(crate) fn waits_for_supply() {
    defmt::warn!("waiting for the supply");
}

/// A fast dip may take the supply below what the clock needs.
pub(crate) fn brown_out_is_low() {
    defmt::warn!("brown-out level below what the clock needs: set BOR_LEV to level 3");
}

/// By which model it decides, or why by none.
pub(crate) fn model(state: ModelState) {
    match state {
        ModelState::Runs { crc, classes } if Part::Classifier.is_built() => {
            defmt::info!("decides by model {=u32:08x}, {=u8} classes", crc, classes);
        }
        ModelState::Refused(refusal) if Part::Classifier.is_built() => {
            limit(number::NO_MODEL);
            defmt::warn!("- {=str}", refusal.text());
        }
        _ => {}
    }
}

/// The motors are off until the user button is pressed.
pub(crate) fn not_armed(reason: NotArmed) {
    match reason {
        NotArmed::After(number) => {
            let [name, _] = texts(number);
            defmt::warn!("not armed: fault {=u8}, {=istr}", number, name);
        }
        NotArmed::Unknown => defmt::warn!("not armed: cause of the reset unknown"),
        NotArmed::OnCommand => defmt::info!("not armed: the scene waits for the user button"),
    }
}

/// The user button was pressed.
pub(crate) fn armed() {
    defmt::info!("armed by the user button");
}

/// A PC asks for what a reader of the log should know of.
pub(crate) fn requested(command: wire::Command) {
    match command {
        wire::Command::Arm => defmt::info!("to be armed, by command"),
        wire::Command::Stop => defmt::info!("to be stopped, by command"),
        wire::Command::Apply(bytes) => {
            defmt::info!("settings to be changed, by command: {=u32} bytes", bytes);
        }
        _ => {}
    }
}

/// Settings were changed by command, or were some time ago.
pub(crate) fn tuned(differ: bool) {
    if differ {
        defmt::warn!("settings differ from the scene's: whisker get says which");
    } else {
        defmt::info!("settings are the scene's");
    }
}

macro_rules! texts {
    ($($number:literal $constant:ident: $name:literal, $causes:literal, $check:literal,
        $reaction:ident, $recovery:ident;)*) => {
        /// What is wrong, and likely causes, of each row of the table of faults.
        // Once in the program, as it takes nearly a kilobyte.
        #[inline(never)]
        fn texts(number: u8) -> [defmt::Str; 2] {
            match number {
                $($number => [defmt::intern!($name), defmt::intern!($causes)],)*
                _ => [defmt::intern!("not in the table"), defmt::intern!("an older table")],
            }
        }
    };
}
firmware::fault_table!(texts);

/// The line of a fault of the board; lines with details may follow.
pub(crate) fn fatal(number: u8) {
    let [name, causes] = texts(number);
    defmt::error!("fault {=u8}, {=istr} ({=istr}?)", number, name, causes);
}

/// The last lines where a clock did not start.
pub(crate) fn clock(error: ClockError) {
    match error {
        ClockError::NoHse => defmt::error!("- no 8 MHz clock from the ST-LINK (PH0)"),
        ClockError::NoPll => defmt::error!("- the PLL does not run"),
    }
}

/// The line of a limit.
fn limit(number: u8) {
    let [name, causes] = texts(number);
    defmt::warn!("limit {=u8}, {=istr} ({=istr}?)", number, name, causes);
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

impl Health {
    /// The longest tick, tenths of a microsecond.
    pub(crate) fn worst_tenths(&self) -> u32 {
        let us = match pace::clocks().counter_hz / 1_000_000 {
            0 => 1,
            counts => counts,
        };
        // In two steps, lest ten times the worst overflow.
        self.worst / us * 10 + self.worst % us * 10 / us
    }
}

/// Once a second: the longest tick, and the limits that were passed since `before`.
pub(crate) fn health(now: &Health, before: &Health) {
    let tenths = now.worst_tenths();
    defmt::info!(
        "longest tick {=u32}.{=u32} us of {=u32}; missed {=u32}, events dropped {=u32}",
        tenths / 10,
        tenths % 10,
        1_000_000 / pace::tick_hz(),
        now.missed,
        now.dropped
    );
    if now.missed != before.missed {
        limit(number::MISSED);
    }
    if now.dropped != before.dropped {
        limit(number::DROPPED);
    }
}

/// A line about what a whisker feels; where several are heard it begins with the whisker's
/// side and number, and reads as the second text.
macro_rules! felt_line {
    ($felt:ident, $text:literal, $of_several:literal $(, $value:expr)* $(,)?) => {
        let Felt { place: $felt, several } = $felt;
        if Part::Several.is_built() && several {
            defmt::info!($of_several, $felt.side_name(), $felt.whisker $(, $value)*);
        } else {
            defmt::info!($text $(, $value)*);
        }
    };
}

/// Who feels it, of several that are heard or of one.
#[derive(Clone, Copy)]
pub(crate) struct Felt {
    pub(crate) place: Place,
    pub(crate) several: bool,
}

/// A touch begins.
pub(crate) fn touch(felt: Felt, number: u16) {
    felt_line!(felt, "touch {=u16}", "{=str} {=u8}: touch {=u16}", number);
}

/// A touch has ended.
pub(crate) fn touch_end(felt: Felt, number: u16) {
    felt_line!(
        felt,
        "touch {=u16} has ended",
        "{=str} {=u8}: touch {=u16} has ended",
        number
    );
}

/// A decision for the class `name`.
pub(crate) fn decision(felt: Felt, name: &str, decided: tactile::Decision) {
    // Percent with four decimals, rounded down: at most 99.9999.
    let posterior = ((u64::from(decided.posterior().q32()) * 1_000_000) >> 32) as u32;
    felt_line!(
        felt,
        "decision: {=str}, posterior {=u32}.{=u32:04} %, {=u32} samples",
        "{=str} {=u8}: decision: {=str}, posterior {=u32}.{=u32:04} %, {=u32} samples",
        name,
        posterior / 10_000,
        posterior % 10_000,
        decided.samples()
    );
}

/// The line of a whisker's fault.
fn fault(place: Place, number: u8) {
    let [name, causes] = texts(number);
    defmt::error!(
        "{=str} {=u8}: fault {=u8}, {=istr} ({=istr}?)",
        place.side_name(),
        place.whisker,
        number,
        name,
        causes
    );
}

/// A motor was switched off.
pub(crate) fn motor_fault(place: Place, of: motor::Fault) {
    fault(place, of.code());
    if let motor::Fault::InvalidHall(hall) = of {
        defmt::error!("- Hall code {=u8}", hall);
    }
}

/// The zero of a sensor was moved.
pub(crate) fn zero_moved(place: Place, [x, y]: [i16; 2]) {
    defmt::info!(
        "{=str} {=u8}: zero moved to x {=i16}, y {=i16} codes",
        place.side_name(),
        place.whisker,
        x,
        y
    );
}

/// A motor is tried again after its rest.
pub(crate) fn motor_retry(place: Place) {
    defmt::info!(
        "{=str} {=u8}: motor is tried again",
        place.side_name(),
        place.whisker
    );
}

/// A motor stays off until it is armed again.
pub(crate) fn motor_given_up(place: Place) {
    defmt::error!(
        "{=str} {=u8}: three faults in a minute: motor off until armed",
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
pub(crate) fn sensor_lost(place: Place, of: SensorFault) {
    fault(place, of.code());
    match of {
        SensorFault::Frame(FrameError::BadStart(found)) => {
            defmt::error!("- it begins with {=u8:#04x}", found);
        }
        SensorFault::Frame(FrameError::BadSum { expected, found }) => {
            defmt::error!("- sum {=u8:#04x} instead of {=u8:#04x}", found, expected);
        }
        SensorFault::Frame(FrameError::Sensor(faults)) => {
            defmt::error!("- error word {=u16:#06x}", faults.bits());
            sensor_reports(faults);
        }
        SensorFault::Often(last) => {
            let [name, causes] = texts(last);
            defmt::error!(
                "- the last: fault {=u8}, {=istr} ({=istr}?)",
                last,
                name,
                causes
            );
        }
        _ => {}
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
