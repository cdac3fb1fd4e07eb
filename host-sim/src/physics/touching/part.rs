//! One part of a step in contact: force, friction, damping.

use super::TouchingWhisker;
use crate::physics::contact::{Force, Frame, Problem};
use crate::physics::pose::Seen;
use crate::physics::vector::{V3, add, dot, length2, scale, sub};

/// Speed by which friction has gone 63 % of the way from resting to sliding, m/s
/// (Stribeck; of the order of what is measured on plastics). A tip that is held
/// across the shaft creeps along it, as the bend draws it back.
const CREEP_M_S: f64 = 1e-3;

/// Rounds by which the bend at the end of a part is found.
const BENDS: usize = 4;

/// What the tip and the plate are to each other.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Touch {
    /// Stretch of the tangential spring, plate coordinates, m.
    pub(super) stretch: V3,
    /// Force on the tip, plate coordinates, N.
    pub(super) force: V3,
    /// Its normal component; positive: in contact.
    pub(super) normal_n: f64,
    pub(super) stuck: bool,
    /// Speed at which it slides, m/s.
    pub(super) slip_m_s: f64,
    /// Energy of the springs, J.
    pub(super) energy_j: f64,
}

impl TouchingWhisker {
    /// One part of a step, from one rigid tip to the next.
    pub(super) fn part(&mut self, old: &Seen, new: &Seen, power: usize, part_s: f64) {
        let Some(reach) = self.reach.1.get(power) else {
            return;
        };
        let start = self.shape.deflections(&self.state);
        let from = self.shape.tip(&self.state, old);
        self.state.free(reach);
        let to = self.shape.tip(&self.state, new);
        let [height, p, q] = self.relief.1.at([to[0], to[1]]);
        let frame = Frame::new([p, q]);
        let gap = (to[2] - height) * frame.upright;
        if gap >= 0.0 {
            self.touch = Touch::default();
            return;
        }
        let along = dot(frame.axes[0], new.z).powi(2);
        let surface = &self.relief.0;
        let springs = self.shape.springs(1.0 / surface.stiffness_n_m, along);
        // Of the stretch before, what the tip's way adds, from where it touched
        // down if it did so on the way.
        let moved = sub(to, from);
        let trial = if self.touch.normal_n > 0.0 {
            add(self.touch.stretch, 1.0, moved)
        } else {
            let fall = -dot(frame.axes[0], moved);
            let late = if fall > 0.0 {
                (-gap / fall).min(1.0)
            } else {
                0.0
            };
            scale(late, moved)
        };
        let sliding = if self.touch.normal_n > 0.0 {
            self.touch.slip_m_s
        } else {
            let [_, a, b] = frame.local(moved);
            length2([a, b]) / part_s
        };
        let friction =
            surface.friction + (surface.hold - surface.friction) * libm::exp(-sliding / CREEP_M_S);
        let free = self.shape.deflections(&self.state);
        let mut end = free;
        let mut solved = ([[0.0; 3]; 2], Force::default(), 0.0);
        for _ in 0..BENDS {
            // Between the deflections at the begin and the end, the tip's way
            // and the work on it are exact in spite of the shortening.
            let ways = self
                .shape
                .ways([0, 1].map(|i| f64::midpoint(start[i], end[i])), new);
            let local = ways.map(|way| frame.local(way));
            let back = self.shape.behind(start, free, end);
            let fix = frame.local(scale(back, new.z));
            let [_, a, b] = frame.local(trial);
            let response = |i: usize, j: usize| {
                reach.response * (local[0][i] * local[0][j] + local[1][i] * local[1][j])
            };
            let problem = Problem {
                gap: gap + fix[0],
                stretch: [a + fix[1], b + fix[2]],
                response: core::array::from_fn(|i| core::array::from_fn(|j| response(i, j))),
                springs,
                friction,
            };
            let force = problem.solve();
            let pushed = local.map(|way| way_force(way, force.local));
            solved = (local, force, problem.slipped(&force));
            let next = [0, 1].map(|i| free[i] + reach.response * pushed[i]);
            let change = length2([next[0] - end[0], next[1] - end[1]]);
            end = next;
            if self.shape.turn(change) < 1e-4 {
                break;
            }
        }
        let (
            local,
            Force {
                local: force,
                stuck,
            },
            slipped,
        ) = solved;
        self.state
            .push(reach, local.map(|way| way_force(way, force)));
        self.state.limit(&self.shape);
        let [n, a, b] = force;
        self.touch = Touch {
            stretch: frame.plate([0.0, -springs[1] * a, -springs[1] * b]),
            force: frame.plate(force),
            normal_n: n,
            stuck,
            slip_m_s: slipped / part_s,
            energy_j: 0.5 * (springs[0] * n * n + springs[1] * (a * a + b * b)),
        };
        let carried = scale(1.0 / part_s, sub(new.tip, old.tip));
        let damp = Damp {
            local,
            carried: frame.local(carried),
            force,
            springs,
            part_s,
        };
        self.damp(&damp, stuck);
    }

    /// Takes the contact's share of the tip's velocity against the ground.
    fn damp(&mut self, contact: &Damp, stuck: bool) {
        let surface = self.relief.0;
        let inertia = self.shape.mobility;
        let spring = contact.springs[0];
        let own = |axis: usize| {
            let square = contact.local[0][axis].powi(2) + contact.local[1][axis].powi(2);
            inertia * square
        };
        let rate = 2.0 * surface.damping * (own(0) / spring).sqrt();
        let share = -libm::expm1(-rate * contact.part_s);
        let impulse = contact.force.map(|f| f * contact.part_s);
        let mut normal = impulse[0];
        for axis in 0..if stuck { 3 } else { 1 } {
            let velocity = self.state.velocity(&self.shape);
            let speed = contact.carried[axis]
                + velocity[0] * contact.local[0][axis]
                + velocity[1] * contact.local[1][axis];
            let massless = contact.springs[axis.min(1)] / (contact.part_s * contact.part_s);
            let mut kick = -share * speed / (own(axis) + massless);
            if axis == 0 {
                kick = kick.max(-impulse[0]);
                normal += kick;
            } else {
                // Half of the cone for each tangent keeps the sum within it.
                let room = (surface.hold * normal * core::f64::consts::FRAC_1_SQRT_2
                    - impulse[axis].abs())
                .max(0.0);
                kick = kick.clamp(-room, room);
            }
            let kicks = contact.local.map(|way| kick * way[axis]);
            self.state.strike(&self.shape, kicks);
        }
    }
}

/// A contact after its force was applied, in its frame.
struct Damp {
    /// Motion of the tip for deflections in x and y.
    local: [[f64; 3]; 2],
    /// Velocity of the rigid tip.
    carried: [f64; 3],
    force: [f64; 3],
    springs: [f64; 2],
    part_s: f64,
}

/// Force on an axis whose way has these components in the contact's frame.
#[inline]
fn way_force(way: [f64; 3], force: [f64; 3]) -> f64 {
    way[0] * force[0] + way[1] * force[1] + way[2] * force[2]
}
