//! The configuration of a module, in one number format.

use firmware::design_parameters::{Plausible, retry, sensor_limits, swing_limits, zero_limits};
use firmware::{
    BusConfig, ClassifierConfig, Config, ConfigError, Field, HeadConfig, Links, MotionConfig,
    SensingConfig, SensorKind, SensorLimits, ServoConfig, SwingLimits,
};
use mlx90333::Decoder;
use scene::{
    ClassifierSection, Deciding, MotorSection, OnFault, PlantKind, Rest, Rule, Scene, SensorMode,
    SensorModel, SensorSection,
};
use tactile::{ClassList, ClassSetting, RuleSettings, SelfMotion, Threshold};
use whisking::motor::{GuardSettings, HomingSettings, ModelSettings};
use whisking::{Real, filter, pd};

use crate::classes::{largest, names_classes};
use crate::{Mismatch, check, contact, contact_min, settings};
use crate::{bearable, protecting, settling};

/// Contact from which a sample counts in a recording, unless the scene says otherwise.
pub const GATE: f64 = 0.05;

/// Where a module runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunsOn {
    /// In a simulation, whose plant `ideal` has nothing that guards could guard. It may record
    /// for a model that is yet to be made.
    Simulation {
        /// Whether it records.
        records: bool,
    },
    /// On a board, real or emulated.
    Board,
}

/// For what a configuration is built.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target<'t> {
    /// Where it runs.
    pub runs_on: RunsOn,
    /// The contact from which its model was trained, if that has one.
    pub gate: Option<f32>,
    /// What the scene says of its model's [`classes`](crate::classes), if it has one.
    pub classes: Option<&'t ClassList>,
    /// The keys that differ from the scene's file, `KEY=VALUE` with spaces between.
    pub overrides: &'t str,
}

impl Target<'_> {
    /// With nothing beside the scene.
    pub const fn of(runs_on: RunsOn) -> Self {
        Self {
            runs_on,
            gate: None,
            classes: None,
            overrides: "",
        }
    }
}

/// The configuration of a scene's module.
///
/// # Errors
/// What is wrong with the scene for it.
pub fn build<R: Real>(scene: &Scene, target: Target<'_>) -> Result<Config<R>, Mismatch> {
    let (runs_on, gate) = (target.runs_on, target.gate);
    let contact_min = contact_min(scene, gate)?;
    let is_simulated = runs_on != RunsOn::Board;
    let is_ideal = is_simulated && scene.plant.kind == PlantKind::Ideal;
    let has_obstacle = scene.plant.obstacle.is_some();
    let records = runs_on == RunsOn::Simulation { records: true };
    // A recording has the touches that a model of it will know.
    let contact_min = contact_min.or((records && has_obstacle).then_some(GATE));
    let contact = match contact(scene, contact_min.is_some())? {
        // The trace shows contact wherever there is something to touch.
        None if is_simulated && has_obstacle => Some(filter::Config::new(
            filter::CORNER_HZ,
            f64::from(scene.tick_hz),
        )?),
        contact => contact,
    };
    let classifier = scene.classifier.as_ref();
    let rule = classifier.filter(|_| !records);
    let classes = target.classes.filter(|_| !records);
    let classes = classes.cloned().unwrap_or_default();
    let rule = rule.map(|classifier| rule_settings(classifier, &classes));
    // A simulation shows touches whether anything is decided or not.
    let listens = is_simulated || classifier.is_some();
    Ok(Config {
        head: head(scene, target.overrides)?,
        sensor: SensingConfig {
            kind: kind(scene),
            rest_us: scene.sensor.rest_us,
            decoder: decoder(&scene.sensor),
            self_motion: scene
                .sensor
                .self_motion_s
                .map(|tau_s| SelfMotion::rate(tau_s, f64::from(scene.tick_hz))),
            limits: sensor(scene, is_ideal),
        },
        contact,
        motion: motion(scene, runs_on)?,
        classifier: listens
            .then(|| -> Result<_, Mismatch> {
                Ok(ClassifierConfig {
                    rule: rule.transpose()?,
                    deciding: classifier.map_or(Deciding::First, |classifier| classifier.whiskers),
                    contact_min: contact_min.map(R::from_f64),
                    says_pose: classifier.is_some_and(|classifier| classifier.pose),
                })
            })
            .transpose()?,
        classes,
        links: Links {
            has_rtt: scene.telemetry.rtt,
            serial_baud: scene.telemetry.serial_baud,
            has_pins: scene.telemetry.pins,
        },
    })
}

