//! Why a module decides nothing, and by which model it decides otherwise.

use tactile::{Model, ModelError, SetupError, Words};

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
    Version = 3: "it is of another version of the format: train it again";
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
    /// A whole model, but not the scene's.
    Other = 11: "it is not the model that was deployed with this scene";
    /// The program has no code for its tables, its rule or so many whiskers.
    NotBuilt = 12: "the program was built without what it needs";
    /// Its opinion holds for how it was whisked in training.
    Whisked = 13: "it was trained at another whisk frequency, or with RCP otherwise";
    /// A model of several poses knows touches, and no windows.
    Touches = 14: "it decides in touches, and the scene by windows";
    /// Its blocks, gaps and roughness hold for the samples a second of its training.
    Rate = 15: "it was trained at another tick rate";
    /// The core has no time for it within a tick.
    Poses = 16: "it was trained in more poses than the board takes";
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

    pub(super) const fn of_model(error: ModelError) -> Self {
        match error {
            ModelError::BadMagic => Self::Strange,
            ModelError::UnknownVersion(_) => Self::Version,
            ModelError::TooShort => Self::TooLong,
            ModelError::Checksum => Self::Damaged,
            ModelError::Classes(_) => Self::Classes,
            _ => Self::Content,
        }
    }

    pub(super) const fn of_setup(error: SetupError) -> Self {
        match error {
            SetupError::Window { .. } => Self::Window,
            SetupError::WindowNames => Self::Touches,
            // No program has the code for windows of several whiskers together.
            SetupError::NotBuilt(_) | SetupError::Whiskers(_) | SetupError::WindowTogether => {
                Self::NotBuilt
            }
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
