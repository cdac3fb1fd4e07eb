//! Lines of the log, by defmt over RTT. Texts stay on the PC; the board sends
//! a number for each. What the serial port says too has its wording from [`firmware::lines`].
//!
//! Only the start writes here, idle, and fault handlers. A line that finds no room in the
//! ring is dropped whole, on a Cortex-M0+ it takes the place of older ones; nothing waits for
//! a probe, not even for one that asked for it and was pulled.
#![allow(
    clippy::match_same_arms,
    reason = "arms differ in their texts, which clippy does not see within a macro"
)]

use defmt::intern;
#[cfg(feature = "tmag5170")]
use firmware::TiltFault;
use firmware::faults::{can_occur, number};
use firmware::{
    ConfigError, Event, Field, ModelState, NotArmed, Part, Place, SelfTest, SensorFault,
    StartCause, Startup,
};
use mlx90333::{Faults, FrameError};
#[cfg(feature = "tmag5170")]
use tmag5170::ReplyError;
use whisking::motor;

use super::about::NO_SCENE;
use super::counters::TICKS;
use super::perception::Names;
use super::scene::Scene;
use super::{pace, serial};

// Lines begin with the time since the first tick, in seconds to the tick.
defmt::timestamp!("{=u32:ms}", {
    let (ticks, tick_hz) = (TICKS.get(), pace::tick_hz());
    let (whole, part) = (ticks / tick_hz, ticks % tick_hz);
    // Wraps with the count of ticks: at 2 kHz after 24.8 days.
    whole
        .wrapping_mul(1_000)
        .wrapping_add(part * 1_000 / tick_hz)
});

macro_rules! say {
    ($level:ident, $text:literal $(, $value:expr)* $(,)?) => {
        defmt::$level!($text $(, $value)*)
    };
}

#[inline(never)]
pub(crate) fn start(cause: StartCause, start: &Startup, found: &Scene) {
    let name = &found.settings.head.name;
    let scene_name = if found.deployed.is_some() {
        name.as_str()
    } else {
        NO_SCENE
    };
    let what = (env!("CARGO_PKG_VERSION"), scene_name, pace::tick_hz());
    firmware::say_start!(say, text, what, (start, cause));
    if found.deployed.is_none() && Part::Deploy.is_built() {
        defmt::warn!("no scene: whisker deploy brings one");
    }
    scene(found);
}

/// An empty slot has a line only where there is no scene.
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

const fn slot_name(slot: usize) -> &'static str {
    if slot == 0 { "A" } else { "B" }
}

fn slot_refused(slot: &str, error: ConfigError) {
    let numbered = |before: defmt::Str, number: u16, behind: defmt::Str| {
        defmt::warn!(
            "slot {=str}: {=istr}{=u16}{=istr}",
            slot,
            before,
            number,
            behind
        );
    };
    let named = |name: defmt::Str, behind: defmt::Str| {
        defmt::warn!("slot {=str}: {=istr}{=istr}", slot, name, behind);
    };
    match error {
        ConfigError::Version(found) => numbered(
            intern!("its layout has version "),
            found,
            intern!(", which this program does not read"),
        ),
        ConfigError::Board(found) => numbered(
            intern!("it was made for another board ("),
            found.into(),
            intern!(")"),
        ),
        ConfigError::Format(found) => numbered(
            intern!("it has another number format ("),
            found.into(),
            intern!(") than this program"),
        ),
        ConfigError::Absent => named(
            intern!("there is none"),
            intern!(": none was deployed, or writing it was interrupted"),
        ),
        ConfigError::Strange => named(intern!("what lies there"), intern!(" is no configuration")),
        ConfigError::TooLong => named(intern!("it is longer"), intern!(" than its place")),
        ConfigError::Damaged => named(
            intern!("it is damaged"),
            intern!(": its checksum does not match"),
        ),
        ConfigError::Unreadable(part) => named(part_text(part), intern!(": it cannot be read")),
        ConfigError::NotBuilt(part) => named(
            part_text(part),
            intern!(": this image was built without it"),
        ),
        ConfigError::Range(field) => named(field_text(field), intern!(": out of range")),
        ConfigError::Room(field) => {
            named(field_text(field), intern!(": more than this board has"));
        }
        // Of a configuration for a module that runs.
        ConfigError::Shape(_) | ConfigError::Armed(_) => {}
    }
}

macro_rules! field_text {
    ($($name:ident = $code:literal: $text:literal;)*) => {
        #[inline(never)]
        fn field_text(field: Field) -> defmt::Str {
            match field {
                $(Field::$name if Field::$name.can_be_refused() => intern!($text),)*
                _ => intern!("what this program does not check"),
            }
        }
    };
}
firmware::config_fields!(field_text);

