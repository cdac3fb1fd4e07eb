//! What the result registers of the axes hold.
//!
//! Sources: the data sheet's data definitions as computed by TI's example code
//! (`resultRegisterTomT`, `getMeasurementsSpcl`), Zephyr's driver and Kharim234's decoder,
//! which agree.

/// The field along one axis: 16 bits with a sign, full scale of the axis's range at 32,768.
///
/// With one conversion an average the lowest four bits are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Field(i16);

impl Field {
    /// From the bits of a result register.
    pub const fn new(register: u16) -> Field {
        Field(register as i16)
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
