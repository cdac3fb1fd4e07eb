//! What a classifier holds that no sample changes.

use crate::error::SetupError;
use crate::model::Model;
use crate::rule::DecisionRule;
use crate::words::{JOINT, Words};

/// A model and a rule for it. Nothing changes after they were joined, so a program can hold
/// the memory they take against a sum.
#[derive(Debug, Clone, PartialEq)]
pub struct Constants<R, W> {
    pub(crate) model: Model<W>,
    pub(crate) rule: R,
}

impl<R: DecisionRule, W: Words> Constants<R, W> {
    /// Joins them.
    ///
    /// # Errors
    ///
    /// The rule's settings do not fit the model, or the program was built without what the
    /// model or the rule needs.
    pub(crate) fn new(model: Model<W>, settings: R::Settings) -> Result<Self, SetupError> {
        if model.is_joint() && !JOINT {
            return Err(SetupError::NotBuilt("joint models"));
        }
        let rule = R::new(&model, settings)?;
        Ok(Self { model, rule })
    }

    /// Another rule for the model.
    ///
    /// # Errors
    ///
    /// As [`Constants::new`]; nothing has changed.
    pub(crate) fn set_rule(&mut self, settings: R::Settings) -> Result<(), SetupError> {
        self.rule = R::new(&self.model, settings)?;
        Ok(())
    }
}
