//! Motors and plant: what is on the far side of the module's wires.

use scene::{Driver, PlantKind, Scene, Texture};
use whisking::motor::{HBridge, SixStep, SixStepConfig};

use crate::Error;
use crate::bench::{AnyAngle, AnyMotor, IdealMotor};
use crate::motor::{MotorSettings, SimMotor};
use crate::plant::{self, Ideal, Plant, Textured, TexturedSettings};

/// The motors of all whiskers and the surface they meet.
pub struct World {
    surface: Surface,
    motors: Motors,
    angles_deg: Vec<f64>,
}

enum Surface {
    Ideal(Ideal),
    Textured(Box<Textured>),
}

enum Motors {
    /// No motors: the angles stay.
    None,
    /// Angles are θ' exactly.
    Ideal(Vec<IdealMotor>),
    Real(Vec<SimMotor>),
}

type Drives = Vec<(AnyMotor, AnyAngle)>;

impl World {
    /// The world of `scene`, and the module's side of its motors, left side first.
    ///
    /// # Errors
    /// [`Error::Work`] if the simulation refuses a setting.
    pub fn new(scene: &Scene) -> Result<(Self, Drives), Error> {
        let broken = |error: &dyn std::error::Error| Error::Work(error.to_string());
        let sides = scene.head.sides.count();
        let mut head = plant::Head::free(sides, scene.head.whiskers_per_side);
        if let Some(obstacle) = &scene.plant.obstacle {
            head.obstacle_deg.clone_from(&obstacle.deg);
            head.stiffness = obstacle.stiffness;
        }
        let (surface, motors, drives) = match scene.plant.kind {
            PlantKind::Ideal => {
                let surface = Ideal::new(head).map_err(|error| broken(&error))?;
                let (motors, drives) = ideal_motors(scene);
                (Surface::Ideal(surface), motors, drives)
            }
            PlantKind::Textured => {
                let settings = TexturedSettings::default();
                let surface =
                    Textured::new(head, settings, scene.seed).map_err(|error| broken(&error))?;
                let (motors, drives) = real_motors(scene)?;
                (Surface::Textured(Box::new(surface)), motors, drives)
            }
        };
        let angles_deg = vec![whisking::REST_DEG; scene.whiskers()];
        Ok((
            Self {
                surface,
                motors,
                angles_deg,
            },
            drives,
        ))
    }

    /// Puts another texture in place.
    pub fn present(&mut self, texture: Texture) {
        if let Surface::Textured(surface) = &mut self.surface {
            surface.present(texture);
        }
    }

    fn plant(&mut self) -> &mut dyn Plant {
        match &mut self.surface {
            Surface::Ideal(ideal) => ideal,
            Surface::Textured(textured) => textured.as_mut(),
        }
    }

    /// What the sensor of a whisker feels now: x and y, each within ±1.
    pub fn deflection(&self, side: usize, whisker: usize) -> [f64; 2] {
        match &self.surface {
            Surface::Ideal(ideal) => ideal.deflection(side, whisker),
            Surface::Textured(textured) => textured.deflection(side, whisker),
        }
    }

    /// Where the whiskers are, left side first, degrees.
    pub fn angles_deg(&self) -> &[f64] {
        &self.angles_deg
    }

    /// Moves on by `dt_s`; `theta_deg` is where the module wants its whiskers.
    pub fn advance(&mut self, theta_deg: &[f64], dt_s: f64) {
        match &mut self.motors {
            Motors::None => {}
            Motors::Ideal(motors) => {
                for (motor, theta) in motors.iter().zip(theta_deg) {
                    motor.set_deg(*theta);
                }
                self.angles_deg.copy_from_slice(theta_deg);
            }
            Motors::Real(motors) => {
                for (motor, angle) in motors.iter_mut().zip(&mut self.angles_deg) {
                    motor.advance(dt_s);
                    *angle = motor.angle_deg();
                }
            }
        }
        let angles = std::mem::take(&mut self.angles_deg);
        self.plant().advance(&angles, dt_s);
        self.angles_deg = angles;
    }
}

fn ideal_motors(scene: &Scene) -> (Motors, Drives) {
    let Some(motor) = &scene.motor else {
        return (Motors::None, Vec::new());
    };
    let counts_per_deg = f64::from(motor.counts_per_rev) * motor.gear / 360.0;
    let motors: Vec<_> = (0..scene.whiskers())
        .map(|_| IdealMotor::new(counts_per_deg))
        .collect();
    let drives = motors
        .iter()
        .map(|motor| {
            (
                AnyMotor(Box::new(motor.clone())),
                AnyAngle(Box::new(motor.clone())),
            )
        })
        .collect();
    (Motors::Ideal(motors), drives)
}

fn real_motors(scene: &Scene) -> Result<(Motors, Drives), Error> {
    let Some(motor) = &scene.motor else {
        return Ok((Motors::None, Vec::new()));
    };
    let settings = MotorSettings {
        gear: motor.gear,
        counts_per_rev: motor.counts_per_rev,
        ..MotorSettings::default()
    };
    let refused = |error| Error::Work(format!("motor: {error}"));
    let (mut motors, mut drives): (Vec<SimMotor>, Drives) = (Vec::new(), Vec::new());
    for _ in 0..scene.whiskers() {
        let (sim, driver, encoder): (_, AnyMotor, _) = match motor.driver {
            Driver::HBridge => {
                let (sim, pins) = SimMotor::brushed(settings).map_err(refused)?;
                (
                    sim,
                    AnyMotor(Box::new(HBridge::new(pins.pwm, pins.dir))),
                    pins.encoder,
                )
            }
            Driver::SixStep => {
                let (sim, pins) = SimMotor::brushless(settings).map_err(refused)?;
                let config = SixStepConfig::DEFAULT;
                let driver = SixStep::new(pins.pwms, pins.enables, pins.halls, config);
                (sim, AnyMotor(Box::new(driver)), pins.encoder)
            }
        };
        motors.push(sim);
        drives.push((driver, AnyAngle(Box::new(encoder))));
    }
    Ok((Motors::Real(motors), drives))
}
