//! A scene in motion: module, motors and plant, tick by tick.

mod flaws;
mod poses;
mod presented;

use firmware::{Command, Event, Sample};
use mlx90333::Word;
use physics::Bent;
use scene::{Scene, Texture};
use tactile::Posteriors;

use crate::Error;
use crate::bench::{self, Bench, Bus, HostModule, Snapshot};
use crate::bus::Slave;
use crate::bus::tmag5170::TmagSlave;
use crate::classifier::Classifier;
use crate::decisions::Decided;
use crate::motor::{PWM_COUNTS, SimMotor};
use crate::trace::{Row, TraceLine, WhiskerRow};
use crate::world::World;
use flaws::Flaws;
use poses::Poses;
use presented::Presented;

/// A running scene, with everything that it needs: module, classifier, motors and plant. `B` is the
/// module: the firmware's on this machine, unless said otherwise.
pub struct Run<B: ?Sized = dyn HostModule> {
    tick_hz: f64,
    dt_s: f64,
    ticks: u64,
    done: u64,
    sides: usize,
    whiskers: usize,
    classes: Vec<String>,
    world: World,
    presented: Presented,
    poses: Poses,
    flaws: Flaws,
    snapshot: Snapshot,
    row: Row,
    events: Vec<Event>,
    /// What bent each whisker's sensor in the last tick, and what it was given of that.
    deflections: Vec<[f64; 2]>,
    sensed: Vec<[f64; 2]>,
    /// The faults of each whisker's sensor and motor that have not ended; 0: none.
    faults: Vec<[u8; 2]>,
    bench: Box<B>,
}

impl Run {
    /// A scene before its first tick, the samples of its whiskers going to `classifier`.
    ///
    /// # Errors
    /// [`Error::Work`] if the module cannot be put together, [`Error::Input`] if
    /// the scene's position control is unstable.
    pub fn new(scene: &Scene, classifier: Option<Classifier>) -> Result<Self, Error> {
        Self::with_pwm(scene, classifier, PWM_COUNTS)
    }

    /// The same with so many steps of the motors' duty, as another board than the
    /// NUCLEO-F446RE has.
    ///
    /// # Errors
    /// As [`Run::new`].
    pub fn with_pwm(
        scene: &Scene,
        classifier: Option<Classifier>,
        pwm_counts: u16,
    ) -> Result<Self, Error> {
        let (world, pins) = World::wired(scene, pwm_counts)?;
        let classes = classifier.as_ref().map(Classifier::classes);
        let classes = classes.unwrap_or_default().to_vec();
        let bench = bench::build(scene, &pins, classifier)?;
        Ok(Self::of(scene, bench, classes, world))
    }

    /// Starts again with the same or another seed: from here on the run equals a new one of the
    /// scene with that seed. Nothing is parsed, checked or solved again. What was done to sensors
    /// and motors, and every gain and setpoint that was set, is undone.
    ///
    /// # Errors
    /// None that a run which could be made once has; see [`Run::new`].
    pub fn reset(&mut self, seed: u64) -> Result<(), Error> {
        let pins = self.world.restart(seed);
        self.bench.restart(seed, pins)?;
        self.done = 0;
        self.presented.restart();
        self.poses.restart(seed);
        self.flaws.restart();
        self.rest();
        Ok(())
    }

    /// Sets the nominal gain g of whisker `n`, counted from 0, left side first,
    /// from the next tick on; limited to 0 to 2.
    ///
    /// # Errors
    /// [`Error::Input`] if there is no such active whisker, or for a gain that is not finite.
    pub fn set_gain(&mut self, n: usize, gain: f64) -> Result<(), Error> {
        self.command(n, Command::Gain(finite("gain", gain)?))
    }

    /// Sets a setpoint θ′ of whisker `n`, degrees, in place of the pattern
    /// generator's, from the next tick on, limited to the scene's `motor.min_deg`
    /// and `motor.max_deg`; `None`: the pattern generator's again.
    ///
    /// # Errors
    /// [`Error::Input`] if there is no such active whisker, or for a setpoint that is not finite.
    pub fn set_setpoint_deg(&mut self, n: usize, setpoint_deg: Option<f64>) -> Result<(), Error> {
        let degrees = setpoint_deg.map(|degrees| finite("setpoint", degrees));
        let theta = degrees.transpose()?.map(whisking::protraction);
        self.command(n, Command::Setpoint(theta))
    }

