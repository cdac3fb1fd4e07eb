//! The floor robot of LEP10 and LEP12: a passive whisker on the front of a
//! small cleaning robot, dragged over the floor.
//!
//! World frame: x and y along the floor, z up, the floor at z = 0. The sensor's x is parallel to
//! the floor and y normal to it as far as the whisker's slope allows (LEP12 section 2).

use super::{Chance, Wander, direction, keys, plane, seed_of, turn, whiskers};
use crate::experiment::{Dataset, Extent, Recording, Request};
use crate::paper::lep10::FLOORS;
use anyhow::{Context, Result};
use physics::vector::{add, cross};
use physics::{Pose, Shaft, TouchingWhisker};

keys! {
    Floor, rig:
    tick_hz: f64 => 200.0..=20_000.0,
    trial_s: f64 => 0.1..=3600.0,
    mount_radius_m: f64 => 0.0..=2.0,
    mount_bearing_deg: f64 => -180.0..=180.0,
    azimuth_deg: f64 => -90.0..=90.0,
    elevation_deg: f64 => -80.0..=-1.0,
    roll_deg: f64 => -90.0..=90.0,
    press_m: f64 => 0.0..=0.1,
    press_sd_m: f64 => 0.0..=0.1,
    placements: usize => 1.0..=16.0,
    wobble_share: f64 => 0.0..=10.0,
    wobble_s: f64 => 1e-3..=1e3,
    turn_rad_s: f64 => 0.0..=20.0,
    forward_m_s: f64 => 0.0..=10.0,
    speed_share_sd: f64 => 0.0..=0.5,
    speed_s: f64 => 1e-3..=1e3,
    leg_least_s: f64 => 0.01..=1e3,
    leg_most_s: f64 => rig.leg_least_s..=1e3,
    full_scale_rad: [f64; 2] => 1e-4..=3.0,
    follicle: f64 => 0.01..=100.0,
    dead_hz: f64 => 0.0..=100.0,
    dead_s: f64 => 1e-3..=100.0,
    missed_hz: f64 => 0.0..=1000.0,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RobotMotion {
    Anticlockwise,
    Clockwise,
    /// Turns either way and forward runs, in an order that the whisker cannot foresee.
    Autonomous,
}

struct Drive<'r> {
    rig: &'r Floor,
    motion: RobotMotion,
    chance: Chance,
    wobble: Wander,
    unevenness: Wander,
    /// Length of the whisker, for the height of the mount.
    height_m: f64,
    place: [f64; 2],
    heading: f64,
    /// Turning rate, rad/s, and speed, m/s: what the wheels do now, and want.
    now: [f64; 2],
    wanted: [f64; 2],
    left_s: f64,
}

impl Floor {
    fn dt_s(&self) -> f64 {
        1.0 / self.tick_hz
    }

    fn ticks(&self) -> usize {
        (self.trial_s * self.tick_hz).round() as usize
    }

    /// A robot with a whisker of `length_m`; `height_m` is the root mean square of the floor's
    /// heights. Where on a large floor it is set down, and how deep it presses, come of the seed
    /// `set_up`; how it goes, of `seed`.
    fn drive(
        &self,
        motion: RobotMotion,
        length_m: f64,
        height_m: f64,
        (set_up, seed): (u64, u64),
    ) -> Drive<'_> {
        let mut chance = Chance::new(set_up);
        let reach = length_m * libm::sin(-self.elevation_deg.to_radians());
        let press = self.press_m + self.press_sd_m * chance.normal();
        let mut drive = Drive {
            rig: self,
            motion,
            wobble: Wander::new(self.wobble_share * height_m, self.wobble_s, self.dt_s()),
            unevenness: Wander::new(self.speed_share_sd, self.speed_s, self.dt_s()),
            height_m: reach - press,
            place: [chance.between(-50.0, 50.0), chance.between(-50.0, 50.0)],
            heading: chance.between(0.0, core::f64::consts::TAU),
            now: [0.0; 2],
            wanted: [0.0; 2],
            left_s: 0.0,
            chance: Chance::new(seed),
        };
        drive.choose();
        drive.now = drive.wanted;
        drive
    }
}

impl Drive<'_> {
    fn choose(&mut self) {
        let rig = self.rig;
        let way = match self.motion {
            RobotMotion::Anticlockwise => 0,
            RobotMotion::Clockwise => 1,
            RobotMotion::Autonomous => self.chance.among(3),
        };
        self.wanted = match way {
            0 => [rig.turn_rad_s, 0.0],
            1 => [-rig.turn_rad_s, 0.0],
            _ => [0.0, rig.forward_m_s],
        };
        self.left_s = self.chance.between(rig.leg_least_s, rig.leg_most_s);
    }

    fn step(&mut self) -> Pose {
        /// Time constant with which the wheels follow, s.
        const WHEELS_S: f64 = 0.05;
        let dt_s = self.rig.dt_s();
        self.left_s -= dt_s;
        if self.left_s <= 0.0 {
            self.choose();
        }
        for (now, wanted) in self.now.iter_mut().zip(self.wanted) {
            *now += (wanted - *now) * (dt_s / WHEELS_S).min(1.0);
        }
        let share = 1.0 + self.unevenness.step(&mut self.chance);
        let [turning, speed] = self.now.map(|now| now * share);
        self.heading += turning * dt_s;
        let (sine, cosine) = libm::sincos(self.heading);
        self.place[0] += speed * cosine * dt_s;
        self.place[1] += speed * sine * dt_s;

        let rig = self.rig;
        let height = self.height_m + self.wobble.step(&mut self.chance);
        let rim = direction(rig.mount_bearing_deg, 0.0);
        let mount = turn(rim.map(|part| part * rig.mount_radius_m), self.heading);
        let base_m = add([self.place[0], self.place[1], height], 1.0, mount);
        let shaft = turn(direction(rig.azimuth_deg, rig.elevation_deg), self.heading);
        let level = turn(direction(rig.azimuth_deg + 90.0, 0.0), self.heading);
        let (aside, upright) = libm::sincos(rig.roll_deg.to_radians());
        let x = add(level.map(|part| upright * part), aside, cross(shaft, level));
        let y = cross(shaft, x);
        Pose { base_m, x, y }
    }
}

