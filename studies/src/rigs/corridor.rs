//! The corridor of Psikharpax: a robot with a pad of vibrissae on either side
//! drives between two textured walls and keeps to the middle by touch.
//!
//! Frame of the corridor: x along it, y to the left, z up; its walls at y = ± half the width. The
//! robot is steered at its neck: a speed vector (V_x, V_y) there, V_y = (D_left − D_right) · 0.01
//! (PSIK eq. 2), turns the robot about the axle behind the neck. D in millimetres and V in m/s:
//! chosen, as the paper gives no units.

use anyhow::Result;
use physics::{Plate, Pose, TouchingWhisker};

use super::{Chance, Layout, Vibrissa, keys, pad, panned, plane, seed_of, turn, whiskers};
use crate::classifiers::imp::Imp;
use crate::experiment::{Dataset, Extent, Recording, Request};
use crate::paper::psik::{ARCS, CORRIDORS, RATE_HZ, VIBRISSAE};

keys! {
    Corridor, rig:
    width_m: f64 => 0.05..=10.0,
    length_m: f64 => 0.01..=100.0,
    speed_m_s: f64 => 1e-3..=10.0,
    gain: f64 => 0.0..=10.0,
    most_m_s: f64 => 0.0..=10.0,
    axle_m: f64 => 0.01..=10.0,
    slack_m: f64 => 0.0..=rig.width_m / 2.0,
    start_spread_m: f64 => 0.0..=rig.width_m / 2.0,
    start_spread_deg: f64 => 0.0..=45.0,
    smooth_s: f64 => 1e-3..=100.0,
    full_scale_rad: f64 => 1e-4..=3.0,
    follicle: f64 => 0.01..=100.0,
    layout: Layout,
}

/// Where the robot is: its neck, and where it heads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Robot {
    /// Of the neck along and across the corridor, m.
    pub(crate) neck_m: [f64; 2],
    /// Radians anticlockwise from the corridor's direction.
    pub(crate) heading: f64,
}

impl Corridor {
    /// V_y by the distances of the robot's sides, mm (PSIK eq. 2).
    pub(crate) fn across_m_s(&self, left_mm: f64, right_mm: f64) -> f64 {
        let across = (left_mm - right_mm) * self.gain;
        across.clamp(-self.most_m_s, self.most_m_s)
    }

    /// The robot `dt_s` later, with V_y, m/s.
    pub(crate) fn go(&self, robot: &mut Robot, across: f64, dt_s: f64) {
        let velocity = turn([self.speed_m_s, across, 0.0], robot.heading);
        robot.neck_m[0] += velocity[0] * dt_s;
        robot.neck_m[1] += velocity[1] * dt_s;
        robot.heading += across / self.axle_m * dt_s;
    }

    /// The robot `dt_s` later in its corridor, steered by the distances of its sides, mm.
    fn drive(&self, robot: &mut Robot, left_mm: f64, right_mm: f64, dt_s: f64) {
        self.go(robot, self.across_m_s(left_mm, right_mm), dt_s);
        // The robot's own sides keep it from the walls.
        let room = self.slack_m;
        robot.neck_m[1] = robot.neck_m[1].clamp(-room, room);
        robot.heading = robot.heading.clamp(-1.0, 1.0);
    }

    /// Where a vibrissa of the left (`side` 0) or right pad is.
    pub(crate) fn pose(robot: &Robot, side: usize, vibrissa: &Vibrissa) -> Pose {
        let Pose { base_m, x, y } = vibrissa.pose;
        // The right pad mirrors the left; x turns round to stay right-handed.
        let mirrored = |[a, b, c]: [f64; 3]| if side == 0 { [a, b, c] } else { [a, -b, c] };
        let left = if side == 0 { 1.0 } else { -1.0 };
        let x = mirrored(x).map(|part| left * part);
        let (base_m, y) = (mirrored(base_m), mirrored(y));
        let mut pose = panned(&Pose { base_m, x, y }, robot.heading);
        pose.base_m[0] += robot.neck_m[0];
        pose.base_m[1] += robot.neck_m[1];
        pose
    }
}

/// Columns before the readings: the inputs, then how far the neck is off the middle, m, its
/// heading, radians, and D of both sides, mm. Behind them are x and y of one vibrissa of the left
/// pad, tick by tick.
pub(crate) const FELT: usize = INPUTS + 4;
pub(crate) const COLUMNS: usize = FELT + 2 * WINDOW as usize;

const PLACEBO: usize = 1;

fn runs(extent: Extent) -> usize {
    let (training, _, deciding) = extent.runs;
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
    let point_m = [begin + way * along, left * rig.width_m / 2.0, up];
    let axes = ([0.0, -left, 0.0], [way, 0.0, 0.0]);
    plane(point_m, axes, relief(request, number))
}