    /// Arms the motors of all whiskers, those that rest or were given up too, or keeps them
    /// off, from the next tick on.
    pub fn arm(&mut self, is_armed: bool) {
        self.bench.arm(is_armed);
    }

    fn command(&mut self, n: usize, command: Command<f64>) -> Result<(), Error> {
        let done = self.bench.command(n, command);
        done.map_err(|error| {
            Error::Input(format!(
                "whisker {n}, counted from 0, left side first: {error}"
            ))
        })
    }

    /// What the classifier got of the first whisker in the last tick, or would have got:
    /// nothing while it has a fault.
    pub fn sample(&mut self) -> Option<Sample> {
        self.samples().first().copied().flatten()
    }

    /// The same of each whisker that is heard.
    pub fn samples(&mut self) -> &[Option<Sample>] {
        let tap = self.bench.tap();
        tap.map(|tap| tap.samples.as_slice()).unwrap_or_default()
    }

    /// Contact of whisker `n` in the last tick, counted from 0, left side first; that of a side
    /// is the largest of its whiskers'. None of one that is not there.
    pub fn felt_by(&self, n: usize) -> Option<f64> {
        self.bench.felt_by(n)
    }

    /// The bus of a head of several boards; none where one board has all whiskers.
    pub fn bus(&mut self) -> Option<&mut Bus> {
        self.bench.bus()
    }

    /// The posterior of each class after the classifier's last full block, of the first whisker or
    /// of all together; equal before it and after a decision. None without a classifier.
    pub fn posteriors(&mut self) -> Option<Posteriors> {
        let classifier = self.bench.tap()?.classifier.as_ref();
        classifier.map(Classifier::posteriors)
    }
}

fn codes(deflection: [f64; 2]) -> [f64; 2] {
    deflection.map(|x| f64::from(Word::from_normalised(x as f32).code14()))
}

fn finite(name: &str, value: f64) -> Result<f64, Error> {
    if value.is_finite() {
        return Ok(value);
    }
    let fault = format!("{name}: found {value}, allowed: a finite number");
    Err(Error::Input(fault))
}

impl<B: Bench + ?Sized> Run<B> {
    /// A scene before its first tick, its module being `bench`, which decides
    /// among `classes`, in `world`.
    pub fn of(scene: &Scene, bench: Box<B>, classes: Vec<String>, world: World) -> Self {
        let sides = scene.head.sides.count();
        let whiskers = scene.head.whiskers_per_side;
        let mut run = Self {
            tick_hz: f64::from(scene.tick_hz),
            dt_s: 1.0 / f64::from(scene.tick_hz),
            ticks: scene.ticks(),
            done: 0,
            sides,
            whiskers,
            classes,
            world,
            presented: Presented::new(scene),
            poses: Poses::new(scene),
            flaws: Flaws::new(scene),
            snapshot: Snapshot::default(),
            row: Row::default(),
            events: Vec::new(),
            deflections: vec![[0.0; 2]; sides * whiskers],
            sensed: vec![[0.0; 2]; sides * whiskers],
            faults: vec![[0; 2]; sides * whiskers],
            bench,
        };
        run.rest();
        run
    }

    fn rest(&mut self) {
        let sides = self.sides;
        let absent = |side: usize, value: f64| if side < sides { value } else { f64::NAN };
        let pair = |value: f64| [absent(0, value), absent(1, value)];
        let rest = pair(whisking::REST_DEG);
        self.snapshot = Snapshot {
            theta_deg: vec![whisking::REST_DEG; sides * self.whiskers],
            z: pair(0.0),
            g: pair(0.0),
            contact: pair(0.0),
            touch: [0; 2],
        };
        self.row = Row {
            theta_deg: rest,
            z: pair(0.0),
            g: pair(0.0),
            contact: pair(0.0),
            angle_deg: rest,
            x: pair(0.0),
            y: pair(0.0),
            ..Row::default()
        };
        self.events.clear();
        self.deflections.fill([0.0; 2]);
        self.sensed.fill([0.0; 2]);
        self.faults.fill([0; 2]);
    }

    /// How many ticks the scene lasts.
    pub const fn ticks(&self) -> u64 {
        self.ticks
    }

