//! What the whiskers touch: from their angles to the deflections at their sensors.
//!
//! Glossary:
//!
//! - *θ′*: angle of a whisker's base, degrees, 50 at rest;
//! - *obstacle*: a surface that a whisker touches beyond an angle θ′_lim;
//! - *overlap*: how far θ′ exceeds θ′_lim, degrees;
//! - *deflection*: what the sensor reads, x along the direction of whisking and
//!   y across it, each within ±1.
//!
//! A host loop, each tick: give every sensor its [`Plant::deflection`], tick the
//! module, advance the motors, [`Plant::advance`].

mod ideal;
mod surface;
mod textured;
mod whisker;

pub use ideal::Ideal;
pub use textured::Textured;
pub(crate) use whisker::HOLD;
pub use whisker::{Elastic, ElasticSettings};

use core::fmt::Debug;

use physics::{At, BadSetting, Bent};
use scene::Texture;

/// How many whiskers there are, and where their obstacles stand.
#[derive(Debug, Clone, PartialEq)]
pub struct Head {
    /// Whiskers on each side.
    pub whiskers_per_side: usize,
    /// θ′_lim of each side, left first, degrees; infinite: nothing to touch.
    /// Its length is the number of sides.
    pub obstacle_deg: Vec<f64>,
    /// Stiffness σ_x, deflection a degree of overlap (BIOTACT eq. 11), 0 to 100.
    pub stiffness: f64,
}

impl Head {
    fn check(&self) -> Result<(), BadSetting> {
        BadSetting::check("stiffness", self.stiffness, 0.0, 100.0)?;
        if self.obstacle_deg.iter().any(|limit| limit.is_nan()) {
            return Err(BadSetting("obstacle_deg"));
        }
        Ok(())
    }

    /// θ′_lim of every whisker, left side first.
    fn limits(&self) -> impl Iterator<Item = f64> {
        let each = self.whiskers_per_side;
        self.obstacle_deg
            .iter()
            .flat_map(move |&limit| core::iter::repeat_n(limit, each))
    }
}

/// Another seed for each n.
const fn apart(seed: u64, n: u64) -> u64 {
    // Not the constant by which generators step from seed to state.
    seed.wrapping_add(n.wrapping_mul(0xD134_2543_DE82_EF95))
}

/// How a surface stands while it is presented, and how sensors then read: off what the scene says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePose {
    /// Tilt of plates more than the scene's, degrees.
    pub tilt_deg: f64,
    /// By how much plates stand beyond the scene's obstacles, degrees.
    pub obstacle_deg: f64,
    /// Factor of what sensors read.
    pub gain: f64,
}

impl SurfacePose {
    /// That of a scene itself.
    pub const OF_SCENE: Self = Self {
        tilt_deg: 0.0,
        obstacle_deg: 0.0,
        gain: 1.0,
    };
}

/// What whiskers touch.
pub trait Plant: Debug + Send {
    /// Puts another texture before all whiskers; nothing where surfaces have none.
    fn present(&mut self, _texture: Texture) {}

    /// Whether surfaces can stand in this pose without a whisker in their way.
    fn has_room(&self, _pose: SurfacePose) -> bool {
        true
    }

    /// Stands surfaces in this pose, before all whiskers; nothing where they are no plates.
    fn stand(&mut self, _pose: SurfacePose) {}

    /// Whether any whisker touches a surface that can be exchanged.
    fn touches(&self) -> bool {
        false
    }

    /// Deflection of whisker `n` now, counted from 0, left side first: `[x, y]`, each within ±1;
    /// zero for a whisker that is not there.
    fn deflection(&self, n: usize) -> [f64; 2];

    /// How whisker `n` is bent; none where shafts have no shape.
    fn bent(&self, _n: usize) -> Option<Bent> {
        None
    }

    /// Where its shaft touches, while it does; none where shafts have no shape.
    fn contact_at(&self, _n: usize) -> Option<At> {
        None
    }

    /// Advances by `dt_s` seconds to the given angles θ′, one a whisker, left
    /// side first. A whisker whose angle is missing or not finite keeps its
    /// last one. Nothing happens unless `dt_s` is positive and finite.
    fn advance(&mut self, angles_deg: &[f64], dt_s: f64);

    /// Starts again, as newly made with this seed.
    fn restart(&mut self, seed: u64);
}

#[cfg(test)]
mod tests;
