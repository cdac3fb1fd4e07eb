//! Directions in a horizontal frame: x forward, y left, z up.

use physics::{Outline, Plate, Pose, Surface};

/// A flat ground without an end, through a place.
pub(crate) fn plane(
    point_m: [f64; 3],
    (normal, along): ([f64; 3], [f64; 3]),
    surface: Surface,
) -> Plate {
    Plate {
        point_m,
        normal,
        along,
        outline: Outline::PLANE,
        surface,
    }
}

/// A direction in a horizontal frame (x forward, y left, z up): `azimuth_deg`
/// anticlockwise from forward as seen from above, `elevation_deg` upwards.
pub(super) fn direction(azimuth_deg: f64, elevation_deg: f64) -> [f64; 3] {
    let (sine, cosine) = libm::sincos(azimuth_deg.to_radians());
    let (up, level) = libm::sincos(elevation_deg.to_radians());
    [level * cosine, level * sine, up]
}

/// A pose that is turned about the vertical axis, anticlockwise from above.
pub(crate) fn panned(pose: &Pose, radians: f64) -> Pose {
    Pose {
        base_m: turn(pose.base_m, radians),
        x: turn(pose.x, radians),
        y: turn(pose.y, radians),
    }
}

pub(super) fn turn([x, y, z]: [f64; 3], radians: f64) -> [f64; 3] {
    let (sine, cosine) = libm::sincos(radians);
    [cosine * x - sine * y, sine * x + cosine * y, z]
}
