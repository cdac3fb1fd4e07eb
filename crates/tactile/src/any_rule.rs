//! A rule chosen at run time. A program built without the feature of a rule has no code
//! for it, and refuses its settings.

use serde::{Deserialize, Serialize};

use crate::class_setting::ClassSettings;
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RuleSettings {
    /// Decides where a posterior exceeds this.
    Sequential(Threshold),
    /// Decides after every so many samples.
    Window(u32),
}

/// The evidence of either.
// The kind that evidence is before it starts comes first, so that its bytes are zero: a program is
// 160 to 250 bytes smaller.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AnyEvidence {
    Window(Totals),
    Sequential(SequentialEvidence),
}

impl AnyEvidence {
    pub(crate) const NONE: Self = Self::Window(Totals::new());

    pub(crate) const fn sequential(&self) -> Option<&SequentialEvidence> {
        match self {
            Self::Sequential(evidence) => Some(evidence),
            Self::Window(_) => None,
        }
    }

    pub(crate) fn is_begun(&self) -> bool {
        self.sequential().is_some_and(SequentialEvidence::is_begun)
    }

    pub(crate) const fn sequential_mut(&mut self) -> Option<&mut SequentialEvidence> {
        match self {
            Self::Sequential(evidence) => Some(evidence),
            Self::Window(_) => None,
        }
    }
}

const SEQUENTIAL: bool = cfg!(feature = "sequential");
const WINDOW: bool = cfg!(feature = "window");

impl DecisionRule for AnyRule {
    type Settings = RuleSettings;
    type Evidence = AnyEvidence;

    fn new<W: Words>(model: &Model<W>, settings: RuleSettings) -> Result<Self, SetupError> {
        match settings {
            RuleSettings::Sequential(threshold) if SEQUENTIAL => {
                SequentialRule::new(model, threshold).map(Self::Sequential)
            }
            RuleSettings::Window(samples) if WINDOW => {
                WindowRule::new(model, samples).map(Self::Window)
            }
            RuleSettings::Sequential(_) => Err(SetupError::NotBuilt("sequential rule")),
            RuleSettings::Window(_) => Err(SetupError::NotBuilt("window rule")),
        }
    }

    fn set_classes(&mut self, classes: &ClassSettings) {
        match self {
            Self::Sequential(rule) if SEQUENTIAL => rule.set_classes(classes),
            Self::Window(rule) if WINDOW => rule.set_classes(classes),
            // There is no rule that is not built.
            _ => {}
        }
    }

    fn classes(&self) -> &ClassSettings {
        match self {
            Self::Sequential(rule) => rule.classes(),
            Self::Window(rule) => rule.classes(),
        }
    }

    fn start(&self) -> AnyEvidence {
        match self {
            Self::Sequential(rule) if SEQUENTIAL => AnyEvidence::Sequential(rule.start()),
            Self::Window(rule) if WINDOW => AnyEvidence::Window(rule.start()),
            // There is no rule that is not built.
            _ => AnyEvidence::NONE,
        }
    }

    fn end_of_block(&self, sums: &mut [u32], evidence: &mut AnyEvidence) -> Option<Decision> {
        match (self, evidence) {
            (Self::Sequential(rule), AnyEvidence::Sequential(evidence)) if SEQUENTIAL => {
                rule.end_of_block(sums, evidence)
            }
            (Self::Window(rule), AnyEvidence::Window(evidence)) if WINDOW => {
                rule.end_of_block(sums, evidence)
            }
            // Evidence is the rule's own.
            _ => None,
        }
    }

    fn gather(&self, sums: &mut [u32], evidence: &mut AnyEvidence) {
        match (self, evidence) {
            (Self::Sequential(rule), AnyEvidence::Sequential(evidence)) if SEQUENTIAL => {
                rule.gather(sums, evidence);
            }
            (_, evidence) => {
                let _ = self.end_of_block(sums, evidence);
            }
        }
    }

    fn limit(&self, evidence: &mut AnyEvidence, limit: u32) {
        if let (Self::Sequential(rule), AnyEvidence::Sequential(evidence)) = (self, evidence)
            && SEQUENTIAL
        {
            rule.limit(evidence, limit);
        }
    }

    fn decide_between(&self, classes: usize, evidence: &AnyEvidence) -> Option<Decision> {
        match (self, evidence) {
            (Self::Sequential(rule), AnyEvidence::Sequential(evidence)) if SEQUENTIAL => {
                rule.decide_between(classes, evidence)
            }
            _ => None,
        }
    }

    fn deficits(&self, evidence: &AnyEvidence, deficits: &mut [u32]) {
        match (self, evidence) {
            (Self::Sequential(rule), AnyEvidence::Sequential(evidence)) if SEQUENTIAL => {
                rule.deficits(evidence, deficits);
            }
            (Self::Window(rule), AnyEvidence::Window(evidence)) if WINDOW => {
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
