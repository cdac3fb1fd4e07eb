//! The classifier, and the models of the build script for it.

use tactile::{Model, Sequential, Threshold};

/// A model of the build script.
#[macro_export]
macro_rules! model {
    ($name:literal) => {
        tactile::include_model!(concat!(env!("OUT_DIR"), "/", $name, ".model"))
    };
}

/// A classifier with this model.
///
/// # Panics
/// If that is none.
pub fn classifier(model: &'static [u8]) -> Sequential {
    let model = Model::parse(model).expect("a model");
    let threshold = Threshold::new(0.99).expect("a threshold");
    Sequential::new(model, threshold).expect("any model has this rule")
}

/// The samples that a decision used; 0: none fell.
#[inline]
pub fn push(classifier: &mut Sequential, codes: [i32; 2]) -> u32 {
    let decision = classifier.push(&codes).ok().flatten();
    decision.map_or(0, |decision| decision.samples())
}
