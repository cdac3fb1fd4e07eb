//! The XY table of POSE: a textured surface at some angle is carried into a fixed whisker at some
//! speed, until a threshold of deflection is crossed, and withdrawn a controller's delay later.
//!
//! The whisker points along z; the surface travels along x, which is also the sensor's x. The angle
//! is that between the surface and its direction of travel: at 0 degrees it would meet the whisker
//! with its edge, at 90 degrees it would lie along the shaft (POSE section II-B).

use super::{Chance, keys, plane, seed_of, whiskers};
use crate::experiment::{Dataset, Extent, Recording, Request};
use crate::paper::pose::{ANGLES_DEG, SPEEDS_MM_S, TEXTURES};
use anyhow::{Context, Result};
use physics::vector::{add, cross};
use physics::{Pose, Shaft, Surface, TouchingWhisker};

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
struct Carriage {
    x_m: f64,
    v_m_s: f64,
}

impl Carriage {
    /// Moves for `dt_s` towards the speed `wanted_m_s` with at most `most`
    /// m/s² of acceleration: exact for that acceleration.
    fn step(&mut self, wanted_m_s: f64, most: f64, dt_s: f64) {
        let change = wanted_m_s - self.v_m_s;
        let reach = (change.abs() / most).min(dt_s);
        let pull = most * if change < 0.0 { -1.0 } else { 1.0 };
        self.x_m += self.v_m_s * reach + 0.5 * pull * reach * reach;
        let reached_m_s = self.v_m_s + pull * reach;
        self.v_m_s = if reach < dt_s {
            wanted_m_s
        } else {
            reached_m_s
        };
        self.x_m += self.v_m_s * (dt_s - reach);
    }
}

/// The surface's normal towards the whisker and the direction along it, for a surface at
/// `angle_deg` that travels towards +x (`way` = 1) or −x (−1), turned by `roll_deg` about its way.
fn facing(angle_deg: f64, roll_deg: f64, way: f64) -> ([f64; 3], [f64; 3]) {
    let (sine, cosine) = libm::sincos(angle_deg.to_radians());
    let (aside, upright) = libm::sincos(roll_deg.to_radians());
    let rolled = |x: f64, z: f64| [x, -aside * z, upright * z];
    (rolled(way * sine, -cosine), rolled(way * cosine, sine))
}

/// A contact's angle, speed and texture, as places in the paper's lists.
pub(crate) type Contact = [usize; 3];

/// The contact of all in a placebo: P80 at a middle angle and speed.
const PLACEBO: Contact = [4, 5, 0];

pub(crate) fn speeds() -> Vec<f64> {
    let (least, most, count) = SPEEDS_MM_S;
    let step = (most - least) / (count - 1) as f64;
    (0..count).map(|n| least + step * n as f64).collect()
}

pub(crate) fn contacts(extent: Extent) -> Vec<Contact> {
    let mut contacts = Vec::new();
    for angle in (0..ANGLES_DEG.len()).step_by(extent.stride) {
        for speed in (0..SPEEDS_MM_S.2).step_by(extent.stride) {
            for texture in 0..TEXTURES.len() {
                contacts.push([angle, speed, texture]);
            }
        }
    }
    // Each is made twice: to train on, and to test with.
    contacts.repeat(2)
}

pub(crate) fn jobs(extent: Extent) -> usize {
    contacts(extent).len()
}

