//! Sequential analysis (LEP12 eq. 3–8): after each block, decide if a posterior
//! exceeds a threshold; otherwise wait for more evidence.
//!
//! The comparison needs neither logarithm nor division: p > θ is the same as
//! Σ_{j ≠ max} 2^(−d_j) < (1 − θ)/θ, where the right side is a constant. Nor
//! does it often need the sum: one rival whose term alone is no smaller keeps
//! a decision off, and from which deficit on a rival's is smaller is a constant
//! too. So the end of a block adds up exponentials only where every rival is
//! far behind, and then mostly decides.

use serde::{Deserialize, Serialize};

use crate::class_setting::{ClassSettings, MOST_THRESHOLD};
use crate::decision::{Decision, Posterior, Reason};
use crate::error::SetupError;
use crate::evidence::{EvidenceScale, MAX_DEFICIT, MAX_ODDS, leader};
use crate::exp2::{INDEX_BITS, ONE, exp2_neg};
use crate::format::{ENTRIES_PER_BIT, MAX_CLASSES};
use crate::model::Model;
use crate::naive_bayes::NaiveBayes;
use crate::rule::DecisionRule;
use crate::words::{PRIORS, Words};

/// Largest threshold: beyond it the largest deficit could not reach it.
const MAX_THRESHOLD: f64 = 1.0 - 1e-12;

/// A threshold on the posterior probability, prepared for the comparison.
/// Computable at compile time. It is stored as two words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "[u32; 2]", into = "[u32; 2]")]
pub struct Threshold {
    /// (1 − θ)/θ · 2^(26 + gain), rounded up; at most 2²⁵ where gain > 0.
    bound: u32,
    /// Chosen so that a bound below 1/4 keeps 25 significant bits.
    gain: u8,
}

impl Threshold {
    /// A threshold θ, 0 < θ ≤ 1 − 1e-12. The bound it turns into is right to
    /// 2⁻²⁴ of itself.
    ///
    /// # Errors
    /// [`SetupError::Threshold`] outside that range, and where it is not a number.
    pub const fn new(theta: f64) -> Result<Self, SetupError> {
        // Not a number fails both comparisons.
        if !(theta > 0.0 && theta <= MAX_THRESHOLD) {
            return Err(SetupError::Threshold);
        }
        let mut odds = (1.0 - theta) / theta;
        let mut gain = 0;
        while odds <= 0.25 {
            odds *= 2.0;
            gain += 1;
        }
        let scaled = odds * ONE as f64;
        // `as` saturates. Above 32 the posterior of any leader exceeds θ.
        let bound = scaled as u32;
        let bound = if bound >= MAX_ODDS {
            MAX_ODDS
        } else {
            bound + ((bound as f64) < scaled) as u32
        };
        Ok(Self { bound, gain })
    }

    /// That of a class whose [`ClassSetting::threshold`](crate::ClassSetting) this is.
    pub fn of_units(units: u16) -> Self {
        // One bit less than there are, so that the bound is at most 2²⁵ where there is a gain.
        let units = units.min(MOST_THRESHOLD);
        let gain = (units / ENTRIES_PER_BIT as u16).saturating_sub(1) as u8;
        let bits = u64::from(units) << (32 + INDEX_BITS - ENTRIES_PER_BIT.ilog2());
        Self {
            bound: exp2_neg(bits, gain.into()),
            gain,
        }
    }

    /// (1 − θ)/θ, rounded up.
    pub fn odds(self) -> f64 {
        // 2 to the power of 26 and the gain.
        f64::from(self.bound) / f64::from_bits((1023 + 26 + u64::from(self.gain)) << 52)
    }
}

impl From<Threshold> for [u32; 2] {
    fn from(Threshold { bound, gain }: Threshold) -> Self {
        [bound, gain.into()]
    }
}

impl TryFrom<[u32; 2]> for Threshold {
    type Error = SetupError;

    /// None that [`new`](Self::new) makes none like, but for its rounding.
    fn try_from([bound, gain]: [u32; 2]) -> Result<Self, SetupError> {
        let most = if gain == 0 { MAX_ODDS } else { ONE / 2 };
        // Odds of 1e-12 have a gain of 38.
        let is_one = bound > ONE / 4 && bound <= most && gain <= 38;
        let gain = gain as u8;
        is_one
            .then_some(Self { bound, gain })
            .ok_or(SetupError::Threshold)
    }
}

