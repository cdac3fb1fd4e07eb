//! What a scene says of each class beside the model: its prior, and the posterior from which it
//! is decided on.
//!
//! Both are logarithms in 1/1024 bit, the unit of tables: so the prior of LEP12 eq. 4,
//! log P(T_k) before the first block, is where the evidence of a class starts, and costs no
//! sample anything. The comparison of a posterior takes the threshold of the leader: of classes
//! with thresholds above one half no two can exceed theirs at once.

use serde::{Deserialize, Serialize};

use crate::format::MAX_CLASSES;
use crate::words::PRIORS;

/// Of one class. By default: as likely as the likeliest, and decided on at the rule's threshold.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClassSetting {
    /// log2 of the largest prior over its own, 1/1024 bit, rounded: a prior is right to
    /// 3.4e-4 of itself. One class at least has 0.
    pub prior: u16,
    /// log2 of θ/(1 − θ), 1/1024 bit, rounded up, at most [`MOST_THRESHOLD`]: (1 − θ)/θ is at
    /// most 6.8e-4 of itself too small. 0: the rule's own threshold.
    pub threshold: u16,
}

/// The largest [`ClassSetting::threshold`]: 40 bit, θ = 1 − 9.1e-13.
pub const MOST_THRESHOLD: u16 = 40 << 10;

impl ClassSetting {
    /// Of a class whose prior is this `share` of the largest, 0 < share ≤ 1 (below 2⁻⁶³ it is
    /// held there), and of a threshold θ, ½ < θ < 1 (above 1 − 9.1e-13 likewise).
    #[cfg(feature = "std")]
    pub fn new(share: f64, threshold: Option<f64>) -> Self {
        // `as` saturates.
        let units = |bits: f64| bits * f64::from(crate::format::ENTRIES_PER_BIT);
        let prior = units(-share.log2()).round() as u16;
        let odds = threshold.map_or(0, |theta| {
            let odds = units((theta / (1.0 - theta)).log2()).ceil() as u16;
            odds.clamp(1, MOST_THRESHOLD)
        });
        Self {
            prior,
            threshold: odds,
        }
    }
}

#[cfg(feature = "std")]
impl ClassSetting {
    /// θ; one half where the rule's own threshold holds.
    pub fn theta(&self) -> f64 {
        let bits = f64::from(self.threshold) / f64::from(crate::format::ENTRIES_PER_BIT);
        1.0 / (1.0 + (-bits).exp2())
    }
}

/// Room for classes, where the program has the code for it.
const ROOM: usize = if PRIORS { MAX_CLASSES } else { 0 };

/// Those of a model's classes, in its order; none: all by default.
pub type ClassList = heapless::Vec<ClassSetting, ROOM>;

/// The same as a rule has them: a place for each class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClassSettings([ClassSetting; ROOM]);

impl ClassSettings {
    /// All by default.
    pub const NONE: Self = Self(
        [ClassSetting {
            prior: 0,
            threshold: 0,
        }; ROOM],
    );

    /// Of these classes, in the model's order; others by default.
    pub fn of(classes: &[ClassSetting]) -> Self {
        let mut settings = Self::NONE;
        for (to, from) in settings.0.iter_mut().zip(classes) {
            *to = *from;
        }
        settings
    }

    #[inline]
    pub(crate) fn get(&self, class: usize) -> ClassSetting {
        self.0.get(class).copied().unwrap_or_default()
    }

    /// How far a class lies behind at the start, of blocks of so many samples.
    #[inline]
    pub(crate) fn behind(&self, class: usize, block: u32) -> u32 {
        // 16 bits by 14.
        u32::from(self.get(class).prior) * block
    }

    pub(crate) fn least_threshold(&self) -> Option<u16> {
        let own = self.0.iter().map(|class| class.threshold);
        own.filter(|threshold| *threshold > 0).min()
    }
}
