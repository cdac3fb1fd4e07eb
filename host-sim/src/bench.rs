//! A module of any shape behind one interface: the firmware's [`Module`] on
//! mock hardware.

mod line;
mod sensor;

use firmware::design_parameters::{Plausible, retry, sensor_limits};
use firmware::{
    Active, ActiveConfig, Classifying, ClassifyingConfig, Clock, Command, Config, Event,
    ModelState, Module, NoActiveWhisker, Place, Refusal, Servo, ServoConfig, StopAll,
};
use mlx90333::Decoder;
use plan::NumberFormat;
use scene::{Arm, Deciding, PlantKind, Scene, SensorModel};
use whisking::motor::{GuardSettings, HomingConfig, StallConfig};
use whisking::{Fix, Real, Start, filter};
use wire::{Packet, TaggedCommand};

use crate::Error;
use crate::bus::Slave;
use crate::bus::tmag5170::TmagSlave;
use crate::classifier::{Classifier, GATE, Tap};
use crate::drive::{self, AnyAngle, AnyMotor};
use crate::motor::Pins;
use line::Line;
use sensor::AnySensor;

/// Time does not pass within a tick of the simulation.
#[derive(Debug, Clone, Copy)]
pub struct NoClock;

impl Clock for NoClock {
    fn now(&mut self) -> u32 {
        0
    }
}

/// What a module shows of itself after a tick. Values of a side that does
/// not exist are NaN.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Snapshot {
    /// θ' of every whisker, left side first, degrees.
    pub theta_deg: Vec<f64>,
    /// z of each side.
    pub z: [f64; 2],
    /// g of the first whisker of each side.
    pub g: [f64; 2],
    /// Contact π of each side.
    pub contact: [f64; 2],
    /// The number of the touch of the first whisker of each side; 0 in the air, and where
    /// it is not heard.
    pub touch: [u16; 2],
}

/// A module as a run sees it.
pub trait Bench {
    /// One tick.
    fn tick(&mut self, events: &mut Vec<Event>);

    /// Fills in `snapshot`; `theta_deg` has a place for every whisker.
    fn look(&mut self, snapshot: &mut Snapshot);

    /// The sensor of whisker `n`, counted from 0, left side first, if it is an MLX90333.
    fn slave_mut(&mut self, n: usize) -> Option<&mut Slave>;

    /// The same, if it is a TMAG5170.
    fn tmag_mut(&mut self, _n: usize) -> Option<&mut TmagSlave> {
        None
    }

    /// Deflections along x and y of whisker `n` from now on, in units of its sensor's range.
    fn bend(&mut self, n: usize, deflection: [f64; 2]) {
        if let Some(slave) = self.slave_mut(n) {
            slave.set(deflection);
        }
    }

    /// Contact π of whisker `n`, counted from 0, left side first; none: that of its side is
    /// all that is known.
    fn felt_by(&self, _n: usize) -> Option<f64> {
        None
    }

    /// Whether its events tell of faults.
    fn tells_faults(&self) -> bool {
        true
    }
}

/// The firmware's module on this machine.
pub trait HostModule: Bench + Send {
    /// Starts again with another seed, on these ends of the motors' wires.
    ///
    /// # Errors
    /// [`Error::Work`] if there are not as many as whiskers.
    fn restart(&mut self, seed: u64, pins: Vec<Pins>) -> Result<(), Error>;

    /// Carries out `command` for whisker `n`, counted from 0, left side first.
    ///
    /// # Errors
    /// [`NoActiveWhisker`].
    fn command(&mut self, n: usize, command: Command<f64>) -> Result<(), NoActiveWhisker>;

    /// Arms the motors or keeps them off, from the next tick on.
    fn arm(&mut self, is_armed: bool);

    /// What the classifier gets.
    fn tap(&mut self) -> Option<&mut Tap>;

    /// Contact of each whisker, left side first.
    fn felt(&self) -> Vec<f64>;

    /// Carries out `request` before the next tick.
    fn request(&mut self, request: TaggedCommand);

    /// What it has sent since the last call.
    fn take_packets(&mut self) -> Vec<Packet>;
}