    /// What is being touched: its class name and the trial.
    pub fn presented(&self) -> (&'static str, u64) {
        (self.presented.label, self.presented.trial)
    }

    /// The number of its pose, from 0: each presentation has another; none where the scene has no
    /// spread of poses.
    pub const fn pose(&self) -> Option<u64> {
        self.poses.number()
    }

    /// How what stands before each whisker does, left side first: its tilt, and how far the whisk
    /// would go beyond where the shaft meets it, degrees; empty unless the scene
    /// has `classifier.pose` or a spread of poses.
    pub fn stands(&self) -> Vec<[f64; 2]> {
        self.poses.stands()
    }

    /// Has a texture laid in place of the present one, as soon as that is not touched, and left
    /// there: as a person would who exchanges samples, instead of in the scene's order.
    pub const fn lay(&mut self, texture: Texture) {
        self.presented.lay(texture);
    }

    /// Whether what was to be [laid](Run::lay) lies there.
    pub const fn is_laid(&self) -> bool {
        self.presented.is_laid()
    }

    /// Whether any whisker touches a texture: the truth, which no module knows.
    pub fn touches(&self) -> bool {
        self.world.plant.touches()
    }

    /// How whisker `n` is bent, counted from 0, left side first: for a picture of it. None
    /// where shafts have no shape.
    pub fn bent(&self, n: usize) -> Option<Bent> {
        self.world.plant.bent(n)
    }

    /// The names of the classes that its decisions are among.
    pub fn classes(&self) -> &[String] {
        &self.classes
    }

    /// The sensor of whisker `n`, counted from 0, left side first: to disturb it. None where it
    /// is no MLX90333.
    pub fn slave_mut(&mut self, n: usize) -> Option<&mut Slave> {
        self.bench.sensor_mut(n)?.mlx()
    }

    /// The same, where it is a TMAG5170.
    pub fn tmag_mut(&mut self, n: usize) -> Option<&mut TmagSlave> {
        self.bench.sensor_mut(n)?.tmag()
    }

    /// The motor of whisker `n`, counted from 0, left side first: to disturb it. None where
    /// motors are ideal.
    pub fn motor_mut(&mut self, n: usize) -> Option<&mut SimMotor> {
        self.world.motor_mut(n)
    }

    /// The module.
    pub fn module_mut(&mut self) -> &mut B {
        &mut self.bench
    }

    /// One tick: the surface is presented, the sensors read, the module ticks,
    /// motors and plant move on. Returns the row of the trace.
    pub fn tick(&mut self) -> Row {
        self.pass();
        self.look();
        self.row
    }

    /// The same for a tick whose row is not needed: events, decisions, samples and whiskers are
    /// of this tick, while the row, the line of the trace, each θ and the contact of each side
    /// stay those of the last [`Run::tick`].
    pub fn pass(&mut self) {
        self.events.clear();
        self.exchange();
        for (n, last) in self.deflections.iter_mut().enumerate() {
            *last = self.world.plant.deflection(n);
        }
        let t_s = self.t_s();
        for (n, sensed) in self.sensed.iter_mut().enumerate() {
            *sensed = self.flaws.sensed(n, t_s, &self.deflections);
            if let Some(sensor) = self.bench.sensor_mut(n) {
                sensor.bend(*sensed);
            }
        }

        self.bench.tick(&mut self.events);
        if self.world.follows_setpoints() {
            self.bench.look(&mut self.snapshot);
        }
        self.world.advance(&self.snapshot.theta_deg, self.dt_s);

        self.keep_faults();
        self.done += 1;
    }

    /// Puts the next surface in place, in a pose of its own, if it is time and nothing is touched.
    fn exchange(&mut self) {
        let next = self.poses.next();
        let touches =
            self.world.plant.touches() || next.is_some_and(|pose| !self.world.plant.has_room(pose));
        let Some(texture) = self.presented.change(self.done, touches) else {
            return;
        };
        if let Some(pose) = self.poses.take() {
            self.world.plant.stand(pose);
            self.flaws.gain = pose.gain;
        }
        self.world.plant.present(texture);
    }

    /// Time that has passed, s.
    pub fn t_s(&self) -> f64 {
        self.done as f64 / self.tick_hz
    }

