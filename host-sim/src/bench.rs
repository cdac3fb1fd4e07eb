//! A module of any scene behind one interface: the firmware's [`Module`] on mock hardware.

pub mod can;
mod head;
mod line;
mod mock;
mod sensor;

use config::{Mismatch, NumberFormat, RunsOn, Target};
use firmware::{
    Command, Config, Event, ModelState, Module, NoActiveWhisker, NotDone, Packet, Perception,
    Refusal, Whisker, WhiskerParts,
};
use scene::{Scene, SensorSection};
use tactile::ClassList;
use whisking::{Fix, Number};
use wire::TaggedCommand;

use crate::Error;
use crate::bus::Slave;
use crate::bus::tmag5170::TmagSlave;
use crate::classifier::{Classifier, Tap};
use crate::drive;
use crate::motor::Pins;
pub use can::Load;
use head::Head;
pub use head::{Bus, Happened};
use line::Line;
use mock::Mock;
pub use mock::NoClock;
use sensor::AnySensor;

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

    /// Whether whisker `n`, counted from 0, left side first, is being homed.
    fn is_homing(&self, _n: usize) -> bool {
        false
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
    /// As [`Module::command`].
    fn command(&mut self, n: usize, command: Command<f64>) -> Result<(), NotDone>;

    /// Arms the motors or keeps them off, from the next tick on.
    fn arm(&mut self, is_armed: bool);

    /// What the classifier gets.
    fn tap(&mut self) -> Option<&mut Tap>;

    /// Carries out `request` before the next tick.
    fn request(&mut self, request: TaggedCommand);

    /// Has requests go to this board of several, and takes what that has sent; at first the one with
    /// number 0.
    fn talk_with(&mut self, board: usize);

    /// Has another board of its head carry out `request`; whether it has one of that number.
    fn request_of(&mut self, board: usize, request: TaggedCommand) -> bool;

    /// What it has sent since the last call, and answers of other boards.
    fn take_packets(&mut self) -> Vec<Packet>;

    /// The bus of a head of several boards; none where one board has all whiskers.
    fn bus(&mut self) -> Option<&mut Bus>;
}

/// A board of a head, or the one that has all its whiskers.
struct Hosted<R: Number> {
    module: Module<R, Mock>,
    config: Config<R>,
    built_with: Config<R>,
    sensor: SensorSection,
    /// Which board of its head it is; 0 of the only one.
    number: u8,
    line: Line,
}

impl<R: Number> Hosted<R> {
    fn sensor_mut(&mut self, n: usize) -> Option<&mut AnySensor> {
        let whisker = self.module.whiskers_mut().get_mut(n)?;
        Some(whisker.sensor_mut().source_mut())
    }

    fn look_at_setpoints(&self, theta_deg: &mut [f64]) {
        let Some(motion) = self.module.motion() else {
            return;
        };
        let servos = self.module.whiskers().iter().map(Whisker::servo);
        let setpoints = motion.state().theta().zip(servos);
        let pd = self.config.motion.as_ref().map(|motion| &motion.servo.pd);
        for (place, (theta, servo)) in theta_deg.iter_mut().zip(setpoints) {
            let commanded = pd.and_then(|pd| Some(pd.clamp(servo?.setpoint()?)));
            *place = whisking::degrees(commanded.unwrap_or(theta).to_f64());
        }
    }

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

    fn command(&mut self, n: usize, command: Command<f64>) -> Result<(), NotDone> {
        let place = self.module.whiskers().get(n).map(Whisker::place);
        let command = match command {
            Command::Gain(gain) => Command::Gain(R::from_f64(gain)),
            Command::Setpoint(theta) => Command::Setpoint(theta.map(R::from_f64)),
            Command::Clear => Command::Clear,
            Command::Home => Command::Home,
        };
        self.module.command(place.ok_or(NoActiveWhisker)?, command)
    }

    fn request(&mut self, request: TaggedCommand) {
        let (line, module) = (&mut self.line, &mut self.module);
        line.carry_out(module, &mut self.config, request);
    }
}

/// A module at rest, its motors on `pins`, its sensors' noise from the seed beside those.
fn module<R: Number>(
    config: &Config<R>,
    number: u8,
    sensor: &SensorSection,
    (seed, pins): (u64, Vec<Pins>),
    classifier: Option<Tap>,
) -> Result<Module<R, Mock>, Error> {
    let own = config.head.of_node(number);
    let misfit = |what: &str| Error::Work(format!("the module's {what} do not fit the scene"));
    let sensors = own
        .clone()
        .map(|n| AnySensor::new(sensor, seed.wrapping_add(n as u64)));
    let sensors: Option<Vec<AnySensor>> = sensors.collect();
    let mut sensors = sensors.ok_or_else(|| misfit("sensors"))?.into_iter();
    let motion = config.motion.as_ref();
    if motion.is_some() && pins.len() != own.len() {
        return Err(misfit("motors"));
    }
    let stall = motion.map(|motion| motion.servo.guards.stall);
    let mut pins = pins.into_iter();
    let parts = std::iter::from_fn(|| {
        let source = sensors.next()?;
        let motor = stall.and_then(|stall| Some(drive::on(pins.next()?, stall)));
        Some(WhiskerParts { source, motor })
    });
    let mut module = Module::of_node(config, number, parts, classifier, (NoClock, 0));
    module.arm(motion.is_some_and(|motion| motion.arms_at_start));
    Ok(module)
}

