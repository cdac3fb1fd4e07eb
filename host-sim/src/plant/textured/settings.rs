//! What textured surfaces do to whiskers, in numbers.

use crate::plant::BadSetting;

/// A whisker's shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WhiskerSettings {
    /// Length L, 1e-3 to 1 m.
    pub length_m: f64,
    /// Undamped frequency of the first bending mode, 0.1 to 10,000 Hz.
    pub resonance_hz: f64,
    /// Its damping ratio, 1e-4 to 0.99.
    pub damping: f64,
}

impl WhiskerSettings {
    /// The front whisker of BIOTACT (section II-C: length and frequency; the
    /// damping, which it does not give, is a choice).
    pub const FRONT: Self = Self::of(0.080, 86.0);
    /// The middle whisker.
    pub const MIDDLE: Self = Self::of(0.112, 50.0);
    /// The rear whisker.
    pub const REAR: Self = Self::of(0.158, 21.0);

    const fn of(length_m: f64, resonance_hz: f64) -> Self {
        Self {
            length_m,
            resonance_hz,
            damping: 0.1,
        }
    }
}

/// Whiskers and how they meet surfaces; choices unless a source is named.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TexturedSettings {
    /// All whiskers' shaft.
    pub whisker: WhiskerSettings,
    /// Excursion of the tip across the direction of whisking, as a share of
    /// that along it, 0 to 10.
    pub lateral: f64,
    /// Bend B at which the shaft gives no more, 1e-3 to 1: room is left below
    /// the end of the sensor's range.
    pub bend_limit: f64,
    /// Share of the bend that friction adds in protraction and takes in
    /// retraction, a unit of μ, 0 to 1.
    pub drag: f64,
    /// Share of the bend that friction turns to y, a unit of μ, 0 to 1: the
    /// whisker lies at a slant to the surface.
    pub drag_y: f64,
    /// Sliding speed at which friction is half of its full value, 1e-3 to 1e6
    /// degrees a second.
    pub creep_deg_s: f64,
    /// Share of its own inertia that bends a free whisker, 0 to 10; a rigid
    /// rod on a hinge spring has 1.
    pub inertia: f64,
    /// Spread of the friction over the landings, the standard deviation of its
    /// logarithm, 0 to 1.
    pub patch: f64,
    /// Friction coefficient μ of every texture in place of its own, 0 to 10.
    pub friction: Option<f64>,
    /// Sensor noise, root mean square, codes of 14 bits, 0 to 1000.
    pub noise_codes: f64,
}

impl Default for TexturedSettings {
    fn default() -> Self {
        Self {
            whisker: WhiskerSettings::MIDDLE,
            lateral: 0.5,
            bend_limit: 0.8,
            drag: 0.4,
            drag_y: 0.4,
            creep_deg_s: 10.0,
            inertia: 1.0,
            patch: 0.2,
            friction: None,
            noise_codes: 4.0,
        }
    }
}

impl TexturedSettings {
    pub(super) fn check(&self) -> Result<(), BadSetting> {
        let check = BadSetting::check;
        check("length_m", self.whisker.length_m, 1e-3, 1.0)?;
        check("resonance_hz", self.whisker.resonance_hz, 0.1, 1e4)?;
        check("damping", self.whisker.damping, 1e-4, 0.99)?;
        check("lateral", self.lateral, 0.0, 10.0)?;
        check("bend_limit", self.bend_limit, 1e-3, 1.0)?;
        check("drag", self.drag, 0.0, 1.0)?;
        check("drag_y", self.drag_y, 0.0, 1.0)?;
        check("creep_deg_s", self.creep_deg_s, 1e-3, 1e6)?;
        check("inertia", self.inertia, 0.0, 10.0)?;
        check("patch", self.patch, 0.0, 1.0)?;
        check("friction", self.friction.unwrap_or(0.0), 0.0, 10.0)?;
        check("noise_codes", self.noise_codes, 0.0, 1000.0)?;
        Ok(())
    }
}
