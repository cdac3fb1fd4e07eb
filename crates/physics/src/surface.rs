//! What surfaces are made of.
//!
//! From sources: the mean grain diameters of the FEPA grades P40 to P600 (FEPA
//! 43-1, ISO 6344; BIOTACT table I has those of P240 and P600). All else is a
//! choice, stated at each material.

use crate::error::BadSetting;

/// Speed by which friction has gone 63 % of the way from resting to sliding, m/s
/// (Stribeck; of the order of what is measured on plastics). A tip that is held
/// across the shaft creeps along it, as the bend draws it back.
const CREEP_M_S: f64 = 1e-3;

/// A statistically described surface: rough within ±√3 · 1.35 of its root mean
/// square height, over three octaves from its grain down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Root mean square height h, m, 0 to 0.01; zero: flat.
    pub height_m: f64,
    /// Distance between grains, loops or stones, m, 1e-6 to 0.1.
    pub grain_m: f64,
    /// Stiffness against a tip that presses on it, N/m, 1 to 1e9.
    pub stiffness_n_m: f64,
    /// Damping ratio of a tip that rings on it and on what of the shaft has no
    /// inertia, 0 to 10.
    pub damping: f64,
    /// Coefficient of friction that holds a resting tip, `friction` to 10.
    pub hold: f64,
    /// Coefficient of friction against a sliding tip, 0 to 10.
    pub friction: f64,
    /// Which of all surfaces with these properties: it moves hills and valleys.
    pub seed: u64,
}

/// Surfaces of the papers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Material {
    /// Perfectly flat and hard, with the friction of plastic: for closed forms.
    Flat,
    /// Moulded plastic (BIOTACT).
    SmoothPlastic,
    /// Sheet aluminium (POSE).
    Aluminium,
    /// Abrasive paper of a FEPA grade P (BIOTACT, POSE, PSIK).
    Sandpaper(Grit),
    /// Carpet with long, coarse loops (LEP10, LEP12).
    RoughCarpet,
    /// Carpet with short, dense loops (LEP10, LEP12).
    SmoothCarpet,
    /// Tarmac: stones in bitumen (LEP10, LEP12).
    Tarmac,
    /// Vinyl floor (LEP10, LEP12).
    Vinyl,
    /// Plexiglass with milled relief, of a period in tenths of a millimetre
    /// (PSIK, corridors).
    Relief(u16),
}

/// FEPA grades of abrasive paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names are the grades")]
pub enum Grit {
    P40,
    P50,
    P60,
    P80,
    P100,
    P120,
    P150,
    P180,
    P220,
    P240,
    P280,
    P320,
    P360,
    P400,
    P500,
    P600,
}

impl Grit {
    /// Mean grain diameter, m.
    pub const fn grain_m(self) -> f64 {
        const MICRONS: [f64; 16] = [
            425.0, 336.0, 269.0, 201.0, 162.0, 125.0, 100.0, 82.0, 68.0, 58.5, 52.2, 46.2, 40.5,
            35.0, 30.2, 25.8,
        ];
        1e-6 * MICRONS[self as usize]
    }
}

impl Surface {
    /// The surface of a material.
    ///
    /// Choices. Grains of abrasive stand half sunk in resin, so that heights
    /// spread by a third of a diameter; a sharper grain ploughs a little more,
    /// μ from 0.45 (P600) to 0.7 (P40 and P50), growing with the logarithm of
    /// the diameter. Loops of the rough carpet are 5 mm apart and 1 mm in root
    /// mean square, of the smooth one 2 mm and 0.25 mm; pile gives way by
    /// 1 mm/N or so, swallows bounces and catches the tip. Stones of tarmac
    /// are 8 mm apart, 0.8 mm in root mean square, hard. Vinyl has an embossing
    /// of 20 µm and a little grip; plastic and aluminium are flat to microns.
    /// Resting friction is 15 to 30 % above sliding friction.
    pub fn of(material: Material) -> Self {
        let hard = |height_m: f64, grain_m: f64, hold: f64, friction: f64| Self {
            height_m,
            grain_m,
            stiffness_n_m: 1e5,
            damping: 0.3,
            hold,
            friction,
            seed: 0,
        };
        let pile = |height_m: f64, grain_m: f64, stiffness_n_m: f64, friction: f64| Self {
            height_m,
            grain_m,
            stiffness_n_m,
            damping: 1.0,
            hold: 1.3 * friction,
            friction,
            seed: 0,
        };
        match material {
            Material::Flat => hard(0.0, 1e-3, 0.2, 0.2),
            Material::SmoothPlastic => hard(1e-6, 50e-6, 0.25, 0.2),
            Material::Aluminium => hard(1.5e-6, 100e-6, 0.22, 0.18),
            Material::Sandpaper(grit) => {
                let grain_m = grit.grain_m();
                let friction = 0.45 + 0.0972 * libm::log(grain_m / 25.8e-6);
                hard(grain_m / 3.0, grain_m, 1.15 * friction, friction)
            }
            Material::RoughCarpet => pile(1e-3, 5e-3, 500.0, 0.4),
            Material::SmoothCarpet => pile(0.25e-3, 2e-3, 1000.0, 0.35),
            Material::Tarmac => hard(0.8e-3, 8e-3, 0.65, 0.55),
            Material::Vinyl => hard(20e-6, 1.5e-3, 0.35, 0.27),
            Material::Relief(tenths) => {
                let period_m = 1e-4 * f64::from(tenths.max(1));
                hard(0.12 * period_m, period_m, 0.35, 0.3)
            }
        }
    }

