//! What the sensor reports about itself, each with its likely cause.
//!
//! Sources: TI's example code and Kharim234's decoder agree on every bit; of two TI's forum has
//! said what sets them (a restart, the memory's check). The causes of the others follow from the
//! names of the checks in the data sheet (SBASAF4, 7.3.7) and are not verified against its text.

use core::fmt;
use core::ops::BitOr;

/// The two status registers: a bit field, several bits may be set. AFE_STATUS is the upper
/// half, SYS_STATUS the lower.
///
/// Displays as the names of all set bits, unknown ones in hexadecimal:
/// `restarted, supply too low, unknown 0x00400000`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct StatusFaults(u32);

/// A fault with its words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Its one bit.
    pub bit: StatusFaults,
    /// What it is called.
    pub name: &'static str,
    /// What is likely behind it.
    pub cause: &'static str,
}

macro_rules! faults {
    ($($(#[$about:meta])* $bit:ident = $bits:literal, $name:literal, $cause:literal;)+) => {
        impl StatusFaults {
            $($(#[$about])* pub const $bit: StatusFaults = StatusFaults($bits);)+

            /// Every fault that has a name, highest bit first.
            pub const KNOWN: [Fault; 18] = [
                $(Fault { bit: StatusFaults::$bit, name: $name, cause: $cause },)+
            ];

            /// All bits that have a name.
            const KNOWN_BITS: u32 = 0 $(| $bits)+;
        }
    };
}

faults! {
    /// CFG_RESET: the settings are those of a power-up. Reading the register clears it.
    RESTARTED = 0x8000_0000, "restarted",
        "just powered up, or a supply that broke down; configure it again";
    /// SENS_STAT: the signal chain of the fields failed its check.
    SIGNAL_CHAIN = 0x1000_0000, "signal chain",
        "supply noise; a broken part if it stays after a power cycle";
    /// TEMP_STAT: that of the temperature.
    TEMPERATURE_CHAIN = 0x0800_0000, "temperature chain",
        "supply noise; a broken part if it stays after a power cycle";
    /// ZHS_STAT: the Hall element of Z failed its check.
    HALL_Z = 0x0400_0000, "Hall element Z",
        "a broken part, by overvoltage or stress on the package";
    /// YHS_STAT: that of Y.
    HALL_Y = 0x0200_0000, "Hall element Y",
        "a broken part, by overvoltage or stress on the package";
    /// XHS_STAT: that of X.
    HALL_X = 0x0100_0000, "Hall element X",
        "a broken part, by overvoltage or stress on the package";
    /// TRIM_STAT: the memory of the factory's trim failed its CRC.
    TRIM = 0x0002_0000, "trim memory", "supply noise, if it goes away; otherwise a broken part";
    /// LDO_STAT: the internal supply is too low.
    INTERNAL_SUPPLY = 0x0001_0000, "internal supply too low",
        "a supply below 2.3 V, or no capacitor beside the part";
    /// ALRT_DRV: the ALERT pin is not at the level that it is driven to.
    ALERT_PIN = 0x0000_4000, "ALERT pin held", "ALERT shorted, or without a pull-up";
    /// SDO_DRV: the SDO pin is not at the level that it is driven to.
    SDO_PIN = 0x0000_2000, "SDO pin held", "SDO shorted, or another part that drives the line";
    /// CRC_STAT: a frame came with wrong check bits.
    FRAME_CRC = 0x0000_1000, "frame with a wrong CRC",
        "a clock too fast for the wires, or a master in another SPI mode";
    /// FRAME_STAT: a frame had not 32 clocks.
    FRAME_LENGTH = 0x0000_0800, "frame of a wrong length",
        "/CS raised before 32 clocks or after more, or noise on SCK";
    /// VCC_OV: the supply is too high.
    SUPPLY_HIGH = 0x0000_0020, "supply too high", "more than 5.5 V, or spikes on the supply";
    /// VCC_UV: the supply is too low.
    SUPPLY_LOW = 0x0000_0010, "supply too low", "less than 2.3 V, or a thin supply wire";
    /// TEMP_THX: the temperature is beyond its thresholds.
    TEMPERATURE_LIMIT = 0x0000_0008, "temperature beyond its limits",
        "heat from a motor, or limits set for another place";
    /// ZCH_THX: Z is beyond its thresholds.
    LIMIT_Z = 0x0000_0004, "Z beyond its limits", "magnet too near, or a range too narrow";
    /// YCH_THX: Y is beyond its thresholds.
    LIMIT_Y = 0x0000_0002, "Y beyond its limits", "magnet off the axis, or a stray field";
    /// XCH_THX: X is beyond its thresholds.
    LIMIT_X = 0x0000_0001, "X beyond its limits", "magnet off the axis, or a stray field";
}

impl StatusFaults {
    /// No bit set.
    pub const NONE: StatusFaults = StatusFaults(0);

    /// What SYS_STATUS holds besides faults: the level of ALERT and the operating state.
    const NO_FAULTS: u32 = 0x0000_8700;

    /// The faults in the two registers; what else SYS_STATUS holds is left out.
    pub const fn new(afe_status: u16, sys_status: u16) -> StatusFaults {
        StatusFaults((((afe_status as u32) << 16) | sys_status as u32) & !StatusFaults::NO_FAULTS)
    }

    /// Their bits in AFE_STATUS.
    pub const fn afe_status(self) -> u16 {
        (self.0 >> 16) as u16
    }

    /// Their bits in SYS_STATUS.
    pub const fn sys_status(self) -> u16 {
        self.0 as u16
    }

    /// Whether no bit is set.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether every bit of `other` is set.
    pub const fn contains(self, other: StatusFaults) -> bool {
        self.0 & other.0 == other.0
    }

    /// Without the bits of `other`.
    pub const fn without(self, other: StatusFaults) -> StatusFaults {
        StatusFaults(self.0 & !other.0)
    }

    /// The set bits that have no name.
    pub const fn unknown(self) -> u32 {
        self.0 & !StatusFaults::KNOWN_BITS
    }

    /// The set bits that have a name, highest first.
    pub fn named(self) -> impl Iterator<Item = Fault> + Clone {
        StatusFaults::KNOWN
            .into_iter()
            .filter(move |fault| self.contains(fault.bit))
    }
}

impl BitOr for StatusFaults {
    type Output = StatusFaults;

    fn bitor(self, other: StatusFaults) -> StatusFaults {
        StatusFaults(self.0 | other.0)
    }
}

impl fmt::Display for StatusFaults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return f.write_str("none");
        }
        let mut separator = "";
        for Fault { name, .. } in self.named() {
            write!(f, "{separator}{name}")?;
            separator = ", ";
        }
        match self.unknown() {
            0 => Ok(()),
            bits => write!(f, "{separator}unknown {bits:#010x}"),
        }
    }
}
