//! A whisker that moves, bends, touches a plate and is measured.
//!
//! Glossary:
//!
//! - *q_k*: amplitude of shape k in one transverse axis ([`crate::shapes`]);
//! - *place*: an arc length, where the shaft touches;
//! - *part*: one of 1, 2, 4 … 32 equal parts of a step in contact.
//!
//! # Model
//!
//! q̈ + 2 ζ ω q̇ + ω² q = f − (p a + r α) for each mode in each axis, and a static shape without
//! inertia, with the force f of the contact on it, the acceleration a of the base and its
//! angular acceleration α. Places are integrals of the tangent, whatever its angle. Between poses
//! the base moves uniformly; changes of its velocity are kicks at the start of a step. Left out:
//! inertia that changes with the shape, forces that grow with the square of the base's angular
//! velocity (2 % of ω² at 20 rad/s for the slowest whisker), twist, a third place that
//! touches at once, and the thickness of the shaft.
//!
//! # Range
//!
//! Pressed slowly on a hard plate by 2 to 45°, base moments and normal forces are within 1.5 % of an
//! exact elastica's, the place within 0.5 % of the length (`touching/tests/elastica.rs`: shafts of 60
//! to 200 mm, taper 3 to 15, slant 20 to 60°, friction 0 to 0.5). Pushes at which the shape is not
//! stable are left out. Up to [`TOUCHING_TAPER`] moments are within 2 %; at a taper of 45 the tip passes
//! through the plate, and most of the moment is missing. At a slant of 5° a cylinder does so at pushes
//! of more than 35°, at 2° of more than 15°. Around bars of 0.5 and 5 mm, moments and forces are
//! within 1 %, places within 0.2 % (`touching/tests/bar.rs`). Whipped onto plates of 3 to 20° of
//! slant at 8 and 16 Hz, base moments are within 2.5 % (rms) of MuJoCo's, also where two places
//! touch; on one exactly
//! along the shaft, which is touched at the base, within 16 %. No point of the shaft is behind the
//! surface by more than 0.5 % of the length, or 3 % where the plate lies along the shaft or the
//! slowest shaft is whisked at 16 Hz and more (`touching/tests/whip.rs`); that one then whips through
//! a plate of 2 mm.
//!
//! # Method
//!
//! A body that ends or is round is touched on its tangent plane ([`crate::outline`]). Modes are
//! propagated exactly, free or under the force of the contact, which is constant during a part and
//! solved for implicitly, with friction and the contact's own damping, to second order where parts
//! resolve the highest mode ([`law`]). Where on the shaft it acts, where that goes and how high the
//! ground is there are found together ([`rounds`]), and both where another place touches too
//! ([`second`]). The sum of modal and elastic energy never grows while the base rests, on any
//! ground, at any stiffness and step.
//!
//! A step is cut in parts by how far the shaft slides over the grains and how fast
//! the highest mode rings; one that stays clear of the plate is not cut.

mod body;
mod law;
mod outputs;
mod part;
mod rounds;
mod second;
mod step;

pub use outputs::{At, Bent};

use crate::beam::Modes;
use crate::error::BadSetting;
use crate::modal::{ModalShaft, ModalState};
use crate::outline::Outline;
use crate::pose::{Plate, PlateFrame, Pose};
use crate::sensor::{Sensor, SensorSettings};
use crate::shaft::Shaft;
use crate::shapes::MODES;
use crate::surface::{Material, Surface};
use crate::vector::{V3, across, dot, scale, sub, unit};
use body::{Body, Ground, Steps, Touch};

/// The most that a shaft may taper, hub over tip: beyond it the modes cannot bend as its tip does.
pub const TOUCHING_TAPER: f64 = 25.0;

/// Largest change of velocity of the base in a step, m/s, and of its direction,
/// rad/s: they keep the arithmetic finite.
const KICK: f64 = 1e4;

