//! Part checked values to a scene.
//!
//! It runs only on values without problems. `None` would mean that the
//! catalogue lacks a key or gives it another type than is asked for here; the
//! tests rule that out by reading every key.

use crate::read::Values;
use crate::types::{
    Classifier, Driver, Gate, Head, Integrator, Motor, Numbers, Obstacle, Plant, PlantKind, Rule,
    Scene, Shaft, ShaftName, ShaftNumbers, Sides, Texture, Textured, Whisking,
};
use crate::value::Value;

/// One section of the values, read by type.
#[derive(Clone, Copy)]
struct Part<'v> {
    values: &'v Values,
    section: &'static str,
}

impl Part<'_> {
    fn bool(self, key: &'static str) -> Option<bool> {
        match self.values.get(self.section, key)? {
            Value::Bool(bool) => Some(*bool),
            _ => None,
        }
    }

    fn integer<T: TryFrom<u64>>(self, key: &'static str) -> Option<T> {
        match self.values.get(self.section, key)? {
            Value::Integer(n) => T::try_from(*n).ok(),
            _ => None,
        }
    }

    fn number(self, key: &'static str) -> Option<f64> {
        match self.values.get(self.section, key)? {
            Value::Number(x) => Some(*x),
            _ => None,
        }
    }

    fn text(self, key: &'static str) -> Option<String> {
        match self.values.get(self.section, key)? {
            Value::Text(text) => Some(text.clone()),
            _ => None,
        }
    }

    fn numbers(self, key: &'static str) -> Option<Vec<f64>> {
        match self.values.get(self.section, key)? {
            Value::Numbers(list) => Some(list.clone()),
            _ => None,
        }
    }
}

/// The scene that the values describe.
pub(crate) fn scene(values: &Values) -> Option<Scene> {
    let all = |section| Part { values, section };
    let given = |section| values.section(section).map(|_| Part { values, section });
    let top = all("");
    let head = Head {
        whiskers_per_side: all("head").integer("whiskers_per_side")?,
        sides: Sides::from_name(&all("head").text("sides")?)?,
    };
    let whiskers = head.sides.count() * head.whiskers_per_side;
    let whisking = match given("whisking") {
        Some(part) => Some(read_whisking(part, whiskers)?),
        None => None,
    };
    let motor = match whisking {
        Some(_) => Some(read_motor(all("motor"))?),
        None => None,
    };
    let gate = |section| match given(section) {
        Some(part) => read_gate(part).map(Some),
        None => Some(None),
    };
    let classifier = match given("classifier") {
        Some(part) => Some(read_classifier(part)?),
        None => None,
    };
    Some(Scene {
        name: top.text("name")?,
        tick_hz: top.integer("tick_hz")?,
        duration_s: top.number("duration_s")?,
        seed: top.integer("seed")?,
        head,
        whisking,
        rcp: gate("rcp")?,
        cia: gate("cia")?,
        motor,
        plant: read_plant(all("plant"))?,
        classifier,
    })
}

fn read_whisking(part: Part<'_>, whiskers: usize) -> Option<Whisking> {
    let gain = match part.number("gain") {
        Some(gain) => vec![gain; whiskers],
        None => part.numbers("gain")?,
    };
    let Value::Pairs(start) = part.values.get(part.section, "start")? else {
        return None;
    };
    let integrator = Integrator::from_name(&part.text("integrator")?)?;
    let numbers_said = Numbers::from_name(&part.text("numbers")?)?;
    let numbers = match (numbers_said, integrator) {
        (Numbers::Auto, Integrator::Exact) => Numbers::Single,
        (Numbers::Auto, Integrator::Euler) => Numbers::Double,
        (said, _) => said,
    };
    Some(Whisking {
        frequency_hz: part.number("frequency_hz")?,
        integrator,
        coupling: part.bool("coupling")?,
        noise: part.number("noise")?,
        gain,
        start: start.clone(),
        numbers,
        numbers_said,
    })
}

fn read_gate(part: Part<'_>) -> Option<Gate> {
    Some(Gate {
        gain: part.number("gain")?,
        tau_s: part.number("tau_s")?,
    })
}

fn read_motor(part: Part<'_>) -> Option<Motor> {
    Some(Motor {
        driver: Driver::from_name(&part.text("driver")?)?,
        kp: part.number("kp")?,
        kd: part.number("kd")?,
        duty_limit: part.number("duty_limit")?,
        slew_per_s: part.number("slew_per_s")?,
        min_deg: part.number("min_deg")?,
        max_deg: part.number("max_deg")?,
        gear: part.number("gear")?,
        counts_per_rev: part.integer("counts_per_rev")?,
    })
}

fn read_plant(part: Part<'_>) -> Option<Plant> {
    let kind = PlantKind::from_name(&part.text("kind")?)?;
    let obstacle = match part.numbers("obstacle_deg") {
        Some(deg) => Some(Obstacle {
            deg,
            stiffness: part.number("stiffness")?,
        }),
        None => None,
    };
    let textured = match kind {
        PlantKind::Ideal => None,
        PlantKind::Textured | PlantKind::Whisker => {
            let Value::Texts(names) = part.values.get(part.section, "textures")? else {
                return None;
            };
            let textures: Option<Vec<Texture>> =
                names.iter().map(|name| Texture::from_name(name)).collect();
            Some(Textured {
                textures: textures?,
                present_s: part.number("present_s")?,
            })
        }
    };
    let shaft = match kind {
        PlantKind::Ideal | PlantKind::Textured => None,
        PlantKind::Whisker => Some(read_shaft(part)?),
    };
    Some(Plant {
        kind,
        obstacle,
        textured,
        shaft,
    })
}

fn read_shaft(part: Part<'_>) -> Option<Shaft> {
    let name = ShaftName::from_name(&part.text("shaft")?)?;
    let own = match name {
        ShaftName::Own => Some(ShaftNumbers {
            length_m: part.number("length_m")?,
            hub_diameter_m: part.number("hub_diameter_m")?,
            tip_diameter_m: part.number("tip_diameter_m")?,
            youngs_pa: part.number("youngs_pa")?,
            density_kg_m3: part.number("density_kg_m3")?,
            damping_ratio: part.number("damping_ratio")?,
            follicle_n_m_rad: part.number("follicle_n_m_rad")?,
        }),
        _ => None,
    };
    Some(Shaft { name, own })
}

fn read_classifier(part: Part<'_>) -> Option<Classifier> {
    let rule = match part.text("rule")?.as_str() {
        Rule::SEQUENTIAL => Rule::Sequential {
            threshold: part.number("threshold")?,
        },
        Rule::WINDOW => Rule::Window {
            samples: part.integer("window")?,
        },
        _ => return None,
    };
    Some(Classifier {
        rule,
        model: part.text("model")?,
        contact_min: part.number("contact_min"),
    })
}
