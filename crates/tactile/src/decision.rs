//! What a rule hands back: the class, the samples it took, and its posterior.

use core::num::NonZeroU32;

use crate::divide::divide;
use crate::exp2::TERM_BITS;

/// A decision. Three words, and no more in an `Option`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Decision {
    // Never zero.
    samples: NonZeroU32,
    /// The posterior, and the class in the five bits above.
    packed: u32,
    /// The touch, and above its 16 bits why no class is named, if none is: one bit that none
    /// is, two of the reason, five of the rival.
    touch: u32,
}

/// Set in [`Decision::touch`] where no class is named.
const UNKNOWN: u32 = 1 << 16;
/// Where in it the reason begins, and where the rival.
const REASON_AT: u32 = 17;
const RIVAL_AT: u32 = 19;

/// Why a decision names no class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// What was felt is unlike all classes, or its model does not say more.
    Unknown,
    /// The way of the touch lies outside the poses of training.
    Pose,
    /// Two opinions differ: it is the leader, or this class.
    Between(usize),
}

impl Reason {
    /// Its name in files and lines.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unknown => "unknown",
            Self::Pose => "pose",
            Self::Between(_) => "between",
        }
    }

    /// In the bits of [`Decision::touch`].
    const fn bits(self) -> u32 {
        match self {
            Self::Unknown => UNKNOWN,
            Self::Pose => UNKNOWN | 1 << REASON_AT,
            // Classes are at most 32.
            Self::Between(rival) => {
                UNKNOWN | 2 << REASON_AT | ((rival % MAX_RIVALS) as u32) << RIVAL_AT
            }
        }
    }
}

/// Classes that fit the bits of a rival.
const MAX_RIVALS: usize = 32;

impl Decision {
    #[inline]
    pub(crate) fn new(class: usize, samples: u32, posterior: Posterior) -> Self {
        Self {
            samples: NonZeroU32::new(samples).unwrap_or(NonZeroU32::MIN),
            // Classes are at most 32.
            packed: posterior.odds | ((class as u32) << ODDS_BITS),
            touch: 0,
        }
    }

    #[inline]
    pub(crate) fn after(self, samples: u32) -> Self {
        Self {
            samples: self.samples.saturating_add(samples),
            ..self
        }
    }

    #[inline]
    pub(crate) fn in_touch(self, touch: u16, reason: Option<Reason>) -> Self {
        Self {
            touch: u32::from(touch) | reason.map_or(0, Reason::bits),
            ..self
        }
    }

    /// The decision whose words a debugger reads as `samples`, `packed` and `touch`;
    /// `None` if `samples` is zero.
    pub fn from_memory(samples: u32, packed: u32, touch: u32) -> Option<Self> {
        Some(Self {
            samples: NonZeroU32::new(samples)?,
            packed,
            touch,
        })
    }

    /// What [`from_memory`](Self::from_memory) takes.
    pub const fn words(&self) -> [u32; 3] {
        [self.samples.get(), self.packed, self.touch]
    }

    /// The class decided for: its index in the model. `None`: no class is named, for a
    /// [reason](Self::reason).
    pub fn class(&self) -> Option<usize> {
        (self.touch & UNKNOWN == 0).then_some(self.leader())
    }

    /// Why no class is named; `None` where one is.
    pub fn reason(&self) -> Option<Reason> {
        if self.touch & UNKNOWN == 0 {
            return None;
        }
        Some(match (self.touch >> REASON_AT) % 4 {
            1 => Reason::Pose,
            2 => Reason::Between((self.touch >> RIVAL_AT) as usize % MAX_RIVALS),
            // Of flipped bits too.
            _ => Reason::Unknown,
        })
    }

    /// Between which two classes it is, where no class is named for that reason.
    pub fn among(&self) -> Option<[usize; 2]> {
        match self.reason()? {
            Reason::Between(rival) => Some([self.leader(), rival]),
            Reason::Unknown | Reason::Pose => None,
        }
    }

    /// The class whose posterior exceeded the threshold, though it may be unknown.
    pub fn leader(&self) -> usize {
        (self.packed >> ODDS_BITS) as usize
    }

    /// The number of the touch it fell in, wrapping; 0 where touches are not detected.
    pub fn touch(&self) -> u16 {
        self.touch as u16
    }

    /// Decision time: how many samples it used, saturated at 2³² − 1.
    pub fn samples(&self) -> u32 {
        self.samples.get()
    }

    /// Posterior probability of the class.
    pub fn posterior(&self) -> Posterior {
        Posterior {
            odds: self.packed % (1 << ODDS_BITS),
        }
    }
}

const MANTISSA_BITS: u32 = 21;
/// Bits of mantissa and exponent together.
const ODDS_BITS: u32 = 27;
/// The exponent of odds of 2³² units of 2⁻²⁶, more than there are.
const LEAST_EXPONENT: u32 = MANTISSA_BITS + TERM_BITS - 32;

