//! One 16-bit reading and its unscaled and scaled forms.

/// A 16-bit reading: alpha, beta, X, Y or Z.
///
/// 0 is the start and 65535 the end of the transfer curve programmed into the sensor. The sensor
/// resolves 14 bits: the upper 14 are the *code*, the lower two carry nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Word(u16);

impl Word {
    /// The middle of the curve: code 8192, [`Word::normalised`] 0.
    pub const MID: Word = Word(0x8000);

    /// A reading from its 16 bits.
    pub const fn new(raw: u16) -> Word {
        Word(raw)
    }

    /// The 16 bits as sent.
    pub const fn raw(self) -> u16 {
        self.0
    }

    /// The 14-bit code, 0..=16383.
    pub const fn code14(self) -> u16 {
        self.0 >> 2
    }

    /// The code about mid-scale, `code14 − 8192`: −8192..=8191.
    pub const fn signed14(self) -> i16 {
        self.code14() as i16 - 8192
    }

    /// The reading as an angle from the start of the curve, in degrees:
    /// `raw / 65535 · full_scale_deg`.
    ///
    /// `full_scale_deg` is the span of the programmed curve (360 for a full
    /// turn); any finite value will do.
    ///
    /// Arithmetic error: at most 1.2e-7 of the result (two roundings). One
    /// step of the 14-bit code is 4/65535 of full scale, 0.022° of 360°; the
    /// largest code, raw 65532, reads 4.6e-5 short of full scale.
    pub const fn angle_deg(self, full_scale_deg: f32) -> f32 {
        // The scale first: with a constant full scale it costs nothing.
        self.0 as f32 * (full_scale_deg / 65535.0)
    }

    /// The reading as a deflection in [−1, 1]: `max((code14 − 8192) / 8191, −1)`.
    ///
    /// Codes 0 and 1 both read −1, so that mid-scale is exactly 0 and the
    /// largest code exactly 1. Arithmetic error: at most 8e-8, absolute.
    pub const fn normalised(self) -> f32 {
        // The limit is one code away from code 0, and from no other.
        let limited = self.signed14() + (self.code14() == 0) as i16;
        // A product with the rounded reciprocal (2⁻²⁶ off) costs one cycle
        // where the quotient costs fourteen.
        limited as f32 * (1.0 / 8191.0)
    }

    /// The reading nearest to a deflection: the inverse of
    /// [`Word::normalised`], for a slave or a simulator.
    ///
    /// `x` is limited to [−1, 1], infinities included; NaN gives
    /// [`Word::MID`]. The lower two bits of the result are 0.
    ///
    /// Round trip: `from_normalised(x).normalised()` is within half a code,
    /// 6.12e-5, of `x` in [−1, 1]. The other way, every word returns with its
    /// lower two bits cleared, except that code 0 returns as code 1.
    pub const fn from_normalised(x: f32) -> Word {
        if x.is_nan() {
            return Word::MID;
        }
        let scaled = x.clamp(-1.0, 1.0) * 8191.0;
        // Adding half away from zero, then cutting, rounds to nearest.
        let signed = (scaled + 0.5_f32.copysign(scaled)) as i32;
        // 1..=16383, so neither the sum nor the shift leaves 16 bits.
        Word(((signed + 8192) as u16) << 2)
    }
}
