//! What a scene names is linked, and nothing else: each part of the firmware, how its
//! code is called (parts.toml), and which scenes have it.

use std::collections::{BTreeMap, BTreeSet};

use config::NumberFormat;
use firmware::boards::BoardFacts;
use scene::{Deciding, Driver, Integrator, Rule, Scene, SensorModel};
use tactile::ModelBuf;

use crate::run::Fault;

/// In the names of functions that read and check constants.
const READS: [&str; 5] = ["serde", "Deserialize", "Bounded", "TryFrom", "from_words"];

/// Every part, with what stands in the names of its functions.
fn parts() -> Result<BTreeMap<String, Vec<String>>, Fault> {
    toml::from_str(include_str!("parts.toml")).map_err(|error| format!("parts.toml: {error}"))
}

#[derive(Clone, Copy)]
pub(super) struct Named<'a> {
    pub(super) scene: &'a Scene,
    pub(super) model: Option<&'a ModelBuf>,
}

/// Whether a scene on a board has a part.
fn is_named(part: &str, named: Named<'_>, board: &BoardFacts) -> Result<bool, Fault> {
    let has_fpu = board.has_fpu;
    let Named { scene, model } = named;
    // A program whose model is deployed has the code for all that a model can ask for.
    let awaits = scene.awaits_model();
    let knows_touches = awaits || model.is_some_and(|model| model.touch_rule().is_some());
    // All its tables, or none, are of samples alone.
    let is_single = !awaits && model.is_none_or(|model| !model.view().is_joint());
    let whisking = scene.whisking.as_ref();
    let classifier = scene.classifier.as_ref();
    let rule = classifier.map(|classifier| &classifier.rule);
    let driver = scene.motor.as_ref().map(|motor| motor.driver);
    let integrates = |integrator| whisking.is_some_and(|w| w.integrator == integrator);
    let has_threshold = knows_touches || classifier.is_some_and(|c| c.contact_min.is_some());
    // Whether anything is computed with numbers at all: motion, or contact.
    let computes = whisking.is_some() || has_threshold;
    let is_fixed = config::on_board(scene, "board", has_fpu) == Ok(NumberFormat::Fixed);
    let tests_itself = scene.sensor.model == SensorModel::Mlx90333;
    Ok(match part {
        "oscillators" | "muscles" => whisking.is_some(),
        "exact integrator" => integrates(Integrator::Exact),
        "Euler's integrator" => integrates(Integrator::Euler),
        "noise" => whisking.is_some_and(|w| w.noise > 0.0),
        "position control" | "encoder" | "motor PWM" | "any motor" => driver.is_some(),
        "H-bridge" => driver == Some(Driver::HBridge),
        "six-step stage" => driver == Some(Driver::SixStep),
        "RCP" => scene.rcp.is_some(),
        "CIA" => scene.cia.is_some(),
        "contact signal" => scene.rcp.is_some() || scene.cia.is_some() || has_threshold,
        "classifier" => classifier.is_some(),
        "touch detector" => knows_touches,
        "several whiskers" => classifier.is_some_and(|c| c.whiskers != Deciding::First),
        "bus of a head" => scene.head.nodes.is_some(),
        "TMAG5170" => scene.sensor.model == SensorModel::Tmag5170,
        "roughness" | "roughness or floors" => !is_single,
        "second opinion" => {
            let may = model.map_or(awaits && board.awaits_opinion, ModelBuf::has_opinion);
            classifier.is_some() && may
        }
        "poses" => classifier.is_some_and(|classifier| classifier.pose),
        "sequential rule" => matches!(rule, Some(Rule::Sequential { .. } | Rule::Costs { .. })),
        "window rule" => matches!(rule, Some(Rule::Window { .. })),
        // What a model says of touches is in single precision, and read at the start.
        "single precision" => has_fpu && knows_touches || computes && !is_fixed,
        // Without an FPU by functions of their own: that reads and compares them, and the root of a
        // self-test's noise turns whole numbers into it and back.
        "numbers compared" => !has_fpu && (classifier.is_some() || tests_itself),
        "numbers turned" => !has_fpu && tests_itself,
        "self-test" => tests_itself,
        "fixed point" => computes && is_fixed,
        _ => return Err(format!("say in size/parts.rs which scenes have: {part}")),
    })
}

