//! What a module decides about what it touches.

use tactile::{Classes, Decision, Model, Rule, State, Streaming, Supported};
use whisking::Real;

use crate::sensing::Reading;

/// Decides from the readings of a module, or does not.
pub trait Perception<R, const S: usize, const N: usize> {
    /// Its constants.
    type Config;

    /// One tick: contact π of each side and the readings it came from.
    fn step(
        &mut self,
        config: &Self::Config,
        contact: [R; S],
        readings: &[[Reading; N]; S],
    ) -> Option<Decision>;
}

/// No perception.
impl<R, const S: usize, const N: usize> Perception<R, S, N> for () {
    type Config = ();

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
impl<R: Copy, P: Perception<R, S, N>, const S: usize, const N: usize> Perception<R, S, N>
    for Option<P>
{
    type Config = Option<P::Config>;

    #[inline]
    fn step(
        &mut self,
        config: &Self::Config,
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
pub struct ClassifyingConfig<R> {
    /// Samples count only while contact π of the whisker's side is at least
    /// this; `None`: always.
    pub contact_min: Option<R>,
}

/// The first whisker of the module (left side first), listened to by `L`.
///
/// Samples are the sensor's raw 14-bit codes, not the filtered contact signal:
/// texture is in the vibration above 50 Hz. While the sensor has a fault there
/// is nothing to listen to.
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

impl<R: Real, L: SampleClassifier, const S: usize, const N: usize> Perception<R, S, N>
    for Classifying<L>
{
    type Config = ClassifyingConfig<R>;

    #[inline]
    fn step(
        &mut self,
        config: &ClassifyingConfig<R>,
        contact: [R; S],
        readings: &[[Reading; N]; S],
    ) -> Option<Decision> {
        let reading = readings.first()?.first()?;
        let contact = *contact.first()?;
        let touching = config.contact_min.is_none_or(|least| contact >= least);
        if !reading.valid || !touching {
            return None;
        }
        self.classifier
            .push([reading.x.code14(), reading.y.code14()])
    }
}

/// A classifier of `K` classes that reads its model in place.
#[derive(Debug)]
pub struct CodeClassifier<'m, R: Rule<K>, const K: usize>
where
    Classes<K>: Supported,
{
    classifier: Streaming<'m, R, 2, K>,
    state: State<R::Evidence, K>,
    /// The model's codes a code of the sensor: powers of two, for which a
    /// product is shorter than a shift of any length.
    factors: [i32; 2],
}

/// The model was not learnt from a sensor's integer codes (or has fewer than
/// two channels), so that it cannot be fed with them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotCodes;

impl core::fmt::Display for NotCodes {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(
            f,
            "the model was not learnt from 14-bit sensor codes of two channels"
        )
    }
}

impl core::error::Error for NotCodes {}

/// By how many bits a sensor's codes are shifted to become the model's, for
/// each channel.
///
/// # Errors
/// [`NotCodes`] if the model was learnt from something else.
pub fn shifts(model: &Model<'_>) -> Result<[u32; 2], NotCodes> {
    let shift = |channel| -> Option<u32> {
        let quantiser = model.quantiser(channel)?;
        // 14 bits and 17 of shift stay below 2^31.
        let fits = quantiser.takes_raw() && quantiser.exponent <= 17;
        fits.then_some(quantiser.exponent.unsigned_abs())
    };
    match (shift(0), shift(1)) {
        (Some(x), Some(y)) => Ok([x, y]),
        _ => Err(NotCodes),
    }
}

impl<'m, R: Rule<K>, const K: usize> CodeClassifier<'m, R, K>
where
    Classes<K>: Supported,
{
    /// Joins a classifier to the model it was made for.
    ///
    /// # Errors
    /// [`NotCodes`] if the model was not learnt from a sensor's codes.
    pub fn new(model: &Model<'m>, classifier: Streaming<'m, R, 2, K>) -> Result<Self, NotCodes> {
        // At most 17 bits.
        let factors = shifts(model)?.map(|shift| 1 << shift);
        let state = classifier.state();
        Ok(Self {
            classifier,
            state,
            factors,
        })
    }
}

impl<R: Rule<K>, const K: usize> SampleClassifier for CodeClassifier<'_, R, K>
where
    Classes<K>: Supported,
{
    #[inline]
    fn push(&mut self, codes: [u16; 2]) -> Option<Decision> {
        let [x, y] = codes;
        let codes = [
            i32::from(x).wrapping_mul(self.factors[0]),
            i32::from(y).wrapping_mul(self.factors[1]),
        ];
        self.classifier.push(&mut self.state, &codes)
    }

    fn reset(&mut self) {
        self.classifier.reset(&mut self.state);
    }
}
