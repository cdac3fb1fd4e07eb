//! One part of a step in contact: where the ground is, force, friction.
//!
//! Glossary:
//!
//! - *modal tip*: where the modes that are kept bring the tip;
//! - *foot*: where the tip stands: the modal tip, less
//! - *stretch* ξ: of what has no inertia here, shaft and ground in series;
//! - *give* C: ξ = −C F, transverse to the shaft and along it, m/N.
//!
//! # The law of a part
//!
//! The force is constant during a part and is that of the stretches at its two
//! ends, weighed, and of a damper beside the spring:
//!
//! −C F = w ξ₁ + (1 − w) ξ₀ + τ (ξ₁ − ξ₀)/dt
//!
//! w is ½, which is of second order, where parts resolve the ringing of the tip
//! on its stretch, and nears 1 where they do not. The foot is held by the ground,
//! slides on it or is lifted ([`crate::physics::contact`]).
//!
//! # Energy on any ground
//!
//! The spring's energy is that of its stretch, whichever way the ground slopes,
//! and as w ≥ ½ it takes no more than the force works. A foot that slides moves
//! along a plane through the grounds at both ends of its way (found by rounds),
//! so that the plane is as high as the ground there. Where rounds have not found
//! it, the foot is off the ground a little. It is brought there as far as the
//! part has dissipated the energy for it, and the rest waits for later parts. So
//! at the end of a part
//!
//! modes + spring ≤ modes + spring before + work of the base,
//!
//! whatever surface, stiffness, speed and step.

use super::TouchingWhisker;
use super::ground::secant;
use super::spring::Give;
use crate::physics::contact::{Force, Frame, Problem};
use crate::physics::pose::Seen;
use crate::physics::state::Reach;
use crate::physics::vector::{V3, dot, length2, sub};

/// Speed by which friction has gone 63 % of the way from resting to sliding, m/s
/// (Stribeck; of the order of what is measured on plastics). A tip that is held
/// across the shaft creeps along it, as the bend draws it back.
const CREEP_M_S: f64 = 1e-3;

/// Rounds by which the end of a part is found, at most.
const ROUNDS: usize = 8;

/// They are enough once the foot moves by less than this share of the distance
/// of the finest octave.
const NEAR: f64 = 0.1;

/// What the tip and the plate are to each other.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Touch {
    /// Stretch along the whisker's axes x, y and z, m.
    pub(super) stretch: V3,
    /// Its energy, J; positive: in contact.
    pub(super) spring_j: f64,
    /// Force on the tip, plate coordinates, N.
    pub(super) force: V3,
    /// Its normal component.
    pub(super) normal_n: f64,
    pub(super) stuck: bool,
    /// Speed at which it slides, m/s.
    pub(super) slip_m_s: f64,
    /// Height and slopes under the foot, if known.
    pub(super) ground: Option<[f64; 3]>,
    /// How much lower than it is the ground counts, m.
    pub(super) lowered_m: f64,
}

/// A part without its force.
struct Part<'a> {
    new: &'a Seen,
    reach: &'a Reach,
    part_s: f64,
    give: Give,
    touching: bool,
    /// Deflections at the begin, and at the end without a force.
    start: [f64; 2],
    free: [f64; 2],
    /// Stretch at the begin, turned with the base.
    stretch: V3,
    /// The foot at the begin and the ground there.
    foot: V3,
    ground: [f64; 3],
    /// How the base carries the modal tip away from the foot.
    carried: V3,
}

/// A part with a force on a plane.
#[derive(Clone, Copy)]
struct Solved {
    frame: Frame,
    force: Force,
    /// The force on the axes x and y, N.
    pushed: [f64; 2],
    /// At the end, plate coordinates, m.
    stretch: V3,
    slipped_m: f64,
    /// Energy of the spring at the begin less the work on the tip, J.
    left_j: f64,
}

impl TouchingWhisker {
    /// One part of a step, from one rigid tip to the next.
    pub(super) fn part(&mut self, old: &Seen, new: &Seen, power: usize, part_s: f64) {
        let Some(reach) = self.reach.1.get(power) else {
            return;
        };
        let start = self.shape.deflections(&self.state);
        self.state.free(reach);
        let free = self.shape.deflections(&self.state);
        let touching = self.touch.spring_j > 0.0;
        let mut end = free;
        let mut below = None;
        if touching {
            // Forces change little from part to part.
            let push = |way: V3| reach.response * dot(way, self.touch.force);
            end = [end[0] + push(new.x), end[1] + push(new.y)];
        } else {
            let to = self.shape.tip(free, new);
            let ground = self.relief.1.at([to[0], to[1]]);
            if to[2] >= ground[0] {
                self.touch = Touch::default();
                return;
            }
            below = Some(ground);
        }
        let tip = self.shape.tip(start, old);
        let foot = sub(tip, old.space(self.touch.stretch));
        let stretch = new.space(self.touch.stretch);
        let here = || self.relief.1.at([foot[0], foot[1]]);
        let part = Part {
            new,
            reach,
            part_s,
            give: self.shape.give(1.0 / self.relief.0.stiffness_n_m),
            touching,
            start,
            free,
            stretch,
            foot,
            ground: self.touch.ground.unwrap_or_else(here),
            carried: sub(sub(self.shape.tip(start, new), stretch), foot),
        };
        let near = NEAR * self.relief.1.finest_m;
        let mut to = if touching && self.touch.stuck {
            foot
        } else {
            sub(self.shape.tip(end, new), stretch)
        };
        let (mut missed, mut relax) = (None::<[f64; 2]>, 1.0_f64);
        for round in 1..=ROUNDS {
            let at = |to: V3| self.relief.1.at([to[0], to[1]]);
            let ground = below.take().unwrap_or_else(|| at(to));
            let slopes = secant([foot[0], foot[1]], part.ground, [to[0], to[1]], ground);
            let solved = self.solve(&part, Frame::new(slopes), end);
            let next = [0, 1].map(|i| free[i] + reach.response * solved.pushed[i]);
            let bend = length2([next[0] - end[0], next[1] - end[1]]);
            end = next;
            let tip = self.shape.tip(end, new);
            let next = sub(tip, solved.stretch);
            let miss = [next[0] - to[0], next[1] - to[1]];
            let moved = length2(miss);
            if let Some(old) = missed.replace(miss) {
                let change = [miss[0] - old[0], miss[1] - old[1]];
                let square = change[0] * change[0] + change[1] * change[1];
                if square > 0.0 {
                    let along = old[0] * change[0] + old[1] * change[1];
                    relax = (-relax * along / square).clamp(0.05, 1.0);
                }
            }
            if round == ROUNDS || (self.shape.turn(bend) < 1e-4 && moved < near) {
                self.state.push(reach, solved.pushed);
                self.touch = settled(&part, &solved, at(next), tip);
                self.state.limit(&self.shape);
                return;
            }
            to = [to[0] + relax * miss[0], to[1] + relax * miss[1], 0.0];
        }
    }

