//! From the readings of whiskers to touches, samples and decisions.

use heapless::Vec;
use serde::{Deserialize, Serialize};
use tactile::{
    ClassSetting, Deciding, Decision, Felt, Pose, RuleSettings, TouchDetector, Touching,
};
use whisking::{MAX_OWN, Real};

use crate::sensing::Reading;
use crate::{Event, Part, Place};

/// Constants of a classifier.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct ClassifierConfig<R: Real> {
    /// By which rule it decides; none: touches are found, and nothing is decided. Where its
    /// settings change, [`Perception::retune`] has to follow.
    pub rule: Option<RuleSettings>,
    /// Which whiskers decide, and by what.
    pub deciding: Deciding,
    /// Contact π of a whisker from which its samples count; none: all do.
    pub contact_min: Option<R>,
    /// Whether it is said how what is named stands ([`Event::Pose`]), where the model knows.
    pub says_pose: bool,
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

/// A classifier of the two channels of some whiskers, counted from 0, left side first.
pub trait SampleClassifier {
    /// Whether it takes the samples of a whisker.
    #[inline]
    fn hears(&self, _whisker: usize) -> bool {
        true
    }

    /// A whisker's sample in a tick with a valid reading; a decision may fall.
    fn push(&mut self, whisker: usize, sample: Sample) -> Option<Decision>;

    /// How what a whisker touches stands, if it is of this class, right after a decision
    /// ([`StreamClassifier::pose`](tactile::StreamClassifier::pose)).
    fn pose(&self, _whisker: usize, _class: usize) -> Option<Pose> {
        None
    }

    /// Whether touches mean anything to it; otherwise all is of the air.
    fn knows_touches(&self) -> bool;

    /// There is no sample of a whisker: its next does not follow the last.
    fn interrupt(&mut self, whisker: usize);

    /// Starts again.
    fn reset(&mut self);

    /// How many classes its model has; 0: there is none.
    fn classes(&self) -> usize {
        0
    }

    /// What its whiskers have felt for the head to decide by
    /// ([`StreamClassifier::evidence`](tactile::StreamClassifier::evidence)).
    fn evidence(&self) -> Option<Felt> {
        None
    }

    /// What another board's have ([`StreamClassifier::hear`](tactile::StreamClassifier::hear)).
    fn hear(&mut self, _board: usize, _felt: Option<&Felt>) -> Option<Decision> {
        None
    }

    /// Whether another board decides for the head.
    fn set_led(&mut self, _is_led: bool) {}

    /// The head has decided.
    fn forget(&mut self) {}

    /// Evidence stays unless the settings of classes are others. What does not fit changes nothing.
    fn set_rule(&mut self, settings: &RuleSettings, classes: &[ClassSetting]);
}

/// What a module makes of its readings: touches, samples and decisions, of each whisker by
/// its own contact.
///
/// Samples are the sensor's raw 14-bit codes, not the filtered contact signal:
/// texture is in the vibration above 50 Hz. While a whisker has a fault, and while its
/// reading is not [current](Reading::current), it touches nothing and there are no samples.
#[derive(Debug, Clone)]
pub struct Perception<C> {
    classifier: C,
    touches: Vec<TouchDetector, MAX_OWN>,
    tick_hz: u32,
}

impl<C: SampleClassifier> Perception<C> {
    /// Of a module of so many whiskers and ticks a second, with this classifier.
    pub fn new(classifier: C, whiskers: usize, tick_hz: u32) -> Self {
        let mut touches = Vec::new();
        for _ in 0..whiskers.min(MAX_OWN) {
            // There is room for them.
            let _ = touches.push(TouchDetector::at(tick_hz));
        }
        Self {
            classifier,
            touches,
            tick_hz,
        }
    }

    /// The classifier.
    pub const fn classifier(&self) -> &C {
        &self.classifier
    }

    /// The classifier.
    pub const fn classifier_mut(&mut self) -> &mut C {
        &mut self.classifier
    }

    /// As before the first tick.
    #[must_use]
    pub fn restarted(mut self) -> Self {
        self.classifier.reset();
        for touches in &mut self.touches {
            *touches = TouchDetector::at(self.tick_hz);
        }
        self
    }

    /// The settings of the rule have changed between two ticks.
    pub fn retune(&mut self, rule: Option<&RuleSettings>, classes: &[ClassSetting]) {
        if let Some(rule) = rule {
            self.classifier.set_rule(rule, classes);
        }
    }

    /// Whether touches of a whisker are found, counted from 0, left side first.
    #[inline]
    pub fn listens_to(&self, whisker: usize) -> bool {
        whisker < self.touches.len()
            && self.classifier.hears(whisker)
            && self.classifier.knows_touches()
    }

    /// Whether a whisker surely touches nothing, counted from 0, left side first.
    #[inline]
    pub fn is_air(&self, whisker: usize) -> bool {
        self.touches.get(whisker).is_some_and(TouchDetector::is_air)
    }

    /// What a whisker touches, counted from 0, left side first; nothing where there is none.
    pub fn touching(&self, whisker: usize) -> Touching {
        let touches = self.touches.get(whisker);
        touches.map_or_else(Touching::default, TouchDetector::touching)
    }

    /// One tick of whisker `n`, counted from 0, left side first, by its reading and its contact π.
    /// `events` gets touches and decisions.
    #[inline]
    pub fn step<R: Real>(
        &mut self,
        (n, place): (usize, Place),
        (reading, contact): (Reading, R),
        config: &ClassifierConfig<R>,
        events: &mut impl FnMut(Event),
    ) {
        let classifier = &mut self.classifier;
        let touches = self.touches.get_mut(n);
        let Some(touches) = touches.filter(|_| classifier.hears(n)) else {
            return;
        };
        if !(reading.valid && reading.current) {
            self.interrupt(n, place, events);
            return;
        }
        let codes = [reading.x.code14(), reading.y.code14()];
        let Touching { number: last, .. } = touches.touching();
        let Touching { number, is_onset } = if classifier.knows_touches() {
            touches.step(codes)
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
            counts: config.contact_min.is_none_or(|least| contact >= least),
            // A false touch in the air is none to the classifier.
            touch: if touches.is_sure() { number } else { 0 },
        };
        if let Some(decision) = classifier.push(n, sample) {
            events(Event::Decision(place, decision));
            if Part::Pose.is_built()
                && config.says_pose
                && let Some(class) = decision.class()
                && let Some(pose) = classifier.pose(n, class)
            {
                events(Event::Pose(place, pose));
            }
        }
    }

    /// A tick with a fault, or with a reading that may be frozen.
    #[cold]
    fn interrupt(&mut self, n: usize, place: Place, events: &mut impl FnMut(Event)) {
        let Some(touches) = self.touches.get_mut(n) else {
            return;
        };
        let Touching { number, .. } = touches.touching();
        if number != 0 {
            events(Event::TouchEnd { place, number });
        }
        touches.interrupt();
        self.classifier.interrupt(n);
    }
}
