//! `[classifier]`: which model, and when its evidence becomes a decision.

use tactile::Deciding;

use crate::choice::choice;
use crate::key::Condition::{self, Is};
use crate::key::{Key, between, integer, number, path, word};
use crate::keys::keys;
use crate::values::{Part, Read};

choice! {
    /// The rules' words.
    pub(crate) enum RuleName {
        /// [`Rule::Sequential`].
        Sequential = "sequential",
        /// [`Rule::Window`].
        Window = "window",
    }
}

/// When a decision falls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rule {
    /// As soon as a posterior exceeds the threshold (LEP12, Lepora et al. 2012).
    Sequential {
        /// Posterior probability, strictly between 0 and 1.
        threshold: f64,
    },
    /// Maximum likelihood over fixed windows (LEP10, Lepora et al. 2010).
    Window {
        /// Samples in a window, at least 1.
        samples: u32,
    },
}

impl Read for Rule {
    fn read(from: Part<'_>, key: &'static str) -> Option<Self> {
        Some(match from.get(key)? {
            RuleName::Sequential => Self::Sequential {
                threshold: from.get("threshold")?,
            },
            RuleName::Window => Self::Window {
                samples: from.get("window")?,
            },
        })
    }
}

choice! { for Deciding { First = "first", Each = "each", Together = "together" } }

const SEQUENTIAL: &[Condition] = &[Is("rule", RuleName::Sequential.name())];
const WINDOW: &[Condition] = &[Is("rule", RuleName::Window.name())];

/// One of the rules' words, with the key that the rule asks for.
const fn rule() -> Key<Rule> {
    word::<RuleName>().read_as()
}

keys! {
    /// Perception: which model, and when its evidence becomes a decision.
    pub struct ClassifierSection {
        /// When a decision falls: once a posterior exceeds the threshold, or after each window.
        rule: Rule = rule(),

        /// Likelihood model: from the scene's folder when it exists there, else from the current
        /// directory.
        model: Option<String> = path().optional(
            "nothing is decided until `whisker deploy` brings one ([flashing.md](flashing.md))"
        ),

        /// Posterior probability at which a class is decided on.
        (threshold): f64 = between(0.0, 1.0).required_if(SEQUENTIAL, "not used"),

        /// Length of the window.
        (window): u32 = integer(1..=1_000_000).unit("samples").required_if(WINDOW, "not used"),

        /// Contact signal below which samples are not classified. A model that knows touches
        /// was trained from one on, its gate: no other is allowed.
        contact_min: Option<f64> = number(0.0..=1.0)
            .optional("the gate of the model; without one every sample is classified"),

        /// Which whiskers decide: the first of the left side; each by its own evidence; or
        /// all together, their evidence added, with rule `sequential`.
        whiskers: Deciding = word().default("\"first\""),
    }
}
