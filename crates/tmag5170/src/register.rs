//! The registers: addresses, what they hold after a reset, which can be written.
//!
//! Sources: the data sheet's table of registers (SLYS052A for the two-die part, SBAS934A),
//! TI's example code (`tmag5170.h`, 2022) and Zephyr's driver agree on every address; the
//! first two on what a register holds after a reset.

/// The registers in the order of addresses: what each holds after a reset, whether it is a
/// setting, and its documentation.
macro_rules! registers {
    ($($name:ident = $after_reset:literal, $is_setting:literal, $about:literal;)+) => {
        /// A register. All are 16 bits wide.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u8)]
        pub enum Register {
            $(#[doc = $about] $name,)+
        }

        impl Register {
            /// Every register, in the order of addresses, which begin at 0 and have no gap.
            pub const ALL: [Register; 21] = [$(Register::$name,)+];

            /// What it holds after power-up. [`TestConfig`](Register::TestConfig) has the part's
            /// version besides: see [`Version`](crate::Version).
            pub const fn after_reset(self) -> u16 {
                [$($after_reset,)+][self as usize]
            }

            /// Whether it is a setting. The data sheet lets
            /// [`ConversionStatus`](Register::ConversionStatus) be written too, without saying
            /// what for; here it counts as read-only.
            pub const fn is_setting(self) -> bool {
                [$($is_setting,)+][self as usize]
            }
        }
    };
}

registers! {
    DeviceConfig = 0x0000, true,
        "Averaging, operating mode, temperature channel: [`DeviceConfig`](crate::DeviceConfig).";
    SensorConfig = 0x0000, true, "Channels and ranges: [`SensorConfig`](crate::SensorConfig).";
    SystemConfig = 0x0000, true,
        "Triggers, diagnostics: [`SystemConfig`](crate::SystemConfig).";
    AlertConfig = 0x0000, true, "What the ALERT pin reports.";
    XThresholds = 0x7D83, true, "Thresholds of X, 98 % of full scale both ways after a reset.";
    YThresholds = 0x7D83, true, "Thresholds of Y.";
    ZThresholds = 0x7D83, true, "Thresholds of Z.";
    TemperatureThresholds = 0x6732, true, "Thresholds of the temperature.";
    ConversionStatus = 0x0000, false, "What has been converted.";
    X = 0x0000, false, "Field along X: [`Field`](crate::Field).";
    Y = 0x0000, false, "Field along Y.";
    Z = 0x0000, false, "Field along Z.";
    Temperature = 0x0000, false, "Temperature of the die: 17,522 at 25 °C, 60 a degree.";
    AfeStatus = 0x8000, false,
        "What the sensor reports about its analogue part; the upper half of
        [`StatusFaults`](crate::StatusFaults).";
    SysStatus = 0x0000, false,
        "What it reports about supply, pins, frames and thresholds; the lower half of
        [`StatusFaults`](crate::StatusFaults).";
    TestConfig = 0x0040, true, "Version of the part, and the switch of the CRC.";
    OscillatorMonitor = 0x0000, false, "Counter of the oscillator check.";
    GainConfig = 0x0000, true, "Gain of one axis before the angle is computed.";
    OffsetConfig = 0x0000, true, "Offsets of two axes before the angle is computed.";
    Angle = 0x0000, false, "Angle between two axes, in 1/16 degree.";
    Magnitude = 0x0000, false, "Length of the vector of those two axes.";
}

impl Register {
    /// Its address, 0..=0x14.
    pub const fn address(self) -> u8 {
        self as u8
    }

    /// The register at an address; `None` where none is documented.
    pub fn at(address: u8) -> Option<Register> {
        Register::ALL.get(usize::from(address)).copied()
    }
}
