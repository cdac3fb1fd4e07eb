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
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Faults(u16);

impl Faults {
    /// No bit set: the reading is valid.
    pub const NONE: Faults = Faults(0);

    /// The converter's self-test failed. Likely cause: supply noise or a
    /// brown-out; if it stays after a power cycle, a broken part.
    pub const ADC_MONITOR: Faults = Faults(0x0004);

    /// The converter is at its end stop. Likely cause: magnet too close, or
    /// the gain programmed too high for it.
    pub const ADC_SATURATED: Faults = Faults(0x0008);

    /// The automatic gain is at its lower end. Likely cause: magnet too strong
    /// or too close.
    pub const GAIN_TOO_LOW: Faults = Faults(0x0010);

    /// The automatic gain is at its upper end. Likely cause: magnet too weak,
    /// too far, or missing.
    pub const GAIN_TOO_HIGH: Faults = Faults(0x0020);

    /// The norm of the field vector is below its limit. Likely cause: magnet
    /// off the sensor's axis or too far.
    pub const NORM_TOO_LOW: Faults = Faults(0x0040);

    /// The field is too weak to measure. Likely cause: magnet missing or
    /// loose.
    pub const FIELD_TOO_LOW: Faults = Faults(0x0080);

    /// The field is too strong to measure. Likely cause: magnet too close, or
    /// a motor's stray field.
    pub const FIELD_TOO_HIGH: Faults = Faults(0x0100);

    /// The rough offset correction is at its limit. Likely cause: a strong
    /// constant field besides the magnet's, or a calibration of another part.
    pub const ROUGH_OFFSET_CLAMP: Faults = Faults(0x0200);

    /// Alpha is in its dead zone. Likely cause: deflection beyond the
    /// programmed transfer curve.
    pub const DEAD_ZONE_ALPHA: Faults = Faults(0x0800);

    /// Beta is in its dead zone. Likely cause: deflection beyond the
    /// programmed transfer curve.
    pub const DEAD_ZONE_BETA: Faults = Faults(0x8000);

    /// In the order of the bits.
    const KNOWN: [(Faults, &'static str); 10] = [
        (Faults::ADC_MONITOR, "ADC monitor"),
        (Faults::ADC_SATURATED, "ADC saturated"),
        (Faults::GAIN_TOO_LOW, "gain too low"),
        (Faults::GAIN_TOO_HIGH, "gain too high"),
        (Faults::NORM_TOO_LOW, "norm too low"),
        (Faults::FIELD_TOO_LOW, "field too low"),
        (Faults::FIELD_TOO_HIGH, "field too high"),
        (Faults::ROUGH_OFFSET_CLAMP, "rough offset clamp"),
        (Faults::DEAD_ZONE_ALPHA, "dead zone alpha"),
        (Faults::DEAD_ZONE_BETA, "dead zone beta"),
    ];

    const KNOWN_BITS: u16 = {
        let mut bits = 0;
        let mut i = 0;
        while i < Faults::KNOWN.len() {
            bits |= Faults::KNOWN[i].0.0;
            i += 1;
        }
        bits
    };

    /// The faults of an error word.
    #[inline]
    pub const fn new(bits: u16) -> Faults {
        Faults(bits)
    }

    /// The error word.
    #[inline]
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// Whether no bit is set.
    #[inline]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether every bit of `other` is set.
    #[inline]
    pub const fn contains(self, other: Faults) -> bool {
        self.0 & other.0 == other.0
    }

    /// The set bits that have no name.
    #[inline]
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

    #[inline]
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