/// A sequential classifier, made from a model and a threshold.
pub type Sequential<W = &'static [u32]> = NaiveBayes<SequentialRule, W>;

/// The sequential rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SequentialRule {
    block: u32,
    scale: EvidenceScale,
    threshold: Threshold,
    /// The least deficit of a rival that does not keep a decision off alone, whichever class
    /// leads.
    far: u32,
    classes: ClassSettings,
}

/// By how much each class lies behind the leader, and since how many blocks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SequentialEvidence {
    deficits: [u32; MAX_CLASSES],
    blocks: u32,
}

impl SequentialEvidence {
    pub(crate) const fn is_begun(&self) -> bool {
        self.blocks > 0
    }

    /// What was gathered elsewhere, in so many blocks.
    pub(crate) fn heard(deficits: [u32; MAX_CLASSES], blocks: u32) -> Self {
        Self {
            deficits: deficits.map(|deficit| deficit.min(MAX_DEFICIT)),
            blocks,
        }
    }

    pub(crate) const fn blocks(&self) -> u32 {
        self.blocks
    }

    pub(crate) const fn deficits(&self) -> [u32; MAX_CLASSES] {
        self.deficits
    }
}

impl SequentialRule {
    /// Takes in the sums of a full block and leaves zeros; how many classes are too near
    /// for a decision, the leader among them.
    ///
    /// No overflow, however many blocks pass without a decision: sums are
    /// below 65535 · 20480 and deficits below 2²⁹, so that every difference
    /// here fits an i32. Those of flipped bits wrap around, and deficits stay below 2²⁹.
    #[inline]
    fn gather_near(&self, sums: &mut [u32], evidence: &mut SequentialEvidence) -> usize {
        let level = |sum: u32, deficit: u32| {
            let deficit = deficit.min(MAX_DEFICIT);
            sum.cast_signed().wrapping_sub(deficit.cast_signed())
        };
        let levels = sums.iter().zip(&evidence.deficits);
        let lead = levels.map(|(&sum, &deficit)| level(sum, deficit)).max();
        let lead = lead.unwrap_or(0);
        let mut near = 0;
        for (deficit, sum) in evidence.deficits.iter_mut().zip(sums) {
            let behind = lead.wrapping_sub(level(core::mem::take(sum), *deficit));
            let behind = behind.cast_unsigned();
            near += usize::from(behind < self.far);
            *deficit = behind.min(MAX_DEFICIT);
        }
        evidence.blocks = evidence.blocks.saturating_add(1);
        near
    }

    /// The evidence of several streams together: log-likelihoods add up, and priors count once.
    pub(crate) fn sum<'e>(
        &self,
        classes: usize,
        all: impl Iterator<Item = &'e SequentialEvidence>,
    ) -> SequentialEvidence {
        // Where priors are taken off, in the middle of what a sum can be: only differences count.
        let start = if PRIORS { 1_u64 << 40 } else { 0 };
        let (mut sums, mut blocks) = ([start; MAX_CLASSES], 0_u32);
        for (n, evidence) in all.enumerate() {
            blocks = blocks.saturating_add(evidence.blocks);
            let deficits = evidence.deficits.iter().take(classes);
            for (class, (sum, deficit)) in sums.iter_mut().zip(deficits).enumerate() {
                *sum += u64::from(*deficit);
                if PRIORS && n > 0 {
                    *sum -= u64::from(self.behind(class));
                }
            }
        }
        // Beyond the model's classes all are zero, and are not looked at.
        let least = sums.iter().take(classes).copied().min().unwrap_or(0);
        let mut deficits = [0; MAX_CLASSES];
        for (deficit, sum) in deficits.iter_mut().zip(sums).take(classes) {
            let behind = u32::try_from(sum.saturating_sub(least)).unwrap_or(MAX_DEFICIT);
            *deficit = behind.min(MAX_DEFICIT);
        }
        SequentialEvidence { deficits, blocks }
    }

    /// Decides by evidence in which no rival is too near.
    #[inline(never)]
    pub(crate) fn decide_by(
        &self,
        classes: usize,
        evidence: &SequentialEvidence,
    ) -> Option<Decision> {
        let deficits = evidence.deficits.iter().take(classes);
        // The leader is near itself.
        let near = deficits.filter(|deficit| **deficit < self.far).count();
        if near > 1 {
            return None;
        }
        self.decide(classes, evidence)
    }

    fn decide(&self, classes: usize, evidence: &SequentialEvidence) -> Option<Decision> {
        let deficits = evidence.deficits.get(..classes).unwrap_or_default();
        let leader = leader(deficits);
        let Threshold { bound, gain } = self.threshold_of(leader);
        let against = self.scale.odds_below(deficits, gain, bound)?;
        let posterior = Posterior::from_odds_against(against, gain);
        let samples = evidence.blocks.saturating_mul(self.block);
        Some(Decision::new(leader, samples, posterior))
    }

    fn threshold_of(&self, class: usize) -> Threshold {
        match self.classes.get(class).threshold {
            own if PRIORS && own > 0 => Threshold::of_units(own),
            _ => self.threshold,
        }
    }

    #[inline]
    fn behind(&self, class: usize) -> u32 {
        self.classes.behind(class, self.block).min(MAX_DEFICIT)
    }
}