const KBIT_S: u16 = 1000;

/// The bus of a scene's head; none: one board has all whiskers.
pub fn bus(scene: &Scene) -> Option<BusConfig> {
    scene.head.nodes.map(|nodes| BusConfig {
        nodes,
        kbit_s: scene.head.bus_kbit_s.unwrap_or(KBIT_S),
    })
}

fn head(scene: &Scene, overrides: &str) -> Result<HeadConfig, Mismatch> {
    let too_long = |field| move |_| Mismatch::Config(ConfigError::Room(field));
    Ok(HeadConfig {
        name: heapless::String::try_from(scene.name.as_str()).map_err(too_long(Field::Name))?,
        overrides: heapless::String::try_from(overrides).map_err(too_long(Field::Name))?,
        tick_hz: scene.tick_hz,
        sides: scene.head.sides.count() as u8,
        whiskers_per_side: scene.head.whiskers_per_side as u8,
        bus: bus(scene),
    })
}

/// How frames of an MLX90333 are read.
pub const fn decoder(sensor: &SensorSection) -> Decoder {
    Decoder {
        mode: sensor.words,
        sum_rule: sensor.sum_rule,
        byte_order: sensor.byte_order,
    }
}

const fn kind(scene: &Scene) -> SensorKind {
    match (scene.sensor.model, scene.sensor.mode) {
        (SensorModel::Mlx90333, SensorMode::Fast) => SensorKind::FastMlx90333,
        (SensorModel::Mlx90333, SensorMode::Slow) => SensorKind::SlowMlx90333,
        (SensorModel::Tmag5170, _) => SensorKind::Tmag5170,
    }
}

fn sensor(scene: &Scene, is_ideal: bool) -> SensorLimits {
    let sensor = &scene.sensor;
    let plausible = Plausible {
        frozen_s: sensor.frozen_s,
        // By BIOTACT eq. 11 contact with a stiff obstacle is a step.
        jump_per_s: if is_ideal {
            f64::INFINITY
        } else {
            sensor.jump_per_s
        },
    };
    SensorLimits {
        swing: swing(scene).filter(|_| !is_ideal),
        zero: sensor
            .zero_after_s
            .map(|after_s| zero_limits(scene.tick_hz, after_s, sensor.zero_calm, sensor.zero_most)),
        ..sensor_limits(scene.tick_hz, plausible)
    }
}

/// Codes by which whisking moves a reading at least, and from how many whisks a second: an
/// inertia of 300 codes at 2 Hz (the plant `textured`; a shaft of the papers gives more), noise of
/// 30 from end to end.
const SWING_CODES: u16 = 50;
const SWING_HZ: f64 = 1.25;

fn swing(scene: &Scene) -> Option<SwingLimits> {
    let (whisking, motor) = (scene.whisking.as_ref()?, scene.motor.as_ref()?);
    let is_known = whisking.frequency_hz >= SWING_HZ;
    let codes = scene.sensor.swing_codes;
    let codes = codes.unwrap_or(if is_known { SWING_CODES } else { 0 });
    let limits = swing_limits(scene.tick_hz, codes, degrees_per_count(motor));
    (codes > 0).then_some(limits)
}

fn degrees_per_count(motor: &MotorSection) -> f64 {
    360.0 / (f64::from(motor.counts_per_rev) * motor.gear)
}

/// The settings of a scene's rule.
///
/// # Errors
/// [`Mismatch::Threshold`] for one that is too near to 1.
/// [`Mismatch::Classes`] where it names classes of a model that is not there.
pub fn rule_settings(
    classifier: &ClassifierSection,
    classes: &[ClassSetting],
) -> Result<RuleSettings, Mismatch> {
    if names_classes(classifier) && classes.is_empty() {
        return Err(Mismatch::Classes {
            key: "model",
            found: "none".to_owned(),
            allowed: "one, whose classes prior, thresholds or costs are of".to_owned(),
        });
    }
    Ok(match classifier.rule {
        Rule::Costs { .. } => RuleSettings::Sequential(largest(classes)),
        Rule::Sequential { threshold } => {
            let made = Threshold::new(threshold).map_err(|fault| Mismatch::Threshold {
                found: threshold,
                fault,
            })?;
            RuleSettings::Sequential(made)
        }
        Rule::Window { samples } => RuleSettings::Window(samples),
    })
}

