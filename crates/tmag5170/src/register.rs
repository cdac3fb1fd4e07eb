//! The registers: addresses, what they hold after a reset, which can be written.
//!
//! Sources: the data sheet's table of registers (SLYS052A for the two-die part, SBAS934A),
//! TI's example code (`tmag5170.h`, 2022) and Zephyr's driver agree on every address; the
//! first two on what a register holds after a reset.

/// A register. All are 16 bits wide.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Register {
    /// Averaging, operating mode, temperature channel: [`DeviceConfig`](crate::DeviceConfig).
    DeviceConfig = 0x00,
    /// Channels and ranges: [`SensorConfig`](crate::SensorConfig).
    SensorConfig = 0x01,
    /// Triggers, layout of replies, diagnostics: [`SystemConfig`](crate::SystemConfig).
    SystemConfig = 0x02,
    /// What the ALERT pin tells: [`AlertConfig`](crate::AlertConfig).
    AlertConfig = 0x03,
    /// AxisThresholds of X: [`AxisThresholds`](crate::AxisThresholds).
    XThresholds = 0x04,
    /// AxisThresholds of Y.
    YThresholds = 0x05,
    /// AxisThresholds of Z.
    ZThresholds = 0x06,
    /// AxisThresholds of the temperature.
    TemperatureThresholds = 0x07,
    /// What has been converted: [`ConversionStatus`](crate::ConversionStatus).
    ConversionStatus = 0x08,
    /// Field along X: [`Field`](crate::Field).
    X = 0x09,
    /// Field along Y.
    Y = 0x0A,
    /// Field along Z.
    Z = 0x0B,
    /// Temperature of the die: [`Temperature`](crate::Temperature).
    Temperature = 0x0C,
    /// What the sensor reports about its analogue part; the upper half of
    /// [`StatusFaults`](crate::StatusFaults).
    AfeStatus = 0x0D,
    /// What it reports about supply, pins, frames and thresholds; the lower half of
    /// [`StatusFaults`](crate::StatusFaults).
    SysStatus = 0x0E,
    /// Version of the part, and the switch of the CRC.
    TestConfig = 0x0F,
    /// Counter of the oscillator check.
    OscillatorMonitor = 0x10,
    /// Gain of one axis before the angle is computed.
    GainConfig = 0x11,
    /// Offsets of two axes before the angle is computed.
    OffsetConfig = 0x12,
    /// Angle between two axes: [`Angle`](crate::Angle).
    Angle = 0x13,
    /// Length of the vector of those two axes.
    Magnitude = 0x14,
}

impl Register {
    /// Every register, in the order of addresses, which begin at 0 and have no gap.
    pub const ALL: [Register; 21] = [
        Register::DeviceConfig,
        Register::SensorConfig,
        Register::SystemConfig,
        Register::AlertConfig,
        Register::XThresholds,
        Register::YThresholds,
        Register::ZThresholds,
        Register::TemperatureThresholds,
        Register::ConversionStatus,
        Register::X,
        Register::Y,
        Register::Z,
        Register::Temperature,
        Register::AfeStatus,
        Register::SysStatus,
        Register::TestConfig,
        Register::OscillatorMonitor,
        Register::GainConfig,
        Register::OffsetConfig,
        Register::Angle,
        Register::Magnitude,
    ];

    /// Its address, 0..=0x14.
    #[inline]
    pub const fn address(self) -> u8 {
        self as u8
    }

    /// The register at an address; `None` where none is documented.
    #[inline]
    pub const fn at(address: u8) -> Option<Register> {
        if (address as usize) < Register::ALL.len() {
            Some(Register::ALL[address as usize])
        } else {
            None
        }
    }

    /// What it holds after power-up. [`TestConfig`](Register::TestConfig) has the part's
    /// version besides: see [`Version`](crate::Version).
    pub const fn after_reset(self) -> u16 {
        match self {
            Register::XThresholds | Register::YThresholds | Register::ZThresholds => 0x7D83,
            Register::TemperatureThresholds => 0x6732,
            Register::AfeStatus => 0x8000,
            Register::TestConfig => 0x0040,
            _ => 0,
        }
    }

    /// Whether it is a setting. The data sheet lets
    /// [`ConversionStatus`](Register::ConversionStatus) be written too, without saying what
    /// for; here it counts as read-only.
    pub const fn is_setting(self) -> bool {
        matches!(
            self,
            Register::DeviceConfig
                | Register::SensorConfig
                | Register::SystemConfig
                | Register::AlertConfig
                | Register::XThresholds
                | Register::YThresholds
                | Register::ZThresholds
                | Register::TemperatureThresholds
                | Register::TestConfig
                | Register::GainConfig
                | Register::OffsetConfig
        )
    }
}
