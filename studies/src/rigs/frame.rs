//! Directions in a horizontal frame: x forward, y left, z up.

/// A direction in a horizontal frame (x forward, y left, z up): `azimuth_deg`
/// anticlockwise from forward as seen from above, `elevation_deg` upwards.
pub(super) fn direction(azimuth_deg: f64, elevation_deg: f64) -> [f64; 3] {
    let (sine, cosine) = libm::sincos(azimuth_deg.to_radians());
    let (up, level) = libm::sincos(elevation_deg.to_radians());
    [level * cosine, level * sine, up]
}

/// Turned anticlockwise about the vertical.
pub(super) fn turn([x, y, z]: [f64; 3], radians: f64) -> [f64; 3] {
    let (sine, cosine) = libm::sincos(radians);
    [cosine * x - sine * y, sine * x + cosine * y, z]
}

#[cfg(test)]
mod tests {
    use super::{direction, turn};
    use physics::vector::{cross, dot};

    #[test]
    fn a_quarter_turn_takes_forward_to_left_and_left_to_back() {
        let forward = direction(0.0, 0.0);
        let left = turn(forward, core::f64::consts::FRAC_PI_2);
        assert!((dot(left, direction(90.0, 0.0)) - 1.0).abs() < 1e-15);
        assert!((cross(forward, left)[2] - 1.0).abs() < 1e-15);
        assert!((dot(direction(30.0, 20.0), direction(30.0, 20.0)) - 1.0).abs() < 1e-15);
        assert!((direction(30.0, 30.0)[2] - 0.5).abs() < 1e-15);
    }
}
