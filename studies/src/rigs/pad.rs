//! A whisker pad of Psikharpax: 33 vibrissae in eight arcs, and the fixed head
//! that sweeps it over a sheet of sandpaper by turning its neck.
//!
//! # Glossary
//!
//! - **arc**: vibrissae of one length, from back (longest) to front.
//! - **row**: from top (0) to bottom (4); short arcs have the lower rows only (PSIK Table 1).
//!
//! Frame of the neck: its axis is z, upwards, at the origin. All tips of a pad
//! lie at one distance from the origin, as fits "an appropriate angle to
//! provide contact with a maximum number of whiskers" (section 3.2.1).

use super::{Chance, direction, keys, panned, plane, seed_of, whiskers};
use crate::classifiers::imp::Imp;
use crate::experiment::{Dataset, Extent, Recording, Request};
use crate::paper::psik::{ARCS, RATE_HZ, VIBRISSAE};
use anyhow::Result;
use physics::vector::{add, cross};
use physics::{Plate, Pose, sensor_code};

const ROWS: usize = 5;

keys! {
    Layout, rig:
    tip_radius_m: f64 => 0.01..=2.0,
    lean_deg: f64 => -90.0..=90.0,
    arc_step_deg: f64 => 0.0..=20.0,
    row_step_deg: f64 => 0.0..=20.0,
    centre_deg: f64 => -180.0..=180.0,
    tip_diameter_m: f64 => 1e-5..=2e-3,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Vibrissa {
    pub(crate) arc: usize,
    pub(crate) row: usize,
    pub(crate) length_m: f64,
    /// Base and axes in the frame of the neck, for the left pad.
    pub(crate) pose: Pose,
}

impl Layout {
    pub(crate) fn vibrissae(&self) -> Vec<Vibrissa> {
        let mut all = Vec::new();
        let middle = (ARCS.len() as f64 - 1.0) / 2.0;
        for (arc, (count, length_mm)) in ARCS.into_iter().enumerate() {
            // The back of a left pad is further to the left.
            let azimuth = self.centre_deg + (middle - arc as f64) * self.arc_step_deg;
            for row in ROWS.saturating_sub(count)..ROWS {
                let elevation = (2.0 - row as f64) * self.row_step_deg;
                let length_m = length_mm / 1000.0;
                let tip = direction(azimuth, elevation).map(|part| part * self.tip_radius_m);
                let shaft = direction(azimuth - self.lean_deg, elevation);
                let x = direction(azimuth - self.lean_deg + 90.0, 0.0);
                let pose = Pose {
                    base_m: add(tip, -length_m, shaft),
                    x,
                    y: cross(shaft, x),
                };
                all.push(Vibrissa {
                    arc,
                    row,
                    length_m,
                    pose,
                });
            }
        }
        all
    }
}

keys! {
    Pad, rig:
    distance_m: f64 => 0.01..=2.0,
    distance_spread_m: f64 => 0.0..=0.5,
    position_spread_m: f64 => 0.0..=5.0,
    sweep_deg: f64 => 1.0..=90.0,
    sweep_s: f64 => 0.01..=100.0,
    bits: usize => 2.0..=14.0,
    full_scale_rad: f64 => 1e-4..=3.0,
    follicle: f64 => 0.01..=100.0,
    pitch_deg: f64 => -60.0..=60.0,
    layout: Layout,
}

impl Pad {
    /// The normal of the sheet, whose top leans away from the head by `pitch_deg`, and the place of
    /// its texture's origin, which is so far from the middle along it and upwards on it.
    fn sheet(&self, distance_m: f64, [along, up]: [f64; 2]) -> ([f64; 3], [f64; 3]) {
        let (sine, cosine) = libm::sincos(self.pitch_deg.to_radians());
        let origin = [distance_m + up * sine, along, up * cosine];
        ([-cosine, 0.0, sine], origin)
    }

    fn ticks(&self) -> usize {
        (self.sweep_s * RATE_HZ).round() as usize
    }

    /// Of one sweep how far the sheet is, m, and where along it and upwards the head is set up: the
    /// origin of the sheet's texture, m.
    fn sweep(&self, chance: &mut Chance) -> (f64, [f64; 2]) {
        let (spread, aside) = (self.distance_spread_m, self.position_spread_m);
        let distance_m = self.distance_m + chance.between(-spread, spread);
        (distance_m, [0, 1].map(|_| chance.between(-aside, aside)))
    }

    /// The pan at a tick, radians: from −`sweep_deg` to `sweep_deg`, with the
    /// speed of half a cosine.
    fn pan(&self, tick: usize) -> f64 {
        let share = tick as f64 / self.ticks().max(1) as f64;
        -self.sweep_deg.to_radians() * libm::cos(core::f64::consts::PI * share)
    }
}

pub(crate) const PAPERS: usize = 8;
/// The sandpaper of all in a placebo: P80.
const PLACEBO: usize = 3;
/// Window of the IMP's mean, samples (86 ms; chosen).
const WINDOW: u32 = 100;

fn sweeps(extent: Extent) -> usize {
    let (training, testing) = extent.sweeps;
    training + testing
}

pub(crate) fn jobs(extent: Extent) -> usize {
    PAPERS * sweeps(extent)
}

/// The sandpaper of a job, and which of its sweeps.
pub(crate) fn place(extent: Extent, job: usize) -> (usize, usize) {
    (job / sweeps(extent), job % sweeps(extent))
}

/// A reading in so many bits, with its sign, 2 to 14.
pub(crate) fn codes(reading: [f64; 2], bits: usize) -> [i16; 2] {
    let most = f64::from((1_u32 << bits.clamp(2, 14).saturating_sub(1)) - 1);
    reading.map(|x| sensor_code(most * x, most))
}

/// The vibrissa whose samples are kept: the middle one of the longest arc.
pub(crate) const ONE: usize = ARCS[0].0 / 2;

/// A reading of so many bits in codes of 14, as the product's classifier takes them.
pub(crate) fn widened(code: [i16; 2], bits: usize) -> [f32; 2] {
    let unit = f32::from(1_u16 << 14_usize.saturating_sub(bits).min(12));
    code.map(|x| unit * f32::from(x))
}

fn sheet(request: &Request, job: usize, seed: u64) -> Plate {
    let rig = &request.rigs.pad;
    let (paper, _) = place(request.extent, job);
    let mut chance = Chance::new(seed_of(seed, &[0]));
    let (distance_m, origin_m) = rig.sweep(&mut chance);
    let spot = request.spot_m(Dataset::Pad, paper, seed);
    let [along, up] = [0, 1].map(|k| spot[k] + origin_m[k]);
    let (normal, point_m) = rig.sheet(distance_m, [along, up]);
    let surface = request.surface(&whiskers::SANDPAPERS, paper, PLACEBO);
    plane(point_m, (normal, [0.0, 1.0, 0.0]), surface)
}

/// Records what one vibrissa feels in a sweep: x and y.
pub(crate) fn record_one(request: &Request, job: usize, seed: u64) -> Result<Recording> {
    let rig = &request.rigs.pad;
    let plate = sheet(request, job, seed);
    let mut whiskers = whiskers::pad(&rig.layout, (rig.full_scale_rad, rig.follicle), seed)?;
    let (vibrissa, whisker) = &mut whiskers[ONE];
    let felt = |tick| {
        let pose = panned(&vibrissa.pose, rig.pan(tick));
        whisker.step(&pose, Some(&plate), 1.0 / RATE_HZ);
        widened(codes(whisker.reading(), rig.bits), rig.bits)
    };
    Ok(Recording::new(2, (0..rig.ticks()).flat_map(felt).collect()))
}

/// Records a sweep: one sample of 33 numbers.
pub(crate) fn record(request: &Request, job: usize, seed: u64) -> Result<Recording> {
    let rig = &request.rigs.pad;
    let plate = sheet(request, job, seed);
    let mut whiskers = whiskers::pad(&rig.layout, (rig.full_scale_rad, rig.follicle), seed)?;
    let (mut imp, mut sums) = (Imp::new(WINDOW), [0_u32; VIBRISSAE]);
    let mut add = |window: [u32; VIBRISSAE]| {
        for (sum, imp) in sums.iter_mut().zip(window) {
            *sum = sum.saturating_add(imp);
        }
    };
    for tick in 0..rig.ticks() {
        let mut all = [[0; 2]; VIBRISSAE];
        for ((vibrissa, whisker), code) in whiskers.iter_mut().zip(&mut all) {
            let pose = panned(&vibrissa.pose, rig.pan(tick));
            whisker.step(&pose, Some(&plate), 1.0 / RATE_HZ);
            *code = codes(whisker.reading(), rig.bits);
        }
        imp.push(&all).map(&mut add);
    }
    imp.finish().map(&mut add);
    // In codes a sample.
    let values = sums.iter().map(|x| *x as f32 / 65_536.0);
    Ok(Recording::new(VIBRISSAE, values.collect()))
}

#[cfg(test)]
mod tests {
    use super::{Pad, VIBRISSAE, panned};
    use crate::rigs::Rigs;
    use physics::vector::{add, cross, dot};

    fn rig() -> Pad {
        Rigs::with(&[]).pad
    }

    #[test]
    fn all_tips_lie_on_one_sphere_and_axes_are_right_handed() {
        let layout = rig().layout;
        let all = layout.vibrissae();
        assert_eq!(all.len(), VIBRISSAE);
        for vibrissa in &all {
            let shaft = cross(vibrissa.pose.x, vibrissa.pose.y);
            let tip = add(vibrissa.pose.base_m, vibrissa.length_m, shaft);
            assert!((dot(tip, tip).sqrt() - layout.tip_radius_m).abs() < 1e-12);
            assert!((dot(shaft, shaft) - 1.0).abs() < 1e-12);
            assert!(dot(vibrissa.pose.x, vibrissa.pose.y).abs() < 1e-12);
        }
        let rows: Vec<_> = all.iter().filter(|v| v.arc == 7).map(|v| v.row).collect();
        assert_eq!(rows, [3, 4], "D7 and E8");
    }

    #[test]
    fn a_sheet_that_is_pitched_faces_the_head_and_upwards() {
        let mut rig = rig();
        let flat = ([-1.0, 0.0, 0.0], [0.25, 0.1, 0.4]);
        assert_eq!(rig.sheet(0.25, [0.1, 0.4]), flat);
        rig.pitch_deg = 30.0;
        let (normal, origin) = rig.sheet(0.25, [0.1, 0.4]);
        assert!(normal[0] < 0.0 && normal[1] == 0.0 && (normal[2] - 0.5).abs() < 1e-12);
        // Wherever its origin is, the sheet goes through the same place before the head.
        assert!(dot(normal, add(origin, -1.0, [0.25, 0.0, 0.0])).abs() < 1e-12);
    }

    /// Every vibrissa is off the sheet at both ends of a sweep and on it in
    /// between, at the middle distance.
    #[test]
    fn a_sweep_brings_every_tip_onto_the_sheet_and_off_again() {
        let rig = rig();
        for vibrissa in rig.layout.vibrissae() {
            let beyond = |tick| {
                let pose = panned(&vibrissa.pose, rig.pan(tick));
                let tip = add(pose.base_m, vibrissa.length_m, cross(pose.x, pose.y));
                tip[0] - rig.distance_m
            };
            assert!(beyond(0) < 0.0 && beyond(rig.ticks()) < 0.0);
            // No base comes nearer to the sheet than its own radius.
            let base = |tick| panned(&vibrissa.pose, rig.pan(tick)).base_m[0];
            let nearest = (0..=rig.ticks()).map(base).fold(f64::MIN, f64::max);
            assert!(nearest < rig.distance_m - 0.002, "{vibrissa:?}: {nearest}");
            let most = (0..rig.ticks()).map(beyond).fold(f64::MIN, f64::max);
            assert!(most > 0.002, "{vibrissa:?}: {most}");
        }
    }
}
