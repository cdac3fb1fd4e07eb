//! The catalogue: every section and key of a scene file, declared once.
//!
//! A declaration is the type, the reader and the row of the reference page, so
//! what is documented is what is accepted. The tables are declared in
//! `sections/scene.rs`, the keys of each in a file of its name.

mod classifier;
mod gates;
mod head;
mod motor;
mod plant;
mod scene;
mod sensor;
mod shaft;
mod telemetry;
mod whisking;

pub(crate) use classifier::RuleName;
pub use classifier::{ClassifierSection, Rule};
pub use head::{HeadSection, Sides};
pub use motor::{Arm, MotorSection, OnFault, Rest};
pub(crate) use plant::TILT_LIMIT_DEG;
pub use plant::{
    Exchanged, FacingChoice, Obstacles, OwnSurfaces, PlantKind, PlantSection, PoseSpread,
    Presentation, ShaftChoice, Texture,
};
pub use scene::Scene;
pub use sensor::{SensorMode, SensorModel, SensorSection};
pub use shaft::{ShaftName, ShaftNumbers};
pub use telemetry::TelemetrySection;
pub use whisking::{Numbers, WhiskingSection};

use crate::section::{Presence, Section};
use crate::table::Keys;

/// The keys above the first table.
pub(crate) static TOP: Section = Section {
    name: "",
    presence: Presence::Required,
    meaning: "What the scene is called, how fast it ticks and how long it lasts.",
    entries: Scene::ENTRIES,
};

/// All sections, the top of the file first, in the order of the reference page.
pub(crate) fn sections() -> impl Iterator<Item = &'static Section> {
    std::iter::once(&TOP).chain(Scene::TABLES)
}

pub(crate) fn section(name: &str) -> Option<&'static Section> {
    sections().find(|section| section.name == name)
}

#[cfg(test)]
mod tests {
    use super::{section, sections};
    use crate::key::{Condition, Need};
    use crate::section::{Presence, Section};
    use crate::value::check;

    #[test]
    fn defaults_are_in_range() {
        let mut defaults = 0;
        for key in sections().flat_map(Section::keys) {
            if let Need::Default(toml) = key.need {
                let value = toml::de::DeValue::parse(toml).expect("a default is TOML");
                assert!(check(&key.kind, &value).is_ok(), "{} = {toml}", key.name);
                defaults += 1;
            }
        }
        // Twenty of the motor, fourteen of the plant, ten of the sensor, two of telemetry, of the
        // head and of the classifier, one of whisking.
        assert_eq!(defaults, 51);
    }

    #[test]
    fn what_the_catalogue_refers_to_is_in_it() {
        for one in sections() {
            if let Presence::Optional {
                needs: Some(needed),
                ..
            } = one.presence
            {
                assert!(section(needed).is_some(), "{needed}");
            }
            for key in one.keys() {
                let any = match key.need {
                    Need::When { any, .. } => any,
                    Need::Always | Need::Default(_) => &[],
                };
                for condition in any.iter().chain(key.only) {
                    let (Condition::Is(other, _)
                    | Condition::Given(other)
                    | Condition::IsWithout(other, ..)) = condition;
                    assert!(one.key(other).is_some(), "{} turns on {other}", key.name);
                }
            }
        }
    }
}