/// A posterior probability p, held as the odds against it, (1 − p)/p, so that
/// a p near one keeps its precision; converted only when read.
///
/// Against exact arithmetic on the same table the odds are off by at most
/// 5.1e-6 + |ln odds| · block / 2³⁰ of themselves (the exponential, the mantissa
/// and the scale of the argument) and, under a threshold θ, K · 2⁻²⁴ of
/// (1 − θ)/θ (truncation); p is off by less than 1e-5.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Posterior {
    /// Odds against = mantissa · 2^−(exponent + 15): six bits of exponent
    /// above 21 of mantissa.
    odds: u32,
}

impl Posterior {
    /// From odds in units of 2^−(26 + gain); `gain` ≤ 40. Truncates.
    #[inline]
    pub(crate) fn from_odds_against(against: u32, gain: u8) -> Self {
        let excess = (u32::BITS - MANTISSA_BITS).saturating_sub(against.leading_zeros());
        let exponent = TERM_BITS + u32::from(gain) - excess - LEAST_EXPONENT;
        Self {
            odds: (against >> excess) | (exponent << MANTISSA_BITS),
        }
    }

    fn mantissa_and_exponent(self) -> (u32, u32) {
        (
            self.odds % (1 << MANTISSA_BITS),
            (self.odds >> MANTISSA_BITS) + LEAST_EXPONENT,
        )
    }

    /// p in units of 2⁻³², rounded down, at most 2³² − 1.
    pub fn q32(self) -> u32 {
        let (mantissa, exponent) = self.mantissa_and_exponent();
        // Shifts by 15 to 78: nothing is left where checked_shr says None.
        let against = (u64::from(mantissa) << 32)
            .checked_shr(exponent)
            .unwrap_or(0);
        // Of 2⁶⁴ − 1.
        divide(u32::MAX, u32::MAX, (1 << 32) + against)
    }

    /// p in double precision.
    pub fn to_f64(self) -> f64 {
        1.0 / (1.0 + self.odds_against())
    }

    /// (1 − p)/p in double precision.
    pub fn odds_against(self) -> f64 {
        let (mantissa, exponent) = self.mantissa_and_exponent();
        // An exact power of two.
        f64::from(mantissa) / (1_u128 << exponent) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn posterior_reads_as_one_over_one_plus_odds() {
        let even = Posterior::from_odds_against(1 << 26, 0);
        assert_eq!(even.q32(), 0x7fff_ffff);
        assert!((even.to_f64() - 0.5).abs() < 1e-15);
        let certain = Posterior::from_odds_against(0, 0);
        assert_eq!(certain.q32(), u32::MAX);
        assert!((certain.to_f64() - 1.0).abs() < 1e-15);
        let near = Posterior::from_odds_against(1 << 25, 26);
        assert!((1.0 - near.to_f64() - 0.5_f64.powi(27)).abs() < 1e-15);
        assert!(u32::MAX - near.q32() <= 32);
        let widest = Posterior::from_odds_against(31 << 26, 0);
        assert!((f64::from(widest.q32()) / 2.0_f64.powi(32) - 1.0 / 32.0).abs() < 1e-9);
    }

    #[test]
    fn what_was_packed_is_read_and_odds_keep_twenty_bits_whatever_their_size() {
        use Reason::{Between, Pose, Unknown};
        for (gain, reason) in [
            (0_u8, None),
            (1, Some(Between(31))),
            (26, Some(Unknown)),
            (40, Some(Pose)),
        ] {
            for against in [0, 1, 1000, (1 << 21) - 1, 1 << 21, 0x0765_4321, u32::MAX] {
                let posterior = Posterior::from_odds_against(against, gain);
                let exact = f64::from(against) / 2.0_f64.powi(26 + i32::from(gain));
                let lost = exact - posterior.odds_against();
                assert!((0.0..=exact * 2.0_f64.powi(-20)).contains(&lost));
                let decision = Decision::new(30, 9, posterior).in_touch(0xffff, reason);
                let (samples, packed, touch) = (decision.samples, decision.packed, decision.touch);
                let read = Decision::from_memory(samples.get(), packed, touch);
                assert_eq!(read, Some(decision));
                assert_eq!((decision.leader(), decision.touch()), (30, 0xffff));
                assert_eq!(decision.posterior(), posterior);
                assert_eq!(decision.reason(), reason);
                assert_eq!(decision.class(), reason.is_none().then_some(30));
                let is_between = reason == Some(Between(31));
                assert_eq!(decision.among(), is_between.then_some([30, 31]));
            }
        }
    }

    #[test]
    fn an_option_takes_no_extra_word() {
        assert_eq!(size_of::<Option<Decision>>(), 12);
    }
}
