//! A whisker that moves, bends, touches a plate and is measured.
//!
//! Glossary:
//!
//! - *q_k*: amplitude of mode k in one transverse axis, m √kg; tip deflection
//!   u = Σ φ_k(L) q_k;
//! - *rigid tip*: where the tip would be if the shaft were straight;
//! - *part*: one of 1, 2, 4 … 32 equal parts of a step in contact.
//!
//! # Model
//!
//! q̈ + 2 ζ ω q̇ + ω² q = φ(L) F − (p a + r α) in each axis, with the force F of the
//! contact, the acceleration a of the base and its angular acceleration α. The
//! tip is at base + (L − κ|u|²/2) z + u_x x + u_y y. Between poses the base moves
//! uniformly; changes of its velocity are kicks at the begin of a step. Left
//! out: forces that grow with the square of the base's angular velocity (2 % of
//! ω² at 20 rad/s for the slowest whisker) and contact elsewhere than at the tip.
//!
//! # Method
//!
//! Modes are propagated exactly, free or under the force of the contact, which
//! is constant during a part and found implicitly, with friction and the
//! contact's own damping, to the second order where parts resolve what rings
//! ([`law`]). Where the tip goes meanwhile and how high the ground is there are
//! found together ([`part`]). The sum of modal and elastic energy never grows
//! while the base rests, on any ground, at any stiffness and step.
//!
//! A step is cut in parts by how far the tip travels over the grains and how fast
//! the highest mode rings; one that stays clear of the plate is not cut and knows
//! nothing of contact.

mod before;
mod ground;
mod law;
mod part;
mod spring;
mod telling;

use super::beam::Modes;
use super::pose::{Plate, Pose};
use super::relief::Relief;
use super::sensor::{Sensor, SensorSettings};
use super::shaft::Shaft;
use super::state::{MODES, Reach, Shape, State};
use super::surface::Surface;
use super::vector::{V3, across, dot, scale, sub, unit};
use crate::BadSetting;
use before::Last;
use part::Touch;
pub(crate) use spring::Give;

/// Parts of a step are at most 2 to this power.
const POWERS: usize = 6;

/// Largest change of velocity of the base in a step, m/s, and of its direction,
/// rad/s: they keep the arithmetic finite.
const KICK: f64 = 1e4;

/// A whisker with its sensor.
#[derive(Debug, Clone)]
pub struct TouchingWhisker {
    shape: Shape,
    state: State,
    /// For steps of this length: how modes move in 1, 2, 4 … parts of it.
    reach: (f64, [Reach; POWERS]),
    pose: Option<Pose>,
    /// Velocity of the base and of the direction of the shaft.
    motion: Option<[V3; 2]>,
    relief: (Surface, Relief),
    last: Option<Last>,
    touch: Touch,
    sensor: Sensor,
    finer: u32,
    /// Of the last step.
    parts: u32,
}

impl TouchingWhisker {
    /// A straight whisker at rest. The seed is that of the sensor's noise; the
    /// surface has its own.
    ///
    /// # Errors
    /// The first setting out of its range, by name.
    pub fn new(shaft: &Shaft, sensor: &SensorSettings, seed: u64) -> Result<Self, BadSetting> {
        sensor.check()?;
        let modes = shaft.modes(MODES)?;
        Ok(Self::of(shaft, &modes, sensor, seed))
    }

    /// As [`TouchingWhisker::new`], with modes that were solved before:
    /// [`Shaft::modes`] takes milliseconds. Modes that are missing do not move.
    ///
    /// # Errors
    /// As [`TouchingWhisker::new`].
    pub fn with_modes(
        shaft: &Shaft,
        modes: &Modes,
        sensor: &SensorSettings,
        seed: u64,
    ) -> Result<Self, BadSetting> {
        shaft.check()?;
        sensor.check()?;
        Ok(Self::of(shaft, modes, sensor, seed))
    }

    fn of(shaft: &Shaft, modes: &Modes, sensor: &SensorSettings, seed: u64) -> Self {
        Self::at_rest(Shape::new(shaft, modes), *sensor, seed)
    }

