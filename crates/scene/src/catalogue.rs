//! The catalogue: every section and key of a scene file, stated once.
//!
//! Reading ([`crate::read`], [`crate::rules`]) and the reference page
//! ([`crate::reference`]) go by it, so what is documented is what is accepted.

mod drive;
mod world;

use crate::spec::{Condition, Key, Kind, Need, Presence, Range, Section};

/// All sections, the top of the file first, in the order of the reference page.
pub(crate) static SECTIONS: &[&Section] = &[
    &TOP,
    &world::HEAD,
    &drive::WHISKING,
    &drive::RCP,
    &drive::CIA,
    &drive::MOTOR,
    &world::PLANT,
    &world::CLASSIFIER,
];

static TOP: Section = Section {
    name: "",
    presence: Presence::Required,
    meaning: "What the scene is called, how fast it ticks and how long it lasts.",
    keys: &[
        required(
            "name",
            Kind::Name { longest: 64 },
            "",
            "Name of the scene; output files are called after it.",
        ),
        required(
            "tick_hz",
            Kind::Integer {
                low: 200,
                high: 20_000,
            },
            "Hz",
            "Control and sampling rate.",
        ),
        required(
            "duration_s",
            Kind::Number(Range::positive(1e5)),
            "s",
            "Length of the run; at least one tick.",
        ),
        required(
            "seed",
            Kind::Integer {
                low: 0,
                high: i64::MAX as u64,
            },
            "",
            "Source of all randomness: the same seed gives the same bytes.",
        ),
    ],
};

/// The section of this name.
pub(crate) fn section(name: &str) -> Option<&'static Section> {
    SECTIONS
        .iter()
        .find(|section| section.name == name)
        .copied()
}

/// A key that must always be there.
const fn required(
    name: &'static str,
    kind: Kind,
    unit: &'static str,
    meaning: &'static str,
) -> Key {
    with_need(name, kind, unit, Need::Always, meaning)
}

/// A key with a default, given as TOML.
const fn defaulted(
    name: &'static str,
    kind: Kind,
    unit: &'static str,
    default: &'static str,
    meaning: &'static str,
) -> Key {
    with_need(name, kind, unit, Need::Default(default), meaning)
}

const fn with_need(
    name: &'static str,
    kind: Kind,
    unit: &'static str,
    need: Need,
    meaning: &'static str,
) -> Key {
    Key {
        name,
        kind,
        unit,
        need,
        only: &[],
        meaning,
    }
}

/// The key, made an error unless one of the conditions holds.
const fn only(conditions: &'static [Condition], key: Key) -> Key {
    Key {
        only: conditions,
        ..key
    }
}

#[cfg(test)]
mod tests {
    use super::SECTIONS;
    use crate::spec::{Condition, Need, Presence};
    use crate::value::check;

    #[test]
    fn defaults_are_in_range() {
        let mut defaults = 0;
        for key in SECTIONS.iter().flat_map(|section| section.keys) {
            if let Need::Default(toml) = key.need {
                let value = toml::de::DeValue::parse(toml).expect("a default is TOML");
                assert!(check(&key.kind, &value).is_ok(), "{} = {toml}", key.name);
                defaults += 1;
            }
        }
        // Nine of the motor, one of the head, of whisking and of the plant.
        assert_eq!(defaults, 12);
    }

    #[test]
    fn what_the_catalogue_refers_to_is_in_it() {
        for section in SECTIONS {
            if let Presence::Optional {
                needs: Some(needed),
                ..
            } = section.presence
            {
                assert!(super::section(needed).is_some(), "{needed}");
            }
            for key in section.keys {
                let any = match key.need {
                    Need::When { any, .. } => any,
                    Need::Always | Need::Default(_) => &[],
                };
                for condition in any.iter().chain(key.only) {
                    let (Condition::Is(other, _) | Condition::Given(other)) = condition;
                    let is_there = section.keys.iter().any(|key| key.name == *other);
                    assert!(is_there, "{} turns on {other}", key.name);
                }
            }
        }
    }
}
