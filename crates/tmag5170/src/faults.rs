//! What the sensor reports about itself, each with its likely cause.
//!
//! Sources: TI's example code and Kharim234's decoder agree on every bit; of two TI's forum
//! has said what sets them (a restart, the memory's check). The causes of the others follow
//! from the names of the checks in the data sheet (SBASAF4, 7.3.7) and are not verified
//! against its text.

use core::fmt;
use core::ops::BitOr;

/// The two status registers: a bit field, several bits may be set. AFE_STATUS is the upper
/// half, SYS_STATUS the lower.
///
/// Displays as the names of all set bits, unknown ones in hexadecimal:
/// `restarted, supply too low, unknown 0x00400000`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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

const fn row(bit: StatusFaults, name: &'static str, cause: &'static str) -> Fault {
    Fault { bit, name, cause }
}

impl StatusFaults {
    /// No bit set.
    pub const NONE: StatusFaults = StatusFaults(0);
    /// CFG_RESET: the settings are those of a power-up. Reading the register clears it.
    pub const RESTARTED: StatusFaults = StatusFaults(0x8000_0000);
    /// SENS_STAT: the signal chain of the fields failed its check.
    pub const SIGNAL_CHAIN: StatusFaults = StatusFaults(0x1000_0000);
    /// TEMP_STAT: that of the temperature.
    pub const TEMPERATURE_CHAIN: StatusFaults = StatusFaults(0x0800_0000);
    /// ZHS_STAT: the Hall element of Z failed its check.
    pub const HALL_Z: StatusFaults = StatusFaults(0x0400_0000);
    /// YHS_STAT: that of Y.
    pub const HALL_Y: StatusFaults = StatusFaults(0x0200_0000);
    /// XHS_STAT: that of X.
    pub const HALL_X: StatusFaults = StatusFaults(0x0100_0000);
    /// TRIM_STAT: the memory of the factory's trim failed its CRC.
    pub const TRIM: StatusFaults = StatusFaults(0x0002_0000);
    /// LDO_STAT: the internal supply is too low.
    pub const INTERNAL_SUPPLY: StatusFaults = StatusFaults(0x0001_0000);
    /// ALRT_DRV: the ALERT pin is not at the level that it is driven to.
    pub const ALERT_PIN: StatusFaults = StatusFaults(0x0000_4000);
    /// SDO_DRV: the SDO pin is not at the level that it is driven to.
    pub const SDO_PIN: StatusFaults = StatusFaults(0x0000_2000);
    /// CRC_STAT: a frame came with wrong check bits.
    pub const FRAME_CRC: StatusFaults = StatusFaults(0x0000_1000);
    /// FRAME_STAT: a frame had not 32 clocks.
    pub const FRAME_LENGTH: StatusFaults = StatusFaults(0x0000_0800);
    /// VCC_OV: the supply is too high.
    pub const SUPPLY_HIGH: StatusFaults = StatusFaults(0x0000_0020);
    /// VCC_UV: the supply is too low.
    pub const SUPPLY_LOW: StatusFaults = StatusFaults(0x0000_0010);
    /// TEMP_THX: the temperature is beyond its thresholds.
    pub const TEMPERATURE_LIMIT: StatusFaults = StatusFaults(0x0000_0008);
    /// ZCH_THX: Z is beyond its thresholds.
    pub const LIMIT_Z: StatusFaults = StatusFaults(0x0000_0004);
    /// YCH_THX: Y is beyond its thresholds.
    pub const LIMIT_Y: StatusFaults = StatusFaults(0x0000_0002);
    /// XCH_THX: X is beyond its thresholds.
    pub const LIMIT_X: StatusFaults = StatusFaults(0x0000_0001);