impl DecisionRule for SequentialRule {
    /// Decides where a posterior exceeds it.
    type Settings = Threshold;
    type Evidence = SequentialEvidence;

    fn new<W: Words>(model: &Model<W>, threshold: Threshold) -> Result<Self, SetupError> {
        let scale = EvidenceScale::per_samples(model.block());
        Ok(Self {
            block: model.block(),
            scale,
            threshold,
            far: scale.first_below(threshold.gain, threshold.bound),
            classes: ClassSettings::NONE,
        })
    }

    fn set_classes(&mut self, classes: &ClassSettings) {
        self.classes = *classes;
        if let Some(least) = classes.least_threshold() {
            let Threshold { bound, gain } = Threshold::of_units(least);
            self.far = self.far.min(self.scale.first_below(gain, bound));
        }
    }

    fn classes(&self) -> &ClassSettings {
        &self.classes
    }

    fn start(&self) -> SequentialEvidence {
        let mut deficits = [0; MAX_CLASSES];
        if PRIORS {
            for (class, deficit) in deficits.iter_mut().enumerate() {
                *deficit = self.behind(class);
            }
        }
        SequentialEvidence {
            deficits,
            blocks: 0,
        }
    }

    // Once a block: apart from the samples, which then need less of the stack.
    #[inline(never)]
    fn end_of_block(
        &self,
        sums: &mut [u32],
        evidence: &mut SequentialEvidence,
    ) -> Option<Decision> {
        let near = self.gather_near(sums, evidence);
        // The leader is near itself.
        if near > 1 {
            return None;
        }
        let decision = self.decide(sums.len(), evidence)?;
        // Those beyond the model's classes are always zero.
        for (class, (deficit, _)) in evidence.deficits.iter_mut().zip(sums).enumerate() {
            *deficit = self.behind(class);
        }
        evidence.blocks = 0;
        Some(decision)
    }

    // Once a block: apart from what is generic.
    #[inline(never)]
    fn gather(&self, sums: &mut [u32], evidence: &mut SequentialEvidence) {
        let _ = self.gather_near(sums, evidence);
    }

    fn limit(&self, evidence: &mut SequentialEvidence, limit: u32) {
        // A surface that may have changed is by its prior another: so a class lies no further
        // behind than that and the limit.
        for (class, deficit) in evidence.deficits.iter_mut().enumerate() {
            *deficit = (*deficit).min(limit.saturating_add(self.behind(class)));
        }
    }

    // At a decision: there once.
    #[inline(never)]
    fn decide_between(&self, classes: usize, evidence: &SequentialEvidence) -> Option<Decision> {
        let mut without = evidence.clone();
        let deficits = without.deficits.get_mut(..classes)?;
        let first = leader(deficits);
        let others = deficits
            .iter_mut()
            .enumerate()
            .filter(|(class, _)| *class != first);
        let (second, deficit) = others.min_by_key(|(_, deficit)| **deficit)?;
        // As if it were no class.
        *deficit = MAX_DEFICIT;
        let decision = self.decide_by(classes, &without)?;
        Some(decision.in_touch(0, Some(Reason::Between(second))))
    }

