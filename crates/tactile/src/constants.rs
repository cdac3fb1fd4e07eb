//! What a classifier holds that no sample changes.

use crate::error::SetupError;
use crate::model::Model;
use crate::rule::DecisionRule;
use crate::words::{JOINT, OPINION, Words};

/// A model and a rule for it. Nothing changes after they were joined, so a program can hold
/// the memory they take against a sum.
#[derive(Debug, Clone, PartialEq)]
pub struct Constants<R, W> {
    pub(crate) model: Model<W>,
    pub(crate) rule: R,
}

impl<R: DecisionRule, W: Words> Constants<R, W> {
    pub(crate) fn new(model: Model<W>, settings: R::Settings) -> Result<Self, SetupError> {
        if model.is_joint() && !JOINT {
            return Err(SetupError::NotBuilt("joint models"));
        }
        if model.has_opinion() && !OPINION {
            return Err(SetupError::NotBuilt("models that object"));
        }
        let rule = R::new(&model, settings)?;
        Ok(Self { model, rule })
    }

    /// Priors and thresholds of classes stay; after an error everything does.
    pub(crate) fn set_rule(&mut self, settings: R::Settings) -> Result<(), SetupError> {
        let mut rule = R::new(&self.model, settings)?;
        rule.set_classes(self.rule.classes());
        self.rule = rule;
        Ok(())
    }
}
