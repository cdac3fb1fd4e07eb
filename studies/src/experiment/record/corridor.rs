//! Runs of the mobile robot through its corridors: the smoothed IMP of all
//! vibrissae of both sides, window by window, and where the robot was.

use super::pads::{INPUTS, Pads, WINDOW};
use super::whiskers;
use crate::experiment::recording::{Dataset, Recording};
use crate::experiment::request::{Extent, Request};
use crate::paper::psik::{CORRIDORS, RATE_HZ};
use crate::rigs::{Chance, Robot, seed_of};
use anyhow::Result;
use physics::{Outline, Plate};

/// Columns before the readings: the inputs, then how far the neck is off the middle, m, its
/// heading, radians, and D of both sides, mm. Behind them are x and y of one vibrissa of the left
/// pad, tick by tick.
pub(crate) const FELT: usize = INPUTS + 4;
/// Numbers of a sample.
pub(crate) const COLUMNS: usize = FELT + 2 * WINDOW as usize;

const PLACEBO: usize = 1;

fn runs(extent: Extent) -> usize {
    let (training, _, deciding) = extent.runs();
    training + deciding
}

pub(crate) fn jobs(extent: Extent) -> usize {
    CORRIDORS.len() * runs(extent)
}

/// The corridor and direction of a job, and which of its runs.
pub(crate) fn place(extent: Extent, job: usize) -> (usize, usize) {
    (job / runs(extent), job % runs(extent))
}

/// The walls on the left and right of a corridor and direction: one corridor
/// has textures 0 and 1, the other 2 and 3; the way back swaps the sides.
pub(crate) fn walls(case: usize) -> [usize; 2] {
    [case, case ^ 1]
}

pub(crate) fn relief(request: &Request, number: usize) -> physics::Surface {
    request.surface(&whiskers::WALLS, number, PLACEBO)
}

/// The wall of a side, and where its relief begins: on the way back at the other end.
pub(crate) fn plate(request: &Request, side: usize, case: usize, seed: u64) -> Plate {
    let rig = &request.rigs.corridor;
    let number = walls(case)[side];
    let left = if side == 0 { 1.0 } else { -1.0 };
    let [along, up] = request.spot_m(Dataset::Corridor, number, seed);
    let (begin, way) = if request.place(case, 0).is_multiple_of(2) {
        (0.0, 1.0)
    } else {
        (rig.length_m, -1.0)
    };
    Plate {
        point_m: [begin + way * along, left * rig.width_m / 2.0, up],
        normal: [0.0, -left, 0.0],
        along: [way, 0.0, 0.0],
        outline: Outline::PLANE,
        surface: relief(request, number),
    }
}

/// Records a run: a sample of [`COLUMNS`] numbers a window.
pub(crate) fn record(request: &Request, job: usize, seed: u64) -> Result<Recording> {
    let rig = &request.rigs.corridor;
    let (case, _) = place(request.extent, job);
    let mut chance = Chance::new(seed_of(seed, &[0]));
    let mut robot = Robot {
        neck_m: [0.0, chance.between(-rig.start_spread_m, rig.start_spread_m)],
        heading: chance
            .between(-rig.start_spread_deg, rig.start_spread_deg)
            .to_radians(),
    };
    let seeds = [1, 2].map(|side| seed_of(seed, &[side]));
    // The walls are the same pieces in every run, met from either end.
    let plates = [0, 1].map(|side| plate(request, side, case, seeds[side]));
    let mut pads = Pads::new(rig, seeds)?;
    let (mut values, mut one) = (Vec::new(), Vec::new());
    let most = (4.0 * rig.length_m / rig.speed_m_s * RATE_HZ) as usize;
    for _ in 0..most {
        let felt = pads.step(&robot, |side, _| Some(plates[side]));
        let [left, right] = felt.distance_mm;
        one.extend(felt.one);
        if let Some(window) = felt.window {
            values.extend(window);
            values.push(robot.neck_m[1] as f32);
            values.push(robot.heading as f32);
            values.extend([left as f32, right as f32]);
            // The ticks of the window.
            one.resize(COLUMNS - FELT, 0.0);
            values.append(&mut one);
        }
        rig.drive(&mut robot, left, right, 1.0 / RATE_HZ);
        if robot.neck_m[0] > rig.length_m {
            break;
        }
    }
    Ok(Recording::new(COLUMNS, values))
}