/// Which parts were missed in some program and found in some other.
#[derive(Default)]
pub(super) struct Seen(BTreeMap<String, [bool; 2]>);

impl Seen {
    /// Compares a program with its scene, and says what is there or absent against the scene.
    pub(super) fn compare(
        &mut self,
        functions: &BTreeSet<String>,
        named: Named<'_>,
        board: &BoardFacts,
    ) -> Result<Vec<String>, Fault> {
        let mut wrong = Vec::new();
        for (part, code) in parts()? {
            let is_its = |name: &&String| code.iter().any(|code| name.contains(code));
            // Every image reads the constants of parts that it may be without.
            let computes = |name: &&String| !READS.iter().any(|read| name.contains(read));
            let found: Vec<&str> = functions
                .iter()
                .filter(computes)
                .filter(is_its)
                .map(String::as_str)
                .collect();
            match (found.is_empty(), is_named(&part, named, board)?) {
                (false, false) => {
                    wrong.push(format!(
                        "{part}: not named, but linked: {}",
                        found.join(", ")
                    ));
                }
                (true, true) => wrong.push(format!("{part}: named, but not found")),
                _ => {}
            }
            self.0.entry(part).or_default()[usize::from(!found.is_empty())] = true;
        }
        Ok(wrong)
    }

    /// Parts that were never there or never absent: their comparison has proved nothing.
    pub(super) fn unproven(&self) -> impl Iterator<Item = &str> {
        let seen = self.0.iter();
        seen.filter_map(|(part, both)| (*both != [true; 2]).then_some(part.as_str()))
    }
}

#[cfg(test)]
mod tests {
    use firmware::boards::NUCLEO_F446RE;

    use super::{Named, Seen, parts};
    use scene::Scene;

    const PASSIVE: &str = "name=\"p\"\ntick_hz=2000\nduration_s=1\nseed=1\n\
        [head]\nwhiskers_per_side=1\nsides=\"left\"\n[plant]\nkind=\"ideal\"\n";

    #[test]
    fn what_a_scene_names_and_nothing_else_must_be_there() {
        let whisking = "[whisking]\nfrequency_hz=2.0\nintegrator=\"exact\"\ncoupling=false\n\
                        noise=0.0\ngain=1.0\nstart=[[1.0,0.0]]\n";
        let mut seen = Seen::default();
        let mut compare = |text: &str, functions: &[&str]| {
            let scene = &Scene::from_str("p.toml", text).unwrap();
            let functions = functions.iter().map(|&name| name.to_owned()).collect();
            let named = Named { scene, model: None };
            seen.compare(&functions, named, &NUCLEO_F446RE).unwrap()
        };
        let [tests, gate] = [
            "firmware::self_test::SelfTest::of",
            "whisking::gate::Rcp<R>::step",
        ];
        let sound = compare(PASSIVE, &["firmware::sensing::decode", tests]);
        assert_eq!(sound, [""; 0]);
        let wrong = compare(PASSIVE, &[gate, tests]);
        assert_eq!(wrong, [format!("RCP: not named, but linked: {gate}")]);
        let wrong = compare(&format!("{PASSIVE}{whisking}"), &[]);
        for part in ["muscles", "single precision"] {
            assert!(wrong.contains(&format!("{part}: named, but not found")));
        }
        let unproven: Vec<&str> = seen.unproven().collect();
        let both = ["RCP", "self-test"];
        assert_eq!(unproven.len(), parts().unwrap().len() - both.len());
        assert!(!both.iter().any(|part| unproven.contains(part)));
    }
}