/// `None`: they are passive.
fn motion<R: Real>(scene: &Scene, runs_on: RunsOn) -> Result<Option<MotionConfig<R>>, Mismatch> {
    let is_board = runs_on == RunsOn::Board;
    let is_ideal = !is_board && scene.plant.kind == PlantKind::Ideal;
    let (Some(settings), Some(whisking), Some(motor)) =
        (settings(scene), &scene.whisking, &scene.motor)
    else {
        return Ok(None);
    };
    check(scene)?;
    let each = scene.head.whiskers_per_side;
    let gains: Vec<&[f64]> = whisking.gain.chunks(each).collect();
    if gains.len() != whisking.start.len() || whisking.gain.len() != scene.whiskers() {
        return Err(Mismatch::Shape);
    }
    let tick_hz = f64::from(scene.tick_hz);
    let degrees_per_count = degrees_per_count(motor);
    let pd = pd::Settings {
        kp: motor.kp,
        kd: motor.kd,
        limit: motor.duty_limit,
        slew_per_s: motor.slew_per_s,
        min_deg: motor.min_deg,
        max_deg: motor.max_deg,
        degrees_per_count,
    };
    // An ideal motor is where it should be whatever it is driven with, and it has no stop.
    let guards = if is_ideal {
        GuardSettings::NONE
    } else {
        bearable::check(whisking, motor)?;
        let guards = guards(motor, degrees_per_count);
        // What is simulated cannot be harmed, and the papers' heads have gains beyond this.
        if is_board {
            protecting::check(motor, degrees_per_count)?;
            settling::check(&pd, &guards, tick_hz)?;
        }
        guards
    };
    let finds_rest = motor.rest == Rest::Find && !is_ideal;
    let homing = homing(motor, degrees_per_count, scene.sensor.zero_calm);
    if finds_rest && degrees_per_count > homing.coarsest_deg() {
        return Err(Mismatch::Coarse {
            found: motor.counts_per_rev,
            gear: motor.gear,
            allowed: (360.0 / (motor.gear * homing.coarsest_deg())).ceil(),
        });
    }
    let approach = motor.approach_deg_s / tick_hz / whisking::DEGREES_PER_UNIT;
    Ok(Some(MotionConfig {
        whisking: settings.build()?,
        start: settings.start(&whisking.start, &gains)?,
        seed: scene.seed,
        servo: ServoConfig {
            pd: pd.build(tick_hz)?,
            retry: retry(scene.tick_hz),
            guards: guards.build(tick_hz),
            approach: R::from_f64(approach),
            homing: finds_rest.then(|| homing.build(tick_hz)),
        },
        driver: motor.driver,
        stops_all: motor.on_fault == OnFault::StopAll,
        arms_at_start: motor.arms_at_start(),
    }))
}

/// The fastest that a motor can be, of its speed at full duty.
pub(crate) const TOP_SPEED: f64 = 1.25;

/// What is a fault of a motor's motion: hard is half of what it may be driven with, and rest
/// is within its travel. Whatever the plant: a board does not know what is simulated.
fn guards(motor: &MotorSection, degrees_per_count: f64) -> GuardSettings {
    GuardSettings {
        degrees_per_count,
        hard_duty: motor.duty_limit / 2.0,
        model: Some(ModelSettings {
            speed_deg_s: motor.top_speed_deg_s / TOP_SPEED,
            time_constant_s: motor.time_constant_s,
            friction_duty: motor.unmoved_duty / 2.0,
            duty_limit: motor.duty_limit,
            slew_per_s: motor.slew_per_s,
        }),
        following_deg: motor.following_limit_deg,
        top_speed_deg_s: motor.top_speed_deg_s,
        travel_deg: [
            motor.min_deg.min(whisking::REST_DEG) - motor.travel_margin_deg,
            motor.max_deg.max(whisking::REST_DEG) + motor.travel_margin_deg,
        ],
        continuous_duty: motor.continuous_duty,
    }
}

fn homing(motor: &MotorSection, degrees_per_count: f64, calm: f64) -> HomingSettings {
    HomingSettings {
        degrees_per_count,
        duty: motor.homing_duty,
        stop_deg: motor.retracted_deg(),
        max_deg: motor.max_deg.max(whisking::REST_DEG),
        far_stop_deg: motor.far_stop_deg,
        every_s: motor.home_every_s,
        calm,
    }
}
