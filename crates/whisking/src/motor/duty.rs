//! The signed drive of a motor as a fixed-point fraction.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

/// Signed drive in Q15: the integer `n` stands for `n / 32767` of the supply.
///
/// Range −32767 (full retraction) to +32767 (full protraction); −32768 does
/// not occur, so that both directions are alike and negation cannot overflow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize)]
#[serde(transparent)]
pub struct Duty(i16);

/// Not every integer is a duty, so that what is read is checked.
impl<'de> Deserialize<'de> for Duty {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let q15 = i16::deserialize(deserializer)?;
        if q15 == i16::MIN {
            return Err(D::Error::custom("-32768 is no duty"));
        }
        Ok(Self(q15))
    }
}

impl Duty {
    /// No drive.
    pub const ZERO: Self = Self(0);
    /// Full protraction.
    pub const FULL: Self = Self(i16::MAX);

    /// From a Q15 integer; −32768 is folded to −32767.
    #[inline]
    pub const fn from_q15(q15: i16) -> Self {
        if q15 == i16::MIN {
            Self(-i16::MAX)
        } else {
            Self(q15)
        }
    }

    /// From a fraction of full drive in Q24, −2^24 to 2^24: the step below or the nearest.
    #[inline]
    pub(crate) const fn from_q24(fraction: i32) -> Self {
        // Full drive is 32767 steps of 2^9 and not 32768: 2^24 (1 − 2^-15).
        Self(((fraction - (fraction >> 15) + (1 << 8)) >> 9) as i16)
    }

    /// From a fraction of full drive, clipped to \[−1, 1\]; NaN gives
    /// [`Duty::ZERO`].
    ///
    /// Rounded to nearest, halves away from zero; error at most 0.504 of a
    /// step, the excess over 0.5 being the rounding of the product in f32.
    #[inline]
    pub fn from_f32(fraction: f32) -> Self {
        let scaled = fraction.clamp(-1.0, 1.0) * f32::from(i16::MAX);
        // A float-to-integer cast drops the fraction, saturates and turns NaN
        // into zero; |scaled| + 0.5 stays below 32768.
        Self((scaled + 0.5_f32.copysign(scaled)) as i16)
    }

    /// The Q15 integer, −32767 to 32767.
    #[inline]
    pub const fn q15(self) -> i16 {
        self.0
    }

    /// The size of the drive, 0 to 32767.
    #[inline]
    pub const fn magnitude(self) -> u16 {
        self.0.unsigned_abs()
    }

    /// Whether it drives towards protraction. False for zero, which has no
    /// direction; the drivers keep their last one then.
    #[inline]
    pub const fn is_forward(self) -> bool {
        self.0 > 0
    }

    /// The magnitude in counts of a PWM timer: `magnitude · max / 32767`
    /// rounded to nearest, never above `max`, exactly `max` at full drive.
    #[inline]
    pub const fn scaled_to(self, max: u16) -> u16 {
        const ONE: u32 = i16::MAX as u32;
        // At most 32767 · 65535 + 16384 < 2^31; the quotient is at most max.
        let above = self.magnitude() as u32 * max as u32 + ONE / 2 + 1;
        // Divided by 2^15 − 1 without a division, which a small core does not have:
        // 1/(2^15 − 1) is 2^-15 + 2^-30 + 2^-45 and so on.
        ((above + ((above + (above >> 15)) >> 15)) >> 15) as u16
    }
}

#[cfg(test)]
mod tests {
    use super::Duty;

    #[test]
    fn counts_are_those_of_a_division() {
        for max in (1..=u16::MAX).rev().step_by(251) {
            for q15 in 0..=i16::MAX {
                let exact = (u32::from(q15.unsigned_abs()) * u32::from(max) + 16_383) / 32_767;
                for duty in [q15, -q15].map(Duty::from_q15) {
                    assert_eq!(u32::from(duty.scaled_to(max)), exact, "{duty:?} {max}");
                }
            }
        }
    }

    #[test]
    fn q24_gives_the_step_below_or_the_nearest_and_both_ends() {
        for (fraction, q15) in [
            (0, 0),
            (1 << 24, 32_767),
            (-(1 << 24), -32_767),
            (1 << 23, 16_384),
            (-(1 << 23), -16_383),
        ] {
            assert_eq!(Duty::from_q24(fraction).q15(), q15, "{fraction}");
        }
        for fraction in (-(1 << 24)..=1 << 24).step_by(997) {
            let exact = f64::from(fraction) / 16_777_216.0 * 32_767.0;
            let error = f64::from(Duty::from_q24(fraction).q15()) - exact;
            assert!(error.abs() <= 1.0, "{fraction}: {error}");
        }
    }
}