/// How many whiskers of a scene are heard by its classifier.
pub fn heard(scene: &Scene) -> usize {
    let all = scene.whiskers();
    let classifier = scene.classifier.as_ref();
    classifier.map_or(1, |classifier| classifier.whiskers.heard(all))
}

/// Makes the module of `scene`: its motors on `pins`, left side first (none
/// where the whiskers are passive), the samples of its whiskers going to `classifier`.
///
/// # Errors
/// [`Error::Work`] if the parts do not fit the scene, [`Error::Input`] if the
/// scene's position control is unstable.
pub fn build(
    scene: &Scene,
    pins: &[Pins],
    classifier: Option<Classifier>,
) -> Result<Box<dyn HostModule>, Error> {
    match config::in_simulation(scene) {
        NumberFormat::Double => head::<f64>(scene, pins, classifier),
        NumberFormat::Fixed => head::<Fix>(scene, pins, classifier),
        NumberFormat::Single => head::<f32>(scene, pins, classifier),
    }
}

fn head<R: Number>(
    scene: &Scene,
    pins: &[Pins],
    classifier: Option<Classifier>,
) -> Result<Box<dyn HostModule>, Error>
where
    Hosted<R>: Send + 'static,
{
    Ok(Box::new(Head::<R>::new(scene, pins, classifier)?))
}

fn broken(mismatch: Mismatch) -> Error {
    match mismatch {
        Mismatch::Unstable(_)
        | Mismatch::Unbearable(_)
        | Mismatch::Unsettled(_)
        | Mismatch::Gate { .. }
        | Mismatch::Threshold { .. }
        | Mismatch::Classes { .. } => Error::Input(mismatch.to_string()),
        mismatch => Error::Work(mismatch.to_string()),
    }
}

/// The configuration of the simulated module of `scene`, which decides by a model with this
/// contact and these classes, if any, or records for one.
///
/// # Errors
/// What is wrong with the scene for it.
pub fn config_of<R: Number>(
    scene: &Scene,
    (gate, classes): (Option<f32>, Option<&ClassList>),
    records: bool,
    overrides: &str,
) -> Result<Config<R>, Error> {
    let target = Target {
        runs_on: RunsOn::Simulation { records },
        gate,
        classes,
        overrides,
    };
    config::build(scene, target).map_err(broken)
}

impl<R: Number> Hosted<R> {
    fn new(
        scene: &Scene,
        number: u8,
        pins: Vec<Pins>,
        classifier: Option<Classifier>,
    ) -> Result<Self, Error> {
        let heard = heard_by_board(scene, number);
        let tap = Tap::new(classifier, heard);
        let gate = tap.touch_rule().map(|touch| touch.gate);
        let model = match (tap.model(), &scene.classifier) {
            // The whiskers that decide are another board's.
            _ if heard == 0 => ModelState::NotHere,
            (Some(model), _) => model,
            (None, Some(_)) => ModelState::Refused(Refusal::Absent),
            (None, None) => ModelState::NotHere,
        };
        let classes = tap.classes().to_vec();
        let known = (gate, tap.settings());
        let config = config_of::<R>(scene, known, tap.is_recording(), "")?;
        let checked = config.check();
        checked.map_err(|fault| Error::Work(fault.to_string()))?;
        let parts = (scene.seed, pins);
        Ok(Self {
            module: module(&config, number, &scene.sensor, parts, Some(tap))?,
            line: Line::new(&config, model, classes),
            built_with: config.clone(),
            config,
            sensor: scene.sensor,
            number,
        })
    }

    /// See [`HostModule::restart`].
    fn restart(&mut self, seed: u64, pins: Vec<Pins>) -> Result<(), Error> {
        self.config.clone_from(&self.built_with);
        if let Some(motion) = &mut self.config.motion {
            motion.seed = seed;
        }
        let perception = self.module.take_perception();
        let mut perception = perception.map(Perception::restarted);
        if let (Some(perception), Some(classifier)) = (&mut perception, &self.config.classifier) {
            perception.retune(classifier.rule.as_ref(), &self.config.classes);
        }
        self.module = module(&self.config, self.number, &self.sensor, (seed, pins), None)?;
        self.module.set_perception(perception);
        self.line.restart();
        Ok(())
    }
}

fn heard_by_board(scene: &Scene, number: u8) -> usize {
    let each = scene.whiskers() / usize::from(scene.head.nodes.unwrap_or(1)).max(1);
    let from_it_on = heard(scene).saturating_sub(usize::from(number) * each);
    from_it_on.min(each)
}
