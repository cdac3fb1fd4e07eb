//! A classifier whose model lies apart from the program, where it was deployed to: checked at
//! the start, and refused if anything is wrong with it.

use tactile::{Decision, Model, ModelError, SetupError, Streams, Words};

use super::{CodeClassifier, Sample, SampleClassifier, TakesRule};

macro_rules! refusals {
    ($($(#[doc = $doc:literal])+ $name:ident = $code:literal: $text:literal;)*) => {
        /// Why a module decides nothing, though its scene has a classifier. Numbers keep their
        /// meanings.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Refusal {
            $($(#[doc = $doc])+ $name = $code,)*
        }

        impl Refusal {
            /// Each of them.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// What is wrong, in words.
            pub const fn text(self) -> &'static str {
                match self {
                    $(Self::$name => $text,)*
                }
            }
        }
    };
}

refusals! {
    /// Its place is empty.
    Absent = 1: "none was deployed, or writing it was interrupted";
    /// Something else lies there.
    Strange = 2: "what lies in its place is no model";
    /// The format has another version.
    Version = 3: "it is of another version of the format: train it anew";
    /// Its place ends before it.
    TooLong = 4: "it is longer than its place";
    /// The checksum is another.
    Damaged = 5: "it is damaged: its checksum does not match";
    /// Its parts do not belong together.
    Content = 6: "it contradicts itself";
    /// There are more classes than the board takes.
    Classes = 7: "it has more classes than the board takes";
    /// It was trained on something else.
    Channels = 8: "it was not trained on sensor codes of x and y";
    /// A window is not whole blocks.
    Window = 9: "the scene's window is no multiple of its block";
    /// The scene listens from another contact on.
    Contact = 10: "the scene's contact_min is not the contact that it was trained from";
}

impl Refusal {
    /// Its number, from 1.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// That of a number.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.iter().copied().find(|one| one.code() == code)
    }

    const fn of(error: ModelError) -> Self {
        match error {
            ModelError::BadMagic => Self::Strange,
            ModelError::UnknownVersion(_) => Self::Version,
            ModelError::TooShort => Self::TooLong,
            ModelError::Checksum => Self::Damaged,
            ModelError::Classes(_) => Self::Classes,
            _ => Self::Content,
        }
    }
}

/// Which model a module decides by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelState {
    /// Its scene has no classifier.
    NotHere,
    /// This one.
    Runs {
        /// The checksum of its file.
        crc: u32,
        /// How many classes it has.
        classes: u8,
    },
    /// None.
    Refused(Refusal),
}

impl ModelState {
    /// Of a module that runs `model`.
    pub fn of<W: Words>(model: &Model<W>) -> Self {
        Self::Runs {
            crc: model.crc(),
            // At most 32.
            classes: model.classes() as u8,
        }
    }
}

/// What a deployed model has to fit besides the rule of its scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelLimits {
    /// Most classes that the board takes.
    pub classes: usize,
    /// The scene's contact π from which samples count, if it has one.
    pub contact_min: Option<f32>,
}

/// A classifier with its model, or why there is none: then touches are told and nothing is
/// decided.
#[derive(Debug, Clone)]
pub struct Deployed<B>(Result<CodeClassifier<B>, Refusal>);

/// A word of flash that is erased.
const ERASED: u32 = u32::MAX;

impl<B: Streams> Deployed<B> {
    /// With the model at the beginning of `place`, which starts on a four-byte boundary, if
    /// it is undamaged and within `limits`. `make` joins it with the scene's rule.
    pub fn new<'p>(
        place: &'p [u8],
        limits: ModelLimits,
        make: impl FnOnce(Model<&'p [u32]>) -> Result<B, SetupError>,
    ) -> Self {
        Self(Self::find(place, limits, make))
    }

    fn find<'p>(
        place: &'p [u8],
        limits: ModelLimits,
        make: impl FnOnce(Model<&'p [u32]>) -> Result<B, SetupError>,
    ) -> Result<CodeClassifier<B>, Refusal> {
        let first = place.first_chunk().ok_or(Refusal::Absent)?;
        if u32::from_le_bytes(*first) == ERASED {
            return Err(Refusal::Absent);
        }
        let model = Model::at_start(place).map_err(Refusal::of)?;
        if model.classes() > limits.classes {
            return Err(Refusal::Classes);
        }
        let gate = model.touch_rule().map(|touch| touch.gate);
        if let (Some(least), Some(gate)) = (limits.contact_min, gate)
            && least != gate
        {
            return Err(Refusal::Contact);
        }
        let bayes = make(model).map_err(|error| match error {
            SetupError::Window { .. } => Refusal::Window,
            _ => Refusal::Content,
        })?;
        CodeClassifier::new(bayes).map_err(|_| Refusal::Channels)
    }

    /// The classifier, if its model was not refused.
    pub fn classifier(&self) -> Option<&CodeClassifier<B>> {
        self.0.as_ref().ok()
    }

    /// Its model, likewise.
    pub fn model(&self) -> Option<&Model<B::Words>> {
        self.classifier()
            .map(|classifier| classifier.bayes().model())
    }

    /// The contact π from which its model was trained, if that knows touches.
    pub fn gate(&self) -> Option<f32> {
        self.model()?.touch_rule().map(|touch| touch.gate)
    }

    /// Which model it is.
    pub fn state(&self) -> ModelState {
        match &self.0 {
            Ok(classifier) => ModelState::of(classifier.bayes().model()),
            Err(refusal) => ModelState::Refused(*refusal),
        }
    }
}

/// Without a model there is no rule to set.
impl<B, D> TakesRule<D> for Deployed<B>
where
    CodeClassifier<B>: TakesRule<D>,
{
    fn set_rule(&mut self, settings: &D) {
        if let Ok(classifier) = &mut self.0 {
            classifier.set_rule(settings);
        }
    }
}

impl<B: Streams> SampleClassifier for Deployed<B> {
    #[inline]
    fn push(&mut self, whisker: usize, sample: Sample) -> Option<Decision> {
        self.0.as_mut().ok()?.push(whisker, sample)
    }

    #[inline]
    fn knows_touches(&self) -> bool {
        // Without a model touches are told all the same.
        self.0
            .as_ref()
            .map_or(true, SampleClassifier::knows_touches)
    }

    fn interrupt(&mut self, whisker: usize) {
        if let Ok(classifier) = &mut self.0 {
            classifier.interrupt(whisker);
        }
    }

    fn reset(&mut self) {
        if let Ok(classifier) = &mut self.0 {
            classifier.reset();
        }
    }
}
