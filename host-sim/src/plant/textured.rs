//! Whiskers that bend, ring and are dragged over textured surfaces.
//!
//! Glossary:
//!
//! - *tip*: the end of the whisker, at its length L from the motor's axis;
//! - *target*: the deflection that the whisker would settle at;
//! - *excursion* e: how far, as an angle, a grain holds the tip back along the
//!   surface: grip · height/L;
//! - *landing*: the begin of a contact. Each is on another spot: the angle
//!   repeats to an encoder count, 0.06° or 0.1 mm at the tip, more than a grain.
//!
//! # Model
//!
//! For overlap o = max(0, θ′ − θ′_lim), a tip that travels L |do/dt| along the
//! surface ([`SurfaceSettings`]) over a profile of relative heights h_x, h_y, and sliding
//! s = v/(|v| + creep) with v = do/dt:
//!
//! - bend: n = B tanh(σ_x u/B), u = max(0, o/(1 + softness) + e h_x). On a hard,
//!   smooth surface the slope at first touch is that of BIOTACT eq. 11;
//! - target: x* = n (1 + drag μ s), y* = σ_x e lateral h_y + n drag_y μ s, with
//!   μ drawn about the surface's at each landing;
//! - x and y follow their targets through the first bending mode, a resonator;
//! - a change of the base's speed kicks dx/dt by −σ_x inertia times that change;
//! - the sensor adds white noise.
//!
//! Means over the tick go into the targets; profile and resonator are exact at
//! any tick. Not modelled: stick and slip, higher modes, the mode's shift while
//! the tip is held, torque back on the motor.

use core::f64::consts::PI;
use core::iter::repeat;

use scene::Texture;

use super::surface::{Path, Profile, SurfaceSettings};
use super::{BadSetting, Head, Plant, apart};
use physics::{Noise, Propagator, Resonator};

/// The middle whisker of BIOTACT (section II-C): length L, m, and undamped frequency of the first
/// bending mode, Hz. Its damping ratio, and all that follows, are choices.
const LENGTH_M: f64 = 0.112;
const RESONANCE_HZ: f64 = 50.0;
const DAMPING: f64 = 0.1;

/// Excursion of the tip across the direction of whisking, as a share of that along it.
const LATERAL: f64 = 0.5;

/// Bend B at which the shaft gives no more: room is left below the end of the sensor's range.
const BEND_LIMIT: f64 = 0.8;

/// Share of the bend that friction adds in protraction and takes in retraction, a unit of μ; and
/// that it turns to y, as the whisker lies at a slant to the surface.
const DRAG: [f64; 2] = [0.4, 0.4];

/// Sliding speed at which friction is half of its full value, degrees a second.
const CREEP_DEG_S: f64 = 10.0;

/// Largest angle (degrees, either sign) and speed (degrees a second) that are
/// believed; they keep the arithmetic finite.
const ANGLE_LIMIT: f64 = 1e6;
const SPEED_LIMIT: f64 = 1e6;

/// Steps of the sensor's 14-bit code in a deflection of 1.
const CODES: f64 = 8191.0;

#[derive(Debug, Clone)]
struct Whisker {
    /// θ′_lim.
    limit_deg: f64,
    angle_deg: Option<f64>,
    speed_deg_s: f64,
    touching: bool,
    /// Friction of the spot landed on, relative to the surface's.
    patch: f64,
    profile: [Profile; 2],
    modes: [Resonator; 2],
    /// For steps of this length, s.
    over: (f64, Propagator),
    reading: [f64; 2],
    noise: Noise,
}

/// What whiskers meet, and what they are like.
#[derive(Debug, Clone)]
struct World {
    surface: SurfaceSettings,
    stiffness: f64,
    /// Friction coefficient μ of every texture in place of its own.
    friction: Option<f64>,
    /// Share of its own inertia that bends a free whisker; a rigid rod on a hinge spring has 1.
    inertia: f64,
    /// Spread of the friction over the landings, the standard deviation of its logarithm.
    patch: f64,
    /// Of the sensor, root mean square, a deflection.
    noise: f64,
}

/// Textured surfaces before simulated whiskers.
#[derive(Debug, Clone)]
pub struct Textured {
    head: Head,
    world: World,
    whiskers: Vec<Whisker>,
}

impl Textured {
    /// Noise of a sensor, root mean square, codes of 14 bits.
    pub const NOISE_CODES: f64 = 4.0;

    /// Whiskers before a smooth surface. `friction` is the coefficient μ of every texture in
    /// place of its own, 0 to 10; `noise_codes` the sensor noise, 0 to 1000. The same seed gives
    /// the same noise and the same grains; each whisker has its own.
    ///
    /// # Errors
    /// The first setting out of its range.
    pub fn new(
        head: Head,
        friction: Option<f64>,
        noise_codes: f64,
        seed: u64,
    ) -> Result<Self, BadSetting> {
        head.check()?;
        BadSetting::check("friction", friction.unwrap_or(0.0), 0.0, 10.0)?;
        BadSetting::check("noise_codes", noise_codes, 0.0, 1000.0)?;
        let world = World {
            surface: SurfaceSettings::of(Texture::Smooth),
            stiffness: head.stiffness,
            friction,
            inertia: 1.0,
            patch: 0.2,
            noise: noise_codes / CODES,
        };
        Ok(Self {
            whiskers: whiskers(&head, seed),
            head,
            world,
        })
    }