    fn look(&mut self) {
        // Where motors follow setpoints, that was done for them.
        if !self.world.follows_setpoints() {
            self.bench.look(&mut self.snapshot);
        }
        self.row.t_s = self.t_s();
        self.row.z = self.snapshot.z;
        self.row.g = self.snapshot.g;
        self.row.contact = self.snapshot.contact;
        self.row.touch = self.snapshot.touch;
        for side in 0..self.sides {
            let first = side * self.whiskers;
            self.row.theta_deg[side] = self.snapshot.theta_deg[first];
            self.row.angle_deg[side] = self.world.angles_deg[first];
            [self.row.x[side], self.row.y[side]] = codes(self.sensed[first]);
        }
    }

    fn keep_faults(&mut self) {
        for event in &self.events {
            let (place, which, number) = match event {
                Event::SensorLost(place, fault) => (place, 0, fault.code()),
                Event::SensorBack(place) => (place, 0, 0),
                Event::MotorFault(place, fault) => (place, 1, fault.code()),
                Event::MotorRetry(place) => (place, 1, 0),
                // Given up, a motor keeps its last fault.
                _ => continue,
            };
            let n = usize::from(place.side) * self.whiskers + usize::from(place.whisker);
            if let Some(faults) = self.faults.get_mut(n) {
                faults[which] = number;
            }
        }
    }

    /// Every whisker after the last tick, left side first, into `rows`.
    pub fn look_at_whiskers(&self, rows: &mut Vec<WhiskerRow>) {
        let faults = self.faults.iter().zip(&self.sensed).enumerate();
        let whisker = |(n, ([sensor, motor], sensed)): (usize, (&[u8; 2], &[f64; 2]))| {
            let side = n / self.whiskers.max(1);
            let of_side = || self.snapshot.contact.get(side).copied();
            let fault = if *sensor == 0 { *motor } else { *sensor };
            let touch = self.world.plant.contact_at(n);
            WhiskerRow {
                theta_deg: self.snapshot.theta_deg.get(n).copied().unwrap_or(f64::NAN),
                angle_deg: self.world.angles_deg.get(n).copied().unwrap_or(f64::NAN),
                speed_deg_s: self.world.speed_deg_s(n),
                duty: self.world.duty(n).unwrap_or(f64::NAN),
                codes: codes(*sensed),
                contact: self.bench.felt_by(n).or_else(of_side).unwrap_or(f64::NAN),
                fault: if self.bench.tells_faults() {
                    f64::from(fault)
                } else {
                    f64::NAN
                },
                touch_at_m: touch.map_or(f64::NAN, |at| at.arc_m),
                place_m: touch.map_or(f64::NAN, |at| at.plate_m[0]),
            }
        };
        rows.clear();
        rows.extend(faults.map(whisker));
    }

    /// The line of the trace of the last tick, in which `decided` fell; `whiskers` as
    /// [`Run::look_at_whiskers`] fills them in.
    pub fn trace_line<'a>(
        &'a self,
        decided: &'a [Decided],
        whiskers: &'a [WhiskerRow],
    ) -> TraceLine<'a> {
        TraceLine {
            row: &self.row,
            decisions: by_side(decided),
            presented: self.presented(),
            whiskers,
        }
    }

    /// The row of the last tick.
    pub const fn row(&self) -> &Row {
        &self.row
    }

    /// The events of the last tick, in order.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// The decisions of the last tick, with what was presented.
    pub fn decisions(&self) -> impl Iterator<Item = Decided> + '_ {
        self.events.iter().filter_map(|event| {
            let Event::Decision(place, decision) = event else {
                return None;
            };
            let trial = self.presented.trial.to_string();
            Some(Decided {
                place: Some(*place),
                t_s: Some(self.t_s()),
                pose: self.events.iter().find_map(|event| match event {
                    Event::Pose(of, pose) if of == place => Some(*pose),
                    _ => None,
                }),
                ..Decided::new(*decision, &self.classes, self.presented.label, &trial)
            })
        })
    }
}

fn by_side(decided: &[Decided]) -> [Option<&str>; 2] {
    [0, 1].map(|side| {
        let is_its = |decided: &&Decided| decided.place.is_some_and(|place| place.side == side);
        let decided = decided.iter().find(is_its);
        decided.map(|decided| decided.decision.as_str())
    })
}
