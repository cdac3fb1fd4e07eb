//! Why a module decides nothing, and by which model it decides otherwise.

use tactile::{Model, ModelError, SetupError, Words};

use crate::numbered::numbered;

numbered! {
    /// Why a module decides nothing, though its scene has a classifier.
    Refusal:
    Absent = 1: "none was deployed, or writing it was interrupted";
    Strange = 2: "what lies in its place is no model";
    Version = 3: "it is of another version of the format: train it again";
    TooLong = 4: "it is longer than its place";
    Damaged = 5: "it is damaged: its checksum does not match";
    Content = 6: "it contradicts itself";
    Classes = 7: "it has more classes than the board takes";
    Channels = 8: "it was not trained on sensor codes of x and y";
    Window = 9: "the scene's window is no multiple of its block";
    Contact = 10: "the scene's contact_min is not the contact that it was trained from";
    Other = 11: "it is not the model that was deployed with this scene";
    NotBuilt = 12: "the program was built without what it needs";
    Whisked = 13: "it was trained at another whisk frequency, or with RCP otherwise";
    Touches = 14: "it decides in touches, and the scene by windows";
    Rate = 15: "it was trained at another tick rate";
    Poses = 16: "it was trained in more poses than the board takes";
}

impl Refusal {
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
