//! `[classifier]`: which model, and when its evidence becomes a decision.

use tactile::Deciding;

use crate::choice::choice;
use crate::key::Condition::{self, Given, Is, IsWithout};
use crate::key::{Key, between, integer, number, path, per_class, positive, word, yes_or_no};
use crate::keys::keys;
use crate::kind::Range;
use crate::values::{Part, Read};

choice! {
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
    /// The same, at the thresholds that cost least on average.
    Costs {
        /// The cost of a wrong decision.
        error: f64,
        /// The cost of a second of contact before a decision, in the same unit.
        delay_per_s: f64,
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
            RuleName::Sequential => match from.get("cost_error") {
                Some(error) => Self::Costs {
                    error,
                    delay_per_s: from.get("cost_delay_per_s")?,
                },
                None => Self::Sequential {
                    threshold: from.get("threshold")?,
                },
            },
            RuleName::Window => Self::Window {
                samples: from.get("window")?,
            },
        })
    }
}

choice! { for Deciding { First = "first", Each = "each", Together = "together" } }

const SEQUENTIAL: &[Condition] = &[Is("rule", RuleName::Sequential.name())];
const THRESHOLD: &[Condition] = &[IsWithout("rule", RuleName::Sequential.name(), "cost_error")];
/// What is left for others must be worth a number, and nothing that is certain need be felt.
const SHARE: Range = Range {
    with_low: true,
    ..Range::open(1e-6, 1.0)
};
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

        /// Likelihood model, from the scene's folder or the current one.
        model: Option<String> = path().optional(
            "nothing is decided until `whisker deploy` brings one ([flashing.md](flashing.md))"
        ),

        /// Posterior probability at which a class is decided on.
        (threshold): f64 = between(0.0, 1.0).required_if(THRESHOLD, "not used"),

        /// Thresholds of single classes, such as `{ p600 = 0.999 }`.
        thresholds: Option<Vec<(String, f64)>> = per_class(Range::open(0.5, 1.0))
            .only_if(SEQUENTIAL)
            .optional("`threshold` holds for every class"),

        /// How frequent classes are where the module works, such as `{ smooth = 0.9 }`: P(T_k) of
        /// LEP12 eq. 4. At most 1 together; other classes share what is left evenly.
        prior: Option<Vec<(String, f64)>> = per_class(SHARE)
            .optional("all classes are equally frequent"),

        /// Cost of a wrong decision, in any unit. With `cost_delay_per_s` it gives [each class its
        /// threshold](start.md#say-what-is-frequent-and-what-errors-cost), in place of `threshold`
        /// and `thresholds`.
        (cost_error): f64 = positive(1e9)
            .only_if(SEQUENTIAL)
            .required_if(&[Given("cost_delay_per_s")], "thresholds are given"),

        /// Cost of a second of contact without a decision, in the unit of `cost_error`.
        (cost_delay_per_s): f64 = positive(1e9)
            .only_if(SEQUENTIAL)
            .required_if(&[Given("cost_error")], "thresholds are given"),

        /// Length of the window.
        (window): u32 = integer(1..=1_000_000).unit("samples").required_if(WINDOW, "not used"),

        /// Contact signal below which samples are not classified. A model that knows touches allows
        /// its own gate alone.
        contact_min: Option<f64> = number(0.0..=1.0)
            .optional("the gate of the model; without one every sample is classified"),

        /// Whether the tilt of what is named and the depth of its contact are estimated, each with
        /// its error for the sensor and the surfaces of training. The model must have learnt it
        /// ([textures.md](textures.md#how-what-is-touched-stands)).
        pose: bool = yes_or_no().default("false"),

        /// Which whiskers decide: the first of the left side; each by its own evidence; or
        /// all together, their evidence added, with rule `sequential`.
        whiskers: Deciding = word().default("\"first\""),
    }
}
