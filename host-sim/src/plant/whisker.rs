//! Elastic whiskers that motors swing against textured plates.
//!
//! Glossary:
//!
//! - *θ′*: angle of the base, degrees; the base turns about the motor's axis;
//! - *plate*: stands where the tip of a straight shaft, or another place of it, touches it at
//!   θ′_lim; it may end, or be a bar;
//! - *piece*: of a surface; every presentation shows another.
//!
//! The physics is [`TouchingWhisker`]; here are its scale and its surfaces. The sensor's full scale
//! is such that a hard plate that holds the tip makes the contact signal grow by σ_x a degree of
//! overlap at first touch, as BIOTACT eq. 11 has it: a tip that is held while the base turns by δ
//! is bent by L δ, which turns the base against its follicle by r/c L δ, with the static rotation r
//! (rad/N) and deflection c (m/N) for a force on the tip. Not modelled: torque back on the motor.

use core::iter::repeat;

use scene::Texture;

use super::{BadSetting, Head, Plant, SurfacePose, apart};
use physics::vector::{add, dot, scale, sub};
use physics::{
    At, Bent, Facing, Grit, Material, Modes, Outline, Plate, SensorSettings, Shaft, Surface,
    TouchingWhisker,
};

/// What holds a resting tip on a surface of no friction of its own and on a scene's own, as a
/// multiple of the friction: between the 1.15 of abrasive and the 1.3 of carpet ([`Surface::of`]).
pub(crate) const HOLD: f64 = 1.2;

/// Root mean square height of the roughest texture, m: its loops are up to 2.4 times as high
/// ([`Surface`]).
const HIGHEST_M: f64 = 1e-3;

/// How far a tip is to be from a plate that is put in place, in root mean square heights of the
/// roughest surface: what is left over is more than a whisker's way in a tick.
const ROOM: f64 = 5.0;

/// Largest angle that is believed, degrees, either sign.
const ANGLE_LIMIT: f64 = 1e6;

/// Elastic whiskers and what they meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticSettings {
    /// All whiskers' shaft.
    pub shaft: Shaft,
    /// How whiskers and plates stand.
    pub facing: Facing,
    /// Where on the straight shaft plates touch first, as a share of its length, 0.2 to 1.
    pub touches_at: f64,
    /// Where plates end.
    pub outline: Outline,
    /// The scene's own surfaces.
    pub own: [Surface; 4],
    /// Friction coefficient of every texture in place of its own, 0 to 8; a resting tip is held
    /// in proportion.
    pub friction: Option<f64>,
    /// Sensor noise, root mean square, codes of 14 bits, 0 to 1000.
    pub noise_codes: f64,
}

impl ElasticSettings {
    /// Of a shaft; plates face it as usual, and sensors have the noise that
    /// sensors have by default.
    pub fn of(shaft: Shaft) -> Self {
        Self {
            shaft,
            facing: Facing::USUAL,
            touches_at: 1.0,
            outline: Outline::PLANE,
            own: [Surface::of(Material::SmoothPlastic); 4],
            friction: None,
            noise_codes: SensorSettings::default().noise_codes,
        }
    }
}

#[derive(Debug, Clone)]
struct Swung {
    whisker: TouchingWhisker,
    /// Where a straight tip touches at θ′_lim; none: no plate.
    plate: Option<Plate>,
    angle_deg: Option<f64>,
}

/// Textured plates before elastic whiskers.
#[derive(Debug, Clone)]
pub struct Elastic {
    head: Head,
    /// As the scene has it.
    facing: Facing,
    length_m: f64,
    /// Of the straight shaft to where it first touches.
    reach_m: f64,
    outline: Outline,
    own: [Surface; 4],
    friction: Option<f64>,
    surface: Surface,
    seed: u64,
    /// Presentations so far.
    pieces: u64,
    whiskers: Vec<Swung>,
}

/// What a texture of a scene is made of, if it is none of the scene's own. Its carpet is the
/// smooth one, of short loops.
const fn material(texture: Texture) -> Material {
    match texture {
        Texture::Smooth | Texture::Own1 | Texture::Own2 | Texture::Own3 | Texture::Own4 => {
            Material::SmoothPlastic
        }
        Texture::P600 => Material::Sandpaper(Grit::P600),
        Texture::P240 => Material::Sandpaper(Grit::P240),
        Texture::P180 => Material::Sandpaper(Grit::P180),
        Texture::P80 => Material::Sandpaper(Grit::P80),
        Texture::P40 => Material::Sandpaper(Grit::P40),
        Texture::Carpet => Material::SmoothCarpet,
        Texture::RoughCarpet => Material::RoughCarpet,
        Texture::Tarmac => Material::Tarmac,
        Texture::Vinyl => Material::Vinyl,
        Texture::Aluminium => Material::Aluminium,
    }
}

