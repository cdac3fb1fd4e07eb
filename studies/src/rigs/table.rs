//! The XY table of POSE: a textured surface at some angle is carried into a
//! fixed whisker at some speed, until a threshold of deflection is crossed,
//! and withdrawn a controller's delay later.
//!
//! The whisker points along z; the surface travels along x, which is also the
//! sensor's x. The angle is that between the surface and its direction of
//! travel: at 0 degrees it would meet the whisker with its edge, at 90 degrees
//! it would lie along the shaft (POSE section II-B).

use super::read::keys;

keys! {
    Table, rig:
    tick_hz: f64 => 200.0..=20_000.0,
    gap_m: f64 => 0.0..=0.1,
    gap_sd_m: f64 => 0.0..=0.1,
    threshold: f64 => 1e-4..=1.0,
    latency_s: f64 => 0.0..=10.0,
    latency_spread_s: f64 => 0.0..=rig.latency_s,
    retract_m_s: f64 => 0.001..=10.0,
    acceleration_m_s2: f64 => 0.1..=1000.0,
    half_window: usize => 1.0..=1e6,
    roll_deg: f64 => -60.0..=60.0,
    high_pass_hz: f64 => 0.0..=200.0,
    low_pass_hz: f64 => 0.0..=2000.0,
    notch_quality: f64 => 0.0..=1000.0,
    full_scale_rad: f64 => 1e-4..=3.0,
    follicle: f64 => 0.01..=100.0,
}

/// The carriage: where the object is along its way, and how fast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Carriage {
    pub(crate) x_m: f64,
    pub(crate) v_m_s: f64,
}

impl Carriage {
    /// Moves for `dt_s` towards the speed `wanted_m_s` with at most `most`
    /// m/s² of acceleration: exact for that acceleration.
    pub(crate) fn step(&mut self, wanted_m_s: f64, most: f64, dt_s: f64) {
        let change = wanted_m_s - self.v_m_s;
        let reach = (change.abs() / most).min(dt_s);
        let pull = most * if change < 0.0 { -1.0 } else { 1.0 };
        self.x_m += self.v_m_s * reach + 0.5 * pull * reach * reach;
        self.v_m_s = if reach < dt_s {
            wanted_m_s
        } else {
            self.v_m_s + pull * reach
        };
        self.x_m += self.v_m_s * (dt_s - reach);
    }
}

/// The surface's normal towards the whisker and the direction along it, for a
/// surface at `angle_deg` that travels towards +x (`way` = 1) or −x (−1), turned by
/// `roll_deg` about its way.
pub(crate) fn facing(angle_deg: f64, roll_deg: f64, way: f64) -> ([f64; 3], [f64; 3]) {
    let (sine, cosine) = libm::sincos(angle_deg.to_radians());
    let (aside, upright) = libm::sincos(roll_deg.to_radians());
    let rolled = |x: f64, z: f64| [x, -aside * z, upright * z];
    (rolled(way * sine, -cosine), rolled(way * cosine, sine))
}

#[cfg(test)]
mod tests {
    use super::{Carriage, facing};
    use physics::vector::dot;

    #[test]
    fn the_carriage_stops_in_its_braking_distance() {
        let mut carriage = Carriage {
            x_m: 0.0,
            v_m_s: 0.1,
        };
        for _ in 0..1000 {
            carriage.step(-0.72, 5.0, 2.5e-4);
        }
        // v² = v0² + 2 a x with a = −5: from 0.1 to −0.72 m/s in 0.164 s.
        let turned = (0.1_f64.powi(2) - 0.72_f64.powi(2)) / 10.0;
        let expected = turned - 0.72 * (0.25 - 0.164);
        assert!((carriage.x_m - expected).abs() < 1e-12, "{}", carriage.x_m);
        assert_eq!(carriage.v_m_s, -0.72);
    }

    #[test]
    fn the_surface_faces_the_whisker_and_its_way() {
        for angle in [10.0, 45.0, 80.0] {
            for way in [1.0, -1.0] {
                let (normal, along) = facing(angle, 0.0, way);
                assert!(dot(normal, along).abs() < 1e-15);
                assert!(normal[2] < 0.0 && normal[0] * way > 0.0);
                // Between the surface and the way: the angle itself.
                let between = (dot(along, [way, 0.0, 0.0])).acos().to_degrees();
                assert!((between - angle).abs() < 1e-9);
                // A roll keeps both, and slopes the surface towards the sensor's y.
                let (rolled, its_way) = facing(angle, 20.0, way);
                assert!(dot(rolled, its_way).abs() < 1e-15);
                assert!((rolled[0] - normal[0]).abs() < 1e-15);
                let slope = (rolled[1] / -rolled[2]).atan().to_degrees();
                assert!((slope - 20.0).abs() < 1e-9, "{slope}");
            }
        }
    }
}
