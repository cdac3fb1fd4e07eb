//! Vectors of three numbers, as arrays.

/// a + k b.
pub(crate) fn add(a: [f64; 3], k: f64, b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|n| a[n] + k * b[n])
}

/// The scalar product.
#[cfg(test)]
pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The vector product.
pub(crate) fn cross([a, b, c]: [f64; 3], [d, e, f]: [f64; 3]) -> [f64; 3] {
    [b * f - c * e, c * d - a * f, a * e - b * d]
}

/// A direction in a horizontal frame (x forward, y left, z up): `azimuth_deg`
/// anticlockwise from forward as seen from above, `elevation_deg` upwards.
pub(crate) fn direction(azimuth_deg: f64, elevation_deg: f64) -> [f64; 3] {
    let (sine, cosine) = libm::sincos(azimuth_deg.to_radians());
    let (up, level) = libm::sincos(elevation_deg.to_radians());
    [level * cosine, level * sine, up]
}

/// Turned anticlockwise about the vertical.
pub(crate) fn turn([x, y, z]: [f64; 3], radians: f64) -> [f64; 3] {
    let (sine, cosine) = libm::sincos(radians);
    [cosine * x - sine * y, sine * x + cosine * y, z]
}

#[cfg(test)]
mod tests {
    use super::{cross, direction, dot, turn};

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
