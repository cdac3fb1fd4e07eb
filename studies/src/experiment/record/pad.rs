//! Sweeps of the fixed head over sandpapers: the IMP of every vibrissa, summed
//! over the sweep, and what one vibrissa feels, sample by sample.

use super::whiskers;
use crate::classifiers::imp::Imp;
use crate::experiment::recording::{Dataset, Recording};
use crate::experiment::request::{Extent, Request};
use crate::paper::psik::{ARCS, RATE_HZ, VIBRISSAE};
use crate::rigs::{Chance, panned, seed_of};
use anyhow::Result;
use physics::{Outline, Plate, sensor_code};

pub(crate) const PAPERS: usize = 8;
/// The sandpaper of all in a placebo: P80.
const PLACEBO: usize = 3;
/// Window of the IMP's mean, samples (86 ms; chosen).
pub(crate) const WINDOW: u32 = 100;

fn sweeps(extent: Extent) -> usize {
    let (training, testing) = extent.sweeps();
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
    Plate {
        point_m,
        normal,
        along: [0.0, 1.0, 0.0],
        outline: Outline::PLANE,
        surface: request.surface(&whiskers::SANDPAPERS, paper, PLACEBO),
    }
}

/// Records what one vibrissa feels in a sweep: x and y.
pub(crate) fn record_one(request: &Request, job: usize, seed: u64) -> Result<Recording> {
    let rig = &request.rigs.pad;
    let plate = sheet(request, job, seed);
    let mut whiskers = whiskers::pad(&rig.layout, (rig.full_scale_rad, rig.follicle), seed)?;
    let mut values = Vec::with_capacity(2 * rig.ticks());
    if let Some((vibrissa, whisker)) = whiskers.get_mut(ONE) {
        for tick in 0..rig.ticks() {
            let pose = panned(&vibrissa.pose, rig.pan(tick));
            whisker.step(&pose, Some(&plate), 1.0 / RATE_HZ);
            values.extend(widened(codes(whisker.reading(), rig.bits), rig.bits));
        }
    }
    Ok(Recording::new(2, values))
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
