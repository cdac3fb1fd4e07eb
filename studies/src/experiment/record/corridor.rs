//! Runs of the mobile robot through its corridors: the smoothed IMP of all
//! vibrissae of both sides, window by window, and where the robot was.

use classifiers::imp::{Band, Imp};

use super::pad;
use super::whiskers;
use crate::experiment::recording::Recording;
use crate::experiment::request::{Extent, Request};
use crate::paper::psik::{ARCS, CORRIDORS, RATE_HZ, VIBRISSAE};
use crate::refused::refused;
use crate::rigs::{Chance, Robot, Vibrissa, seed_of};
use host_sim::Error;
use physics::{Plate, TouchingWhisker};

/// Inputs of the network: the vibrissae of both sides.
pub(crate) const INPUTS: usize = 2 * VIBRISSAE;
/// Numbers of a sample: the inputs, then how far the neck is off the middle, m,
/// its heading, radians, and D of both sides, mm.
pub(crate) const COLUMNS: usize = INPUTS + 4;
/// Bits of a reading.
const BITS: usize = 8;
/// Window of the IMP's mean, samples (50 ms; chosen).
const WINDOW: u32 = 58;

/// The wall of all in a placebo.
const PLACEBO: usize = 1;

/// Runs of one corridor and direction.
fn runs(extent: Extent) -> usize {
    let (training, _, deciding) = extent.runs();
    training + deciding
}

/// How many runs there are.
pub(crate) fn jobs(extent: Extent) -> usize {
    CORRIDORS.len() * runs(extent)
}

/// The corridor and direction of a job, and which of its runs.
pub(crate) fn place(extent: Extent, job: usize) -> (usize, usize) {
    let each = runs(extent).max(1);
    (job / each, job % each)
}

/// The walls on the left and right of a corridor and direction: one corridor
/// has textures 0 and 1, the other 2 and 3; the way back swaps the sides.
pub(crate) fn walls(case: usize) -> [usize; 2] {
    let first = case / 2 * 2;
    if case.is_multiple_of(2) {
        [first, first + 1]
    } else {
        [first + 1, first]
    }
}

/// A side of the robot: its wall, its vibrissae and what they do.
struct Side {
    plate: Plate,
    whiskers: Vec<(Vibrissa, TouchingWhisker)>,
    /// Low-passed deflection, 0 to 1, and IMP of each vibrissa.
    bent: [f32; VIBRISSAE],
    power: [f32; VIBRISSAE],
}

impl Side {
    fn new(request: &Request, side: usize, texture: usize, seed: u64) -> Result<Self, Error> {
        let rig = &request.rigs.corridor;
        let left = if side == 0 { 1.0 } else { -1.0 };
        let spread = rig.spot_spread_m;
        let spot = Chance::new(seed_of(seed, &[0])).between(-spread, spread);
        Ok(Self {
            plate: Plate {
                point_m: [spot, left * rig.width_m / 2.0, 0.0],
                normal: [0.0, -left, 0.0],
                along: [1.0, 0.0, 0.0],
                surface: whiskers::wall(texture),
            },
            whiskers: whiskers::pad(&rig.layout, rig.full_scale_rad, seed)?,
            bent: [0.0; VIBRISSAE],
            power: [0.0; VIBRISSAE],
        })
    }

    /// A tick: codes of all vibrissae. `keep` is that of the low-pass filter.
    fn step(
        &mut self,
        request: &Request,
        robot: &Robot,
        side: usize,
        keep: f32,
    ) -> [[i16; 2]; VIBRISSAE] {
        let rig = &request.rigs.corridor;
        let mut codes = [[0; 2]; VIBRISSAE];
        let all = self.whiskers.iter_mut().zip(&mut codes).zip(&mut self.bent);
        for (((vibrissa, whisker), code), bent) in all {
            let pose = rig.pose(robot, side, vibrissa);
            whisker.step(&pose, Some(&self.plate), 1.0 / RATE_HZ);
            *code = pad::codes(whisker.reading(), BITS);
            let [x, y] = code.map(f32::from);
            // A deflection of both axes at their ends counts as 1.
            let deflection = (x.hypot(y) / 127.0).min(1.0);
            *bent = keep * *bent + (1.0 - keep) * deflection;
        }
        codes
    }
}

