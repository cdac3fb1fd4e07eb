//! The head's module: the firmware's own tick on six sensors and motors. All that it knows of its
//! whiskers comes by sensor frames and encoders. A whisker that is bent pulls back on its motor.

use anyhow::Result;
use firmware::design_parameters::{Plausible, retry, sensor_limits};
use firmware::{
    BusError, Config, Driver, Event, FrameSource, Hardware, HeadConfig, Module, MotionConfig,
    SensingConfig, ServoConfig, WhiskerParts,
};
use host_sim::bench::NoClock;
use host_sim::classifier::Tap;
use host_sim::drive::{self, AnyAngle, AnyMotor};
use host_sim::motor::{IdealMotor, MotorSettings, Pins, SimMotor};
use mlx90333::{FRAME_LEN, Faults, SumRule, Word, encode};
use whisking::motor::GuardSettings;
use whisking::{degrees, filter, pd};

use super::read::keys;

pub(super) const SIDES: usize = 2;
/// Whiskers of a side, the front one first.
pub(super) const EACH: usize = 3;

keys! {
    #[derive(Copy)]
    PositionControl, rig:
    follows: bool,
    kp: f64 => 0.0..=1e3,
    kd: f64 => 0.0..=1e3,
    slew_per_s: f64 => 1.0..=1e6,
    min_deg: f64 => -180.0..=180.0,
    max_deg: f64 => rig.min_deg..=360.0,
}

impl PositionControl {
    /// How far a whisker may be off where friction holds it, degrees: τ_c over k_p k U/R.
    pub(crate) fn dead_band_deg(&self) -> f64 {
        let motor = MotorSettings::DEFAULT;
        let full_nm = motor.torque_nm_per_a * motor.supply_v / motor.resistance_ohm;
        motor.coulomb_nm / (self.kp * full_nm)
    }
}

/// Full duty is allowed, and half of it counts as driven hard, as in a scene.
const DUTY_LIMIT: f64 = 1.0;

/// The newest frame of a sensor: the tick reads what was measured before it.
struct Frames([u8; FRAME_LEN]);

impl Frames {
    const REST: Self = Self(encode::alpha_beta(
        Word::MID,
        Word::MID,
        Faults::NONE,
        SumRule::SumB1B6,
    ));

    /// Codes within ±8191 of mid-scale.
    fn set(&mut self, codes: [i16; 2]) {
        let [x, y] = codes.map(|code| Word::new((8192_i16.saturating_add(code) as u16) << 2));
        self.0 = encode::alpha_beta(x, y, Faults::NONE, SumRule::SumB1B6);
    }
}

impl FrameSource for Frames {
    fn take(&mut self) -> Result<Option<[u8; FRAME_LEN]>, BusError> {
        Ok(Some(self.0))
    }
}

enum Actuator {
    Motor(Box<SimMotor>),
    Ideal(IdealMotor),
}

/// What the head is made of; it decides nothing.
struct Parts;

impl Hardware for Parts {
    type Source = Frames;
    type Motor = AnyMotor;
    type Angle = AnyAngle;
    type Classifier = Tap;
    type Clock = NoClock;
}

/// A module of six whiskers with its motors, left side first, at θ' = 50 degrees.
pub(super) struct HeadModule {
    module: Module<f64, Parts>,
    config: Config<f64>,
    actuators: Vec<Actuator>,
}

