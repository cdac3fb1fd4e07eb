//! Catalogue: the head, what its whiskers meet, and what is made of it.

use super::{defaulted, only, required, with_need};
use crate::spec::{Condition, Kind, Need, Presence, Range, Section};
use crate::types::{PlantKind, Rule, Sides, Texture};

pub(super) static HEAD: Section = Section {
    name: "head",
    presence: Presence::Required,
    meaning: "The array of whiskers.",
    keys: &[
        required(
            "whiskers_per_side",
            Kind::Integer { low: 1, high: 12 },
            "",
            "Whiskers on each side.",
        ),
        defaulted(
            "sides",
            Kind::Word(Sides::NAMES),
            "",
            "\"both\"",
            "Which sides are built; with `left`, lists that have one entry a side have one entry.",
        ),
    ],
};

const TEXTURED: Condition = Condition::Is("kind", PlantKind::Textured.name());

pub(super) static PLANT: Section = Section {
    name: "plant",
    presence: Presence::Required,
    meaning: "What the whiskers meet.",
    keys: &[
        required(
            "kind",
            Kind::Word(PlantKind::NAMES),
            "",
            "`ideal`: the angle is θ′ exactly, contact by BIOTACT eq. 11. \
             `textured`: simulated motor, whisker and surfaces; needs `[whisking]`.",
        ),
        with_need(
            "obstacle_deg",
            Kind::PerSide(Range::closed(-360.0, 360.0)),
            "degrees",
            Need::When {
                any: &[TEXTURED],
                without: "free whisking",
            },
            "Angle of the obstacle on each side.",
        ),
        with_need(
            "stiffness",
            Kind::Number(Range::closed(0.0, 100.0)),
            "1/degree",
            Need::When {
                any: &[Condition::Given("obstacle_deg"), TEXTURED],
                without: "not used",
            },
            "Stiffness σ_x: contact signal per degree of overlap (BIOTACT eq. 11).",
        ),
        only(
            TEXTURED,
            with_need(
                "textures",
                Kind::Words(Texture::NAMES),
                "",
                Need::When {
                    any: &[TEXTURED],
                    without: "no texture",
                },
                "Surfaces, in the order in which they are presented.",
            ),
        ),
        only(
            TEXTURED,
            with_need(
                "present_s",
                Kind::Number(Range::positive(1e5)),
                "s",
                Need::When {
                    any: &[TEXTURED],
                    without: "no texture",
                },
                "How long each texture is presented; at least one tick.",
            ),
        ),
    ],
};

pub(super) static CLASSIFIER: Section = Section {
    name: "classifier",
    presence: Presence::Optional {
        without: "no perception: nothing is classified",
        needs: None,
    },
    meaning: "Texture perception by naive Bayes (LEP10, LEP12). \
              The threshold may stand beside the window: the rule says which is used.",
    keys: &[
        required(
            "rule",
            Kind::Word(Rule::NAMES),
            "",
            "When a decision falls: once a posterior exceeds the threshold, or after each window.",
        ),
        required(
            "model",
            Kind::Path,
            "",
            "Likelihood model: from the scene's folder when it exists there, \
             else from the current directory.",
        ),
        with_need(
            "threshold",
            Kind::Number(Range::open(0.0, 1.0)),
            "",
            Need::When {
                any: &[Condition::Is("rule", Rule::SEQUENTIAL)],
                without: "not used",
            },
            "Posterior probability at which a class is decided on.",
        ),
        with_need(
            "window",
            Kind::Integer {
                low: 1,
                high: 1_000_000,
            },
            "samples",
            Need::When {
                any: &[Condition::Is("rule", Rule::WINDOW)],
                without: "not used",
            },
            "Length of the window.",
        ),
        with_need(
            "contact_min",
            Kind::Number(Range::closed(0.0, 1.0)),
            "",
            Need::When {
                any: &[],
                without: "every sample is classified",
            },
            "Contact signal below which samples are not classified.",
        ),
    ],
};
