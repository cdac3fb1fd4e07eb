//! What a scene names is linked, and nothing else: each part of the firmware,
//! how its code is called, and which scenes have it.

use std::collections::BTreeSet;

use plan::NumberFormat;
use scene::{Driver, Integrator, Rule, Scene};

/// A part that a scene names or leaves out.
pub(super) struct Part {
    /// What messages call it.
    pub(super) name: &'static str,
    /// Its functions have one of these in their name.
    code: &'static [&'static str],
    /// Whether a scene on a board, with an FPU or without, has it.
    named: fn(&Scene, bool) -> bool,
}

/// Every part.
pub(super) const ALL: [Part; 19] = [
    Part {
        name: "oscillators",
        code: &["whisking::oscillator::"],
        named: |scene, _| scene.whisking.is_some(),
    },
    Part {
        name: "exact integrator",
        code: &["whisking::oscillator::exact::", "whisking::muscle::exact::"],
        named: |scene, _| integrates(scene, Integrator::Exact),
    },
    Part {
        name: "Euler's integrator",
        code: &["whisking::oscillator::euler::", "whisking::muscle::euler::"],
        named: |scene, _| integrates(scene, Integrator::Euler),
    },
    Part {
        name: "noise",
        code: &["whisking::noise::"],
        named: |scene, _| scene.whisking.as_ref().is_some_and(|w| w.noise > 0.0),
    },
    Part {
        name: "muscles",
        code: &["whisking::muscle::"],
        named: |scene, _| scene.whisking.is_some(),
    },
    Part {
        name: "position control",
        code: &["whisking::pd::"],
        named: |scene, _| scene.motor.is_some(),
    },
    Part {
        name: "encoder",
        code: &["board::encoder::"],
        named: |scene, _| scene.motor.is_some(),
    },
    Part {
        name: "motor PWM",
        code: &["board::pwm::"],
        named: |scene, _| scene.motor.is_some(),
    },
    Part {
        name: "any motor",
        code: &[
            "whisking::motor::",
            "firmware::active::",
            "firmware::servo::",
        ],
        named: |scene, _| scene.motor.is_some(),
    },
    Part {
        name: "H-bridge",
        code: &["whisking::motor::hbridge::"],
        named: |scene, _| drives(scene, Driver::HBridge),
    },
    Part {
        name: "six-step stage",
        code: &["whisking::motor::six_step::"],
        named: |scene, _| drives(scene, Driver::SixStep),
    },
    Part {
        name: "RCP",
        code: &["whisking::gate::Rcp"],
        named: |scene, _| scene.rcp.is_some(),
    },
    Part {
        name: "CIA",
        code: &["whisking::gate::Cia"],
        named: |scene, _| scene.cia.is_some(),
    },
    Part {
        name: "contact signal",
        code: &["firmware::module::Module<R,F,M,P,C,_,_>::feel"],
        named: |scene, _| {
            let least = scene.classifier.as_ref().and_then(|c| c.contact_min);
            scene.rcp.is_some() || scene.cia.is_some() || least.is_some()
        },
    },
    Part {
        name: "classifier",
        code: &["tactile::"],
        named: |scene, _| scene.classifier.is_some(),
    },
    Part {
        name: "sequential rule",
        code: &["tactile::sequential::"],
        named: |scene, _| decides(scene, |rule| matches!(rule, Rule::Sequential { .. })),
    },
    Part {
        name: "window rule",
        code: &["tactile::window::"],
        named: |scene, _| decides(scene, |rule| matches!(rule, Rule::Window { .. })),
    },
    Part {
        name: "single precision",
        code: &["whisking::real::float::", "compiler_builtins::float::"],
        named: |scene, has_fpu| computes(scene) && !is_fixed(scene, has_fpu),
    },
    Part {
        name: "fixed point",
        code: &["whisking::real::fix::"],
        named: |scene, has_fpu| computes(scene) && is_fixed(scene, has_fpu),
    },
];

fn integrates(scene: &Scene, integrator: Integrator) -> bool {
    let whisking = scene.whisking.as_ref();
    whisking.is_some_and(|whisking| whisking.integrator == integrator)
}

