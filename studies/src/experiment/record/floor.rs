//! Trials of the floor robot: four floors, three motions, each some times:
//! natural motion twice as often as either rotation.

use super::whiskers;
use crate::experiment::recording::Recording;
use crate::experiment::request::{Extent, Request};
use crate::paper::lep10::FLOORS;
use crate::rigs::{RobotMotion, seed_of};
use anyhow::Result;
use physics::{Plate, Shaft, TouchingWhisker};

pub(crate) const MOTIONS: [RobotMotion; 3] = [
    RobotMotion::Anticlockwise,
    RobotMotion::Clockwise,
    RobotMotion::Autonomous,
];

/// The floor of all in a placebo: tarmac.
const PLACEBO: usize = 2;

/// How long the whisker is dragged before a placement is recorded, s.
const LEAD_S: f64 = 0.5;

fn each(extent: Extent) -> usize {
    (MOTIONS.len() - 1) * extent.trials() + extent.natural_trials()
}

pub(crate) fn jobs(extent: Extent) -> usize {
    FLOORS.len() * each(extent)
}

/// The job of a trial: trials of a motion together, motions of a floor together.
pub(crate) fn number(extent: Extent, floor: usize, motion: RobotMotion, trial: usize) -> usize {
    let place = MOTIONS.iter().position(|one| *one == motion).unwrap_or(0);
    floor * each(extent) + place * extent.trials() + trial
}

fn place(extent: Extent, job: usize) -> (usize, RobotMotion) {
    let each = each(extent).max(1);
    let motion = job % each / extent.trials().max(1);
    let last = MOTIONS.len() - 1;
    let motion = MOTIONS.get(motion.min(last)).copied();
    (job / each, motion.unwrap_or(RobotMotion::Autonomous))
}

/// Records a trial: codes of x and y.
pub(crate) fn record(request: &Request, job: usize, seed: u64) -> Result<Recording> {
    let (floor, motion) = place(request.extent, job);
    let rig = &request.rigs.floor;
    let shaft = Shaft::floor_robot();
    let sensor = whiskers::sensor(rig.full_scale_rad);
    let plate = Plate {
        point_m: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
        along: [1.0, 0.0, 0.0],
        surface: whiskers::floor(&request.rigs.surfaces, request.felt(floor, PLACEBO)),
    };
    let lead = (LEAD_S * rig.tick_hz).round() as usize;
    let each = rig.ticks() / rig.placements.max(1);
    let mut codes = Vec::with_capacity(2 * rig.ticks());
    for placement in 0..rig.placements as u64 {
        let whisker = TouchingWhisker::new(&shaft, &sensor, seed_of(seed, &[0, placement]));
        let mut whisker = whisker?;
        let seed = seed_of(seed, &[1, placement]);
        let mut drive = rig.drive(motion, shaft.length_m, plate.surface.height_m, seed);
        for tick in 0..lead + each {
            whisker.step(&drive.step(), Some(&plate), rig.dt_s());
            if tick >= lead {
                codes.extend(whisker.codes());
            }
        }
    }
    Ok(Recording::from_codes(2, &codes))
}

#[cfg(test)]
mod tests {
    use super::{MOTIONS, jobs, number, place};
    use crate::experiment::request::Extent;
    use crate::rigs::RobotMotion;

    #[test]
    fn every_trial_has_a_job_and_natural_motion_has_eight() {
        let extent = Extent::Full;
        let mut next = 0;
        for floor in 0..4 {
            for motion in MOTIONS {
                let trials = if motion == RobotMotion::Autonomous {
                    8
                } else {
                    4
                };
                for trial in 0..trials {
                    assert_eq!(number(extent, floor, motion, trial), next);
                    assert_eq!(place(extent, next), (floor, motion));
                    next += 1;
                }
            }
        }
        assert_eq!(jobs(extent), next);
    }
}
