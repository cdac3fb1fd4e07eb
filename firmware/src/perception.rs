//! What decides about what a module touches, or does not.

use tactile::{Decision, DecisionRule, Model, NaiveBayes};
use whisking::{Optional, Real};

use crate::sensing::Reading;

/// Decides from the readings of a module by the constants `C`, or does not.
pub trait Perception<R, C, const S: usize, const N: usize> {
    /// One tick: contact π of each side and the readings it came from.
    fn step(
        &mut self,
        config: &C,
        contact: [R; S],
        readings: &[[Reading; N]; S],
    ) -> Option<Decision>;
}

/// No perception.
impl<R, const S: usize, const N: usize> Perception<R, (), S, N> for () {
    #[inline]
    fn step(
        &mut self,
        (): &(),
        _contact: [R; S],
        _readings: &[[Reading; N]; S],
    ) -> Option<Decision> {
        None
    }
}

/// Perception that is there or not at run time, for simulations of any scene.
/// A configuration without the perception, or the reverse, decides nothing.
impl<R, C, P, const S: usize, const N: usize> Perception<R, Option<C>, S, N> for Option<P>
where
    P: Perception<R, C, S, N>,
{
    #[inline]
    fn step(
        &mut self,
        config: &Option<C>,
        contact: [R; S],
        readings: &[[Reading; N]; S],
    ) -> Option<Decision> {
        self.as_mut()?.step(config.as_ref()?, contact, readings)
    }
}

/// A classifier of the two channels of one whisker, and its state.
pub trait SampleClassifier {
    /// Takes one sample as the sensor's codes, 0 to 16383; a decision may fall.
    fn push(&mut self, codes: [u16; 2]) -> Option<Decision>;

    /// Forgets all evidence: something else is being touched.
    fn reset(&mut self);
}

/// Constants of [`Classifying`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassifyingConfig<T, D> {
    /// Samples count only while contact π of the whisker's side is at least
    /// this; absent: always.
    pub contact_min: T,
    /// Settings of the decision rule, with which the classifier is made.
    pub rule: D,
}

/// Classifies what the first whisker of the module (left side first) touches.
///
/// Samples are the sensor's raw 14-bit codes, not the filtered contact signal:
/// texture is in the vibration above 50 Hz. While the sensor has a fault there
/// are no samples.
#[derive(Debug)]
pub struct Classifying<L> {
    classifier: L,
}

impl<L> Classifying<L> {
    /// With this classifier.
    pub const fn new(classifier: L) -> Self {
        Self { classifier }
    }

    /// The classifier.
    pub const fn classifier_mut(&mut self) -> &mut L {
        &mut self.classifier
    }
}

impl<R, T, D, L, const S: usize, const N: usize> Perception<R, ClassifyingConfig<T, D>, S, N>
    for Classifying<L>
where
    R: Real,
    T: Optional<R>,
    L: SampleClassifier,
{
    #[inline]
    fn step(
        &mut self,
        config: &ClassifyingConfig<T, D>,
        contact: [R; S],
        readings: &[[Reading; N]; S],
    ) -> Option<Decision> {
        let reading = readings.first()?.first()?;
        let contact = *contact.first()?;
        let touching = config
            .contact_min
            .part()
            .is_none_or(|least| contact >= *least);
        if !reading.valid || !touching {
            return None;
        }
        self.classifier
            .push([reading.x.code14(), reading.y.code14()])
    }
}

/// Naive Bayes on a sensor's codes. `W` holds the model's words: flash on a
/// board, memory of its own on a PC.
#[derive(Debug, Clone)]
pub struct CodeClassifier<R: DecisionRule, W = &'static [u32]> {
    bayes: NaiveBayes<R, W>,
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
pub fn shifts<W: AsRef<[u32]>>(model: &Model<W>) -> Result<[u32; 2], NotCodes> {
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

impl<R: DecisionRule, W: AsRef<[u32]>> CodeClassifier<R, W> {
    /// With this classifier.
    ///
    /// # Errors
    /// [`NotCodes`] if its model was not trained on a sensor's codes.
    pub fn new(bayes: NaiveBayes<R, W>) -> Result<Self, NotCodes> {
        // At most 17 bits.
        let factors = shifts(bayes.model())?.map(|shift| 1 << shift);
        Ok(Self { bayes, factors })
    }

    /// The classifier: its model, and posteriors.
    pub const fn bayes(&self) -> &NaiveBayes<R, W> {
        &self.bayes
    }
}

impl<R: DecisionRule, W: AsRef<[u32]>> SampleClassifier for CodeClassifier<R, W> {
    #[inline]
    fn push(&mut self, codes: [u16; 2]) -> Option<Decision> {
        let [x, y] = codes;
        let codes = [
            i32::from(x).wrapping_mul(self.factors[0]),
            i32::from(y).wrapping_mul(self.factors[1]),
        ];
        // Two channels, as `new` has made sure.
        self.bayes.push(&codes).ok().flatten()
    }

    fn reset(&mut self) {
        self.bayes.reset();
    }
}
