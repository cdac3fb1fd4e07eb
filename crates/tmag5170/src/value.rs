//! What result registers hold: fields, temperatures, angles.
//!
//! Sources: the data sheet's data definitions as computed by TI's example code
//! (`resultRegisterTomT`, `getMeasurementsSpcl`), Zephyr's driver and Kharim234's decoder,
//! which agree.

/// The field along one axis: 16 bits with a sign, full scale of the axis's range at 32,768.
///
/// With one conversion an average the lowest four bits are 0; a pair carries the upper
/// twelve only.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Field(i16);

impl Field {
    /// From the bits of a result register.
    pub const fn new(register: u16) -> Field {
        Field(register as i16)
    }

    /// From the lower twelve bits, as a pair carries them.
    pub const fn from_12(bits: u16) -> Field {
        Field::new(bits << 4)
    }

    /// The code, −32,768..=32,767.
    pub const fn code(self) -> i16 {
        self.0
    }

    /// The field in units of `full_scale_mt`, in millitesla for a full scale in millitesla:
    /// `code / 32768 · full_scale`.
    ///
    /// Arithmetic error: one rounding, 6e-8 of the result.
    pub const fn mt(self, full_scale_mt: f32) -> f32 {
        self.0 as f32 * (1.0 / 32_768.0) * full_scale_mt
    }

    /// The code nearest to a field, both in millitesla, for a simulated sensor: limited to
    /// the full scale; NaN gives 0.
    pub const fn from_mt(field_mt: f32, full_scale_mt: f32) -> Field {
        let scaled = field_mt / full_scale_mt * 32_768.0;
        // A cast cuts, limits to the range, and makes NaN zero.
        Field((scaled + 0.5_f32.copysign(scaled)) as i16)
    }
}

/// The temperature of the die: 17,522 at 25 °C, 60 a degree, both typical.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Temperature(u16);

impl Temperature {
    /// From the bits of the result register.
    pub const fn new(register: u16) -> Temperature {
        Temperature(register)
    }

    /// From the lower twelve bits, as a pair carries them.
    pub const fn from_12(bits: u16) -> Temperature {
        Temperature::new(bits << 4)
    }

    /// The code, 0..=65,535.
    pub const fn code(self) -> u16 {
        self.0
    }

    /// In degrees Celsius: `25 + (code − 17522) / 60`. The part's own error is up to 2 °C.
    pub const fn celsius(self) -> f32 {
        25.0 + (self.0 as f32 - 17_522.0) / 60.0
    }

    /// The code nearest to a temperature in degrees Celsius, for a simulated sensor; NaN
    /// gives 0.
    pub const fn from_celsius(celsius: f32) -> Temperature {
        // Codes below 0 are limited by the cast.
        Temperature((17_522.0 + 60.0 * (celsius - 25.0) + 0.5) as u16)
    }
}

/// The angle between two axes: degrees with four binary places.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Angle(u16);

impl Angle {
    /// From the bits of the result register, of which the upper three are always 0.
    pub const fn new(register: u16) -> Angle {
        Angle(register & 0x1FFF)
    }

    /// From the lower twelve bits, as a pair carries them: with three binary places.
    pub const fn from_12(bits: u16) -> Angle {
        Angle::new(bits << 1)
    }

    /// In degrees, 0 to 360: `code / 16`, exact.
    pub const fn degrees(self) -> f32 {
        self.0 as f32 / 16.0
    }
}
