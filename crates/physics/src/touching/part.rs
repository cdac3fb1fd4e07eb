//! One part of a step in contact: where the foot goes.
//!
//! Glossary:
//!
//! - *modal tip*: where the modes that are kept bring the tip;
//! - *stretch*: of what has no inertia here, shaft and ground in series;
//! - *foot*: where the tip stands on the ground, the modal tip less the stretch.
//!
//! A foot that slides moves along a plane through the grounds at both ends of
//! its way, so that the plane leads as high as the ground does. The far end is
//! found by rounds: the force on a plane ([`super::law`]), where it brings the
//! foot, the plane to there. Steep ground throws the foot about from round to
//! round; it is then moved by a share of that only (Aitken's, for vectors: Irons
//! and Tuck 1969).
//!
//! # Energy on any ground
//!
//! The stretch's energy does not depend on how the ground slopes, and takes no
//! more than the force works ([`super::law`]). Where rounds have not quite found
//! the end, the foot is off the ground. It is brought there as far as the part
//! has dissipated the energy for it, and the rest waits for later parts. So at the
//! end of a part
//!
//! modes + stretch ≤ modes + stretch before + work of the base,
//!
//! whatever surface, stiffness, speed and step.

use super::TouchingWhisker;
use super::ground::secant;
use super::law::{Part, Solved, kept};
use super::spring::Give;
use crate::contact::Frame;
use crate::pose::Seen;
use crate::vector::{V3, dot, length2, scale, sub};

/// Rounds by which the end of a part is found, at most; mostly one.
const ROUNDS: usize = 8;

/// They are enough once the foot moves by less than this share of the distance
/// of the finest octave, and the way of the tip turns by less than this, rad.
const NEAR: f64 = 0.1;
const NEAR_RAD: f64 = 1e-4;

/// Smallest share of a round.
const LEAST: f64 = 0.05;

/// What the tip and the plate are to each other.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Touch {
    /// Stretch along the whisker's axes x, y and z, m.
    pub(super) stretch: V3,
    /// Its energy, J.
    pub(super) spring_j: f64,
    /// Its force on the axes x and y, N.
    pub(super) pull: [f64; 2],
    /// Force on the tip, the mean of the part, plate coordinates, N.
    pub(super) force: V3,
    /// Its normal component; positive: in contact.
    pub(super) normal_n: f64,
    pub(super) stuck: bool,
    /// Speed at which it slides, m/s.
    pub(super) slip_m_s: f64,
    /// Height and slopes under the foot, if known.
    pub(super) ground: Option<[f64; 3]>,
    /// How much lower than it is the ground counts, m.
    pub(super) lowered_m: f64,
}

impl Touch {
    /// A foot in the air with a stretch.
    fn of(give: &Give, stretch: V3) -> Self {
        let force = give.force(stretch);
        Self {
            stretch,
            spring_j: -0.5 * dot(force, stretch),
            pull: [force[0], force[1]],
            ..Self::default()
        }
    }
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
        let give = self.shape.give(1.0 / self.relief.0.stiffness_n_m);
        let touching = self.contact();
        let stretch = new.space(self.touch.stretch);
        let mut end = free;
        let (mut to, mut below);
        if touching {
            // Forces change little from part to part.
            let push = |way: V3| reach.response * dot(way, self.touch.force);
            end = [end[0] + push(new.x), end[1] + push(new.y)];
            to = sub(self.shape.tip(end, new), stretch);
            below = None;
        } else {
            let keep = kept(self.share(reach, part_s, &give, 1.0));
            to = sub(self.shape.tip(free, new), scale(keep, stretch));
            let ground = self.relief.1.at([to[0], to[1]]);
            if to[2] >= ground[0] {
                let stretch = scale(keep, self.touch.stretch);
                self.touch = Touch::of(&give, stretch);
                self.touch.ground = Some(ground);
                return;
            }
            below = Some(ground);
        }
        let tip = self.shape.tip(start, old);
        let foot = sub(tip, old.space(self.touch.stretch));
        let here = || self.relief.1.at([foot[0], foot[1]]);
        let part = Part {
            new,
            reach,
            dt_s: part_s,
            give,
            touching,
            start,
            free,
            stretch,
            foot,
            ground: self.touch.ground.unwrap_or_else(here),
            carried: sub(sub(self.shape.tip(start, new), stretch), foot),
        };
        let near = NEAR * self.relief.1.finest_m;
        if touching && self.touch.stuck {
            to = foot;
        }
        let (mut missed, mut relax) = (None, 1.0);
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
                relax = relaxed(relax, old, miss);
            }
            if round == ROUNDS || (self.shape.turn(bend) < NEAR_RAD && moved < near) {
                self.state.push(reach, solved.pushed);
                self.touch = settled(&part, &solved, at(next), tip);
                if self.state.limit(&self.shape) {
                    self.touch.ground = None;
                }
                return;
            }
            to = [to[0] + relax * miss[0], to[1] + relax * miss[1], 0.0];
        }
    }
}

/// The share of the next round, from what two rounds with `share` between them
/// have missed by.
fn relaxed(share: f64, old: [f64; 2], new: [f64; 2]) -> f64 {
    let change = [new[0] - old[0], new[1] - old[1]];
    let square = change[0] * change[0] + change[1] * change[1];
    if square > 0.0 {
        let along = old[0] * change[0] + old[1] * change[1];
        (-share * along / square).clamp(LEAST, 1.0)
    } else {
        share
    }
}

/// Brings the foot to the ground, as far as there is the energy.
fn settled(part: &Part<'_>, solved: &Solved, ground: [f64; 3], tip: V3) -> Touch {
    let Solved { frame, .. } = solved;
    let foot = sub(tip, solved.stretch);
    // Straight up or down: the ground is known there.
    let deep = ground[0] - foot[2];
    let body = part.new.body(solved.stretch);
    let left_j = solved.left_j.max(0.0);
    // A foot in the air stays there.
    let normal_n = solved.force.local[0];
    let deep = if normal_n > 0.0 { deep } else { deep.max(0.0) };
    let up = part.new.body([0.0, 0.0, -deep]);
    let (stretch, paid) = part.give.within(left_j, body, up);
    Touch {
        force: frame.plate(solved.force.local),
        normal_n,
        stuck: solved.force.stuck,
        slip_m_s: solved.slipped_m / part.dt_s,
        ground: Some(ground),
        lowered_m: (1.0 - paid) * deep,
        ..Touch::of(&part.give, stretch)
    }
}
