//! A classifier of the sensors' codes. Its model may lie apart from the program, where it was
//! deployed to: it is checked at the start, and refused if anything is wrong with it.

use tactile::{
    AnyRule, ClassSetting, ClassSettings, Constants, Deciding, Decision, JOINT, MAX_STREAMS, Model,
    Pose, RuleSettings, StreamClassifier, Whisked, Words,
};

#[cfg(feature = "bus")]
use tactile::Felt;

use super::{ModelState, Refusal, Sample, SampleClassifier};
use crate::Part;
use crate::config::ERASED;

/// The model was not trained on the integer codes of a sensor's two channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the model was not trained on 14-bit sensor codes of two channels a whisker")]
pub struct NotCodes;

/// The model's codes a code of the sensor of each whisker: powers of two.
type Factors = [[i32; 2]; MAX_STREAMS];

/// The factors of a model of two channels for all whiskers, or of two for each.
fn factors<W: Words>(model: &Model<W>) -> Result<Factors, NotCodes> {
    let channels = model.channels();
    let is_shared = channels == 2;
    if !is_shared && (MAX_STREAMS == 1 || channels % 2 == 1) {
        return Err(NotCodes);
    }
    let mut factors = [[0; 2]; MAX_STREAMS];
    for (whisker, factors) in factors.iter_mut().enumerate() {
        let first = if is_shared { 0 } else { 2 * whisker };
        for (channel, factor) in (first..channels).zip(factors) {
            let quantiser = model.quantiser(channel);
            // 14 bits and 17 of shift stay below 2^31.
            let fits = quantiser.filter(|q| q.takes_raw() && q.exponent <= 17);
            *factor = 1 << fits.ok_or(NotCodes)?.exponent.unsigned_abs();
        }
    }
    Ok(factors)
}

/// What a deployed model has to fit besides the rule of its scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelLimits {
    /// Most classes that the board takes.
    pub classes: usize,
    /// Most poses that a model with a second opinion was trained in.
    pub poses: usize,
    /// The scene's contact π from which samples count, if it has one.
    pub contact_min: Option<f32>,
    /// How the scene whisks.
    pub whisked: Whisked,
    /// The scene's ticks a second.
    pub tick_hz: u32,
}

/// With its model, or why there is none: then touches are found and nothing is decided.
#[derive(Debug, Clone)]
pub struct CodeClassifier<W = &'static [u32]> {
    found: Result<Codes<W>, Refusal>,
    heard: usize,
}

#[derive(Debug, Clone)]
struct Codes<W> {
    classifier: StreamClassifier<W>,
    factors: Factors,
}

impl<'p> CodeClassifier<&'p [u32]> {
    /// With the model at the beginning of `place`, on a four-byte boundary, if it is undamaged and
    /// within `limits`, for a scene's rule and whiskers.
    pub fn at_start(
        place: &'p [u8],
        limits: ModelLimits,
        config: (RuleSettings, Deciding),
        whiskers: usize,
    ) -> Self {
        let (_, deciding) = config;
        let mut classifier = Self::refused(Refusal::Absent, deciding.heard(whiskers));
        classifier.find(place, limits, config, &[], whiskers);
        classifier
    }

    /// As [`at_start`](Self::at_start), where it lies: a board's stack has no room for it.
    pub fn find(
        &mut self,
        place: &'p [u8],
        limits: ModelLimits,
        config: (RuleSettings, Deciding),
        classes: &[ClassSetting],
        whiskers: usize,
    ) {
        let (rule, deciding) = config;
        self.heard = deciding.heard(whiskers);
        self.found = find(place, limits).and_then(|model| {
            let of_each = 2 * self.heard;
            if ![2, of_each].contains(&model.channels()) {
                return Err(Refusal::Channels);
            }
            let classifier = StreamClassifier::unstarted(model, rule, deciding, whiskers);
            let classifier = classifier.map_err(Refusal::of_setup)?;
            let factors = factors(&model).map_err(|NotCodes| Refusal::Channels)?;
            Ok(Codes {
                classifier,
                factors,
            })
        });
        if let Ok(codes) = &mut self.found {
            codes.classifier.set_classes(&ClassSettings::of(classes));
        }
    }

    /// Gives the model up, for this reason.
    pub fn refuse(&mut self, why: Refusal) {
        self.found = Err(why);
    }
}

fn find(place: &[u8], limits: ModelLimits) -> Result<Model<&[u32]>, Refusal> {
    let first = place.first_chunk().ok_or(Refusal::Absent)?;
    if u32::from_le_bytes(*first) == ERASED {
        return Err(Refusal::Absent);
    }
    let model = Model::at_start(place).map_err(Refusal::of_model)?;
    if model.classes() > limits.classes {
        return Err(Refusal::Classes);
    }
    if model.poses() > limits.poses {
        return Err(Refusal::Poses);
    }
    let gate = model.touch_rule().map(|touch| touch.gate);
    if let (Some(least), Some(gate)) = (limits.contact_min, gate)
        && least != gate
    {
        return Err(Refusal::Contact);
    }
    if model.whisked().differs(&limits.whisked) {
        return Err(Refusal::Whisked);
    }
    if model.rate_hz().is_some_and(|hz| hz != limits.tick_hz) {
        return Err(Refusal::Rate);
    }
    Ok(model)
}

