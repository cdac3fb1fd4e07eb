//! Trials of the floor robot: four floors, three motions, each some times.

use super::whiskers;
use crate::experiment::recording::{Dataset, Recording};
use crate::experiment::request::{Extent, Request};
use crate::paper::lep10::FLOORS;
use crate::rigs::{Chance, Floor, RobotMotion, seed_of};
use anyhow::{Context, Result};
use physics::{Outline, Plate, Shaft, TouchingWhisker};

const MOTIONS: [RobotMotion; 3] = [
    RobotMotion::Anticlockwise,
    RobotMotion::Clockwise,
    RobotMotion::Autonomous,
];

/// The floor of all in a placebo: tarmac.
const PLACEBO: usize = 2;

/// How long the whisker is dragged before a placement is recorded, s.
const LEAD_S: f64 = 0.5;

/// A trial: its floor, motion, and which of these.
pub(crate) type Trial = (usize, RobotMotion, usize);

/// All trials in the order of their jobs: natural motion twice as often as either rotation (LEP10
/// section III-D).
pub(crate) fn trials(extent: Extent) -> Vec<Trial> {
    let mut all = Vec::new();
    for floor in 0..FLOORS.len() {
        for motion in MOTIONS {
            let count = match motion {
                RobotMotion::Autonomous => extent.natural_trials(),
                _ => extent.trials(),
            };
            all.extend((0..count).map(|trial| (floor, motion, trial)));
        }
    }
    all
}

/// Dead zones and missed pulses of both axes.
struct Flaws {
    chance: Chance,
    /// Of each axis: how long its dead zone lasts still, s, and what it reads there.
    dead: [(f64, i16); 2],
}

impl Flaws {
    fn new(seed: u64) -> Self {
        Self {
            chance: Chance::new(seed),
            dead: [(0.0, 0); 2],
        }
    }

    /// What is recorded where the sensor reads `codes`, a tick after the last.
    fn of(&mut self, codes: [i16; 2], rig: &Floor) -> [i16; 2] {
        /// A reading at the bottom of the range.
        const BOTTOM: i16 = -8191;
        let Self { chance, dead } = self;
        let mut recorded = codes;
        for (code, (left_s, held)) in recorded.iter_mut().zip(dead) {
            *left_s -= rig.dt_s();
            if *left_s > 0.0 {
                *code = *held;
            } else if chance.unit() < rig.dead_hz * rig.dt_s() {
                // Of exponential length.
                (*left_s, *held) = (-rig.dead_s * libm::log(1.0 - chance.unit()), *code);
            }
            if chance.unit() < rig.missed_hz * rig.dt_s() {
                *code = BOTTOM;
            }
        }
        recorded
    }
}

/// Records a trial: codes of x and y.
pub(crate) fn record(request: &Request, job: usize, seed: u64) -> Result<Recording> {
    let trials = trials(request.extent);
    let &(floor, motion, _) = trials.get(job).context("no such trial")?;
    let rig = &request.rigs.floor;
    let shaft = whiskers::held(Shaft::floor_robot(), rig.follicle);
    let sensor = whiskers::sensor(rig.full_scale_rad);
    let plate = Plate {
        point_m: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
        along: [1.0, 0.0, 0.0],
        outline: Outline::PLANE,
        surface: request.surface(&whiskers::FLOORS, floor, PLACEBO),
    };
    let lead = (LEAD_S * rig.tick_hz).round() as usize;
    let each = rig.ticks() / rig.placements.max(1);
    let trial = job % (trials.len() / FLOORS.len());
    let set_up = request.set_up(Dataset::Floor, (floor, trial), seed);
    let mut values = Vec::with_capacity(2 * rig.ticks());
    let mut flaws = Flaws::new(seed_of(seed, &[2]));
    for placement in 0..rig.placements as u64 {
        let whisker = TouchingWhisker::new(&shaft, &sensor, seed_of(seed, &[0, placement]));
        let mut whisker = whisker?;
        let seeds = [set_up, seed].map(|seed| seed_of(seed, &[1, placement]));
        let height_m = plate.surface.height_m;
        let mut drive = rig.drive(motion, shaft.length_m, height_m, seeds.into());
        for tick in 0..lead + each {
            whisker.step(&drive.step(), Some(&plate), rig.dt_s());
            if tick >= lead {
                values.extend(flaws.of(whisker.codes(), rig).map(f32::from));
            }
        }
    }
    Ok(Recording::new(2, values))
}

#[cfg(test)]
mod tests {
    use super::Flaws;
    use crate::rigs::Rigs;

    /// Of 800 dead zones the share is known to some 4 %, of 4000 pulses the rate to 1.6 %.
    #[test]
    fn dead_zones_and_missed_pulses_come_as_often_as_they_should() {
        let set = ["floor.dead_hz=0.5", "floor.dead_s=0.5", "floor.missed_hz=2"];
        let rig = Rigs::with(&set).floor;
        let (mut flaws, mut held, mut missed) = (Flaws::new(1), 0, 0);
        let count = 4_000_000;
        for n in 0..count {
            let code = (n % 1000) as i16;
            let [x, _] = flaws.of([code; 2], &rig);
            held += u32::from(x != code && x >= 0);
            missed += u32::from(x < 0);
        }
        // Free for 2 s on average, then dead for 0.5 s: a fifth of the time, to 2 %.
        let share = f64::from(held) / f64::from(count);
        assert!((share - 0.2).abs() < 0.01, "{share}");
        let rate = f64::from(missed) / f64::from(count) * rig.tick_hz;
        assert!((rate - 2.0).abs() < 0.1, "{rate}");
    }
}
