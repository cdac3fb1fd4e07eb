//! Catalogue: the head, what its whiskers meet, and what is made of it.

use super::{defaulted, only, required, with_need};
use crate::spec::{Condition, Key, Kind, Need, Presence, Range, Section};
use crate::types::{PlantKind, Rule, ShaftName, Sides, Texture};

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
const ELASTIC: Condition = Condition::Is("kind", PlantKind::Whisker.name());

/// The plants with textures.
const TEXTURES: &[Condition] = &[TEXTURED, ELASTIC];

/// What there is to press on.
const STIFF: &[Condition] = &[Condition::Given("obstacle_deg"), TEXTURED, ELASTIC];

/// The plant with an elastic shaft.
const WHISKER: &[Condition] = &[ELASTIC];

/// A shaft of the scene's own numbers.
const OWN: &[Condition] = &[Condition::Is("shaft", ShaftName::Own.name())];

/// One of these numbers.
const fn own(name: &'static str, range: Range, unit: &'static str, meaning: &'static str) -> Key {
    let need = Need::When {
        any: OWN,
        without: "that of `shaft`",
    };
    only(
        OWN,
        with_need(name, Kind::Number(range), unit, need, meaning),
    )
}

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
             `textured`: simulated motor, whisker and surfaces; needs `[whisking]`. \
             `whisker`: the same with an elastic shaft that sticks, slips and bounces.",
        ),
        with_need(
            "obstacle_deg",
            Kind::PerSide(Range::closed(-360.0, 360.0)),
            "degrees",
            Need::When {
                any: TEXTURES,
                without: "free whisking",
            },
            "Angle of the obstacle on each side.",
        ),
        with_need(
            "stiffness",
            Kind::Number(Range::closed(0.0, 100.0)),
            "1/degree",
            Need::When {
                any: STIFF,
                without: "not used",
            },
            "Stiffness σ_x: contact signal per degree of overlap (BIOTACT eq. 11).",
        ),
        only(
            TEXTURES,
            with_need(
                "textures",
                Kind::Words(Texture::NAMES),
                "",
                Need::When {
                    any: TEXTURES,
                    without: "no texture",
                },
                "Surfaces, in the order in which they are presented.",
            ),
        ),
        only(
            TEXTURES,
            with_need(
                "present_s",
                Kind::Number(Range::positive(1e5)),
                "s",
                Need::When {
                    any: TEXTURES,
                    without: "no texture",
                },
                "How long each texture is presented; at least one tick.",
            ),
        ),
        only(
            WHISKER,
            defaulted(
                "shaft",
                Kind::Word(ShaftName::NAMES),
                "",
                "\"biotact-middle\"",
                "The whiskers' shaft: a paper's, or `own`: the numbers that follow.",
            ),
        ),
        own("length_m", Range::closed(1e-3, 1.0), "m", "Length."),
        own(
            "hub_diameter_m",
            Range::closed(1e-5, 0.2),
            "m",
            "Diameter at the base; at most a fifth of the length.",
        ),
        own(
            "tip_diameter_m",
            Range::closed(1e-6, 0.2),
            "m",
            "Diameter at the tip; at most a fifth of the length.",
        ),
        own(
            "youngs_pa",
            Range::closed(1e5, 1e12),
            "Pa",
            "Young's modulus.",
        ),
        own(
            "density_kg_m3",
            Range::closed(10.0, 3e4),
            "kg/m³",
            "Density.",
        ),
        own(
            "damping_ratio",
            Range::closed(1e-4, 0.99),
            "",
            "Of every mode.",
        ),
        own(
            "follicle_n_m_rad",
            Range::closed(1e-9, 1e6),
            "N m/rad",
            "Rotational stiffness of what holds the base.",
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