/// A whisker with its sensor.
#[derive(Debug, Clone)]
pub struct TouchingWhisker {
    body: Body,
    steps: Steps,
    pose: Option<Pose>,
    /// Velocity of the base and of the direction of the shaft.
    motion: Option<[V3; 2]>,
    /// Point and directions of the last plate, and its axes.
    plate: ([V3; 3], Option<PlateFrame>),
    sensor: Sensor,
    /// Of the last step: how many parts it was cut into.
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
        Self::with_modes(shaft, &modes, sensor, seed)
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
        let shaft = ModalShaft::new(shaft, modes);
        Ok(Self::at_rest(shaft, *sensor, seed))
    }

    fn at_rest(shaft: ModalShaft, sensor: SensorSettings, seed: u64) -> Self {
        Self {
            body: Body {
                ground: Ground::new(Surface::of(Material::Flat), shaft.tip_radius_m),
                shaft,
                outline: Outline::PLANE,
                state: ModalState::default(),
                curve: None,
                touch: Touch::default(),
                other: Touch::default(),
                last: None,
                finer: 0,
            },
            steps: Steps::default(),
            pose: None,
            motion: None,
            plate: ([[f64::NAN; 3]; 3], None),
            sensor: Sensor::new(sensor, seed),
            parts: 0,
        }
    }

    /// Starts again, as if newly made with this seed for the sensor's noise.
    pub fn restart(&mut self, seed: u64) {
        let shaft = self.body.shaft.clone();
        *self = Self::at_rest(shaft, self.sensor.settings(), seed).finer(self.body.finer);
    }

    /// Cuts steps in contact 2ⁿ times finer, up to 32 parts in all: to see what
    /// the usual choice costs in accuracy.
    #[must_use]
    pub fn finer(mut self, n: u32) -> Self {
        self.body.finer = n;
        self
    }

    /// Straightens the shaft, at rest, wherever the next pose is; the surface,
    /// the sensor's noise and its last value stay.
    pub fn rest(&mut self) {
        self.body.place(ModalState::default());
        self.pose = None;
        self.motion = None;
    }

    /// Bends the shaft statically, at rest, until its tip is off by these
    /// distances, m, within ±L.
    pub fn bend(&mut self, tip_m: [f64; 2]) {
        let limit = self.body.shaft.length_m;
        let tip_m = tip_m.map(|u| {
            if u.is_finite() {
                u.clamp(-limit, limit)
            } else {
                0.0
            }
        });
        self.body.place(self.body.shaft.bent(tip_m));
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
        if self.steps.dt_s != dt_s {
            self.steps = Steps::new(&self.body.shaft, dt_s);
        }
        self.carry(&pose, dt_s);
        self.parts = 0;
        if let Some(plate) = plate {
            self.step_before(&pose, plate);
        } else {
            self.body.free(&self.steps);
        }
        if self.body.state.limit(&self.body.shaft) {
            self.body.curve = None;
        }
        if !self.body.state.is_finite() {
            self.body.place(ModalState::default());
        }
        if self.sensor.due(dt_s) {
            self.sensor.advance(self.rotation_rad(), dt_s);
        } else {
            self.sensor.advance([0.0; 2], dt_s);
        }
    }

    /// Moves the base to a new pose: the change of its velocity kicks the modes.
    fn carry(&mut self, pose: &Pose, dt_s: f64) {
        let Some(before) = self.pose.replace(*pose) else {
            return;
        };
        let rate = |to: V3, from: V3| scale(1.0 / dt_s, sub(to, from));
        let motion = [rate(pose.base_m, before.base_m), rate(pose.z(), before.z())];
        let Some(old) = self.motion.replace(motion) else {
            return;
        };
        let [shift, turn] = [0, 1].map(|i| {
            let change = sub(motion[i], old[i]).map(|c| c.clamp(-KICK, KICK));
            [dot(change, pose.x), dot(change, pose.y)]
        });
        self.body.state.kick(&self.body.shaft, shift, turn);
    }

    /// A step before a plate. One whose point or directions are not finite is not
    /// there.
    fn step_before(&mut self, pose: &Pose, plate: &Plate) {
        let placed = [plate.point_m, plate.normal, plate.along];
        if self.plate.0 != placed {
            let finite = placed.iter().flatten().all(|x| x.is_finite());
            self.plate = (placed, finite.then(|| PlateFrame::new(plate)));
        }
        let Some(frame) = &self.plate.1 else {
            self.body.free(&self.steps);
            return;
        };
        if !self.body.ground.is_of(&plate.surface) {
            self.body.ground = Ground::new(plate.surface, self.body.shaft.tip_radius_m);
            self.body.touch.ground = None;
            self.body.other.ground = None;
        }
        self.body.outline = plate.outline.limited();
        let pose = frame.see(pose);
        self.parts = self.body.step(pose, &self.steps);
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