/// The floor of all in a placebo: tarmac.
const PLACEBO: usize = 2;

/// How long the whisker is dragged before a placement is recorded, s.
const LEAD_S: f64 = 0.5;

/// A trial: its floor, motion, and which of these.
pub(crate) type Trial = (usize, RobotMotion, usize);

/// All trials in the order of their jobs: natural motion twice as often as either rotation (LEP10
/// section III-D).
pub(crate) fn trials(extent: Extent) -> Vec<Trial> {
    let motions = [
        (RobotMotion::Anticlockwise, extent.trials),
        (RobotMotion::Clockwise, extent.trials),
        (RobotMotion::Autonomous, 2 * extent.trials),
    ];
    let mut all = Vec::new();
    for floor in 0..FLOORS.len() {
        for (motion, count) in motions {
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
    let axes = ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
    let surface = request.surface(&whiskers::FLOORS, floor, PLACEBO);
    let plate = plane([0.0; 3], axes, surface);
    let lead = (LEAD_S * rig.tick_hz).round() as usize;
    let each = rig.ticks() / rig.placements.max(1);
    let trial = job % (trials.len() / FLOORS.len());
    let set_up = request.set_up(Dataset::Floor, (floor, trial), seed);
    let mut values = Vec::with_capacity(2 * rig.ticks());
    let mut flaws = Flaws::new(seed_of(seed, &[2]));
    for placement in 0..rig.placements as u64 {
        let mut whisker = TouchingWhisker::new(&shaft, &sensor, seed_of(seed, &[0, placement]))?;
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
    use super::{Flaws, Floor, RobotMotion};
    use crate::rigs::Rigs;
    use physics::vector::{add, cross, dot};

    fn calm() -> Floor {
        let mut rig = Rigs::with(&[]).floor;
        rig.press_sd_m = 0.0;
        rig.wobble_share = 0.0;
        rig.speed_share_sd = 0.0;
        rig
    }

    #[test]
    fn a_straight_tip_is_as_deep_as_the_press_and_circles_the_robot() {
        let rig = calm();
        let length = 0.2;
        for (motion, sign) in [
            (RobotMotion::Anticlockwise, 1.0),
            (RobotMotion::Clockwise, -1.0),
        ] {
            let mut drive = rig.drive(motion, length, 1e-3, (4, 4));
            let centre = [drive.place[0], drive.place[1], 0.0];
            let mut tips = Vec::new();
            for _ in 0..2000 {
                let pose = drive.step();
                let shaft = cross(pose.x, pose.y);
                assert!((dot(shaft, shaft) - 1.0).abs() < 1e-12);
                assert!(pose.x[2].abs() < 1e-15, "x is parallel to the floor");
                assert!(pose.y[2] > 0.9, "y points up: {:?}", pose.y);
                tips.push(add(add(pose.base_m, length, shaft), -1.0, centre));
            }
            // Mount at the front, whisker at 45 degrees: the law of cosines.
            let level = length * rig.elevation_deg.to_radians().cos();
            let (r, a) = (rig.mount_radius_m, rig.azimuth_deg.to_radians());
            let radius = (r * r + level * level + 2.0 * r * level * a.cos()).sqrt();
            for tip in &tips {
                assert!((tip[2] + rig.press_m).abs() < 1e-12, "{tip:?}");
                assert!((tip[0].hypot(tip[1]) - radius).abs() < 1e-12);
            }
            let angle = |tip: &[f64; 3]| tip[1].atan2(tip[0]);
            let swept = (angle(&tips[1]) - angle(&tips[0])).sin() * rig.tick_hz;
            assert!((swept - sign * rig.turn_rad_s).abs() < 1e-6, "{swept}");
        }
    }

    #[test]
    fn autonomous_motion_turns_both_ways_and_runs_forward() {
        let rig = calm();
        let mut drive = rig.drive(RobotMotion::Autonomous, 0.2, 1e-3, (9, 9));
        let mut seen = [0_u32; 3];
        for _ in 0..rig.ticks() * 4 {
            drive.step();
            let [turning, speed] = drive.now;
            seen[0] += u32::from(turning > 0.9 * rig.turn_rad_s);
            seen[1] += u32::from(turning < -0.9 * rig.turn_rad_s);
            seen[2] += u32::from(speed > 0.9 * rig.forward_m_s);
        }
        assert!(seen.iter().all(|count| *count > 10_000), "{seen:?}");
    }

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