    fn deficits(&self, evidence: &SequentialEvidence, deficits: &mut [u32]) {
        for (to, from) in deficits.iter_mut().zip(&evidence.deficits) {
            *to = *from;
        }
    }

    fn scale(&self) -> EvidenceScale {
        self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AT_COMPILE_TIME: Result<Threshold, SetupError> = Threshold::new(0.5);

    #[test]
    fn thresholds_are_checked_and_come_back_from_their_words() {
        for bad in [0.0, -0.1, 1.0, 1.0 - 1e-13, 2.0, f64::NAN, f64::INFINITY] {
            assert_eq!(Threshold::new(bad), Err(SetupError::Threshold));
        }
        let (bound, gain) = (ONE, 0);
        assert_eq!(AT_COMPILE_TIME, Ok(Threshold { bound, gain }));
        assert!(Threshold::new(f64::MIN_POSITIVE).is_ok());
        for theta in [
            0.04,
            0.3,
            0.79,
            0.8,
            0.81,
            0.9,
            0.99,
            1.0 - 1e-8,
            1.0 - 1e-12,
        ] {
            let threshold = Threshold::new(theta).unwrap();
            let read = Threshold::try_from(<[u32; 2]>::from(threshold));
            assert_eq!(read, Ok(threshold), "{theta}");
            let error = threshold.odds() / ((1.0 - theta) / theta) - 1.0;
            let stated = 0.0..=2.0_f64.powi(-24);
            assert!(stated.contains(&error), "{theta} {error}");
            assert!(threshold.gain == 0 || threshold.bound <= 1 << 25);
        }
        for words in [
            [0, 0],
            [ONE / 4, 0],
            [ONE, 1],
            [MAX_ODDS + 1, 0],
            [ONE / 2, 39],
            [ONE, 256],
        ] {
            let read = Threshold::try_from(words);
            assert_eq!(read, Err(SetupError::Threshold), "{words:?}");
        }
    }

    #[cfg(feature = "std")]
    #[test]
    fn thresholds_of_units_are_those_of_their_odds() {
        use crate::class_setting::ClassSetting;
        for theta in [0.500_001, 0.6, 0.667, 0.75, 0.99, 0.999_999, 1.0 - 1e-12] {
            let units = ClassSetting::new(1.0, Some(theta)).threshold;
            let threshold = Threshold::of_units(units);
            // None of new's, but for its rounding.
            let read = Threshold::try_from(<[u32; 2]>::from(threshold));
            assert_eq!(read, Ok(threshold), "{theta}");
            let error = threshold.odds() / ((1.0 - theta) / theta) - 1.0;
            assert!((-6.9e-4..5e-6).contains(&error), "{theta}: {error}");
        }
        let most = Threshold::of_units(MOST_THRESHOLD);
        assert_eq!(most.odds(), 2.0_f64.powi(-40));
        assert_eq!(most, Threshold::of_units(u16::MAX));
        assert_eq!(ClassSetting::new(0.25, None).prior, 2048);
    }

    /// Whatever bits a deficit has, deficits are within their bound after a block, and all
    /// is as before once a decision has fallen.
    #[test]
    fn spoilt_evidence_lasts_until_the_next_decision() {
        let scale = EvidenceScale::per_samples(20);
        let threshold = Threshold::new(0.99).unwrap();
        let rule = SequentialRule {
            block: 20,
            scale,
            threshold,
            far: scale.first_below(threshold.gain, threshold.bound),
            classes: ClassSettings::NONE,
        };
        // Two bit a block for the second of three.
        let block = [200_000, 200_000 + 2 * 1_024 * 20, 150_000];
        for class in 0..3 {
            for bit in 0..32 {
                let mut evidence = rule.start();
                assert_eq!(rule.end_of_block(&mut block.clone(), &mut evidence), None);
                evidence.deficits[class] ^= 1 << bit;
                let falls = (0..1_000_000).find(|_| {
                    let decision = rule.end_of_block(&mut block.clone(), &mut evidence);
                    assert!(evidence.deficits.iter().all(|d| *d <= MAX_DEFICIT));
                    decision.is_some()
                });
                assert!(falls.is_some(), "{class} {bit}");
                assert_eq!(evidence, rule.start());
            }
        }
    }
}