/// Records a contact: codes of x and y about the peak of x, x turned to positive.
pub(crate) fn record(request: &Request, job: usize, seed: u64) -> Result<Recording> {
    let all = contacts(request.extent);
    let &[angle, speed, texture] = all.get(job).context("no such contact")?;
    let rig = &request.rigs.table;
    let speed_m_s = speeds()[request.place(speed, PLACEBO[1])] / 1000.0;
    let angle_deg = ANGLES_DEG[request.place(angle, PLACEBO[0])];
    let surface = request.surface(&whiskers::TABLE, texture, PLACEBO[2]);
    let spot_m = request.spot_m(Dataset::Table, texture, seed);
    let (codes, way) = approach(rig, (angle_deg, speed_m_s), (surface, spot_m), seed)?;

    let x = |n: usize| codes.get(2 * n).copied().unwrap_or(0);
    let count = codes.len() / 2;
    // Deflection is positive the way the object pushes; the first of equals.
    let sign: i16 = if way < 0.0 { -1 } else { 1 };
    let peak = (0..count).rev().max_by_key(|n| sign * x(*n)).unwrap_or(0);
    let mut values = Vec::with_capacity(4 * rig.half_window);
    // Beyond the recording the whisker rests: its first or last sample stands.
    for n in 0..2 * rig.half_window {
        let at = (peak + n).saturating_sub(rig.half_window);
        let at = at.min(count.saturating_sub(1));
        values.push(f32::from(sign * x(at)));
        values.push(f32::from(codes.get(2 * at + 1).copied().unwrap_or(0)));
    }
    Ok(Recording::new(2, values))
}

/// One approach and withdrawal at an angle, degrees, and a speed, m/s, to a spot of a surface:
/// codes of x and y, and which way the object went (1 or −1). Either way meets the same spot.
fn approach(
    rig: &Table,
    (angle_deg, speed_m_s): (f64, f64),
    (surface, spot_m): (Surface, [f64; 2]),
    seed: u64,
) -> Result<(Vec<i16>, f64)> {
    let dt_s = 1.0 / rig.tick_hz;
    let mut chance = Chance::new(seed_of(seed, &[0]));
    let way = if chance.unit() < 0.5 { -1.0 } else { 1.0 };
    let gap = rig.gap_m + rig.gap_sd_m * chance.normal();
    let latency = rig.latency_s + rig.latency_spread_s * chance.between(-1.0, 1.0);
    let shaft = whiskers::held(Shaft::xy_table(), rig.follicle);
    let sensor = whiskers::sensor([rig.full_scale_rad; 2]);
    let mut whisker = TouchingWhisker::new(&shaft, &sensor, seed_of(seed, &[1]))?;
    let (normal, along) = facing(angle_deg, rig.roll_deg, way);
    let across = cross(normal, along);
    let origin = add([0.0, 0.0, shaft.length_m], spot_m[0], along);
    let origin = add(origin, spot_m[1], across);
    let mut plate = plane(origin, (normal, along), surface);
    let pose = Pose {
        base_m: [0.0; 3],
        x: [1.0, 0.0, 0.0],
        y: [0.0, 1.0, 0.0],
    };

    let lead = rig.half_window;
    let mut carriage = Carriage {
        x_m: -gap,
        v_m_s: speed_m_s,
    };
    let mut codes = Vec::new();
    let (mut left, mut withdrawn) = (None, 0);
    let slowest = (gap / speed_m_s.max(1e-6) + 10.0) * rig.tick_hz;
    for tick in 0..lead + slowest as usize {
        if tick < lead {
            // The object is still on its way: nothing to touch.
            whisker.step(&pose, None, dt_s);
        } else {
            let is_over = left.is_some_and(|left: f64| left <= 0.0);
            let wanted_m_s = if is_over { -rig.retract_m_s } else { speed_m_s };
            carriage.step(wanted_m_s, rig.acceleration_m_s2, dt_s);
            plate.point_m[0] = origin[0] + way * carriage.x_m;
            whisker.step(&pose, Some(&plate), dt_s);
            let deflected = whisker.reading()[0].abs() > rig.threshold;
            let begins = deflected.then_some(latency);
            left = left.map(|left| left - dt_s).or(begins);
        }
        codes.extend(whisker.codes());
        withdrawn += usize::from(left.is_some_and(|left| left <= 0.0));
        if withdrawn > rig.half_window {
            break;
        }
    }
    Ok((codes, way))
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