type Motors<R, const S: usize, const N: usize> = Option<Active<R, AnyMotor, AnyAngle, S, N>>;
type Ears<const S: usize, const N: usize> = Option<Classifying<Tap, S, N>>;
type Sensors<const S: usize, const N: usize> = [[AnySensor; N]; S];

type HostConfig<R> = Config<
    Option<ActiveConfig<R, whisking::Config<R>, Option<StopAll>, Option<HomingConfig>>>,
    Option<ClassifyingConfig<Option<R>, ()>>,
    Option<filter::Config<R>>,
>;

struct Shaped<R: Real, const S: usize, const N: usize> {
    module: Module<R, AnySensor, Motors<R, S, N>, Ears<S, N>, NoClock, S, N>,
    config: HostConfig<R>,
    start: Option<Start<R, S, N>>,
    arms_at_start: bool,
    model: SensorModel,
    line: Line,
}

impl<R: Real, const S: usize, const N: usize> Shaped<R, S, N> {
    fn sensor_mut(&mut self, n: usize) -> Option<&mut AnySensor> {
        Some(self.module.sensor_mut(n / N, n % N)?.source_mut())
    }
}

impl<R: Real, const S: usize, const N: usize> Bench for Shaped<R, S, N> {
    fn tick(&mut self, events: &mut Vec<Event>) {
        if let Some(perception) = self.module.perception_mut() {
            perception.classifier_mut().samples.fill(None);
        }
        self.module.tick(&self.config, &mut |event| {
            self.line.note(&event);
            events.push(event);
        });
        self.line.tick_ends(&self.module, &self.config);
    }

    fn look(&mut self, snapshot: &mut Snapshot) {
        if let Some(perception) = self.module.perception_mut() {
            for (place, touching) in snapshot.touch.iter_mut().zip(perception.touching()) {
                *place = touching.first().map_or(0, |touching| touching.number);
            }
        }
        for (place, pi) in snapshot.contact.iter_mut().zip(self.module.contact()) {
            *place = pi.to_f64();
        }
        let Some(active) = self.module.motion() else {
            return;
        };
        let state = active.state();
        let theta = state.theta();
        let servos = active.servos().iter().flatten();
        let setpoints = theta.iter().flatten().zip(servos);
        for (place, (theta, servo)) in snapshot.theta_deg.iter_mut().zip(setpoints) {
            let pd = self.config.motion.as_ref().map(|motion| &motion.servo.pd);
            let commanded = pd.and_then(|pd| Some(pd.clamp(servo.setpoint()?)));
            *place = whisking::degrees(commanded.unwrap_or(*theta).to_f64());
        }
        for (place, z) in snapshot.z.iter_mut().zip(state.z) {
            *place = z.value.to_f64();
        }
        for (place, whiskers) in snapshot.g.iter_mut().zip(&state.whiskers) {
            *place = whiskers.first().map_or(f64::NAN, whisking::Whisker::gain);
        }
    }

    fn slave_mut(&mut self, n: usize) -> Option<&mut Slave> {
        self.sensor_mut(n)?.slave_mut()
    }

    fn tmag_mut(&mut self, n: usize) -> Option<&mut TmagSlave> {
        self.sensor_mut(n)?.tmag_mut()
    }

    fn bend(&mut self, n: usize, deflection: [f64; 2]) {
        if let Some(sensor) = self.sensor_mut(n) {
            sensor.bend(deflection);
        }
    }

    fn felt_by(&self, n: usize) -> Option<f64> {
        let felt = self.module.felt().as_flattened();
        felt.get(n).map(|felt| felt.to_f64())
    }
}

