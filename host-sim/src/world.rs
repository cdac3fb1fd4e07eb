//! Motors and plant: what is on the far side of the module's wires.

use scene::{Driver, MotorSection, PlantKind, Presentation, Rest, Scene, ShaftName};

use crate::Error;
use crate::motor::{IdealMotor, MotorSettings, Pins, SimMotor};
use crate::plant::{self, Elastic, ElasticSettings, HOLD, Ideal, Plant, Textured};
use physics::{BadSetting, Biotact, Facing, Follicle, Outline, Shaft, Surface, TOUCHING_TAPER};

/// The motors of all whiskers and the surface they meet.
#[derive(Debug)]
pub struct World {
    pub(crate) plant: Box<dyn Plant>,
    motors: Motors,
    /// Of the whiskers, left side first.
    pub(crate) angles_deg: Vec<f64>,
    /// Of ideal motors, by their last step, degrees a second.
    speeds_deg_s: Vec<f64>,
}

#[derive(Debug)]
enum Motors {
    Ideal(Vec<IdealMotor>),
    /// None where whiskers are passive: the angles stay.
    Real(Vec<SimMotor>),
}

impl Motors {
    fn pins(&self) -> Vec<Pins> {
        match self {
            Self::Ideal(motors) => motors.iter().cloned().map(Pins::Ideal).collect(),
            Self::Real(motors) => motors.iter().map(SimMotor::pins).collect(),
        }
    }
}

impl World {
    /// The world of `scene`, and the wires of its motors, left side first; none
    /// where the whiskers are passive. `pwm_counts` are the steps of the duty.
    ///
    /// # Errors
    /// [`Error::Work`] if the simulation refuses a setting.
    pub fn wired(scene: &Scene, pwm_counts: u16) -> Result<(Self, Vec<Pins>), Error> {
        let broken = |error: BadSetting| Error::Work(error.to_string());
        let obstacle = scene.plant.obstacle.as_ref();
        let nothing = vec![f64::INFINITY; scene.head.sides.count()];
        let head = plant::Head {
            whiskers_per_side: scene.head.whiskers_per_side,
            obstacle_deg: obstacle.map_or(nothing, |obstacle| obstacle.obstacle_deg.clone()),
            stiffness: obstacle.map_or(0.0, |obstacle| obstacle.stiffness),
        };
        let plant: Box<dyn Plant> = match scene.plant.kind {
            PlantKind::Ideal => Box::new(Ideal::new(head).map_err(broken)?),
            PlantKind::Textured => {
                let textured = scene.plant.textured.as_ref();
                let friction = textured.and_then(|textured| textured.friction);
                let plant = Textured::new(head, friction, Textured::NOISE_CODES, scene.seed);
                Box::new(plant.map_err(broken)?)
            }
            PlantKind::Whisker => {
                let mut settings = ElasticSettings::of(shaft(scene.plant.shaft));
                if let Some(facing) = scene.plant.facing {
                    settings.facing = Facing {
                        slant_deg: facing.slant_deg,
                        tilt_deg: facing.tilt_deg,
                        elevation_deg: facing.elevation_deg,
                    };
                    settings.touches_at = facing.touches_at;
                    settings.outline = Outline {
                        flat_m: [
                            facing.begins_m.unwrap_or(f64::NEG_INFINITY),
                            facing.ends_m.unwrap_or(f64::INFINITY),
                        ],
                        radius_m: facing.edge_radius_m,
                    };
                }
                if let Some(textured) = &scene.plant.textured {
                    own_surfaces(textured, &mut settings.own);
                    settings.friction = textured.friction;
                }
                let [least, most] = Elastic::stiffness(&settings).map_err(broken)?;
                let found = head.stiffness;
                let refused = |bad| match bad {
                    BadSetting("stiffness") => Error::Input(format!(
                        "plant.stiffness: found {found}, allowed with this shaft: {least:.1e} to \
                         {most:.1e} per degree"
                    )),
                    bad => broken(bad),
                };
                Box::new(Elastic::new(head, settings, scene.seed).map_err(refused)?)
            }
        };
        let count = scene.whiskers();
        let motors = match (&scene.motor, scene.plant.kind) {
            (None, _) => Motors::Real(Vec::new()),
            (Some(motor), PlantKind::Ideal) => {
                let counts_per_deg = f64::from(motor.counts_per_rev) * motor.gear / 360.0;
                let motor = |_| IdealMotor::new(counts_per_deg);
                Motors::Ideal((0..count).map(motor).collect())
            }
            (Some(motor), _) => real_motors(motor, count, pwm_counts)?,
        };
        let pins = motors.pins();
        let world = Self {
            plant,
            motors,
            angles_deg: vec![whisking::REST_DEG; scene.whiskers()],
            speeds_deg_s: vec![0.0; scene.whiskers()],
        };
        Ok((world, pins))
    }