    fn at_rest(shape: Shape, sensor: SensorSettings, seed: u64) -> Self {
        let flat = Surface::of(super::Material::Flat);
        Self {
            shape,
            state: State::default(),
            reach: (0.0, [Reach::default(); POWERS]),
            pose: None,
            motion: None,
            relief: (flat, Relief::new(&flat, 0.0)),
            last: None,
            touch: Touch::default(),
            sensor: Sensor::new(sensor, seed),
            finer: 0,
            parts: 0,
        }
    }

    /// Starts anew, as newly made with this seed for the sensor's noise.
    pub fn restart(&mut self, seed: u64) {
        *self = Self::at_rest(self.shape.clone(), self.sensor.settings(), seed).finer(self.finer);
    }

    /// Cuts steps in contact 2ⁿ times finer, up to 32 parts in all: to see what
    /// the usual choice costs in accuracy.
    #[must_use]
    pub fn finer(mut self, n: u32) -> Self {
        self.finer = n;
        self
    }

    /// Straightens the shaft, at rest, wherever the next pose is; the surface,
    /// the sensor's noise and its last value stay.
    pub fn rest(&mut self) {
        self.state = State::default();
        self.touch = Touch::default();
        self.pose = None;
        self.motion = None;
        self.last = None;
    }

    /// Bends the shaft statically, at rest, until its tip is off by these
    /// distances, m, within ±L.
    pub fn bend(&mut self, tip_m: [f64; 2]) {
        let limit = self.shape.length_m;
        let tip_m = tip_m.map(|u| {
            if u.is_finite() {
                u.clamp(-limit, limit)
            } else {
                0.0
            }
        });
        self.state = self.shape.bent(tip_m);
        self.touch = Touch::default();
        self.last = None;
    }

    /// Moves on by `dt_s` (s, positive) to a pose, before a plate if there is
    /// one. The first pose after the start or [`TouchingWhisker::rest`] is taken
    /// as resting, and the first velocity as having been there before. A pose
    /// that is not finite counts as the last one. Values of the surface out of
    /// their ranges count as the nearest that is within.
    pub fn step(&mut self, pose: &Pose, plate: Option<&Plate>, dt_s: f64) {
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return;
        }
        let Some(pose) = proper(pose).or(self.pose) else {
            return;
        };
        if self.reach.0 != dt_s {
            let of = |power: usize| Reach::new(&self.shape, dt_s / f64::from(1_u32 << power));
            self.reach = (dt_s, core::array::from_fn(of));
        }
        self.carry(&pose, dt_s);
        self.parts = 0;
        if let Some(plate) = plate {
            self.before(&pose, plate, dt_s);
        } else {
            self.state.free(&self.reach.1[0]);
            self.touch = Touch::default();
            self.last = None;
        }
        self.state.limit(&self.shape);
        if !self.state.is_finite() {
            self.state = State::default();
            self.touch = Touch::default();
        }
        if self.sensor.due(dt_s) {
            let rotation = self.shape.rotation(&self.state, self.touch.pull);
            self.sensor.advance(rotation, dt_s);
        } else {
            self.sensor.advance([0.0; 2], dt_s);
        }
    }

    /// The base goes to a new pose: kicks by the change of its velocity.
    fn carry(&mut self, pose: &Pose, dt_s: f64) {
        let before = self.pose.replace(*pose);
        let Some(before) = before else {
            return;
        };
        let rate = |to: V3, from: V3| scale(1.0 / dt_s, sub(to, from));
        let motion = [rate(pose.base_m, before.base_m), rate(pose.z(), before.z())];
        let Some(old) = self.motion.replace(motion) else {
            return;
        };
        let [shift, turn] = [0, 1].map(|i| {
            let change = sub(motion[i], old[i]);
            change.map(|c| c.clamp(-KICK, KICK))
        });
        for (axis, way) in [pose.x, pose.y].into_iter().enumerate() {
            self.state
                .kick(&self.shape, axis, dot(shift, way), dot(turn, way));
        }
    }
}

/// The pose with axes of length one at right angles, if it is finite.
fn proper(pose: &Pose) -> Option<Pose> {
    let all = [pose.base_m, pose.x, pose.y];
    if !all.iter().flatten().all(|c| c.abs() < 1e6) {
        return None;
    }
    let x = unit(pose.x, [1.0, 0.0, 0.0]);
    let y = across(pose.y, x);
    Some(Pose {
        base_m: pose.base_m,
        x,
        y,
    })
}

#[cfg(test)]
mod tests;