impl<R: Real, const S: usize, const N: usize> HostModule for Shaped<R, S, N>
where
    Self: Send,
{
    fn restart(&mut self, seed: u64, pins: Vec<Pins>) -> Result<(), Error> {
        let stall = self
            .config
            .motion
            .as_ref()
            .map(|motion| motion.servo.guards.stall);
        let motors = match (&self.start, stall) {
            (Some(start), Some(stall)) => Some(motors(start, stall, seed, pins)?),
            _ => None,
        };
        let perception = self.module.perception_mut().take();
        let perception = perception.map(Classifying::restarted);
        let sensors = sensors(self.model, seed)?;
        self.module = Module::new(sensors, motors, perception, NoClock);
        self.module.arm(self.arms_at_start);
        self.line.restart();
        Ok(())
    }

    fn command(&mut self, n: usize, command: Command<f64>) -> Result<(), NoActiveWhisker> {
        if n >= S * N {
            return Err(NoActiveWhisker);
        }
        let place = Place::new((n / N) as u8, (n % N) as u8);
        let command = match command {
            Command::Gain(gain) => Command::Gain(R::from_f64(gain)),
            Command::Setpoint(theta) => Command::Setpoint(theta.map(R::from_f64)),
            Command::Clear => Command::Clear,
            Command::Home => Command::Home,
        };
        self.module.command(place, command)
    }

    fn arm(&mut self, is_armed: bool) {
        self.module.arm(is_armed);
    }

    fn tap(&mut self) -> Option<&mut Tap> {
        Some(self.module.perception_mut().as_mut()?.classifier_mut())
    }

    fn felt(&self) -> Vec<f64> {
        let felt = self.module.felt().as_flattened();
        felt.iter().map(|felt| felt.to_f64()).collect()
    }

    fn request(&mut self, request: TaggedCommand) {
        let (line, module) = (&mut self.line, &mut self.module);
        line.carry_out(module, &self.config, request);
    }

    fn take_packets(&mut self) -> Vec<Packet> {
        self.line.take()
    }
}

/// What the readings of a scene's sensors can be.
fn plausible(scene: &Scene) -> Plausible {
    Plausible {
        frozen_s: scene.sensor.frozen_s,
        // By BIOTACT eq. 11 contact with a stiff obstacle is a step.
        jump_per_s: match scene.plant.kind {
            PlantKind::Ideal => f64::INFINITY,
            PlantKind::Textured | PlantKind::Whisker => scene.sensor.jump_per_s,
        },
    }
}

fn misfit(what: &str) -> Error {
    Error::Work(format!("the module's {what} do not fit the scene"))
}

fn sensors<const S: usize, const N: usize>(
    model: SensorModel,
    seed: u64,
) -> Result<Sensors<S, N>, Error> {
    let mut seeds = seed..;
    array(|| AnySensor::new(model, seeds.next()?)).ok_or_else(|| misfit("sensors"))
}

fn motors<R: Real, const S: usize, const N: usize>(
    start: &Start<R, S, N>,
    stall: StallConfig,
    seed: u64,
    pins: Vec<Pins>,
) -> Result<Active<R, AnyMotor, AnyAngle, S, N>, Error> {
    let mut pins = pins.into_iter();
    let servos = array(|| {
        let (motor, angle) = drive::on(pins.next()?, stall);
        Some(Servo::new(motor, angle))
    });
    let state = whisking::State::new(start, seed);
    Ok(Active::new(state, servos.ok_or_else(|| misfit("motors"))?))
}

/// How many whiskers of a scene are heard by its classifier.
pub fn heard(scene: &Scene) -> usize {
    match scene
        .classifier
        .as_ref()
        .map(|classifier| classifier.whiskers)
    {
        None | Some(Deciding::First) => 1,
        Some(Deciding::Each | Deciding::Together) => scene.whiskers(),
    }
}

/// Makes the module of `scene`: its motors on `pins`, left side first (none
/// where the whiskers are passive), the samples of its whiskers going to `classifier`.
///
/// # Errors
/// [`Error::Work`] if the parts do not fit the scene, [`Error::Input`] if the
/// scene's position control is unstable.
pub fn build(
    scene: &Scene,
    pins: Vec<Pins>,
    classifier: Option<Classifier>,
) -> Result<Box<dyn HostModule>, Error> {
    macro_rules! shapes {
        ($number:ty: $($n:literal)*) => {
            match (scene.head.sides.count(), scene.head.whiskers_per_side) {
                $(
                    (1, $n) => shaped::<$number, 1, $n>(scene, pins, classifier),
                    (2, $n) => shaped::<$number, 2, $n>(scene, pins, classifier),
                )*
                (sides, whiskers) => {
                    Err(Error::Work(format!("no module of {sides} sides with {whiskers} whiskers")))
                }
            }
        };
    }
    match plan::in_simulation(scene) {
        NumberFormat::Double => shapes!(f64: 1 2 3 4 5 6 7 8 9 10 11 12),
        NumberFormat::Fixed => shapes!(Fix: 1 2 3 4 5 6 7 8 9 10 11 12),
        NumberFormat::Single => shapes!(f32: 1 2 3 4 5 6 7 8 9 10 11 12),
    }
}