impl<W: Words> CodeClassifier<W> {
    /// With this classifier.
    ///
    /// # Errors
    /// [`NotCodes`] if its model was not trained on a sensor's codes.
    pub fn new(classifier: StreamClassifier<W>) -> Result<Self, NotCodes> {
        let heard = classifier.streams();
        let factors = factors(classifier.model())?;
        let found = Ok(Codes {
            classifier,
            factors,
        });
        Ok(Self { found, heard })
    }

    /// Without a model, for this reason, in a module of which so many whiskers are heard.
    pub const fn refused(why: Refusal, heard: usize) -> Self {
        Self {
            found: Err(why),
            heard,
        }
    }

    /// The classifier, if its model was not refused.
    pub fn classifier(&self) -> Option<&StreamClassifier<W>> {
        let codes = self.found.as_ref().ok()?;
        Some(&codes.classifier)
    }

    /// Its model, likewise.
    pub fn model(&self) -> Option<&Model<W>> {
        self.classifier().map(StreamClassifier::model)
    }

    /// The contact π from which its model was trained, if that knows touches.
    pub fn gate(&self) -> Option<f32> {
        self.model()?.touch_rule().map(|touch| touch.gate)
    }

    /// Which model it is.
    pub fn state(&self) -> ModelState {
        match &self.found {
            Ok(codes) => ModelState::of(codes.classifier.model()),
            Err(refusal) => ModelState::Refused(*refusal),
        }
    }

    /// What no sample changes, likewise: its model and rule, and the factors of its codes.
    pub fn constants(&self) -> Option<(&Constants<AnyRule, W>, &Factors)> {
        let codes = self.found.as_ref().ok()?;
        Some((codes.classifier.constants(), &codes.factors))
    }
}

impl<W: Words> SampleClassifier for CodeClassifier<W> {
    #[inline]
    fn hears(&self, whisker: usize) -> bool {
        whisker < self.heard
    }

    #[inline]
    fn push(&mut self, whisker: usize, sample: Sample) -> Option<Decision> {
        let knows_touches = self.knows_touches();
        let Codes {
            classifier,
            factors,
        } = self.found.as_mut().ok()?;
        let [x, y] = sample.codes;
        let [of_x, of_y] = *factors.get(whisker)?;
        if sample.touch != 0 && sample.touch != classifier.touch_of(whisker) {
            classifier.begin_touch(whisker, sample.touch);
        }
        let codes = [
            i32::from(x).wrapping_mul(of_x),
            i32::from(y).wrapping_mul(of_y),
        ];
        // Two channels a whisker, as was made sure at the start.
        if sample.counts && (sample.touch != 0 || !knows_touches) {
            return classifier.push_to(whisker, &codes).ok().flatten();
        }
        let _ = classifier.pass_to(whisker, &codes);
        None
    }

    fn pose(&self, whisker: usize, class: usize) -> Option<Pose> {
        self.classifier()?.pose(whisker, class)
    }

    #[inline]
    fn knows_touches(&self) -> bool {
        // Without a model touches are found all the same.
        self.model()
            .map_or(JOINT, |model| model.touch_rule().is_some())
    }

    fn interrupt(&mut self, whisker: usize) {
        if let Ok(codes) = &mut self.found {
            codes.classifier.interrupt_stream(whisker);
        }
    }

    fn reset(&mut self) {
        if let Ok(codes) = &mut self.found {
            codes.classifier.restart();
        }
    }

    #[cfg(feature = "bus")]
    fn classes(&self) -> usize {
        self.model().map_or(0, Model::classes)
    }

    #[cfg(feature = "bus")]
    fn evidence(&self) -> Option<Felt> {
        self.classifier()?.evidence()
    }

    #[cfg(feature = "bus")]
    fn hear(&mut self, board: usize, felt: Option<&Felt>) -> Option<Decision> {
        let codes = self.found.as_mut().ok()?;
        codes.classifier.hear(board, felt)
    }

    #[cfg(feature = "bus")]
    fn set_led(&mut self, is_led: bool) {
        if let Ok(codes) = &mut self.found {
            codes.classifier.set_led(is_led);
        }
    }

    #[cfg(feature = "bus")]
    fn forget(&mut self) {
        if let Ok(codes) = &mut self.found {
            codes.classifier.forget();
        }
    }

    fn set_rule(&mut self, settings: &RuleSettings, classes: &[ClassSetting]) {
        if let Ok(codes) = &mut self.found {
            if Part::Priors.is_built() {
                codes.classifier.change_classes(&ClassSettings::of(classes));
            }
            // What does not fit the model changes nothing.
            let _ = codes.classifier.set_rule(*settings);
        }
    }
}