/// Between which the full scale of the sensor may lie, rad.
const FULL_SCALE_RAD: [f64; 2] = [1e-6, 3.0];

/// By how much a degree of a tip that is held turns the base, rad.
fn a_degree(shaft: &Shaft, modes: &Modes, elevation_deg: f64) -> f64 {
    let reach_m = shaft.length_m * libm::cos(elevation_deg.to_radians());
    1.0_f64.to_radians() * reach_m * modes.base_rad_n / modes.tip_m_n
}

impl Elastic {
    /// Whiskers before smooth plastic. The same seed gives the same noise and
    /// the same surfaces; each whisker has its own.
    ///
    /// # Errors
    /// The first setting out of its range; `stiffness` too where it asks for a
    /// full scale of the sensor above 3 rad or below 1e-6.
    pub fn new(head: Head, settings: ElasticSettings, seed: u64) -> Result<Self, BadSetting> {
        head.check()?;
        let check = BadSetting::check;
        check("slant_deg", settings.facing.slant_deg, 0.0, 80.0)?;
        check("tilt_deg", settings.facing.tilt_deg, -80.0, 80.0)?;
        let elevation_deg = check("elevation_deg", settings.facing.elevation_deg, -60.0, 60.0)?;
        let touches_at = check("touches_at", settings.touches_at, 0.2, 1.0)?;
        for surface in &settings.own {
            surface.check()?;
        }
        check("friction", settings.friction.unwrap_or(0.0), 0.0, 8.0)?;
        let shaft = settings.shaft;
        let modes = shaft.modes(8)?;
        // Whiskers that meet nothing need no scale.
        let full_scale_rad = if head.stiffness > 0.0 {
            let a_degree = a_degree(&shaft, &modes, elevation_deg);
            let [least, most] = FULL_SCALE_RAD;
            check("stiffness", a_degree / head.stiffness, least, most)?
        } else if head.limits().all(f64::is_infinite) {
            3.0
        } else {
            return Err(BadSetting("stiffness"));
        };
        let sensor = SensorSettings {
            full_scale_rad: [full_scale_rad; 2],
            noise_codes: settings.noise_codes,
            ..SensorSettings::default()
        };
        let surface = Surface::of(Material::SmoothPlastic);
        let swung = |(stream, _): (u64, f64)| {
            let seed = apart(seed, stream);
            let whisker = TouchingWhisker::with_modes(&shaft, &modes, &sensor, seed)?;
            Ok(Swung {
                whisker,
                plate: None,
                angle_deg: None,
            })
        };
        let whiskers = (0..).zip(head.limits()).map(swung);
        let whiskers = whiskers.collect::<Result<_, BadSetting>>()?;
        let mut plant = Self {
            head,
            facing: settings.facing,
            length_m: shaft.length_m,
            reach_m: touches_at * shaft.length_m,
            outline: settings.outline,
            own: settings.own,
            friction: settings.friction,
            surface,
            seed,
            pieces: 0,
            whiskers,
        };
        plant.stand(SurfacePose::OF_SCENE);
        Ok(plant)
    }

    /// The least and the most `stiffness` that these settings go with, by the full scale of the
    /// sensor that it asks for.
    pub(crate) fn stiffness(settings: &ElasticSettings) -> Result<[f64; 2], BadSetting> {
        let modes = settings.shaft.modes(8)?;
        let a_degree = a_degree(&settings.shaft, &modes, settings.facing.elevation_deg);
        let [least, most] = FULL_SCALE_RAD;
        Ok([a_degree / most, a_degree / least])
    }

    /// The same whiskers with nothing before them from here on.
    #[must_use]
    pub fn in_the_air(&self) -> Self {
        let mut free = self.clone();
        free.head.obstacle_deg.fill(f64::INFINITY);
        for swung in &mut free.whiskers {
            swung.plate = None;
        }
        free
    }

    /// Puts a new piece of a surface before all whiskers.
    fn present_surface(&mut self, surface: Surface) {
        self.pieces = self.pieces.wrapping_add(1);
        self.surface = surface;
    }

