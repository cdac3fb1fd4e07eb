//! The settings, register by register. What fields may hold is in `config/fields.rs`.
//!
//! Sources: TI's example code (`tmag5170.h`, 2022) and light655's library (`TMAG5170.hpp`) have
//! every field and value and agree; so do brain113's crate and Kharim234's decoder wherever
//! they name one, except where a field says so.

mod fields;

pub use fields::{
    AlertMode, AnglePair, Average, Channels, DataType, Diagnostics, MagnetType, OperatingMode,
    Range, SleepTime, Trigger, Version,
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
    /// Checks the temperature against its thresholds.
    pub temperature_limits: bool,
}

impl DeviceConfig {
    /// As the register holds it.
    pub const fn bits(self) -> u16 {
        self.average.bits()
            | self.magnet.bits()
            | self.mode.bits()
            | bit(self.temperature, 3)
            | bit(self.temperature_once, 2)
            | bit(self.temperature_limits, 1)
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

/// What starts a conversion, how replies are laid out, and which checks run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SystemConfig {
    /// Checks of the analogue part.
    pub diagnostics: Diagnostics,
    /// What starts a conversion in the modes that wait for one.
    pub trigger: Trigger,
    /// What a reply carries.
    pub data_type: DataType,
    /// Checks X, Y and Z against their thresholds.
    pub limits: [bool; 3],
}

impl SystemConfig {
    /// As the register holds it.
    pub const fn bits(self) -> u16 {
        let [x, y, z] = self.limits;
        self.diagnostics.bits()
            | self.trigger.bits()
            | self.data_type.bits()
            | bit(z, 2)
            | bit(y, 1)
            | bit(x, 0)
    }
}

/// What the ALERT pin, an open drain that pulls low, reports. With everything off that is nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct AlertConfig {
    /// What kind of pin it is.
    pub mode: AlertMode,
    /// Stays asserted until it is read.
    pub latched: bool,
    /// Reports [`StatusFaults`](crate::StatusFaults).
    pub faults: bool,
    /// Reports each finished conversion.
    pub results: bool,
    /// Conversions beyond a threshold in succession before it counts, 1 to 4; others count
    /// as the nearest of these.
    pub crossings: u8,
    /// Reports crossed thresholds of X, Y, Z and the temperature.
    pub thresholds: [bool; 4],
}

impl AlertConfig {
    /// As the register holds it.
    pub const fn bits(self) -> u16 {
        let [x, y, z, t] = self.thresholds;
        let crossings = match self.crossings {
            0 | 1 => 0x0000,
            2 => 0x0010,
            3 => 0x0020,
            _ => 0x0030,
        };
        self.mode.bits()
            | crossings
            | bit(self.latched, 13)
            | bit(self.faults, 11)
            | bit(self.results, 8)
            | bit(t, 3)
            | bit(z, 2)
            | bit(y, 1)
            | bit(x, 0)
    }
}

/// Two thresholds of an axis, each in 1/128 of its full scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct AxisThresholds {
    /// Above this is beyond.
    pub high: i8,
    /// Below this is beyond.
    pub low: i8,
}

impl Default for AxisThresholds {
    /// ±98 % of full scale, as after a reset.
    fn default() -> AxisThresholds {
        AxisThresholds {
            high: 125,
            low: -125,
        }
    }
}

impl AxisThresholds {
    /// As the register holds it.
    pub const fn bits(self) -> u16 {
        u16::from_be_bytes([self.high as u8, self.low as u8])
    }
}

/// All settings that [`Tmag5170::configure`](crate::Tmag5170::configure) writes. The default
/// is what the sensor has after a reset, where it measures nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Config {
    /// Averaging and operating mode.
    pub device: DeviceConfig,
    /// Channels and ranges.
    pub sensor: SensorConfig,
    /// Triggers, replies, checks.
    pub system: SystemConfig,
    /// The ALERT pin.
    pub alert: AlertConfig,
    /// Thresholds of X, Y and Z.
    pub thresholds: [AxisThresholds; 3],
}
