//! The field of a cylinder that is magnetised along its axis, on that axis.

/// A cylinder, magnetised along its axis.
pub(super) struct Magnet {
    pub(super) radius_mm: f64,
    pub(super) length_mm: f64,
    pub(super) remanence_t: f64,
}

impl Magnet {
    /// B at the distance z of 0 or more from a face, mT:
    /// (B_r/2) ((L + z)/√((L + z)² + R²) − z/√(z² + R²)).
    pub(super) fn axial_mt(&self, z: f64) -> f64 {
        let seen = |at: f64| at / at.hypot(self.radius_mm);
        500.0 * self.remanence_t * (seen(self.length_mm + z) - seen(z))
    }

    /// dB/dz, mT/mm: d(z/√(z² + R²))/dz = R²/(z² + R²)^(3/2).
    fn slope_mt(&self, z: f64) -> f64 {
        let steepness = |at: f64| self.radius_mm.powi(2) / at.hypot(self.radius_mm).powi(3);
        500.0 * self.remanence_t * (steepness(self.length_mm + z) - steepness(z))
    }

    /// k in B_across = k B φ, of a magnet that turns about its centre by a small φ.
    ///
    /// Seen from the magnet the sensor then lies d sin φ beside the axis, d from the centre. There
    /// the field across is −(d φ/2) dB/dz, as it has no divergence, and B φ of the field along
    /// is across the sensor's axis, against it: k = −(d/2B) dB/dz − 1. A dipole, B ∝ d⁻³, has 1/2.
    pub(super) fn tilt_share(&self, z: f64) -> f64 {
        let from_centre = z + self.length_mm / 2.0;
        -from_centre / 2.0 * self.slope_mt(z) / self.axial_mt(z) - 1.0
    }

    /// The distance from a face at which B has this value, mm, within 100 mm.
    pub(super) fn gap_mm(&self, field_mt: f64) -> f64 {
        let (mut near, mut far) = (0.0, 100.0);
        for _ in 0..60 {
            let middle = f64::midpoint(near, far);
            if self.axial_mt(middle) > field_mt {
                near = middle;
            } else {
                far = middle;
            }
        }
        near
    }
}

#[cfg(test)]
mod tests {
    use super::Magnet;

    const MAGNET: Magnet = Magnet {
        radius_mm: 2.0,
        length_mm: 3.0,
        remanence_t: 1.2,
    };

    /// At a face half of what a long magnet's middle has: (B_r/2) L/√(L² + R²).
    #[test]
    fn the_field_at_a_face_and_far_off_is_known() {
        let face = 600.0 * 3.0 / 13.0_f64.sqrt();
        assert!((MAGNET.axial_mt(0.0) - face).abs() < 1e-9);
        // Far off a dipole of moment B_r V/μ0: B = B_r R² L/(2 d³).
        let d: f64 = 200.0;
        let dipole = 1_200.0 * 4.0 * 3.0 / (2.0 * d.powi(3));
        let found = MAGNET.axial_mt(d - 1.5);
        assert!((found / dipole - 1.0).abs() < 1e-3, "{found} {dipole}");
        let share = MAGNET.tilt_share(d - 1.5);
        assert!((share - 0.5).abs() < 1e-3, "{share}");
    }

    /// Against the field of the surface currents, added up: a loop's across its axis.
    #[test]
    fn the_field_of_a_tilted_magnet_is_that_of_its_currents() {
        let (z, phi) = (3.25, 0.02_f64);
        let (loops, parts) = (60, 720);
        let mut field = [0.0_f64; 2];
        // Current of a loop: M L/loops with M = B_r/μ0; so that B = (B_r L/loops)/(4π) ∮ dl × r/r³.
        let strength = 1_200.0 * MAGNET.length_mm / f64::from(loops) / (4.0 * std::f64::consts::PI);
        for n in 0..loops {
            let along = MAGNET.length_mm * ((f64::from(n) + 0.5) / f64::from(loops) - 0.5);
            for m in 0..parts {
                let step = std::f64::consts::TAU / f64::from(parts);
                let (sine, cosine) = (step * f64::from(m)).sin_cos();
                let turn = |[x, y, z]: [f64; 3]| {
                    [
                        x * phi.cos() + z * phi.sin(),
                        y,
                        z * phi.cos() - x * phi.sin(),
                    ]
                };
                let at = turn([MAGNET.radius_mm * cosine, MAGNET.radius_mm * sine, along]);
                let dl = turn([-sine, cosine, 0.0]).map(|part| part * MAGNET.radius_mm * step);
                // The sensor lies below the centre, on the axis at rest.
                let r = [-at[0], -at[1], -(z + MAGNET.length_mm / 2.0) - at[2]];
                let cubed = r.iter().map(|part| part * part).sum::<f64>().powf(1.5);
                field[0] += strength * (dl[1] * r[2] - dl[2] * r[1]) / cubed;
                field[1] += strength * (dl[0] * r[1] - dl[1] * r[0]) / cubed;
            }
        }
        let [across, along] = field;
        assert!((along / MAGNET.axial_mt(z) - 1.0).abs() < 2e-3, "{along}");
        let share = -across / (along * phi);
        let told = MAGNET.tilt_share(z);
        assert!((share / told - 1.0).abs() < 5e-3, "{share} {told}");
    }
}