fn drives(scene: &Scene, driver: Driver) -> bool {
    let motor = scene.motor.as_ref();
    motor.is_some_and(|motor| motor.driver == driver)
}

fn decides(scene: &Scene, is: impl Fn(&Rule) -> bool) -> bool {
    let classifier = scene.classifier.as_ref();
    classifier.is_some_and(|classifier| is(&classifier.rule))
}

/// Whether anything is computed with numbers at all: motion, or contact.
fn computes(scene: &Scene) -> bool {
    let least = scene.classifier.as_ref().and_then(|c| c.contact_min);
    scene.whisking.is_some() || least.is_some()
}

fn is_fixed(scene: &Scene, has_fpu: bool) -> bool {
    plan::on_board(scene, "board", has_fpu) == Ok(NumberFormat::Fixed)
}

impl Part {
    /// Whether a program of these functions has it.
    pub(super) fn is_in(&self, functions: &BTreeSet<String>) -> bool {
        let is_its = |name: &String| self.code.iter().any(|code| name.contains(code));
        functions.iter().any(is_its)
    }

    /// Whether the scene has it, on a board with an FPU or without.
    pub(super) fn is_named(&self, scene: &Scene, has_fpu: bool) -> bool {
        (self.named)(scene, has_fpu)
    }
}

/// Which parts were found in some program and missed in some other.
#[derive(Default)]
pub(super) struct Seen {
    there: BTreeSet<&'static str>,
    absent: BTreeSet<&'static str>,
}

impl Seen {
    /// Compares a program with its scene, and says what is there or absent
    /// against the scene.
    pub(super) fn compare(
        &mut self,
        functions: &BTreeSet<String>,
        scene: &Scene,
        has_fpu: bool,
    ) -> Vec<String> {
        let mut wrong = Vec::new();
        for part in &ALL {
            let (found, named) = (part.is_in(functions), part.is_named(scene, has_fpu));
            let side = if found {
                &mut self.there
            } else {
                &mut self.absent
            };
            side.insert(part.name);
            match (found, named) {
                (true, false) => wrong.push(format!("{}: linked, but not named", part.name)),
                (false, true) => wrong.push(format!("{}: named, but not found", part.name)),
                _ => {}
            }
        }
        wrong
    }

    /// Parts that were never there or never absent: their comparison has proved
    /// nothing.
    pub(super) fn unproven(&self) -> Vec<&'static str> {
        let both = |name: &str| self.there.contains(name) && self.absent.contains(name);
        let names = ALL.iter().map(|part| part.name);
        names.filter(|name| !both(name)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{ALL, Seen};
    use scene::Scene;
    use std::collections::BTreeSet;

    const PASSIVE: &str = "name=\"p\"\ntick_hz=2000\nduration_s=1\nseed=1\n\
        [head]\nwhiskers_per_side=1\nsides=\"left\"\n[plant]\nkind=\"ideal\"\n";

    #[test]
    fn what_a_scene_leaves_out_must_be_absent() {
        let scene = Scene::from_str("p.toml", PASSIVE).unwrap();
        let mut seen = Seen::default();
        let sound = BTreeSet::from(["firmware::sensing::decode".to_owned()]);
        assert!(seen.compare(&sound, &scene, true).is_empty());
        let gate = BTreeSet::from(["whisking::gate::Rcp<R>::step".to_owned()]);
        let wrong = seen.compare(&gate, &scene, true);
        assert_eq!(wrong, ["RCP: linked, but not named"]);
        assert_eq!(seen.unproven().len(), ALL.len() - 1, "RCP was both");
    }

    #[test]
    fn what_a_scene_names_must_be_there() {
        let text = format!(
            "{PASSIVE}{}",
            "[whisking]\nfrequency_hz=2.0\nintegrator=\"exact\"\ncoupling=false\n\
             noise=0.0\ngain=1.0\nstart=[[1.0,0.0]]\n"
        );
        let scene = Scene::from_str("a.toml", &text).unwrap();
        let wrong = Seen::default().compare(&BTreeSet::new(), &scene, true);
        assert!(wrong.contains(&"muscles: named, but not found".to_owned()));
        assert!(wrong.contains(&"single precision: named, but not found".to_owned()));
    }
}
