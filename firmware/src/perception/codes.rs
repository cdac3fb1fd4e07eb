//! A classifier of the sensors' codes.

use tactile::{Constants, Decision, DecisionRule, Model, Streams, Words};

use super::{Sample, SampleClassifier, TakesRule};

/// Naive Bayes on the codes of sensors; `B` says of how many whiskers, and how they
/// decide ([`tactile::NaiveBayes`], [`tactile::Each`], [`tactile::Together`]).
#[derive(Debug, Clone)]
pub struct CodeClassifier<B> {
    bayes: B,
    /// The model's codes a code of the sensor: powers of two.
    factors: [i32; 2],
}

/// The model was not trained on the integer codes of a sensor's two channels,
/// so that it cannot classify them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the model was not trained on 14-bit sensor codes of two channels")]
pub struct NotCodes;

/// By how many bits a sensor's codes are shifted to become the model's, for
/// each channel.
///
/// # Errors
/// [`NotCodes`] if the model was trained on something else.
pub fn shifts<W: Words>(model: &Model<W>) -> Result<[u32; 2], NotCodes> {
    let shift = |channel| -> Option<u32> {
        let quantiser = model.quantiser(channel)?;
        // 14 bits and 17 of shift stay below 2^31.
        let fits = quantiser.takes_raw() && quantiser.exponent <= 17;
        fits.then_some(quantiser.exponent.unsigned_abs())
    };
    match (shift(0), shift(1), model.channels()) {
        (Some(x), Some(y), 2) => Ok([x, y]),
        _ => Err(NotCodes),
    }
}

impl<B: Streams> CodeClassifier<B> {
    /// With this classifier.
    ///
    /// # Errors
    /// [`NotCodes`] if its model was not trained on a sensor's codes.
    pub fn new(bayes: B) -> Result<Self, NotCodes> {
        // At most 17 bits.
        let factors = shifts(bayes.model())?.map(|shift| 1 << shift);
        Ok(Self { bayes, factors })
    }

    /// The classifier: its model, and posteriors.
    pub const fn bayes(&self) -> &B {
        &self.bayes
    }

    /// What no sample changes: its model and rule, and the factors of its codes.
    pub fn constants(&self) -> (&Constants<B::Rule, B::Words>, &[i32; 2]) {
        (self.bayes.constants(), &self.factors)
    }
}

impl<B: Streams, D: Copy> TakesRule<D> for CodeClassifier<B>
where
    B::Rule: DecisionRule<Settings = D>,
{
    fn set_rule(&mut self, settings: &D) {
        // What does not fit the model changes nothing.
        let _ = self.bayes.set_rule(*settings);
    }
}

impl<B: Streams> SampleClassifier for CodeClassifier<B> {
    #[inline]
    fn push(&mut self, whisker: usize, sample: Sample) -> Option<Decision> {
        let [x, y] = sample.codes;
        if sample.touch != 0 && sample.touch != self.bayes.touch_of(whisker) {
            self.bayes.begin_touch(whisker, sample.touch);
        }
        let codes = [
            i32::from(x).wrapping_mul(self.factors[0]),
            i32::from(y).wrapping_mul(self.factors[1]),
        ];
        // Two channels, as `new` has made sure.
        if sample.counts && (sample.touch != 0 || !self.knows_touches()) {
            return self.bayes.push_to(whisker, &codes).ok().flatten();
        }
        let _ = self.bayes.pass_to(whisker, &codes);
        None
    }

    #[inline]
    fn knows_touches(&self) -> bool {
        self.bayes.model().touch_rule().is_some()
    }

    fn interrupt(&mut self, whisker: usize) {
        self.bayes.interrupt_stream(whisker);
    }

    fn reset(&mut self) {
        self.bayes.restart();
    }
}
