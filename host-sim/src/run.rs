//! A scene in motion: module, motors and plant, tick by tick.

use firmware::Event;
use mlx90333::Word;
use scene::{PlantKind, Scene, Texture};

use crate::Error;
use crate::bench::{self, AnyListener, Bench, Parts, Snapshot};
use crate::bus::Slave;
use crate::decisions::Decided;
use crate::trace::Row;
use crate::world::World;

/// What a tick brought besides its row.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Happened {
    /// Events in order.
    pub events: Vec<Event>,
}

/// A running scene.
pub struct Run<'m> {
    tick_hz: f64,
    ticks: u64,
    done: u64,
    sides: usize,
    whiskers: usize,
    bench: Box<dyn Bench + 'm>,
    slaves: Vec<Slave>,
    world: World,
    presented: Presented,
    snapshot: Snapshot,
    row: Row,
}

/// What is being touched: which texture, for the how-manieth time.
#[derive(Debug, Clone, PartialEq)]
struct Presented {
    textures: Vec<Texture>,
    /// Ticks a presentation.
    length: u64,
    label: &'static str,
    trial: u64,
}

impl Presented {
    fn new(scene: &Scene) -> Self {
        let label = match scene.plant.kind {
            PlantKind::Ideal if scene.plant.obstacle.is_some() => "obstacle",
            _ => "free",
        };
        let (textures, length) = match &scene.plant.textured {
            Some(textured) => {
                let ticks = (textured.present_s * f64::from(scene.tick_hz)).round();
                (textured.textures.clone(), (ticks as u64).max(1))
            }
            None => (Vec::new(), u64::MAX),
        };
        Self {
            textures,
            length,
            label,
            trial: 0,
        }
    }

    /// The texture to put in place before tick `done + 1`, if it changes there.
    fn change(&mut self, done: u64) -> Option<Texture> {
        if !done.is_multiple_of(self.length) {
            return None;
        }
        let count = done / self.length;
        let among = self.textures.len() as u64;
        let texture = *self.textures.get(count.checked_rem(among)? as usize)?;
        self.label = texture.name();
        self.trial = count / among;
        Some(texture)
    }
}

impl<'m> Run<'m> {
    /// A scene before its first tick, its first whisker listened to by `listener`.
    ///
    /// # Errors
    /// [`Error::Work`] if the module cannot be put together.
    pub fn new(scene: &Scene, listener: Option<AnyListener<'m>>) -> Result<Self, Error> {
        let slaves: Vec<Slave> = (0..scene.whiskers()).map(|_| Slave::new()).collect();
        let (world, drives) = World::new(scene)?;
        let parts = Parts {
            slaves: slaves.clone(),
            drives,
            listener,
        };
        let bench = bench::build(scene, parts)?;
        Ok(Self::of(scene, bench, slaves, world))
    }

    /// A scene before its first tick, its module being `bench`: with a sensor
    /// in `slaves` for every whisker, left side first, in `world`.
    pub fn of(scene: &Scene, bench: Box<dyn Bench + 'm>, slaves: Vec<Slave>, world: World) -> Self {
        let sides = scene.head.sides.count();
        let whiskers = scene.head.whiskers_per_side;
        let absent = |side: usize, value: f64| if side < sides { value } else { f64::NAN };
        let pair = |value: f64| [absent(0, value), absent(1, value)];
        let rest = pair(whisking::REST_DEG);
        Self {
            tick_hz: f64::from(scene.tick_hz),
            ticks: scene.ticks(),
            done: 0,
            sides,
            whiskers,
            bench,
            slaves,
            world,
            presented: Presented::new(scene),
            snapshot: Snapshot {
                theta_deg: vec![whisking::REST_DEG; sides * whiskers],
                z: pair(0.0),
                g: pair(0.0),
                contact: pair(0.0),
            },
            row: Row {
                t_s: 0.0,
                theta_deg: rest,
                z: pair(0.0),
                g: pair(0.0),
                contact: pair(0.0),
                angle_deg: rest,
                x: pair(0.0),
                y: pair(0.0),
            },
        }
    }

    /// How many ticks the scene lasts.
    pub const fn ticks(&self) -> u64 {
        self.ticks
    }

    /// What is being touched: its class name and the trial.
    pub fn presented(&self) -> (&'static str, u64) {
        (self.presented.label, self.presented.trial)
    }

    /// The sensors, left side first, to disturb them.
    pub fn slaves(&self) -> &[Slave] {
        &self.slaves
    }

    /// One tick: the surface is presented, the sensors read, the module ticks,
    /// motors and plant move on. Returns the row of the trace.
    pub fn tick(&mut self, happened: &mut Happened) -> &Row {
        happened.events.clear();
        if let Some(texture) = self.presented.change(self.done) {
            self.world.present(texture);
            self.bench.forget();
        }
        for (n, slave) in self.slaves.iter().enumerate() {
            let (side, whisker) = (n / self.whiskers, n % self.whiskers);
            let deflection = self.world.deflection(side, whisker);
            slave.set(deflection);
            if whisker == 0 {
                let code = |x| f64::from(Word::from_normalised(x as f32).code14());
                [self.row.x[side], self.row.y[side]] = deflection.map(code);
            }
        }

        self.bench.tick(&mut happened.events);
        self.bench.look(&mut self.snapshot);
        self.world
            .advance(&self.snapshot.theta_deg, 1.0 / self.tick_hz);

        self.done += 1;
        self.row.t_s = self.done as f64 / self.tick_hz;
        self.row.z = self.snapshot.z;
        self.row.g = self.snapshot.g;
        self.row.contact = self.snapshot.contact;
        for side in 0..self.sides {
            let first = side * self.whiskers;
            self.row.theta_deg[side] = self.snapshot.theta_deg[first];
            self.row.angle_deg[side] = self.world.angles_deg()[first];
        }
        &self.row
    }

    /// The decision among what happened, with what was presented.
    pub fn decided(&self, happened: &Happened, classes: &[String]) -> Option<Decided> {
        happened.events.iter().find_map(|event| {
            let Event::Decision(decision) = event else {
                return None;
            };
            Some(Decided {
                label: self.presented.label.to_owned(),
                trial: self.presented.trial.to_string(),
                decision: classes.get(decision.class()).cloned().unwrap_or_default(),
                samples: decision.samples(),
                posterior: decision.posterior().to_f64(),
            })
        })
    }
}
