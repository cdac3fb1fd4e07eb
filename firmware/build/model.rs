//! The model of a scene's classifier, checked for the board.

use std::error::Error;
use std::fmt::Display;
use std::fs;
use std::path::Path;

use scene::{ClassifierSection, Rule};
use tactile::{ModelBuf, Threshold};

/// Largest exponent of a model's scale that still lets 14-bit codes fit it.
const MAX_EXPONENT: i16 = 17;

/// Reads the model at `path` and checks it against the scene's classifier.
///
/// # Errors
/// What keeps a board from classifying with it.
pub(crate) fn read(
    path: &Path,
    classifier: &ClassifierSection,
) -> Result<ModelBuf, Box<dyn Error>> {
    let refused = |reason: &dyn Display| format!("model {}: {reason}", path.display());
    let bytes = fs::read(path)
        .map_err(|error| refused(&format!("{error}; train it first with `host-sim train`")))?;
    let model = ModelBuf::from_bytes(&bytes).map_err(|error| refused(&error))?;
    let takes_codes = |channel| {
        model
            .quantiser(channel)
            .is_some_and(|q| q.takes_raw() && q.exponent <= MAX_EXPONENT.into())
    };
    if model.channels() != 2 || !takes_codes(0) || !takes_codes(1) {
        return Err(refused(&"it was not trained on sensor codes of x and y").into());
    }
    if let Rule::Window { samples } = classifier.rule
        && !samples.is_multiple_of(model.block())
    {
        let block = model.block();
        return Err(refused(&format!(
            "classifier.window: found {samples}; allowed: a multiple of the model's block of \
             {block}"
        ))
        .into());
    }
    Ok(model)
}

/// What is wrong with a rule for any model.
///
/// # Errors
/// A threshold too near to 1.
pub(crate) fn check_rule(rule: Rule) -> Result<(), String> {
    match rule {
        Rule::Sequential { threshold } => Threshold::new(threshold)
            .map(drop)
            .map_err(|error| format!("classifier.threshold: found {threshold}; {error}")),
        Rule::Window { .. } => Ok(()),
    }
}