    /// Every fault that has a name, highest bit first.
    pub const KNOWN: [Fault; 18] = [
        row(
            StatusFaults::RESTARTED,
            "restarted",
            "just powered up, or a supply that broke down; configure it again",
        ),
        row(
            StatusFaults::SIGNAL_CHAIN,
            "signal chain",
            "supply noise; a broken part if it stays after a power cycle",
        ),
        row(
            StatusFaults::TEMPERATURE_CHAIN,
            "temperature chain",
            "supply noise; a broken part if it stays after a power cycle",
        ),
        row(
            StatusFaults::HALL_Z,
            "Hall element Z",
            "a broken part, by overvoltage or stress on the package",
        ),
        row(
            StatusFaults::HALL_Y,
            "Hall element Y",
            "a broken part, by overvoltage or stress on the package",
        ),
        row(
            StatusFaults::HALL_X,
            "Hall element X",
            "a broken part, by overvoltage or stress on the package",
        ),
        row(
            StatusFaults::TRIM,
            "trim memory",
            "supply noise, if it goes away; otherwise a broken part",
        ),
        row(
            StatusFaults::INTERNAL_SUPPLY,
            "internal supply too low",
            "a supply below 2.3 V, or no capacitor beside the part",
        ),
        row(
            StatusFaults::ALERT_PIN,
            "ALERT pin held",
            "ALERT shorted, or without a pull-up",
        ),
        row(
            StatusFaults::SDO_PIN,
            "SDO pin held",
            "SDO shorted, or another part that drives the line",
        ),
        row(
            StatusFaults::FRAME_CRC,
            "frame with a wrong CRC",
            "a clock too fast for the wires, or a master in another SPI mode",
        ),
        row(
            StatusFaults::FRAME_LENGTH,
            "frame of a wrong length",
            "/CS raised before 32 clocks or after more, or noise on SCK",
        ),
        row(
            StatusFaults::SUPPLY_HIGH,
            "supply too high",
            "more than 5.5 V, or spikes on the supply",
        ),
        row(
            StatusFaults::SUPPLY_LOW,
            "supply too low",
            "less than 2.3 V, or a thin supply wire",
        ),
        row(
            StatusFaults::TEMPERATURE_LIMIT,
            "temperature beyond its limits",
            "heat from a motor, or limits set for another place",
        ),
        row(
            StatusFaults::LIMIT_Z,
            "Z beyond its limits",
            "magnet too near, or a range too narrow",
        ),
        row(
            StatusFaults::LIMIT_Y,
            "Y beyond its limits",
            "magnet off the axis, or a stray field",
        ),
        row(
            StatusFaults::LIMIT_X,
            "X beyond its limits",
            "magnet off the axis, or a stray field",
        ),
    ];

    /// What SYS_STATUS holds besides faults: the level of ALERT and the operating state.
    const NO_FAULTS: u32 = 0x0000_8700;

    /// All bits that have a name.
    const KNOWN_BITS: u32 = {
        let mut bits = 0;
        let mut i = 0;
        while i < StatusFaults::KNOWN.len() {
            bits |= StatusFaults::KNOWN[i].bit.0;
            i += 1;
        }
        bits
    };

    /// The faults in the two registers; what else SYS_STATUS holds is left out.
    #[inline]
    pub const fn new(afe_status: u16, sys_status: u16) -> StatusFaults {
        StatusFaults((((afe_status as u32) << 16) | sys_status as u32) & !StatusFaults::NO_FAULTS)
    }

    /// Their bits in AFE_STATUS.
    #[inline]
    pub const fn afe_status(self) -> u16 {
        (self.0 >> 16) as u16
    }

    /// Their bits in SYS_STATUS.
    #[inline]
    pub const fn sys_status(self) -> u16 {
        self.0 as u16
    }

    /// Whether no bit is set.
    #[inline]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether every bit of `other` is set.
    #[inline]
    pub const fn contains(self, other: StatusFaults) -> bool {
        self.0 & other.0 == other.0
    }

    /// Without the bits of `other`.
    #[inline]
    pub const fn without(self, other: StatusFaults) -> StatusFaults {
        StatusFaults(self.0 & !other.0)
    }

    /// The set bits that have no name.
    #[inline]
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

    #[inline]
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
