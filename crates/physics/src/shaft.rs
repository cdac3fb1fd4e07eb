//! A whisker's shaft and what holds it: dimensions, material, ranges.

use crate::error::BadSetting;

/// What holds the base of a shaft: rubber in a tube.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Follicle {
    /// Rotational stiffness k_θ, N m/rad, 1e-9 or more; infinite: clamped, and
    /// then a magnet at the base does not turn.
    pub rotation_n_m_rad: f64,
    /// Stiffness along the shaft, N/m, 1 to 1e9.
    pub axial_n_m: f64,
}

/// A straight round shaft whose diameter goes linearly from hub to tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaft {
    /// Length L, 1e-3 to 1 m.
    pub length_m: f64,
    /// Diameter at the base, 1e-5 m to a fifth of the length: thicker ones do
    /// not bend as Euler and Bernoulli have it.
    pub hub_diameter_m: f64,
    /// Diameter at the tip, 1e-6 m to a fifth of the length.
    pub tip_diameter_m: f64,
    /// Young's modulus E, 1e5 to 1e12 Pa.
    pub youngs_pa: f64,
    /// Density ρ, 10 to 3e4 kg/m³.
    pub density_kg_m3: f64,
    /// Damping ratio ζ of the first mode, 1e-4 to 0.99. All modes have it: the
    /// loss factor 2 ζ of a polymer changes little over the few octaves that
    /// the modes span.
    pub damping: f64,
    /// What holds the base.
    pub follicle: Follicle,
}

impl Shaft {
    /// Whether all settings are in their ranges.
    ///
    /// # Errors
    /// The first one that is not, by name.
    pub fn check(&self) -> Result<(), BadSetting> {
        let check = BadSetting::check;
        let length = check("length_m", self.length_m, 1e-3, 1.0)?;
        check("hub_diameter_m", self.hub_diameter_m, 1e-5, length / 5.0)?;
        check("tip_diameter_m", self.tip_diameter_m, 1e-6, length / 5.0)?;
        check("youngs_pa", self.youngs_pa, 1e5, 1e12)?;
        check("density_kg_m3", self.density_kg_m3, 10.0, 3e4)?;
        check("damping", self.damping, 1e-4, 0.99)?;
        let Follicle {
            rotation_n_m_rad,
            axial_n_m,
        } = self.follicle;
        check("rotation_n_m_rad", rotation_n_m_rad, 1e-9, f64::INFINITY)?;
        check("axial_n_m", axial_n_m, 1.0, 1e9)?;
        Ok(())
    }

    pub(crate) fn diameter_m(&self, at_m: f64) -> f64 {
        let share = at_m / self.length_m;
        self.hub_diameter_m + share * (self.tip_diameter_m - self.hub_diameter_m)
    }
}
