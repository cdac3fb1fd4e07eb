//! What decides about what a module touches, or does not.

mod classifying;
mod codes;
mod refusal;

pub use classifying::{ClassifierConfig, Perception, Sample, SampleClassifier};
pub use codes::{CodeClassifier, ModelLimits, NotCodes};
pub use refusal::{ModelState, Refusal};