/// Records a run: a sample of [`COLUMNS`] numbers a window.
pub(crate) fn record(request: &Request, job: usize, seed: u64) -> Result<Recording> {
    let rig = &request.rigs.corridor;
    let (case, _) = place(request.extent, job);
    let mut chance = Chance::new(seed_of(seed, &[0]));
    let aside = chance.between(-rig.start_spread_m, rig.start_spread_m);
    let turned_deg = chance.between(-rig.start_spread_deg, rig.start_spread_deg);
    let mut robot = Robot {
        neck_m: [0.0, aside],
        heading: turned_deg.to_radians(),
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

pub(crate) const INPUTS: usize = 2 * VIBRISSAE;
const BITS: usize = 8;
/// Window of the IMP's mean, samples (50 ms; chosen).
pub(crate) const WINDOW: u32 = 58;

struct Side {
    whiskers: Vec<(Vibrissa, TouchingWhisker)>,
    imp: Imp,
    /// Low-passed deflection, 0 to 1, and IMP of each vibrissa.
    bent: [f32; VIBRISSAE],
    power: [f32; VIBRISSAE],
}

pub(crate) struct Pads {
    sides: [Side; 2],
    /// Of the low-pass filters, a tick and a window.
    keep: f32,
    keep_window: f32,
}

#[derive(Default)]
pub(crate) struct Felt {
    /// D of the left and the right (PSIK eq. 1), mm.
    pub(crate) distance_mm: [f64; 2],
    /// x and y of one vibrissa of the left pad, codes.
    pub(crate) one: [f32; 2],
    /// The smoothed IMP of all vibrissae, where a window ends.
    pub(crate) window: Option<Vec<f32>>,
}

impl Pads {
    pub(crate) fn new(rig: &Corridor, seeds: [u64; 2]) -> Result<Self> {
        let side = |seed| {
            anyhow::Ok(Side {
                whiskers: whiskers::pad(&rig.layout, (rig.full_scale_rad, rig.follicle), seed)?,
                imp: Imp::new(WINDOW),
                bent: [0.0; VIBRISSAE],
                power: [0.0; VIBRISSAE],
            })
        };
        let [left, right] = seeds;
        let dt_s = 1.0 / RATE_HZ;
        Ok(Self {
            sides: [side(left)?, side(right)?],
            keep: libm::exp(-dt_s / rig.smooth_s) as f32,
            keep_window: libm::exp(-f64::from(WINDOW) * dt_s / rig.smooth_s) as f32,
        })
    }

    /// A tick: `wall` says what a vibrissa of a side (0: left) may touch, by its pose.
    pub(crate) fn step(
        &mut self,
        robot: &Robot,
        wall: impl Fn(usize, &Pose) -> Option<Plate>,
    ) -> Felt {
        let mut felt = Felt::default();
        let (keep, keep_window) = (self.keep, self.keep_window);
        for (number, side) in self.sides.iter_mut().enumerate() {
            let mut codes = [[0; 2]; VIBRISSAE];
            let all = side.whiskers.iter_mut().zip(&mut codes).zip(&mut side.bent);
            for (((vibrissa, whisker), code), bent) in all {
                let pose = Corridor::pose(robot, number, vibrissa);
                let plate = wall(number, &pose);
                whisker.step(&pose, plate.as_ref(), 1.0 / RATE_HZ);
                *code = pad::codes(whisker.reading(), BITS);
                let [x, y] = code.map(f32::from);
                // A deflection of both axes at their ends counts as 1.
                let deflection = (x.hypot(y) / 127.0).min(1.0);
                *bent = keep * *bent + (1.0 - keep) * deflection;
            }
            if number == 0 {
                felt.one = pad::widened(codes[pad::ONE], BITS);
            }
            felt.distance_mm[number] = distance_mm(&side.bent);
            if let Some(window) = side.imp.push(&codes) {
                for (power, imp) in side.power.iter_mut().zip(window) {
                    let imp = imp as f32 / 65_536.0;
                    *power = keep_window * *power + (1.0 - keep_window) * imp;
                }
                felt.window.get_or_insert_default().extend(side.power);
            }
        }
        felt
    }
}

/// The distance of what a pad touches, D = (1/N) Σ_i (1 − V_i) L_i (PSIK eq. 1), mm: V_i is the
/// mean of an arc over `bent`, the deflection of each vibrissa, arc by arc, 0 to 1.
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

#[cfg(test)]
mod tests {
    use physics::vector::{add, cross, dot};

    use super::{Corridor, Robot, VIBRISSAE, distance_mm};
    use crate::rigs::Rigs;

    fn rig() -> Corridor {
        Rigs::with(&[]).corridor
    }

    const MIDDLE: Robot = Robot {
        neck_m: [0.0, 0.0],
        heading: 0.0,
    };

    #[test]
    fn more_room_on_the_left_steers_left_at_the_stated_rate() {
        let rig = rig();
        let mut robot = MIDDLE;
        rig.drive(&mut robot, 101.0, 100.0, 0.01);
        let across = 0.01 * 1.0;
        assert!((robot.neck_m[1] - across * 0.01).abs() < 1e-15, "{robot:?}");
        assert!((robot.neck_m[0] - rig.speed_m_s * 0.01).abs() < 1e-15);
        assert!((robot.heading - across / rig.axle_m * 0.01).abs() < 1e-15);
    }

    /// PSIK section 3.3.1: in a corridor the two longer arcs touch.
    #[test]
    fn in_the_middle_just_the_two_longer_arcs_reach_the_walls() {
        let rig = rig();
        for side in [0, 1] {
            for vibrissa in rig.layout.vibrissae() {
                let pose = Corridor::pose(&MIDDLE, side, &vibrissa);
                let shaft = cross(pose.x, pose.y);
                assert!((dot(shaft, shaft) - 1.0).abs() < 1e-12);
                let tip = add(pose.base_m, vibrissa.length_m, shaft);
                let beyond = if side == 0 { tip[1] } else { -tip[1] } - rig.width_m / 2.0;
                assert_eq!(beyond > 0.0, vibrissa.arc < 2, "{vibrissa:?} {beyond}");
                let base = pose.base_m[1].abs();
                assert!(base < rig.width_m / 2.0 - rig.slack_m);
            }
        }
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
