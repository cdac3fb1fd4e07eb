//! The field of a magnet that turns with the base of a whisker.

use crate::error::BadSetting;

/// A magnet above a sensor of fields, turning about its own centre: a point dipole on the
/// sensor's axis of Z.
///
/// The field of a dipole of direction m at the distance d along the unit vector r is
/// μ₀ m / (4π d³) · (3 (m·r) r − m) (Jackson, Classical Electrodynamics, 5.56): along the axis
/// twice what it is across.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Magnet {
    axial_mt: f64,
}

impl Magnet {
    /// From its field at the sensor while the whisker is at rest, mT, 0.01 to 1000.
    ///
    /// # Errors
    /// If the field is out of its range.
    pub fn of_field(axial_mt: f64) -> Result<Self, BadSetting> {
        BadSetting::check("axial_mt", axial_mt, 0.01, 1000.0)?;
        Ok(Self { axial_mt })
    }

    /// The field at the sensor along X, Y and Z, mT, of a magnet tilted by these angles, rad:
    /// in the direction of whisking and across it, together a rotation by their norm.
    ///
    /// B/2 · sin φ against the tilt, B cos φ along the axis.
    pub fn field_mt(self, tilt_rad: [f64; 2]) -> [f64; 3] {
        let [x, y] = tilt_rad;
        let angle = libm::hypot(x, y);
        // sin φ / φ, by its limit where the quotient is none.
        let sinc = if angle > 1e-9 {
            libm::sin(angle) / angle
        } else {
            1.0
        };
        let across = -0.5 * self.axial_mt * sinc;
        [across * x, across * y, self.axial_mt * libm::cos(angle)]
    }
}

#[cfg(test)]
mod tests {
    use super::Magnet;
    use proptest::prelude::*;

    /// The dipole's field from its vector equation, at the distance 1 above it, times B/2.
    fn by_vectors(axial_mt: f64, direction: [f64; 3]) -> [f64; 3] {
        // Where the sensor is, seen from the magnet.
        let r = [0.0, 0.0, -1.0];
        let along: f64 = direction.iter().zip(r).map(|(m, r)| m * r).sum();
        std::array::from_fn(|i| 0.5 * axial_mt * (3.0 * along * r[i] - direction[i]))
    }

    #[test]
    fn settings_out_of_range_are_refused() {
        assert!(Magnet::of_field(0.0).is_err());
        assert!(Magnet::of_field(f64::NAN).is_err());
    }

    proptest! {
        #[test]
        fn as_the_vector_equation(axial in 1.0..200.0, x in -1.5..1.5, y in -1.5..1.5) {
            let magnet = Magnet::of_field(axial).unwrap();
            let angle = f64::hypot(x, y).max(1e-12);
            let tilted = [angle.sin() * x / angle, angle.sin() * y / angle, angle.cos()];
            let expected = by_vectors(axial, tilted);
            for (field, expected) in magnet.field_mt([x, y]).into_iter().zip(expected) {
                prop_assert!((field - expected).abs() < 1e-12 * axial);
            }
        }
    }
}
