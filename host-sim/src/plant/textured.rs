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

mod settings;

use core::f64::consts::PI;
use core::iter::repeat;

use scene::Texture;

use super::surface::{Path, Profile, SurfaceSettings};
use super::{BadSetting, Head, Plant, apart};
use physics::{Noise, Propagator, Resonator};
pub use settings::{TexturedSettings, WhiskerSettings};

/// Largest angle (degrees, either sign) and speed (degrees a second) that are
/// believed; they keep the arithmetic finite.
const ANGLE_LIMIT: f64 = 1e6;
const SPEED_LIMIT: f64 = 1e6;

/// Steps of the sensor's 14-bit code in a deflection of 1.
const CODES: f64 = 8191.0;

#[derive(Debug, Clone)]
struct Whisker {
    shaft: WhiskerSettings,
    /// Way of the tip.
    metres_per_degree: f64,
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

/// Textured surfaces before simulated whiskers.
#[derive(Debug, Clone)]
pub struct Textured {
    head: Head,
    settings: TexturedSettings,
    surface: SurfaceSettings,
    whiskers: Vec<Whisker>,
}

impl Textured {
    /// Whiskers before a smooth surface. The same seed gives the same noise and
    /// the same grains; each whisker has its own.
    ///
    /// # Errors
    /// The first setting out of its range.
    pub fn new(head: Head, settings: TexturedSettings, seed: u64) -> Result<Self, BadSetting> {
        head.check()?;
        settings.check()?;
        let whiskers = whiskers(&head, &settings, seed);
        Ok(Self {
            head,
            settings,
            surface: SurfaceSettings::of(Texture::Smooth),
            whiskers,
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

    /// Puts any surface before all whiskers; those in contact land again. Its
    /// values are limited to 0 to 1 m of height, 1e-9 to 1e3 m of grain, 1000 of
    /// grip and softness and 10 of friction; one that is not a number counts as
    /// the lowest.
    pub fn present_surface(&mut self, surface: SurfaceSettings) {
        // The larger of a number and NaN is the number.
        let limit = |value: f64, lo: f64, hi: f64| value.max(lo).min(hi);
        self.surface = SurfaceSettings {
            height_m: limit(surface.height_m, 0.0, 1.0),
            grain_m: limit(surface.grain_m, 1e-9, 1e3),
            grip: limit(surface.grip, 0.0, 1e3),
            softness: limit(surface.softness, 0.0, 1e3),
            friction: limit(surface.friction, 0.0, 10.0),
        };
        for whisker in &mut self.whiskers {
            whisker.touching = false;
        }
    }
}

fn whiskers(head: &Head, settings: &TexturedSettings, seed: u64) -> Vec<Whisker> {
    let whisker = |(n, limit_deg)| Whisker::new(settings.whisker, limit_deg, apart(seed, n));
    (0..).zip(head.limits()).map(whisker).collect()
}

struct World<'a> {
    surface: &'a SurfaceSettings,
    stiffness: f64,
    settings: &'a TexturedSettings,
    /// Of the sensor, a deflection.
    noise: f64,
    dt_s: f64,
}

impl Whisker {
    fn new(shaft: WhiskerSettings, limit_deg: f64, seed: u64) -> Self {
        Self {
            shaft,
            metres_per_degree: shaft.length_m * PI / 180.0,
            limit_deg,
            angle_deg: None,
            speed_deg_s: 0.0,
            touching: false,
            patch: 1.0,
            profile: [Profile::default(); 2],
            modes: [Resonator::default(); 2],
            over: (0.0, Propagator::new(shaft.resonance_hz, shaft.damping, 0.0)),
            reading: [0.0; 2],
            noise: Noise::new(seed),
        }
    }

    /// Targets of x and y for a base that moves between two angles.
    fn targets(&mut self, world: &World<'_>, before: f64, after: f64) -> [f64; 2] {
        let World {
            surface,
            stiffness,
            settings,
            dt_s,
            ..
        } = *world;
        let from = (before - self.limit_deg).max(0.0);
        let to = (after - self.limit_deg).max(0.0);
        let landed = self.touching;
        self.touching = from > 0.0 || to > 0.0;
        if !self.touching {
            return [0.0; 2];
        }
        let metres_per_degree = self.metres_per_degree;
        let grains = (to - from).abs() * metres_per_degree / surface.grain_m;
        let path = Path::new(grains);
        let noise = &mut self.noise;
        if !landed {
            self.patch = libm::exp(settings.patch * noise.next());
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
        let bend = settings.bend_limit * libm::tanh(strain / settings.bend_limit);
        let speed = (to - from) / dt_s;
        let friction = self.patch * surface.friction * speed / (speed.abs() + settings.creep_deg_s);
        let grain_y = stiffness * excursion * settings.lateral * across;
        [
            bend * (1.0 + settings.drag * friction),
            grain_y + bend * settings.drag_y * friction,
        ]
    }

    fn advance(&mut self, world: &World<'_>, angle: f64) {
        let believed = Some(angle).filter(|angle| angle.abs() <= ANGLE_LIMIT);
        let Some(after) = believed.or(self.angle_deg) else {
            return;
        };
        let before = self.angle_deg.replace(after).unwrap_or(after);
        let (dt_s, settings) = (world.dt_s, world.settings);
        if self.over.0 != dt_s {
            let shaft = &self.shaft;
            let over = Propagator::new(shaft.resonance_hz, shaft.damping, dt_s);
            self.over = (dt_s, over);
        }
        let targets = self.targets(world, before, after);
        let speed = ((after - before) / dt_s).clamp(-SPEED_LIMIT, SPEED_LIMIT);
        let kick = settings.inertia * world.stiffness * (speed - self.speed_deg_s);
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
        surface.friction = self.settings.friction.unwrap_or(surface.friction);
        self.present_surface(surface);
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
        let world = World {
            surface: &self.surface,
            stiffness: self.head.stiffness,
            settings: &self.settings,
            noise: self.settings.noise_codes / CODES,
            dt_s,
        };
        let angles = angles_deg.iter().copied().chain(repeat(f64::NAN));
        for (whisker, angle) in self.whiskers.iter_mut().zip(angles) {
            whisker.advance(&world, angle);
        }
    }

    fn restart(&mut self, seed: u64) {
        self.surface = SurfaceSettings::of(Texture::Smooth);
        self.whiskers = whiskers(&self.head, &self.settings, seed);
    }
}

#[cfg(test)]
mod tests;
