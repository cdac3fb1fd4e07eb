//! Contacts on the XY table: angles × speeds × textures, twice.

use super::whiskers;
use crate::experiment::recording::{Dataset, Recording};
use crate::experiment::request::{Extent, Request};
use crate::paper::pose::{ANGLES_DEG, SPEEDS_MM_S, TEXTURES};
use crate::rigs::{Carriage, Chance, Table, facing, seed_of};
use anyhow::{Context, Result};
use physics::vector::{add, cross};
use physics::{Outline, Plate, Pose, Shaft, Surface, TouchingWhisker};

/// How often each contact is made.
pub(crate) const TIMES: usize = 2;

/// A contact's condition, as places in the paper's lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Contact {
    pub(crate) angle: usize,
    pub(crate) speed: usize,
    pub(crate) texture: usize,
}

/// The contact of all in a placebo: P80 at a middle angle and speed.
const PLACEBO: Contact = Contact {
    angle: 4,
    speed: 5,
    texture: 0,
};

pub(crate) fn speeds() -> Vec<f64> {
    let (least, most, count) = SPEEDS_MM_S;
    let step = (most - least) / (count - 1) as f64;
    (0..count).map(|n| least + step * n as f64).collect()
}

pub(crate) fn contacts(extent: Extent) -> Vec<Contact> {
    let mut contacts = Vec::new();
    for angle in (0..ANGLES_DEG.len()).step_by(extent.stride()) {
        for speed in (0..SPEEDS_MM_S.2).step_by(extent.stride()) {
            contacts.extend((0..TEXTURES.len()).map(|texture| Contact {
                angle,
                speed,
                texture,
            }));
        }
    }
    contacts.repeat(TIMES)
}

pub(crate) fn jobs(extent: Extent) -> usize {
    contacts(extent).len()
}

/// Records a contact: codes of x and y about the peak of x, x turned to
/// positive.
pub(crate) fn record(request: &Request, job: usize, seed: u64) -> Result<Recording> {
    let all = contacts(request.extent);
    let contact = all.get(job).context("no such contact")?;
    let rig = &request.rigs.table;
    let speed = request.place(contact.speed, PLACEBO.speed);
    let speed_m_s = speeds().get(speed).copied().unwrap_or(0.0) / 1000.0;
    let angle_deg = ANGLES_DEG[request.place(contact.angle, PLACEBO.angle)];
    let surface = request.surface(&whiskers::TABLE, contact.texture, PLACEBO.texture);
    let spot_m = request.spot_m(Dataset::Table, contact.texture, seed);
    let (codes, way) = approach(rig, (angle_deg, speed_m_s), (surface, spot_m), seed)?;

    let x = |n: usize| codes.get(2 * n).copied().unwrap_or(0);
    let count = codes.len() / 2;
    // Deflection is positive the way the object pushes; the first of equals.
    let sign: i16 = if way < 0.0 { -1 } else { 1 };
    let peak = (0..count).max_by_key(|n| (sign * x(*n), usize::MAX - n));
    let peak = peak.unwrap_or(0);
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
    let mut plate = Plate {
        point_m: origin,
        normal,
        along,
        outline: Outline::PLANE,
        surface,
    };
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
            let wanted = if left.is_some_and(|left: f64| left <= 0.0) {
                -rig.retract_m_s
            } else {
                speed_m_s
            };
            carriage.step(wanted, rig.acceleration_m_s2, dt_s);
            plate.point_m[0] = origin[0] + way * carriage.x_m;
            whisker.step(&pose, Some(&plate), dt_s);
            let deflected = whisker.reading()[0].abs() > rig.threshold;
            left = match left {
                None if deflected => Some(latency),
                None => None,
                Some(left) => Some(left - dt_s),
            };
        }
        codes.extend(whisker.codes());
        withdrawn += usize::from(left.is_some_and(|left| left <= 0.0));
        if withdrawn > rig.half_window {
            break;
        }
    }
    Ok((codes, way))
}