fn shaped<R: Real, const S: usize, const N: usize>(
    scene: &Scene,
    pins: Vec<Pins>,
    classifier: Option<Classifier>,
) -> Result<Box<dyn HostModule>, Error>
where
    Shaped<R, S, N>: Send + 'static,
{
    let broken = |mismatch: plan::Mismatch| match mismatch {
        mismatch @ (plan::Mismatch::Unstable(_) | plan::Mismatch::Gate { .. }) => {
            Error::Input(mismatch.to_string())
        }
        mismatch => Error::Work(mismatch.to_string()),
    };
    let tick_hz = f64::from(scene.tick_hz);
    let plan = plan::motion::<R, S, N>(scene).map_err(broken)?;

    // The trace shows contact wherever there is something to touch.
    let tap = Tap::new(classifier, heard(scene));
    let touch = tap.touch_rule();
    let model = tap.model();
    let contact_min = plan::contact_min(scene, touch.map(|touch| touch.gate)).map_err(broken)?;
    // A recording has the touches that a model of it will know.
    let records = tap.is_recording() && scene.plant.obstacle.is_some();
    let contact_min = contact_min.or(records.then_some(GATE));
    let contact = match plan::contact(scene, contact_min.is_some()).map_err(broken)? {
        None if scene.plant.obstacle.is_some() => {
            let h50 = filter::Config::new(filter::CORNER_HZ, tick_hz);
            Some(h50.map_err(|error| Error::Work(error.to_string()))?)
        }
        contact => contact,
    };
    let start = plan.as_ref().map(|plan| plan.start);
    let config = Config {
        decoder: Decoder::new(),
        sensor_limits: sensor_limits(scene.tick_hz, plausible(scene)),
        contact,
        motion: plan.map(|plan| ActiveConfig {
            whisking: plan.whisking,
            servo: ServoConfig {
                pd: plan.pd,
                retry: retry(scene.tick_hz),
                // An ideal motor is where it should be whatever it is driven with.
                guards: match scene.plant.kind {
                    PlantKind::Ideal => GuardSettings::NONE.build(tick_hz),
                    PlantKind::Textured | PlantKind::Whisker => plan.guards,
                },
                approach: plan.approach,
                // Nor has it a stop.
                homing: plan.homing.filter(|_| scene.plant.kind != PlantKind::Ideal),
            },
            stop_all: plan.stop_all.then_some(StopAll),
        }),
        perception: Some(ClassifyingConfig {
            contact_min: contact_min.map(R::from_f64),
            rule: (),
        }),
        period: 0,
    };
    let motors = match (&start, &config.motion) {
        (Some(start), Some(motion)) => {
            Some(motors(start, motion.servo.guards.stall, scene.seed, pins)?)
        }
        _ => None,
    };
    let perception = Some(Classifying::new(tap));
    let motor = scene.motor.as_ref();
    let arms_at_start = motor.is_some_and(|motor| motor.arm == Arm::AtStart);
    let sensors = sensors(scene.sensor.model, scene.seed)?;
    let mut module = Module::new(sensors, motors, perception, NoClock);
    module.arm(arms_at_start);
    let model = match (model, &scene.classifier) {
        (Some(model), _) => model,
        (None, Some(_)) => ModelState::Refused(Refusal::Absent),
        (None, None) => ModelState::NotHere,
    };
    Ok(Box::new(Shaped {
        module,
        config,
        start,
        arms_at_start,
        model: scene.sensor.model,
        line: Line::new(scene, model),
    }))
}

/// S × N things, or `None` if `make` runs out of them.
fn array<T, const S: usize, const N: usize>(
    mut make: impl FnMut() -> Option<T>,
) -> Option<[[T; N]; S]> {
    let mut sides = Vec::with_capacity(S);
    for _ in 0..S {
        let side: Vec<T> = (0..N).map_while(|_| make()).collect();
        sides.push(<[T; N]>::try_from(side).ok()?);
    }
    <[[T; N]; S]>::try_from(sides).ok()
}
