//! The constants of a scene's module, in one number format.

use firmware::design_parameters::{Plausible, retry, sensor_limits, zero_limits};
use firmware::{
    ActiveConfig, ClassifyingConfig, Config, SensorLimits, ServoConfig, StopAll, ZeroLimits,
};
use mlx90333::Decoder;
use plan::MotionPlan;
use scene::{PlantKind, Scene};
use tactile::AnyRuleSettings;
use whisking::motor::{GuardSettings, HomingConfig};
use whisking::{Real, filter};

use crate::Error;
use crate::classifier::{GATE, settings};

/// With parts that are there or not at run time.
pub(super) type HostConfig<R> = Config<
    Option<ActiveConfig<R, whisking::Config<R>, Option<StopAll>, Option<HomingConfig>>>,
    Option<ClassifyingConfig<Option<R>, Option<AnyRuleSettings>>>,
    Option<filter::Config<R>>,
>;

/// Where a module runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunsOn {
    /// In a simulation, whose plant `ideal` has nothing that guards could guard. It may record
    /// for a model that is yet to be made.
    Simulation {
        /// Whether it records.
        records: bool,
    },
    /// On a board.
    Board,
}

/// What is wrong with a scene for its module.
pub(super) fn broken(mismatch: plan::Mismatch) -> Error {
    match mismatch {
        mismatch @ (plan::Mismatch::Unstable(_) | plan::Mismatch::Gate { .. }) => {
            Error::Input(mismatch.to_string())
        }
        mismatch => Error::Work(mismatch.to_string()),
    }
}

/// The constants of `scene`, of which `plan` are those of its motion and `gate` is the contact
/// of its model.
///
/// # Errors
/// [`Error::Input`] if scene and model do not fit each other.
pub(super) fn config<R: Real, const S: usize, const N: usize>(
    scene: &Scene,
    plan: Option<&MotionPlan<R, S, N>>,
    gate: Option<f32>,
    runs_on: RunsOn,
) -> Result<HostConfig<R>, Error> {
    let tick_hz = f64::from(scene.tick_hz);
    let contact_min = plan::contact_min(scene, gate).map_err(broken)?;
    let is_simulated = runs_on != RunsOn::Board;
    let is_ideal = is_simulated && scene.plant.kind == PlantKind::Ideal;
    let has_obstacle = scene.plant.obstacle.is_some();
    // A recording has the touches that a model of it will know.
    let records = runs_on == RunsOn::Simulation { records: true } && has_obstacle;
    let contact_min = contact_min.or(records.then_some(GATE));
    let contact = match plan::contact(scene, contact_min.is_some()).map_err(broken)? {
        // The trace shows contact wherever there is something to touch.
        None if is_simulated && has_obstacle => {
            let h50 = filter::Config::new(filter::CORNER_HZ, tick_hz);
            Some(h50.map_err(|error| Error::Work(error.to_string()))?)
        }
        contact => contact,
    };
    let has_no_model = runs_on == RunsOn::Simulation { records: true };
    let rule = scene.classifier.as_ref().filter(|_| !has_no_model);
    let rule = rule.map(|classifier| settings(classifier.rule)).transpose();
    Ok(Config {
        decoder: Decoder::new(),
        sensor_limits: SensorLimits {
            zero: zero(scene),
            ..sensor_limits(scene.tick_hz, plausible(scene, is_ideal))
        },
        contact,
        motion: plan.map(|plan| ActiveConfig {
            whisking: plan.whisking,
            servo: ServoConfig {
                pd: plan.pd,
                retry: retry(scene.tick_hz),
                // An ideal motor is where it should be whatever it is driven with.
                guards: if is_ideal {
                    GuardSettings::NONE.build(tick_hz)
                } else {
                    plan.guards
                },
                approach: plan.approach,
                // Nor has it a stop.
                homing: plan.homing.filter(|_| !is_ideal),
            },
            stop_all: plan.stop_all.then_some(StopAll),
        }),
        perception: Some(ClassifyingConfig {
            contact_min: contact_min.map(R::from_f64),
            rule: rule.map_err(|fault| Error::Input(fault.to_string()))?,
        }),
        period: 0,
    })
}

/// When the zero of a scene's sensors is found anew.
fn zero(scene: &Scene) -> ZeroLimits {
    let sensor = &scene.sensor;
    sensor.zero_after_s.map_or(ZeroLimits::NONE, |after_s| {
        zero_limits(scene.tick_hz, after_s, sensor.zero_calm, sensor.zero_most)
    })
}

/// What the readings of a scene's sensors can be.
fn plausible(scene: &Scene, is_ideal: bool) -> Plausible {
    Plausible {
        frozen_s: scene.sensor.frozen_s,
        // By BIOTACT eq. 11 contact with a stiff obstacle is a step.
        jump_per_s: if is_ideal {
            f64::INFINITY
        } else {
            scene.sensor.jump_per_s
        },
    }
}
