//! From the readings of whiskers to touches, samples and decisions.

use tactile::{Decision, TouchDetector, Touching};
use whisking::{Optional, Real};

use super::Perception;
use crate::sensing::Reading;
use crate::{Event, Place};

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

/// A classifier of the two channels of each of some whiskers, counted from 0, left side
/// first, and its state.
pub trait SampleClassifier {
    /// Whether it is told of a whisker.
    #[inline]
    fn hears(&self, _whisker: usize) -> bool {
        true
    }

    /// Takes the sample of a whisker in every tick with a valid reading; a decision may
    /// fall.
    fn push(&mut self, whisker: usize, sample: Sample) -> Option<Decision>;

    /// Whether it is to be told touches; otherwise all is of the air to it.
    fn knows_touches(&self) -> bool;

    /// There is no sample of a whisker: its next does not follow the last.
    fn interrupt(&mut self, whisker: usize);

    /// Starts anew.
    fn reset(&mut self);
}

/// A classifier whose rule has settings `D`.
pub trait TakesRule<D> {
    /// Another setting of its rule takes effect; evidence stays.
    fn set_rule(&mut self, settings: &D);
}

/// Constants of [`Classifying`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassifyingConfig<T, D> {
    /// Samples count only while the contact of their whisker is at least this;
    /// absent: always.
    pub contact_min: T,
    /// Settings of the decision rule, with which the classifier is made; where they change,
    /// it is to be [told](Perception::retune).
    pub rule: D,
}

/// Classifies what the first `B` whiskers of each of the first `A` sides touch, each with
/// its own contact and touch: the first whisker of the module alone, or all.
///
/// Samples are the sensor's raw 14-bit codes, not the filtered contact signal:
/// texture is in the vibration above 50 Hz. While a whisker has a fault, and while its
/// reading is not [current](Reading::current), it touches nothing and there are no samples.
#[derive(Debug)]
pub struct Classifying<L, const A: usize = 1, const B: usize = 1> {
    classifier: L,
    touches: [[TouchDetector; B]; A],
}

impl<L, const A: usize, const B: usize> Classifying<L, A, B> {
    /// With this classifier.
    pub const fn new(classifier: L) -> Self {
        Self {
            classifier,
            touches: [const { [const { TouchDetector::new() }; B] }; A],
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
    pub const fn classifier(&self) -> &L {
        &self.classifier
    }

    /// The classifier.
    pub const fn classifier_mut(&mut self) -> &mut L {
        &mut self.classifier
    }

    /// What each whisker touches.
    pub fn touching(&self) -> [[Touching; B]; A] {
        let side = |side: &[TouchDetector; B]| side.each_ref().map(TouchDetector::touching);
        self.touches.each_ref().map(side)
    }
}

/// A whisker that is heard, in one tick.
struct Heard<'a, L> {
    classifier: &'a mut L,
    touches: &'a mut TouchDetector,
    whisker: usize,
    place: Place,
}

impl<L: SampleClassifier> Heard<'_, L> {
    /// A tick with these codes.
    #[inline]
    fn step(self, codes: [u16; 2], counts: bool, events: &mut impl FnMut(Event)) {
        let place = self.place;
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
        let is_sure = self.touches.is_sure();
        let sample = Sample {
            codes,
            counts,
            // A false touch in the air is none to the classifier.
            touch: if is_sure { number } else { 0 },
        };
        if let Some(decision) = self.classifier.push(self.whisker, sample) {
            events(Event::Decision(place, decision));
        }
    }

    /// A tick with a fault, or with a reading that may be frozen.
    #[cold]
    fn interrupt(self, events: &mut impl FnMut(Event)) {
        let place = self.place;
        let Touching { number, .. } = self.touches.touching();
        if number != 0 {
            events(Event::TouchEnd { place, number });
        }
        self.touches.interrupt();
        self.classifier.interrupt(self.whisker);
    }
}

impl<R, T, D, L, const A: usize, const B: usize, const S: usize, const N: usize>
    Perception<R, ClassifyingConfig<T, D>, S, N> for Classifying<L, A, B>
where
    R: Real,
    T: Optional<R>,
    L: SampleClassifier + TakesRule<D>,
{
    #[inline]
    fn step(
        &mut self,
        config: &ClassifyingConfig<T, D>,
        contact: &[[R; N]; S],
        readings: &[[Reading; N]; S],
        events: &mut impl FnMut(Event),
    ) {
        let least = config.contact_min.part();
        let sides = self.touches.iter_mut().zip(readings).zip(contact);
        for (side, ((touches, readings), contact)) in sides.enumerate() {
            let whiskers = touches.iter_mut().zip(readings).zip(contact);
            for (w, ((touches, reading), contact)) in whiskers.enumerate() {
                let whisker = side * B + w;
                if !self.classifier.hears(whisker) {
                    continue;
                }
                let heard = Heard {
                    classifier: &mut self.classifier,
                    touches,
                    whisker,
                    place: Place::new(side as u8, w as u8),
                };
                if reading.valid && reading.current {
                    let codes = [reading.x.code14(), reading.y.code14()];
                    let counts = least.is_none_or(|least| contact >= least);
                    heard.step(codes, counts, events);
                } else {
                    heard.interrupt(events);
                }
            }
        }
    }

    fn retune(&mut self, config: &ClassifyingConfig<T, D>) {
        self.classifier.set_rule(&config.rule);
    }
}