    /// Starts again with another seed, as newly made. Returns new ends of the
    /// motors' wires; the old ones are no longer connected.
    pub fn restart(&mut self, seed: u64) -> Vec<Pins> {
        self.plant.restart(seed);
        self.angles_deg.fill(whisking::REST_DEG);
        self.speeds_deg_s.fill(0.0);
        match &mut self.motors {
            Motors::Ideal(motors) => {
                for motor in motors {
                    motor.set_deg(whisking::REST_DEG);
                }
            }
            Motors::Real(motors) => motors.iter_mut().for_each(SimMotor::restart),
        }
        self.motors.pins()
    }

    /// The speed of whisker `n` now, degrees a second; 0 of one that is not there.
    pub fn speed_deg_s(&self, n: usize) -> f64 {
        match &self.motors {
            Motors::Real(motors) => motors.get(n).map_or(0.0, SimMotor::speed_deg_s),
            Motors::Ideal(_) => self.speeds_deg_s.get(n).copied().unwrap_or(0.0),
        }
    }

    /// The duty at the driver of whisker `n`, -1 to 1; none where motors are ideal.
    pub fn duty(&self, n: usize) -> Option<f64> {
        match &self.motors {
            Motors::Real(motors) => motors.get(n).map(SimMotor::duty),
            Motors::Ideal(_) => None,
        }
    }

    /// The motor of whisker `n`; none where motors are ideal.
    pub fn motor_mut(&mut self, n: usize) -> Option<&mut SimMotor> {
        match &mut self.motors {
            Motors::Real(motors) => motors.get_mut(n),
            Motors::Ideal(_) => None,
        }
    }

    /// Whether the whiskers are where the module's setpoints are, as motors are ideal.
    pub const fn follows_setpoints(&self) -> bool {
        matches!(self.motors, Motors::Ideal(_))
    }

    /// Advances by `dt_s`; `theta_deg` are the module's setpoints, used by ideal motors.
    pub fn advance(&mut self, theta_deg: &[f64], dt_s: f64) {
        match &mut self.motors {
            Motors::Ideal(motors) => {
                for (motor, theta) in motors.iter().zip(theta_deg) {
                    motor.set_deg(*theta);
                }
                let angles = self.angles_deg.iter_mut().zip(theta_deg);
                for ((angle, theta), speed) in angles.zip(&mut self.speeds_deg_s) {
                    *speed = (theta - *angle) / dt_s;
                    *angle = *theta;
                }
            }
            Motors::Real(motors) => {
                for (motor, angle) in motors.iter_mut().zip(&mut self.angles_deg) {
                    motor.advance(dt_s);
                    *angle = motor.angle_deg();
                }
            }
        }
        self.plant.advance(&self.angles_deg, dt_s);
    }
}

pub(crate) const SHAFTS: [(ShaftName, Shaft); 5] = [
    (ShaftName::BiotactFront, Shaft::biotact(Biotact::Front)),
    (ShaftName::BiotactMiddle, Shaft::biotact(Biotact::Middle)),
    (ShaftName::BiotactRear, Shaft::biotact(Biotact::Rear)),
    (ShaftName::FloorRobot, Shaft::floor_robot()),
    (ShaftName::XyTable, Shaft::xy_table()),
];