    /// The same whiskers with nothing before them from here on.
    #[must_use]
    pub fn in_the_air(&self) -> Self {
        let mut free = self.clone();
        for whisker in &mut free.whiskers {
            whisker.limit_deg = f64::INFINITY;
        }
        free
    }
}

fn whiskers(head: &Head, seed: u64) -> Vec<Whisker> {
    let whisker = |(n, limit_deg)| Whisker::new(limit_deg, apart(seed, n));
    (0..).zip(head.limits()).map(whisker).collect()
}

impl Whisker {
    fn new(limit_deg: f64, seed: u64) -> Self {
        Self {
            limit_deg,
            angle_deg: None,
            speed_deg_s: 0.0,
            touching: false,
            patch: 1.0,
            profile: [Profile::default(); 2],
            modes: [Resonator::default(); 2],
            over: (0.0, Propagator::new(RESONANCE_HZ, DAMPING, 0.0)),
            reading: [0.0; 2],
            noise: Noise::new(seed),
        }
    }

    /// Targets of x and y for a base that moves between two angles.
    fn targets(&mut self, world: &World, before: f64, after: f64, dt_s: f64) -> [f64; 2] {
        let (surface, stiffness) = (world.surface, world.stiffness);
        let from = (before - self.limit_deg).max(0.0);
        let to = (after - self.limit_deg).max(0.0);
        let landed = self.touching;
        self.touching = from > 0.0 || to > 0.0;
        if !self.touching {
            return [0.0; 2];
        }
        let metres_per_degree = LENGTH_M * PI / 180.0;
        let grains = (to - from).abs() * metres_per_degree / surface.grain_m;
        let path = Path::new(grains);
        let noise = &mut self.noise;
        if !landed {
            self.patch = libm::exp(world.patch * noise.next());
        }
        let [along, across] = self.profile.each_mut().map(|profile| {
            if !landed {
                profile.land(noise);
            }
            profile.travel(&path, noise)
        });
        let excursion = surface.grip * surface.height_m / metres_per_degree;
        let overlap = f64::midpoint(from, to) / (1.0 + surface.softness);
        let strain = stiffness * (overlap + excursion * along).max(0.0);
        let bend = BEND_LIMIT * libm::tanh(strain / BEND_LIMIT);
        let speed = (to - from) / dt_s;
        let friction = self.patch * surface.friction * speed / (speed.abs() + CREEP_DEG_S);
        let grain_y = stiffness * excursion * LATERAL * across;
        let [drag, drag_y] = DRAG;
        [
            bend * (1.0 + drag * friction),
            grain_y + bend * drag_y * friction,
        ]
    }

    fn advance(&mut self, world: &World, angle: f64, dt_s: f64) {
        let believed = Some(angle).filter(|angle| angle.abs() <= ANGLE_LIMIT);
        let Some(after) = believed.or(self.angle_deg) else {
            return;
        };
        let before = self.angle_deg.replace(after).unwrap_or(after);
        if self.over.0 != dt_s {
            self.over = (dt_s, Propagator::new(RESONANCE_HZ, DAMPING, dt_s));
        }
        let targets = self.targets(world, before, after, dt_s);
        let speed = ((after - before) / dt_s).clamp(-SPEED_LIMIT, SPEED_LIMIT);
        let kick = world.inertia * world.stiffness * (speed - self.speed_deg_s);
        self.speed_deg_s = speed;
        let [x, _] = &mut self.modes;
        x.v -= kick;
        let parts = self.modes.iter_mut().zip(targets);
        for ((mode, target), reading) in parts.zip(&mut self.reading) {
            mode.step(&self.over.1, target);
            let noise = world.noise * self.noise.next();
            *reading = (mode.x + noise).clamp(-1.0, 1.0);
        }
    }
}

impl Plant for Textured {
    fn present(&mut self, texture: Texture) {
        let mut surface = SurfaceSettings::of(texture);
        surface.friction = self.world.friction.unwrap_or(surface.friction);
        self.world.surface = surface;
        // Those in contact land again.
        for whisker in &mut self.whiskers {
            whisker.touching = false;
        }
    }

    fn touches(&self) -> bool {
        self.whiskers.iter().any(|whisker| whisker.touching)
    }

    fn deflection(&self, n: usize) -> [f64; 2] {
        let whisker = self.whiskers.get(n);
        whisker.map_or([0.0; 2], |whisker| whisker.reading)
    }

    fn advance(&mut self, angles_deg: &[f64], dt_s: f64) {
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return;
        }
        let angles = angles_deg.iter().copied().chain(repeat(f64::NAN));
        for (whisker, angle) in self.whiskers.iter_mut().zip(angles) {
            whisker.advance(&self.world, angle, dt_s);
        }
    }

    fn restart(&mut self, seed: u64) {
        self.world.surface = SurfaceSettings::of(Texture::Smooth);
        self.whiskers = whiskers(&self.head, seed);
    }
}

#[cfg(test)]
mod tests;