    fn plate(&self, limit_deg: f64, pose: SurfacePose) -> Option<Plate> {
        let facing = Facing {
            tilt_deg: self.facing.tilt_deg + pose.tilt_deg,
            ..self.facing
        };
        let limit = (limit_deg + pose.obstacle_deg).to_radians();
        let plate = || Plate {
            outline: self.outline,
            ..Plate::in_the_way(limit, self.reach_m, &facing, self.surface)
        };
        limit.is_finite().then(plate)
    }

    fn piece(&self, whisker: u64) -> Surface {
        // Inverted: other seeds than those of the sensors' noise.
        let seed = apart(!self.seed, self.pieces);
        self.surface.piece(apart(seed, whisker.rotate_left(32)))
    }
}

impl Swung {
    /// How high the tip is over a plate, m, bent as it is; none before the first step.
    fn tip_over(&self, plate: &Plate, facing: &Facing, length_m: f64) -> Option<f64> {
        let pose = facing.pose(self.angle_deg?.to_radians());
        let [x, y] = self.whisker.tip_m();
        let straight = scale(length_m, pose.z());
        let tip = add(add(add(pose.base_m, 1.0, straight), x, pose.x), y, pose.y);
        Some(dot(plate.normal, sub(tip, plate.point_m)))
    }

    fn advance(&mut self, facing: &Facing, surface: Surface, angle: f64, dt_s: f64) {
        let believed = Some(angle).filter(|angle| angle.abs() <= ANGLE_LIMIT);
        let Some(angle) = believed.or(self.angle_deg) else {
            return;
        };
        self.angle_deg = Some(angle);
        if let Some(plate) = &mut self.plate {
            plate.surface = surface;
        }
        let pose = facing.pose(angle.to_radians());
        self.whisker.step(&pose, self.plate.as_ref(), dt_s);
    }
}

impl Plant for Elastic {
    fn present(&mut self, texture: Texture) {
        let own = texture.own().and_then(|n| self.own.get(n));
        let mut surface = own.map_or_else(|| Surface::of(material(texture)), |own| *own);
        if let Some(friction) = self.friction {
            let hold = surface.hold / surface.friction;
            // A surface without friction of its own holds as the scene's own do.
            let hold = if hold.is_finite() { hold } else { HOLD };
            surface.friction = friction;
            surface.hold = hold * friction;
        }
        self.present_surface(surface);
    }

    fn has_room(&self, pose: SurfacePose) -> bool {
        let highest_m = self.own.iter().map(|own| own.height_m);
        let room_m = ROOM * highest_m.fold(HIGHEST_M, f64::max);
        let plates = self.head.limits().map(|limit| self.plate(limit, pose));
        let mut all = self.whiskers.iter().zip(plates);
        all.all(|(swung, plate)| {
            let height_m =
                plate.and_then(|plate| swung.tip_over(&plate, &self.facing, self.length_m));
            height_m.is_none_or(|height_m| height_m >= room_m)
        })
    }

    fn stand(&mut self, pose: SurfacePose) {
        let plates = self.head.limits().map(|limit| self.plate(limit, pose));
        let plates: Vec<_> = plates.collect();
        for (swung, plate) in self.whiskers.iter_mut().zip(plates) {
            swung.plate = plate;
        }
    }

    fn touches(&self) -> bool {
        self.whiskers.iter().any(|swung| swung.whisker.contact())
    }

    fn deflection(&self, n: usize) -> [f64; 2] {
        let whisker = self.whiskers.get(n);
        whisker.map_or([0.0; 2], |swung| swung.whisker.reading())
    }

    fn bent(&self, whisker: usize) -> Option<Bent> {
        Some(self.whiskers.get(whisker)?.whisker.bent())
    }

    fn contact_at(&self, whisker: usize) -> Option<At> {
        self.whiskers.get(whisker)?.whisker.contact_at()
    }

    fn advance(&mut self, angles_deg: &[f64], dt_s: f64) {
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return;
        }
        let angles = angles_deg.iter().copied().chain(repeat(f64::NAN));
        for (n, angle) in (0..self.whiskers.len()).zip(angles) {
            let surface = self.piece(n as u64);
            if let Some(swung) = self.whiskers.get_mut(n) {
                swung.advance(&self.facing, surface, angle, dt_s);
            }
        }
    }

    fn restart(&mut self, seed: u64) {
        self.seed = seed;
        self.pieces = 0;
        self.surface = Surface::of(Material::SmoothPlastic);
        for (stream, swung) in (0..).zip(&mut self.whiskers) {
            swung.whisker.restart(apart(seed, stream));
            swung.angle_deg = None;
        }
        self.stand(SurfacePose::OF_SCENE);
    }
}

#[cfg(test)]
mod tests;