macro_rules! part_text {
    ($($name:ident $feature:tt = $code:literal: $text:literal;)*) => {
        #[inline(never)]
        fn part_text(part: Part) -> defmt::Str {
            match part {
                $(Part::$name if Part::TAKES_CONFIGURATIONS => intern!($text),)*
                _ => intern!("a part of what was linked"),
            }
        }
    };
}
firmware::config_parts!(part_text);

pub(crate) fn waits_for_supply() {
    defmt::warn!("waiting for the supply");
}

pub(crate) fn brown_out_is_low() {
    defmt::warn!("brown-out level below what the clock needs: whisker flash sets it");
}

pub(crate) fn model(state: ModelState, names: &Names) {
    match state {
        ModelState::Runs { crc, classes } if Part::Classifier.is_built() => {
            defmt::info!("decides by model {=u32:08x}, {=u8} classes", crc, classes);
        }
        ModelState::Refused(refusal) if Part::Classifier.is_built() => {
            event(&Event::Limit(number::NO_MODEL), names);
            defmt::warn!("- {=str}", refusal.text());
        }
        _ => {}
    }
}

/// What reading a sensor by its driver has found: frames, and the noise of x and y in codes.
#[inline(never)]
pub(crate) fn self_test(place: Place, found: &SelfTest) {
    let [x, y] = found.noise_tenths();
    defmt::info!(
        "self-test {=str} {=u8} {=u16}.{=u16} {=u16}.{=u16}",
        place.side_name(),
        found.good(),
        x / 10,
        x % 10,
        y / 10,
        y % 10
    );
    for (number, count) in found.faults() {
        let text = text(number);
        defmt::warn!("- {=u8}: fault {=u8}, {=istr}", count, number, text);
    }
}

pub(crate) fn not_armed(reason: NotArmed) {
    firmware::say_not_armed!(say, text, reason);
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

pub(crate) fn tuned(differ: bool) {
    if differ {
        defmt::warn!("settings differ from the scene's: whisker get says which");
    } else {
        defmt::info!("settings are the scene's");
    }
}

macro_rules! fault_text {
    ($($number:literal $constant:ident: $text:literal, $check:literal, $reaction:ident, $recovery:ident;)*) => {
        /// What is wrong, and likely causes, of each row of the table of faults.
        // Once in the program, as it takes nearly a kilobyte.
        #[inline(never)]
        fn text(number: u8) -> defmt::Str {
            match number {
                $($number if can_occur($number) => intern!($text),)*
                _ => intern!("not in the table (an older table?)"),
            }
        }
    };
}
firmware::fault_table!(fault_text);

pub(crate) fn fatal(number: u8) {
    firmware::say_board_fault!(say, text, number);
}

pub(crate) fn no_clock() {
    defmt::error!("- the PLL does not run");
}

pub(crate) fn event(event: &Event, names: &Names) {
    firmware::say_event!(
        say,
        *event,
        text,
        |class| names.class(class),
        [pace::period_us(), serial::lost()]
    );
    match *event {
        Event::SensorLost(_, fault) => sensor_lost(fault),
        Event::MotorFault(_, motor::Fault::InvalidHall(hall)) if Part::Motion.is_built() => {
            defmt::error!("- Hall code {=u8}", hall);
        }
        _ => {}
    }
}

fn sensor_lost(of: SensorFault) {
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
            let text = text(last);
            defmt::error!("- the last: fault {=u8}, {=istr}", last, text);
        }
        #[cfg(feature = "tmag5170")]
        SensorFault::Tilt(fault) => tilt_lost(fault),
        _ => {}
    }
}

#[cfg(feature = "tmag5170")]
fn tilt_lost(of: TiltFault) {
    match of {
        TiltFault::Reply(ReplyError::Rejected) => {
            defmt::error!("- it found wrong check bits in a command");
        }
        TiltFault::Reply(ReplyError::BadCrc { expected, found }) => {
            defmt::error!(
                "- a reply with check bits {=u8:#03x} instead of {=u8:#03x}",
                found,
                expected
            );
        }
        TiltFault::Reply(ReplyError::Sensor(status)) => {
            defmt::error!("- status {=u16:#05x}", status.bits());
        }
        TiltFault::Reported(faults) => {
            let (afe, sys) = (faults.afe_status(), faults.sys_status());
            defmt::error!("- AFE_STATUS {=u16:#06x}, SYS_STATUS {=u16:#06x}", afe, sys);
        }
        TiltFault::NotWritten(register) => {
            defmt::error!(
                "- register {=u8:#04x} does not read back",
                register.address()
            );
        }
        _ => {}
    }
}

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