impl HeadModule {
    /// A module that has not ticked; `gain` is that of all whiskers.
    pub(super) fn new(
        settings: &whisking::Settings,
        control: &PositionControl,
        gain: f64,
        seed: u64,
    ) -> Result<Self> {
        let tick_hz = settings.tick_hz;
        let ticks_per_s = tick_hz.round() as u32;
        let motor = MotorSettings::DEFAULT;
        let pd = pd::Settings {
            kp: control.kp,
            kd: control.kd,
            limit: DUTY_LIMIT,
            slew_per_s: control.slew_per_s,
            min_deg: control.min_deg,
            max_deg: control.max_deg,
            degrees_per_count: motor.degrees_per_count(),
        };
        let guards = GuardSettings::NONE.build(tick_hz);
        let still = Config::still();
        let config = Config {
            head: HeadConfig {
                tick_hz: ticks_per_s,
                sides: SIDES as u8,
                whiskers_per_side: EACH as u8,
                ..still.head
            },
            sensor: SensingConfig {
                limits: sensor_limits(ticks_per_s, Plausible::ANY),
                ..still.sensor
            },
            contact: Some(filter::Config::new(filter::CORNER_HZ, tick_hz)?),
            motion: Some(MotionConfig {
                whisking: settings.build()?,
                // Retracted, so that no whisker begins inside the surface.
                start: settings.start(&[[-1.0, 0.0]; SIDES], &[&[gain; EACH][..]; SIDES])?,
                seed,
                servo: ServoConfig {
                    pd: pd.build(tick_hz)?,
                    retry: retry(ticks_per_s),
                    guards,
                    approach: 1.0,
                    homing: None,
                },
                driver: Driver::HBridge,
                stops_all: false,
                arms_at_start: true,
            }),
            ..still
        };

        let mut actuators = Vec::with_capacity(SIDES * EACH);
        let mut parts = Vec::with_capacity(SIDES * EACH);
        for _ in 0..SIDES * EACH {
            let (actuator, pins) = if control.follows {
                let (motor, pins) = SimMotor::brushed(motor)?;
                (Actuator::Motor(Box::new(motor)), Pins::Brushed(pins))
            } else {
                let ideal = IdealMotor::new(1.0 / motor.degrees_per_count());
                (Actuator::Ideal(ideal.clone()), Pins::Ideal(ideal))
            };
            actuators.push(actuator);
            parts.push(WhiskerParts {
                source: Frames::REST,
                motor: Some(drive::on(pins, guards.stall)),
            });
        }
        let mut module = Module::new(&config, parts, None, (NoClock, 0));
        module.arm(true);
        Ok(Self {
            module,
            config,
            actuators,
        })
    }

    pub(super) fn feel(&mut self, n: usize, codes: [i16; 2]) {
        if let Some(whisker) = self.module.whiskers_mut().get_mut(n) {
            whisker.sensor_mut().source_mut().set(codes);
        }
    }

    pub(super) fn tick(&mut self) -> Result<()> {
        let mut fault = None;
        self.module.tick(&self.config, &mut |event| {
            if let Event::MotorFault(..) = event {
                fault = Some(format!("{event:?}"));
            }
        });
        fault.map_or(Ok(()), |fault| Err(anyhow::Error::msg(fault)))
    }

    /// Lets a tick pass for the motor of whisker `n` against a torque on the
    /// whisker, N·m, positive towards protraction; the angle θ' after it, degrees.
    pub(super) fn turn(&mut self, n: usize, load_nm: f64, dt_s: f64) -> f64 {
        match self.actuators.get_mut(n) {
            Some(Actuator::Motor(motor)) => {
                motor.set_load_nm(load_nm);
                motor.advance(dt_s);
                motor.angle_deg()
            }
            Some(Actuator::Ideal(motor)) => {
                let motion = self.module.motion();
                let theta = motion.and_then(|motion| motion.state().theta().nth(n));
                let angle = theta.map_or(f64::NAN, degrees);
                motor.set_deg(angle);
                angle
            }
            None => f64::NAN,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{EACH, HeadModule, PositionControl, SIDES};
    use firmware::{Command, Place};
    use whisking::{Integrator, Settings, protraction};

    const CONTROL: PositionControl = PositionControl {
        follows: true,
        kp: 0.05,
        kd: 0.0004,
        slew_per_s: 400.0,
        min_deg: 30.0,
        max_deg: 160.0,
    };

    const WHISKING: Settings = Settings {
        tick_hz: 2000.0,
        frequency_hz: 2.0,
        integrator: Integrator::Exact,
        coupling: true,
        noise: 0.0,
        rcp: None,
        cia: None,
    };

    /// At rest the duty k_p e balances load and friction: the drive is k U/R · k_p e at the rotor,
    /// so that a load of τ leaves an error between (τ/G ± τ_c)/(k_p k U/R).
    #[test]
    fn a_load_leaves_the_error_that_the_gain_allows() {
        let mut module = HeadModule::new(&WHISKING, &CONTROL, 1.0, 1).unwrap();
        let front = Place::new(0, 0);
        let setpoint = Command::Setpoint(Some(protraction(100.0)));
        module.module.command(front, setpoint).unwrap();
        let load = -2e-3_f64;
        let mut angle = 0.0;
        for _ in 0..4000 {
            module.tick().unwrap();
            angle = module.turn(0, load, 5e-4);
            for n in 1..SIDES * EACH {
                module.turn(n, 0.0, 5e-4);
            }
        }
        let full = 2.5e-3 * 6.0 / 25.0 * CONTROL.kp;
        let [least, most] = [-3e-5, 3e-5].map(|friction| (-load / 11.0 + friction) / full);
        let error = 100.0 - angle;
        assert!(
            (least - 0.1..most + 0.1).contains(&error),
            "{error}: {least} to {most}"
        );
    }
}
