//! The settings, register by register. What fields may hold is in `config/fields.rs`.
//!
//! Sources: TI's example code (`tmag5170.h`, 2022) and light655's library (`TMAG5170.hpp`) have
//! every field and value and agree; so do brain113's crate and Kharim234's decoder wherever
//! they name one, except where a field says so.

mod fields;

pub use fields::{
    AnglePair, Average, Channels, Diagnostics, MagnetType, OperatingMode, Range, SleepTime,
    Trigger, Version,
};

const fn bit(is_set: bool, place: u32) -> u16 {
    (is_set as u16) << place
}

/// How often and what of the temperature is measured, and when.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct DeviceConfig {
    /// Conversions an average.
    pub average: Average,
    /// The magnet's loss with temperature that the sensor makes good.
    pub magnet: MagnetType,
    /// When the sensor measures.
    pub mode: OperatingMode,
    /// Measures the temperature too.
    pub temperature: bool,
    /// Converts the temperature once a set, whatever the average.
    pub temperature_once: bool,
}

impl DeviceConfig {
    /// As the register holds it.
    pub const fn bits(self) -> u16 {
        self.average.bits()
            | self.magnet.bits()
            | self.mode.bits()
            | bit(self.temperature, 3)
            | bit(self.temperature_once, 2)
    }
}

/// Which axes are measured, and how far they reach.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SensorConfig {
    /// The axes that the angle is computed from.
    pub angle: AnglePair,
    /// Time between wake-ups in [`OperatingMode::WakeAndSleep`].
    pub sleep: SleepTime,
    /// The axes that are measured, and in which order.
    pub channels: Channels,
    /// Ranges of X, Y and Z.
    pub ranges: [Range; 3],
}

impl SensorConfig {
    /// As the register holds it.
    pub const fn bits(self) -> u16 {
        let [x, y, z] = self.ranges;
        self.angle.bits()
            | self.sleep.bits()
            | self.channels.bits()
            | (z.bits() << 4)
            | (y.bits() << 2)
            | x.bits()
    }
}

/// What starts a conversion, and which checks run. Replies carry registers, and nothing is held
/// against thresholds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SystemConfig {
    /// Checks of the analogue part.
    pub diagnostics: Diagnostics,
    /// What starts a conversion in the modes that wait for one.
    pub trigger: Trigger,
}

impl SystemConfig {
    /// As the register holds it.
    pub const fn bits(self) -> u16 {
        self.diagnostics.bits() | self.trigger.bits()
    }
}

/// The settings that [`Tmag5170::configure`](crate::Tmag5170::configure) writes; thresholds and the
/// ALERT pin are as after a reset. The default is what the sensor has then, where it measures
/// nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Config {
    /// Averaging and operating mode.
    pub device: DeviceConfig,
    /// Channels and ranges.
    pub sensor: SensorConfig,
    /// Triggers, checks.
    pub system: SystemConfig,
}