    /// The same kind of surface, another piece.
    pub const fn piece(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Whether all values are in their ranges.
    ///
    /// # Errors
    /// The first one that is not, by name.
    pub fn check(&self) -> Result<(), BadSetting> {
        let check = BadSetting::check;
        check("height_m", self.height_m, 0.0, 0.01)?;
        check("grain_m", self.grain_m, 1e-6, 0.1)?;
        check("stiffness_n_m", self.stiffness_n_m, 1.0, 1e9)?;
        check("damping", self.damping, 0.0, 10.0)?;
        check("friction", self.friction, 0.0, 10.0)?;
        check("hold", self.hold, self.friction, 10.0)?;
        Ok(())
    }

    /// Coefficient of friction at a sliding speed, m/s, 0 or more: from `hold` at
    /// rest to `friction`, exponentially.
    #[inline]
    pub(crate) fn friction_at(&self, sliding_m_s: f64) -> f64 {
        let change = self.hold - self.friction;
        let speeds = sliding_m_s / CREEP_M_S;
        // e^−40 of the change is lost in the rounding of the sum.
        if change == 0.0 || (speeds > 40.0 && change <= self.friction) {
            return self.friction;
        }
        self.friction + change * libm::exp(-speeds)
    }

    /// The nearest surface whose values are in their ranges; one that is not a
    /// number counts as the lowest.
    pub(crate) fn limited(self) -> Self {
        // The larger of a number and NaN is the number.
        let limit = |value: f64, lo: f64, hi: f64| value.max(lo).min(hi);
        let friction = limit(self.friction, 0.0, 10.0);
        Self {
            height_m: limit(self.height_m, 0.0, 0.01),
            grain_m: limit(self.grain_m, 1e-6, 0.1),
            stiffness_n_m: limit(self.stiffness_n_m, 1.0, 1e9),
            damping: limit(self.damping, 0.0, 10.0),
            hold: limit(self.hold, friction, 10.0),
            friction,
            seed: self.seed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{CREEP_M_S, Grit, Material, Surface};

    #[test]
    fn every_material_is_within_the_ranges_and_stays_as_it_is() {
        let all = [
            Material::Flat,
            Material::SmoothPlastic,
            Material::Aluminium,
            Material::Sandpaper(Grit::P40),
            Material::Sandpaper(Grit::P600),
            Material::RoughCarpet,
            Material::SmoothCarpet,
            Material::Tarmac,
            Material::Vinyl,
            Material::Relief(0),
            Material::Relief(500),
        ];
        for surface in all.map(Surface::of) {
            assert_eq!(surface.check(), Ok(()), "{surface:?}");
            assert_eq!(surface.limited(), surface);
        }
    }

    #[test]
    fn what_is_not_a_number_is_limited() {
        let bad = Surface {
            height_m: f64::NAN,
            stiffness_n_m: f64::INFINITY,
            friction: -1.0,
            hold: f64::NAN,
            ..Surface::of(Material::Flat)
        };
        assert!(bad.check().is_err());
        let limited = bad.limited();
        assert_eq!(limited.check(), Ok(()));
        assert_eq!((limited.height_m, limited.stiffness_n_m), (0.0, 1e9));
    }

    #[test]
    fn coarser_papers_have_more_friction() {
        let of = |grit| Surface::of(Material::Sandpaper(grit)).friction;
        assert!((of(Grit::P600) - 0.45).abs() < 1e-12);
        assert!((of(Grit::P50) - 0.70).abs() < 2e-3);
        assert!(of(Grit::P180) < of(Grit::P80));
    }

    #[test]
    fn friction_goes_from_resting_to_sliding_and_no_shortcut_shows() {
        let bent = |surface: Surface, speed: f64| {
            surface.friction + (surface.hold - surface.friction) * libm::exp(-speed / CREEP_M_S)
        };
        for material in [Material::Tarmac, Material::Flat, Material::SmoothCarpet] {
            let surface = Surface::of(material);
            assert_eq!(
                surface.friction_at(0.0),
                surface.friction + (surface.hold - surface.friction)
            );
            for n in 0..1000 {
                let speed = 1e-4 * f64::from(n);
                assert_eq!(surface.friction_at(speed), bent(surface, speed));
            }
        }
    }
}