    /// The force on a plane, for deflections at the end of about `end`.
    fn solve(&self, part: &Part<'_>, frame: Frame, end: [f64; 2]) -> Solved {
        let surface = &self.relief.0;
        let middle = [0, 1].map(|i| f64::midpoint(part.start[i], end[i]));
        let ways = self.shape.ways(middle, part.new);
        let local = ways.map(|way| frame.local(way));
        let [u, v] = [0, 1].map(|i| part.free[i] - part.start[i]);
        // The tip's way without a force.
        let carried = frame.local(part.carried);
        let moved: V3 = core::array::from_fn(|i| carried[i] + u * local[0][i] + v * local[1][i]);
        let begin = frame.local(part.stretch);
        let above = if part.touching {
            0.0
        } else {
            ((part.foot[2] - part.ground[0]) * frame.upright).max(0.0)
        };
        // The share of the part after it touches down.
        let late = if moved[0] < 0.0 {
            (1.0 + above / moved[0]).clamp(1e-9, 1.0)
        } else {
            1.0
        };
        let weight = part.give.weight(part.reach.response);
        let lag = part.give.lag_s(surface.damping, self.shape.mobility);
        let share = late * weight + lag / part.part_s;
        let sliding = if part.touching {
            self.touch.slip_m_s
        } else {
            length2([moved[1], moved[2]]) / part.part_s
        };
        let along = frame.local(part.new.z);
        let response = |i: usize, j: usize| {
            part.reach.response * (local[0][i] * local[0][j] + local[1][i] * local[1][j])
        };
        let least = part.give.least();
        let more = |i: usize, j: usize| (part.give.at(along, i, j) - if i == j { least } else { 0.0 }) / share;
        let mut problem = Problem {
            gap: above + begin[0] / share + moved[0],
            stretch: [1, 2].map(|i| begin[i] / share + late * moved[i]),
            response: core::array::from_fn(|i| core::array::from_fn(|j| response(i, j) + more(i, j))),
            springs: [least / share; 2],
            friction: surface.friction
                + (surface.hold - surface.friction) * libm::exp(-sliding / CREEP_M_S),
            near: [1, 2].map(|i| dot(frame.axes[i], self.touch.force)),
        };
        let on_axes = |force: &Force| local.map(|way| dot(way, force.local));
        let left = |force: &Force| {
            let pushed = on_axes(force);
            let shaft = part.reach.response * (pushed[0] * pushed[0] + pushed[1] * pushed[1]);
            self.touch.spring_j - dot(force.local, moved) - shaft
        };
        let mut force = problem.solve();
        let mut left_j = left(&force);
        if left_j < 0.0 {
            // What slides before it touches down can do this; without friction,
            // nothing does.
            problem.friction = 0.0;
            force = problem.solve();
            left_j = left(&force);
        }
        let stretch = if force.local[0] > 0.0 {
            core::array::from_fn(|i| {
                let given: f64 = (0..3).map(|j| part.give.at(along, i, j) * force.local[j]).sum();
                begin[i] - (begin[i] + given) / share
            })
        } else {
            // The damper holds it back: pressed in, and not pressing.
            [(begin[0] + above + moved[0]).min(0.0), 0.0, 0.0]
        };
        Solved {
            frame,
            force,
            pushed: on_axes(&force),
            stretch: frame.plate(stretch),
            slipped_m: problem.slipped(&force),
            left_j,
        }
    }
}

/// Brings the foot to the ground, as far as there is the energy.
fn settled(part: &Part<'_>, solved: &Solved, ground: [f64; 3], tip: V3) -> Touch {
    let Solved { frame, .. } = solved;
    let foot = sub(tip, solved.stretch);
    // Straight up or down: the ground is known there.
    let deep = ground[0] - foot[2];
    let body = part.new.body(solved.stretch);
    let normal = part.new.body(frame.axes[0]);
    let left_j = solved.left_j.max(0.0);
    let (stretch, paid) = part.give.within(left_j, body, part.new.body([0.0, 0.0, -deep]));
    if dot(stretch, normal) >= 0.0 {
        return Touch::default();
    }
    let force = part.give.force(stretch);
    Touch {
        stretch,
        spring_j: -0.5 * dot(force, stretch),
        force: part.new.space(force),
        normal_n: dot(force, normal).max(0.0),
        stuck: solved.force.stuck,
        slip_m_s: solved.slipped_m / part.part_s,
        ground: Some(ground),
        lowered_m: (1.0 - paid) * deep,
    }
}
