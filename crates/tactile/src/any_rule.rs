//! A rule chosen at run time, for programs on a PC. A board names its rule as
//! a type, and links no other.

use crate::decision::Decision;
use crate::error::SetupError;
use crate::evidence::EvidenceScale;
use crate::model::Model;
use crate::rule::DecisionRule;
use crate::sequential::{SequentialEvidence, SequentialRule, Threshold};
use crate::totals::Totals;
use crate::window::WindowRule;
use crate::words::Words;

/// Either of the rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AnyRule {
    /// See [`SequentialRule`].
    Sequential(SequentialRule),
    /// See [`WindowRule`].
    Window(WindowRule),
}

/// The settings of either.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AnyRuleSettings {
    /// Decides where a posterior exceeds this.
    Sequential(Threshold),
    /// Decides after every so many samples.
    Window(u32),
}

/// The evidence of either.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AnyEvidence {
    /// Of the sequential rule.
    Sequential(SequentialEvidence),
    /// Of the window rule.
    Window(Totals),
}

impl DecisionRule for AnyRule {
    type Settings = AnyRuleSettings;
    type Evidence = AnyEvidence;

    fn new<W: Words>(model: &Model<W>, settings: AnyRuleSettings) -> Result<Self, SetupError> {
        Ok(match settings {
            AnyRuleSettings::Sequential(threshold) => {
                Self::Sequential(SequentialRule::new(model, threshold)?)
            }
            AnyRuleSettings::Window(samples) => Self::Window(WindowRule::new(model, samples)?),
        })
    }

    fn interval(&self) -> u32 {
        match self {
            Self::Sequential(rule) => rule.interval(),
            Self::Window(rule) => rule.interval(),
        }
    }

    fn start(&self) -> AnyEvidence {
        match self {
            Self::Sequential(rule) => AnyEvidence::Sequential(rule.start()),
            Self::Window(rule) => AnyEvidence::Window(rule.start()),
        }
    }

    fn end_of_block(&self, sums: &mut [u32], evidence: &mut AnyEvidence) -> Option<Decision> {
        match (self, evidence) {
            (Self::Sequential(rule), AnyEvidence::Sequential(evidence)) => {
                rule.end_of_block(sums, evidence)
            }
            (Self::Window(rule), AnyEvidence::Window(evidence)) => {
                rule.end_of_block(sums, evidence)
            }
            // Evidence is the rule's own.
            _ => None,
        }
    }

    fn limit(&self, evidence: &mut AnyEvidence, limit: u32) {
        if let (Self::Sequential(rule), AnyEvidence::Sequential(evidence)) = (self, evidence) {
            rule.limit(evidence, limit);
        }
    }

    fn deficits(&self, evidence: &AnyEvidence, deficits: &mut [u32]) {
        match (self, evidence) {
            (Self::Sequential(rule), AnyEvidence::Sequential(evidence)) => {
                rule.deficits(evidence, deficits);
            }
            (Self::Window(rule), AnyEvidence::Window(evidence)) => {
                rule.deficits(evidence, deficits);
            }
            _ => {}
        }
    }

    fn scale(&self) -> EvidenceScale {
        match self {
            Self::Sequential(rule) => rule.scale(),
            Self::Window(rule) => rule.scale(),
        }
    }
}
