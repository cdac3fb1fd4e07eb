//! A module of any shape behind one interface: the firmware's [`Module`] on
//! mock hardware.

mod config;
mod line;
mod sensor;
mod tunable;

pub use config::RunsOn;
pub use tunable::{ConstantWords, TunableConstant, TunableConstants, tunable_constants};

use firmware::{
    Active, Classifying, Clock, Command, Event, ModelState, Module, NoActiveWhisker, Perception,
    Place, Refusal, Servo,
};
use plan::NumberFormat;
use scene::{Arm, Deciding, Scene, SensorSection};
use whisking::motor::StallConfig;
use whisking::{Fix, Real, Start};
use wire::{Packet, TaggedCommand};

use crate::Error;
use crate::bus::Slave;
use crate::bus::tmag5170::TmagSlave;
use crate::classifier::{Classifier, Tap};
use crate::drive::{self, AnyAngle, AnyMotor};
use crate::motor::Pins;
use config::{HostConfig, broken};
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

struct Shaped<R: Real, const S: usize, const N: usize> {
    module: Module<R, AnySensor, Motors<R, S, N>, Ears<S, N>, NoClock, S, N>,
    config: HostConfig<R>,
    /// As the scene has it.
    built_with: HostConfig<R>,
    start: Option<Start<R, S, N>>,
    arms_at_start: bool,
    sensor: SensorSection,
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
        self.config = self.built_with;
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
        let mut perception = perception.map(Classifying::restarted);
        Perception::<R, _, S, N>::retune(&mut perception, &self.config.perception);
        let sensors = sensors(&self.sensor, seed)?;
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
        line.carry_out(module, &mut self.config, request);
    }

    fn take_packets(&mut self) -> Vec<Packet> {
        self.line.take()
    }
}

fn misfit(what: &str) -> Error {
    Error::Work(format!("the module's {what} do not fit the scene"))
}

fn sensors<const S: usize, const N: usize>(
    section: &SensorSection,
    seed: u64,
) -> Result<Sensors<S, N>, Error> {
    let mut next = seed;
    let sensor = || {
        let seed = next;
        next = next.wrapping_add(1);
        AnySensor::new(section, seed)
    };
    array(sensor).ok_or_else(|| misfit("sensors"))
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
    let plan = plan::motion::<R, S, N>(scene).map_err(broken)?;
    let tap = Tap::new(classifier, heard(scene));
    let gate = tap.touch_rule().map(|touch| touch.gate);
    let model = tap.model();
    let runs_on = RunsOn::Simulation {
        records: tap.is_recording(),
    };
    let config = config::config(scene, plan.as_ref(), gate, runs_on)?;
    let start = plan.as_ref().map(|plan| plan.start);
    let motors = match (&start, &config.motion) {
        (Some(start), Some(motion)) => {
            Some(motors(start, motion.servo.guards.stall, scene.seed, pins)?)
        }
        _ => None,
    };
    let perception = Some(Classifying::new(tap));
    let motor = scene.motor.as_ref();
    let arms_at_start = motor.is_some_and(|motor| motor.arm == Arm::AtStart);
    let sensors = sensors(&scene.sensor, scene.seed)?;
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
        built_with: config,
        start,
        arms_at_start,
        sensor: scene.sensor,
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
