//! What decides about what a module touches, or does not.

use tactile::{Decision, DecisionRule, Model, NaiveBayes, TouchDetector, Touching, Words};
use whisking::{Optional, Real};

use crate::sensing::Reading;
use crate::{Event, Place};

/// Decides from the readings of a module by the constants `C`, or does not.
pub trait Perception<R, C, const S: usize, const N: usize> {
    /// One tick: contact π of each side and the readings it came from. `events` gets
    /// touches and decisions.
    fn step(
        &mut self,
        config: &C,
        contact: [R; S],
        readings: &[[Reading; N]; S],
        events: &mut impl FnMut(Event),
    );
}

/// No perception.
impl<R, const S: usize, const N: usize> Perception<R, (), S, N> for () {
    #[inline]
    fn step(
        &mut self,
        (): &(),
        _contact: [R; S],
        _readings: &[[Reading; N]; S],
        _events: &mut impl FnMut(Event),
    ) {
    }
}

/// Perception that lies elsewhere.
impl<R, C, P, const S: usize, const N: usize> Perception<R, C, S, N> for &mut P
where
    P: Perception<R, C, S, N>,
{
    #[inline]
    fn step(
        &mut self,
        config: &C,
        contact: [R; S],
        readings: &[[Reading; N]; S],
        events: &mut impl FnMut(Event),
    ) {
        (**self).step(config, contact, readings, events);
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
        events: &mut impl FnMut(Event),
    ) {
        if let (Some(perception), Some(config)) = (self, config) {
            perception.step(config, contact, readings, events);
        }
    }
}

/// A sample of one whisker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sample {
    /// The sensor's codes of x and y, 0 to 16383.
    pub codes: [u16; 2],
    /// Whether contact is at least the scene's, or the model's, least.
    pub counts: bool,
    /// The number of the touch, as soon as it is sure; 0 in the air.
    pub touch: u16,
}

/// A classifier of the two channels of one whisker, and its state.
pub trait SampleClassifier {
    /// Takes the sample of every tick with a valid reading; a decision may fall.
    fn push(&mut self, sample: Sample) -> Option<Decision>;

    /// Whether it is to be told touches; otherwise all is of the air to it.
    fn knows_touches(&self) -> bool;

    /// There is no sample: the next does not follow the last.
    fn interrupt(&mut self);

    /// Starts anew.
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
/// texture is in the vibration above 50 Hz. While the whisker has a fault it touches
/// nothing and there are no samples.
#[derive(Debug)]
pub struct Classifying<L> {
    classifier: L,
    touches: TouchDetector,
}

impl<L> Classifying<L> {
    /// With this classifier.
    pub const fn new(classifier: L) -> Self {
        Self {
            classifier,
            touches: TouchDetector::new(),
        }
    }

    /// As before the first tick.
    #[must_use]
    pub fn restarted(mut self) -> Self
    where
        L: SampleClassifier,
    {
        self.classifier.reset();
        Self::new(self.classifier)
    }

    /// The classifier.
    pub const fn classifier_mut(&mut self) -> &mut L {
        &mut self.classifier
    }

    /// What the whisker touches.
    pub const fn touching(&self) -> Touching {
        self.touches.touching()
    }

    /// A tick of a whisker with a fault.
    #[cold]
    fn interrupt(&mut self, place: Place, events: &mut impl FnMut(Event))
    where
        L: SampleClassifier,
    {
        let Touching { number, .. } = self.touches.touching();
        if number != 0 {
            events(Event::TouchEnd { place, number });
        }
        self.touches.interrupt();
        self.classifier.interrupt();
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
        events: &mut impl FnMut(Event),
    ) {
        let reading = readings.first().and_then(|side| side.first());
        let (Some(reading), Some(contact)) = (reading, contact.first()) else {
            return;
        };
        let place = Place::new(0, 0);
        if !reading.valid {
            self.interrupt(place, events);
            return;
        }
        let codes = [reading.x.code14(), reading.y.code14()];
        let least = config.contact_min.part();
        let counts = least.is_none_or(|least| contact >= least);
        let Touching { number: last, .. } = self.touches.touching();
        let Touching { number, is_onset } = if self.classifier.knows_touches() {
            self.touches.step(codes)
        } else {
            Touching::default()
        };
        if is_onset {
            events(Event::Touch { place, number });
        } else if number == 0 && last != 0 {
            let number = last;
            events(Event::TouchEnd { place, number });
        }
        let sample = Sample {
            codes,
            counts,
            // A false touch in the air is none to the classifier.
            touch: if self.touches.is_sure() { number } else { 0 },
        };
        if let Some(decision) = self.classifier.push(sample) {
            events(Event::Decision(decision));
        }
    }
}

/// Naive Bayes on a sensor's codes. `W` holds the model's words: flash on a
/// board, memory of its own on a PC.
#[derive(Debug, Clone)]
pub struct CodeClassifier<R: DecisionRule, W = &'static [u32]> {
    bayes: NaiveBayes<R, W>,
    /// The model's codes a code of the sensor: powers of two.
    factors: [i32; 2],
    /// Whether samples count only while something is touched.
    needs_touch: bool,
    /// The last touch.
    touch: u16,
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

impl<R: DecisionRule, W: Words> CodeClassifier<R, W> {
    /// With this classifier.
    ///
    /// # Errors
    /// [`NotCodes`] if its model was not trained on a sensor's codes.
    pub fn new(bayes: NaiveBayes<R, W>) -> Result<Self, NotCodes> {
        // At most 17 bits.
        let factors = shifts(bayes.model())?.map(|shift| 1 << shift);
        let needs_touch = bayes.model().touch_rule().is_some();
        Ok(Self {
            bayes,
            factors,
            needs_touch,
            touch: 0,
        })
    }

    /// The classifier: its model, and posteriors.
    pub const fn bayes(&self) -> &NaiveBayes<R, W> {
        &self.bayes
    }
}

impl<R: DecisionRule, W: Words> SampleClassifier for CodeClassifier<R, W> {
    #[inline]
    fn push(&mut self, sample: Sample) -> Option<Decision> {
        let [x, y] = sample.codes;
        if sample.touch != 0 && sample.touch != self.touch {
            self.touch = sample.touch;
            self.bayes.touch(sample.touch);
        }
        let codes = [
            i32::from(x).wrapping_mul(self.factors[0]),
            i32::from(y).wrapping_mul(self.factors[1]),
        ];
        // Two channels, as `new` has made sure.
        if sample.counts && (sample.touch != 0 || !self.knows_touches()) {
            return self.bayes.push(&codes).ok().flatten();
        }
        let _ = self.bayes.pass(&codes);
        None
    }

    #[inline]
    fn knows_touches(&self) -> bool {
        W::JOINT && self.needs_touch
    }

    fn interrupt(&mut self) {
        self.bayes.interrupt();
    }

    fn reset(&mut self) {
        self.touch = 0;
        self.bayes.reset();
    }
}
