//! The error word: what the sensor reports about itself.
//!
//! Source: one vendor driver; other bits are kept and reported as unknown.

use core::fmt;
use core::ops::BitOr;

/// The error word of an alpha-beta frame: a bit field, several bits may be set.
///
/// Displays as the names of all set bits, unknown ones in hexadecimal:
/// `gain too high, field too low, unknown 0x0001`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Faults(u16);

macro_rules! faults {
    ($($(#[$about:meta])* $bit:ident = $bits:literal, $name:literal;)+) => {
        impl Faults {
            $($(#[$about])* pub const $bit: Faults = Faults($bits);)+

            const KNOWN: [(Faults, &'static str); 10] = [$((Faults::$bit, $name),)+];
            const KNOWN_BITS: u16 = 0 $(| $bits)+;
        }
    };
}

faults! {
    /// The converter's self-test failed. Likely cause: supply noise or a
    /// brown-out; if it stays after a power cycle, a broken part.
    ADC_MONITOR = 0x0004, "ADC monitor";
    /// The converter is at its end stop. Likely cause: magnet too close, or
    /// the gain programmed too high for it.
    ADC_SATURATED = 0x0008, "ADC saturated";
    /// The automatic gain is at its lower end. Likely cause: magnet too strong or too close.
    GAIN_TOO_LOW = 0x0010, "gain too low";
    /// The automatic gain is at its upper end. Likely cause: magnet too weak, too far, or missing.
    GAIN_TOO_HIGH = 0x0020, "gain too high";
    /// The norm of the field vector is below its limit. Likely cause: magnet
    /// off the sensor's axis or too far.
    NORM_TOO_LOW = 0x0040, "norm too low";
    /// The field is too weak to measure. Likely cause: magnet missing or loose.
    FIELD_TOO_LOW = 0x0080, "field too low";
    /// The field is too strong to measure. Likely cause: magnet too close, or
    /// a motor's stray field.
    FIELD_TOO_HIGH = 0x0100, "field too high";
    /// The rough offset correction is at its limit. Likely cause: a strong
    /// constant field besides the magnet's, or a calibration of another part.
    ROUGH_OFFSET_CLAMP = 0x0200, "rough offset clamp";
    /// Alpha is in its dead zone. Likely cause: deflection beyond the programmed transfer curve.
    DEAD_ZONE_ALPHA = 0x0800, "dead zone alpha";
    /// Beta is in its dead zone. Likely cause: deflection beyond the programmed transfer curve.
    DEAD_ZONE_BETA = 0x8000, "dead zone beta";
}

impl Faults {
    /// No bit set: the reading is valid.
    pub const NONE: Faults = Faults(0);

    /// The faults of an error word.
    pub const fn new(bits: u16) -> Faults {
        Faults(bits)
    }

    /// The error word.
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// Whether no bit is set.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether every bit of `other` is set.
    pub const fn contains(self, other: Faults) -> bool {
        self.0 & other.0 == other.0
    }

    /// The set bits that have no name.
    pub const fn unknown(self) -> u16 {
        self.0 & !Faults::KNOWN_BITS
    }

    /// The set bits that have a name, one at a time with it, lowest first.
    pub fn named(self) -> impl Iterator<Item = (Faults, &'static str)> + Clone {
        Faults::KNOWN
            .into_iter()
            .filter(move |&(fault, _)| self.contains(fault))
    }
}

impl BitOr for Faults {
    type Output = Faults;

    fn bitor(self, other: Faults) -> Faults {
        Faults(self.0 | other.0)
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return f.write_str("none");
        }
        let mut separator = "";
        for (_, name) in self.named() {
            write!(f, "{separator}{name}")?;
            separator = ", ";
        }
        match self.unknown() {
            0 => Ok(()),
            bits => write!(f, "{separator}unknown {bits:#06x}"),
        }
    }
}