/// The distance of what a pad touches, D = (1/N) Σ_i (1 − V_i) L_i (PSIK eq. 1),
/// mm: V_i is the mean of an arc over `bent`, the deflection of each vibrissa,
/// arc by arc, 0 to 1.
fn distance_mm(bent: &[f32; VIBRISSAE]) -> f64 {
    let mut rest = bent.as_slice();
    let arcs = ARCS.map(|(size, length_mm)| {
        // The sizes add up to the vibrissae.
        let (arc, after) = rest.split_at_checked(size).unwrap_or((rest, &[]));
        rest = after;
        (1.0 - arc.iter().sum::<f32>() / size as f32) * length_mm as f32
    });
    f64::from(arcs.iter().sum::<f32>() / ARCS.len() as f32)
}

/// Records a run: a sample of [`COLUMNS`] numbers a window.
pub(crate) fn record(request: &Request, job: usize, seed: u64) -> Result<Recording, Error> {
    let rig = &request.rigs.corridor;
    let (case, _) = place(request.extent, job);
    let mut chance = Chance::new(seed_of(seed, &[0]));
    let mut robot = Robot {
        neck_m: [0.0, chance.between(-rig.start_spread_m, rig.start_spread_m)],
        heading: chance
            .between(-rig.start_spread_deg, rig.start_spread_deg)
            .to_radians(),
    };
    let [left, right] = walls(case).map(|wall| request.felt(wall, PLACEBO));
    // The walls are the same pieces in every run, met from either end.
    let mut sides = [
        Side::new(request, 0, left, seed_of(seed, &[1]))?,
        Side::new(request, 1, right, seed_of(seed, &[2]))?,
    ];
    let dt_s = 1.0 / RATE_HZ;
    let keep = libm::exp(-dt_s / rig.smooth_s) as f32;
    let keep_window = libm::exp(-f64::from(WINDOW) * dt_s / rig.smooth_s) as f32;
    let imp = Imp::<VIBRISSAE>::new(WINDOW, Band::default()).map_err(refused)?;
    let mut states = [imp.state(), imp.state()];
    let mut values = Vec::new();
    let most = (4.0 * rig.length_m / rig.speed_m_s * RATE_HZ) as usize;
    for _ in 0..most {
        let mut ended = false;
        for (side, (half, state)) in sides.iter_mut().zip(&mut states).enumerate() {
            let codes = half.step(request, &robot, side, keep);
            if let Some(window) = imp.push(state, &codes) {
                ended = true;
                for (power, imp) in half.power.iter_mut().zip(window) {
                    let imp = imp as f32 / 65_536.0;
                    *power = keep_window * *power + (1.0 - keep_window) * imp;
                }
            }
        }
        let [left, right] = [distance_mm(&sides[0].bent), distance_mm(&sides[1].bent)];
        if ended {
            values.extend(sides.iter().flat_map(|half| half.power));
            values.push(robot.neck_m[1] as f32);
            values.push(robot.heading as f32);
            values.extend([left as f32, right as f32]);
        }
        rig.drive(&mut robot, left, right, dt_s);
        if robot.neck_m[0] > rig.length_m {
            break;
        }
    }
    Ok(Recording::new(COLUMNS, values))
}

#[cfg(test)]
mod tests {
    use super::{VIBRISSAE, distance_mm, walls};

    #[test]
    fn the_way_back_swaps_the_walls() {
        assert_eq!([0, 1, 2, 3].map(walls), [[0, 1], [1, 0], [2, 3], [3, 2]]);
    }

    #[test]
    fn distance_is_the_paper_s_and_arcs_take_their_vibrissae_and_no_others() {
        assert_eq!(distance_mm(&[0.0; VIBRISSAE]), 1035.0 / 8.0);
        assert_eq!(distance_mm(&[1.0; VIBRISSAE]), 0.0);
        let mut bent = [0.0; VIBRISSAE];
        // The last of arc 5 (100 mm), two of arc 6 (90 mm), one of arc 8 (55 mm).
        (bent[24], bent[25], bent[27], bent[32]) = (1.0, 0.25, 0.5, 1.0);
        let expected = (1035.0 - 100.0 / 5.0 - 90.0 * 0.75 / 3.0 - 55.0 / 2.0) / 8.0;
        assert!((distance_mm(&bent) - expected).abs() < 1e-4);
    }
}