/// What is simulated otherwise than it would be, or than was meant, though the scene can be run.
pub(crate) fn caution(scene: &Scene) -> Option<String> {
    let plant = &scene.plant;
    let obstacle = plant.obstacle.as_ref();
    let obstacle = obstacle.filter(|_| plant.kind == PlantKind::Whisker)?;
    let shaft = shaft(plant.shaft);
    let taper = shaft.hub_diameter_m / shaft.tip_diameter_m;
    if taper > TOUCHING_TAPER {
        return Some(format!(
            "plant.tip_diameter_m: it tapers by {taper:.0}; beyond {TOUCHING_TAPER} a simulated tip passes \
             through what it touches, and moments come out too small; host-sim press has them right"
        ));
    }
    // A plate that goes on to both sides cuts the circle of the tip twice: where it is touched, and
    // so much further.
    let facing = plant
        .facing
        .filter(|of| of.begins_m.is_none() && of.ends_m.is_none())?;
    let behind_deg = 2.0f64.mul_add(-facing.slant_deg, 180.0);
    let mut all = obstacle.obstacle_deg.iter();
    let found = all.find(|at| (whisking::REST_DEG - **at).rem_euclid(360.0) < behind_deg)?;
    Some(format!(
        "plant.obstacle_deg: a plate at {found} reaches round to the whisker at rest, which it holds; \
         for free air take 200"
    ))
}

/// The physical shaft of a scene; the default where the scene names none.
fn shaft(of: Option<scene::ShaftChoice>) -> Shaft {
    let middle = Shaft::biotact(Biotact::Middle);
    let Some(scene::ShaftChoice { shaft, own }) = of else {
        return middle;
    };
    let Some(own) = own else {
        let known = SHAFTS.iter().find(|(known, _)| *known == shaft);
        return known.map_or(middle, |(_, shaft)| *shaft);
    };
    Shaft {
        length_m: own.length_m,
        hub_diameter_m: own.hub_diameter_m,
        tip_diameter_m: own.tip_diameter_m,
        youngs_pa: own.youngs_pa,
        density_kg_m3: own.density_kg_m3,
        damping: own.damping_ratio,
        follicle: Follicle {
            rotation_n_m_rad: own.follicle_n_m_rad,
            ..middle.follicle
        },
    }
}

fn own_surfaces(textured: &Presentation, all: &mut [Surface; 4]) {
    let Some(given) = &textured.own else {
        return;
    };
    let own = textured.textures.iter().filter_map(|texture| texture.own());
    for (place, n) in own.enumerate() {
        let Some(surface) = all.get_mut(n) else {
            continue;
        };
        let set = |list: &Option<Vec<f64>>, value: &mut f64| {
            if let Some(given) = list.as_ref().and_then(|list| list.get(place)) {
                *value = *given;
            }
        };
        set(&given.own_height_m, &mut surface.height_m);
        set(&given.own_grain_m, &mut surface.grain_m);
        set(&given.own_stiffness_n_m, &mut surface.stiffness_n_m);
        set(&given.own_damping, &mut surface.damping);
        set(&given.own_friction, &mut surface.friction);
        surface.hold = HOLD * surface.friction;
    }
}

/// How far beyond the travel that is no fault the end stops are, degrees.
const STOP_MARGIN_DEG: f64 = 5.0;

/// Where the end stops are: where the scene says, if they are to be found;
/// otherwise a little beyond the travel in which the whisker may be.
fn stops_deg(motor: &MotorSection) -> [f64; 2] {
    let margin = motor.travel_margin_deg + STOP_MARGIN_DEG;
    let retracted = match motor.rest {
        Rest::AtStart => motor.min_deg.min(whisking::REST_DEG) - margin,
        Rest::Find => motor.retracted_deg(),
    };
    let protracted = match (motor.rest, motor.far_stop_deg) {
        (Rest::Find, Some(far_deg)) => far_deg,
        _ => motor.max_deg.max(whisking::REST_DEG) + margin,
    };
    [retracted, protracted]
}

fn real_motors(motor: &MotorSection, count: usize, pwm_counts: u16) -> Result<Motors, Error> {
    let settings = MotorSettings {
        gear: motor.gear,
        counts_per_rev: motor.counts_per_rev,
        stops_deg: stops_deg(motor),
        pwm_counts,
        ..MotorSettings::DEFAULT
    };
    let motor = |_| match motor.driver {
        Driver::HBridge => SimMotor::brushed(settings).map(|(motor, _)| motor),
        Driver::SixStep => SimMotor::brushless(settings).map(|(motor, _)| motor),
    };
    let motors: Result<_, _> = (0..count).map(motor).collect();
    let bad =
        |BadSetting(name)| Error::Work(format!("motor: motor setting {name} is out of range"));
    Ok(Motors::Real(motors.map_err(bad)?))
}
