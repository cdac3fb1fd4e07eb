//! The corridor of Psikharpax: a robot with a pad of vibrissae on either side
//! drives between two textured walls and keeps to the middle by touch.
//!
//! Frame of the corridor: x along it, y to the left, z up; its walls at
//! y = ± half the width. The robot is steered at its neck: a speed vector
//! (V_x, V_y) there, V_y = (D_left − D_right) · 0.01 (PSIK eq. 2), turns the
//! robot about the axle behind the neck. D in millimetres and V in m/s:
//! chosen, as the paper gives no units.

use super::pad::{Layout, Vibrissa};
use super::read::keys;
use crate::rigs::frame::{panned, turn};
use physics::Pose;

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
    pub(crate) fn drive(&self, robot: &mut Robot, left_mm: f64, right_mm: f64, dt_s: f64) {
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
        let x = if side == 0 {
            x
        } else {
            mirrored(x).map(|part| -part)
        };
        let (base_m, y) = (mirrored(base_m), mirrored(y));
        let mut pose = panned(&Pose { base_m, x, y }, robot.heading);
        pose.base_m[0] += robot.neck_m[0];
        pose.base_m[1] += robot.neck_m[1];
        pose
    }
}

#[cfg(test)]
mod tests {
    use super::{Corridor, Robot};
    use crate::rigs::Rigs;
    use physics::vector::{add, cross, dot};

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
                assert_eq!(
                    beyond > 0.0,
                    vibrissa.arc < 2,
                    "{side} {vibrissa:?} {beyond}"
                );
                let base = pose.base_m[1].abs();
                assert!(base < rig.width_m / 2.0 - rig.slack_m);
            }
        }
    }
}
