//! A simulated board: the firmware's module on mock hardware, and its link to a PC.

use std::ops::Range;

use firmware::{
    Clock, Command, Config, Event, Hardware, ModelState, Module, NoActiveWhisker, Node, NotDone,
    Perception, Refusal, Whisker, WhiskerParts,
};
use scene::{Scene, SensorSection};
use whisking::Number;
use wire::TaggedCommand;

use super::line::Line;
use super::sensor::AnySensor;
use super::{config_of, heard};
use crate::Error;
use crate::classifier::{Classifier, Tap};
use crate::drive::{self, AnyAngle, AnyMotor};
use crate::motor::Pins;

/// Time does not pass within a tick of the simulation.
#[derive(Debug, Clone, Copy)]
pub struct NoClock;

impl Clock for NoClock {
    fn now(&mut self) -> u32 {
        0
    }
}

pub(super) struct Mock;

impl Hardware for Mock {
    type Source = AnySensor;
    type Motor = AnyMotor;
    type Angle = AnyAngle;
    type Classifier = Tap;
    type Clock = NoClock;
}

/// A board of a head, or the one that has all its whiskers.
pub(super) struct Board<R: Number> {
    pub(super) module: Module<R, Mock>,
    pub(super) config: Config<R>,
    built_with: Config<R>,
    sensor: SensorSection,
    /// Which board of its head it is; 0 of the only one.
    number: u8,
    pub(super) line: Line,
    /// None of the only one.
    pub(super) node: Option<Node>,
    /// Its whiskers among all of the head.
    pub(super) own: Range<usize>,
    pub(super) pins: Vec<Pins>,
    /// Ticks since its start: its own clock.
    pub(super) ticks: u64,
}

/// Those of `own`; none where whiskers are passive.
pub(super) fn pins_of(own: &Range<usize>, pins: &[Pins]) -> Vec<Pins> {
    pins.get(own.clone()).unwrap_or_default().to_vec()
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

impl<R: Number> Board<R> {
    pub(super) fn new(
        scene: &Scene,
        number: u8,
        pins: &[Pins],
        classifier: Option<Classifier>,
    ) -> Result<Self, Error> {
        let nodes = scene.head.nodes;
        let each = scene.whiskers() / usize::from(nodes.unwrap_or(1)).max(1);
        let first = usize::from(number) * each;
        let own = first..first + each;
        let pins = pins_of(&own, pins);
        let heard = heard(scene).saturating_sub(first).min(each);
        let tap = Tap::new(classifier, heard);
        let classifier = tap.classifier.as_ref();
        let model = match (classifier, &scene.classifier) {
            // The whiskers that decide are another board's.
            _ if heard == 0 => ModelState::NotHere,
            (Some(classifier), _) => classifier.model(),
            (None, Some(_)) => ModelState::Refused(Refusal::Absent),
            (None, None) => ModelState::NotHere,
        };
        let classes = classifier.map_or(&[][..], Classifier::classes).to_vec();
        let gate = classifier.and_then(|classifier| Some(classifier.touch_rule()?.gate));
        let known = (gate, classifier.map(Classifier::settings));
        let config = config_of::<R>(scene, known, classifier.is_none(), "")?;
        let checked = config.check();
        checked.map_err(|fault| Error::Work(fault.to_string()))?;
        let parts = (scene.seed, pins.clone());
        Ok(Self {
            module: module(&config, number, &scene.sensor, parts, Some(tap))?,
            line: Line::new(&config, model, classes),
            built_with: config.clone(),
            sensor: scene.sensor,
            number,
            node: nodes.map(|_| Node::new(&config.head, number)),
            config,
            own,
            pins,
            ticks: 0,
        })
    }

    pub(super) fn restart(&mut self, seed: u64) -> Result<(), Error> {
        self.config.clone_from(&self.built_with);
        if let Some(motion) = &mut self.config.motion {
            motion.seed = seed;
        }
        let perception = self.module.take_perception();
        let mut perception = perception.map(Perception::restarted);
        if let (Some(perception), Some(classifier)) = (&mut perception, &self.config.classifier) {
            perception.retune(classifier.rule.as_ref(), &self.config.classes);
        }
        let parts = (seed, self.pins.clone());
        self.module = module(&self.config, self.number, &self.sensor, parts, None)?;
        self.module.set_perception(perception);
        self.line.restart();
        if let Some(node) = &mut self.node {
            *node = Node::new(&self.config.head, self.number);
        }
        self.ticks = 0;
        Ok(())
    }

    pub(super) fn sensor_mut(&mut self, n: usize) -> Option<&mut AnySensor> {
        let whisker = self.module.whiskers_mut().get_mut(n)?;
        Some(whisker.sensor_mut().source_mut())
    }

    pub(super) fn look_at_setpoints(&self, theta_deg: &mut [f64]) {
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

    pub(super) fn tick(&mut self, events: &mut Vec<Event>) {
        if let Some(perception) = self.module.perception_mut() {
            perception.classifier_mut().samples.fill(None);
        }
        self.module.tick(&self.config, &mut |event| {
            self.line.note(&event);
            events.push(event);
        });
        self.line.tick_ends(&self.module, &self.config);
    }

    pub(super) fn command(&mut self, n: usize, command: Command<f64>) -> Result<(), NotDone> {
        let place = self.module.whiskers().get(n).map(Whisker::place);
        let command = match command {
            Command::Gain(gain) => Command::Gain(R::from_f64(gain)),
            Command::Setpoint(theta) => Command::Setpoint(theta.map(R::from_f64)),
            Command::Clear => Command::Clear,
            Command::Home => Command::Home,
        };
        self.module.command(place.ok_or(NoActiveWhisker)?, command)
    }

    pub(super) fn request(&mut self, request: TaggedCommand) {
        let (line, module) = (&mut self.line, &mut self.module);
        line.carry_out(module, &mut self.config, request);
    }
}
