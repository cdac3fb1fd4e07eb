//! A whisker pressed slowly against a plate: the exact elastica, at any deflection.
//!
//! The motor turns the base by a push φ beyond the angle at which the straight tip touches. The
//! force at the contact is P f, f = n + friction, whose direction in space stays. So the unbent
//! direction z of the shaft and f span a plane in which the rod bends; e is its second axis.
//! With ψ the angle between tangent and z, and c the arc length of the contact,
//!
//! ```text
//! E I ψ' = P [f_e (z(c) − z) − f_z (e(c) − e)],   z' = cos ψ,   e' = sin ψ,   E I = E π d⁴/64,
//! E I ψ' = k ψ at the base,   n·r(c) = n·(tip at first touch),
//! ```
//!
//! and beyond c the shaft is straight. Either its tip touches, c = L, and points into the plate,
//! n·t ≤ 0; or it touches along the shaft, where n·t = 0. Both are one family: w ≥ 0 is the angle
//! of the tip into the plate, w < 0 means c = L (1 + w). For each push the base's two
//! equations are solved for P and w by Newton's method, the rod being integrated from the contact
//! to the base (Runge–Kutta of order 4); the pushes are followed from 0 on, so that a shaft that
//! would snap over is refused.
//!
//! **Friction** slides from the first touch on, against the first slide of the tip, and keeps that
//! direction. To first order in φ the tip can move only along h, where the plate meets the plane
//! across the shaft. Where friction μ along h cannot hold it, it acts along h. Otherwise it takes
//! n's part along the motor's axis, so that nothing bends out of the plane of whisking, and what
//! is left of it acts against the slide of second order, which is towards the base. The two meet
//! where friction can just hold; without tilt all of it acts away from the base.
//!
//! Nothing holds a shaft sideways. With a tilt it goes around the normal and lets go on the other
//! side; without one it is taken to keep to the plane of whisking, though from a push of
//! 90° − slant + atan μ on it would fall out of it.
//!
//! Neglected are gravity, the shaft's thickness, and its stretch in the follicle.

mod path;

use crate::error::BadSetting;
use crate::pose::Plate;
use crate::shaft::Shaft;
use crate::surface::{Material, Surface};
use crate::swing::Facing;
use crate::vector::{V3, add};
use path::Path;

/// A shaft and the plate that it is pressed against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Press {
    /// The shaft, of a taper from 1 to [`MOST_TAPER`]; its density, its damping and its axial stiffness play no part.
    pub shaft: Shaft,
    /// Angle between shaft and plate at first touch, in the plane of whisking, degrees, 0 to 80.
    pub slant_deg: f64,
    /// Inclination of the plate towards the motor's axis, degrees, ±80.
    pub tilt_deg: f64,
    /// Coefficient of friction μ, 0 to 8.
    pub friction: f64,
}

/// A shaft at one push.
#[derive(Debug, Clone, PartialEq)]
pub struct Pressed {
    /// Moment at the base, N m: about the motor's axis, and across both axis and shaft; sizes.
    pub moment_n_m: [f64; 2],
    /// Force along the plate's normal, N.
    pub normal_n: f64,
    /// Force along the plate, N.
    pub friction_n: f64,
    /// Arc length from the base to the contact, m.
    pub contact_m: f64,
    /// Place of the contact from first touch, m, along the line in which the plate meets the
    /// plane of whisking; positive away from the base.
    pub place_m: f64,
    /// Points of the shaft from base to tip, m: arc length, then x along the unbent shaft at
    /// first touch, y towards protraction, z along the motor's axis. The base is at 0.
    pub points_m: Vec<[f64; 4]>,
}

/// Why there is no answer.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PressError {
    /// A setting is out of its range.
    #[error(transparent)]
    Setting(#[from] BadSetting),
    /// Beyond some push the shaft snaps over, lets go of the plate, or is behind it.
    #[error("the shaft holds up to {up_to_deg} degrees")]
    Ends {
        /// The largest push that holds, degrees; whole thousandths.
        up_to_deg: f64,
    },
}

/// Largest push, degrees.
pub const MOST_PUSH_DEG: f64 = 90.0;

/// Largest taper: the diameter at the base over that at the tip.
pub const MOST_TAPER: f64 = 100.0;

impl Press {
    /// The shaft at each push, degrees, 0 to [`MOST_PUSH_DEG`], in the order given.
    ///
    /// Moments, forces and places are within 2e-7 of the equations above, relative, for tapers
    /// up to 30, and within 3e-6 up to [`MOST_TAPER`] (see the tests).
    ///
    /// # Errors
    /// [`PressError`].
    pub fn at(&self, push_deg: &[f64]) -> Result<Vec<Pressed>, PressError> {
        self.solve(push_deg, path::STEPS)
    }

    fn solve(&self, push_deg: &[f64], steps: u32) -> Result<Vec<Pressed>, PressError> {
        self.shaft.check()?;
        let hub_m = self.shaft.hub_diameter_m;
        let tip_m = self.shaft.tip_diameter_m;
        BadSetting::check("tip_diameter_m", tip_m, hub_m / MOST_TAPER, hub_m)?;
        BadSetting::check("slant_deg", self.slant_deg, 0.0, 80.0)?;
        BadSetting::check("tilt_deg", self.tilt_deg, -80.0, 80.0)?;
        BadSetting::check("friction", self.friction, 0.0, 8.0)?;
        for push in push_deg {
            BadSetting::check("push_deg", *push, 0.0, MOST_PUSH_DEG)?;
        }
        let mut order: Vec<(usize, f64)> = push_deg.iter().copied().enumerate().collect();
        order.sort_by(|(_, a), (_, b)| a.total_cmp(b));
        let mut path = Path::new(self, steps);
        let mut all = Vec::new();
        for (n, push) in order {
            path.go_to(push)?;
            all.push((n, path.pressed()));
        }
        all.sort_by_key(|(n, _)| *n);
        Ok(all.into_iter().map(|(_, pressed)| pressed).collect())
    }

    /// n, and f = n + friction, at first touch of a shaft along x that is turned towards y.
    fn directions(&self) -> (V3, V3) {
        let facing = Facing {
            slant_deg: self.slant_deg,
            tilt_deg: self.tilt_deg,
            elevation_deg: 0.0,
        };
        let surface = Surface::of(Material::Flat);
        let n = Plate::in_the_way(0.0, self.shaft.length_m, &facing, surface).normal;
        let tangent = libm::tan(self.tilt_deg.to_radians());
        let [_, back, up] = n;
        // n's part across the shaft, and along it (0, up, -back)/m, friction on the tip's slide.
        let m = (back * back + up * up).sqrt();
        let cosine = libm::cos(self.slant_deg.to_radians());
        if tangent.abs() * m > self.friction * cosine {
            let size = self.friction.copysign(-self.tilt_deg) / m;
            return (n, add(n, size, [0.0, up, -back]));
        }
        let along = self.along();
        let left = (self.friction * self.friction - tangent * tangent).max(0.0);
        // n less its part along the axis by a step within the plate.
        let level = libm::cos(self.tilt_deg.to_radians());
        let held = [n[0] / (level * level), n[1] / (level * level), 0.0];
        (n, add(held, left.sqrt(), along))
    }

    /// Away from the base, along the line in which the plate meets the plane of whisking.
    fn along(&self) -> V3 {
        let (slant, flat) = libm::sincos(self.slant_deg.to_radians());
        [flat, -slant, 0.0]
    }
}

#[cfg(test)]
mod tests;
