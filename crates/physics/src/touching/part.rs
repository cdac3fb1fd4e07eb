//! One part of a step in contact: where the foot goes.
//!
//! Glossary:
//!
//! - *modal tip*: where the modes that are kept bring the tip;
//! - *stretch*: of the massless spring, shaft and ground in series;
//! - *foot*: where the tip stands on the ground, the modal tip less the stretch.
//!
//! A foot that slides moves along a plane through the ground at both ends of its
//! path, so that the plane rises as far as the ground does. The far end is
//! found by iteration: the force on a plane ([`super::law`]), where it brings the
//! foot, the plane to there. Steep ground throws the foot about from round to
//! round; it is then moved by only a share of that (Aitken's method for vectors:
//! Irons and Tuck 1969).
//!
//! # Energy on any ground
//!
//! The stretch's energy does not depend on how the ground slopes, and it gains no
//! more than the work of the force ([`super::law`]). Where the iteration has not
//! quite found the end, the foot is off the ground. It is brought there as far as the part
//! has dissipated the energy for it, and the rest waits for later parts. So at the
//! end of a part
//!
//! modes + stretch ≤ modes + stretch before + work of the base,
//!
//! whatever surface, stiffness, speed and step.

use super::body::{Body, Touch};
use super::law::{Part, Solved};
use super::secant::secant;
use crate::contact::Frame;
use crate::modal::ModalStep;
use crate::pose::PlatePose;
use crate::vector::{V3, dot, length2, scale, sub};

/// Most rounds of the iteration for the end of a part; mostly one or two.
const ROUNDS: usize = 8;

/// The iteration ends once the foot moves by less than this share of the distance
/// of the finest octave, and the path of the tip turns by less than this, rad.
const NEAR: f64 = 0.1;
const NEAR_RAD: f64 = 1e-4;

/// Smallest share of a round.
const LEAST: f64 = 0.05;

impl Body {
    /// One part of a step, from one rigid tip to the next.
    pub(super) fn part(&mut self, old: &PlatePose, new: &PlatePose, step: &ModalStep, part_s: f64) {
        let start = self.shaft.deflections(&self.state);
        self.state.free(step);
        let free = self.shaft.deflections(&self.state);
        let law = self.law(step, part_s);
        let touching = self.touch.is_contact();
        let stretch = new.vector(self.touch.stretch);
        let mut end = free;
        let (mut to, mut below);
        if touching {
            // Forces change little from part to part.
            let push = |way: V3| step.response * dot(way, self.touch.force);
            end = [end[0] + push(new.x), end[1] + push(new.y)];
            to = sub(self.shaft.tip(end, new), stretch);
            below = None;
        } else {
            let keep = law.kept();
            to = sub(self.shaft.tip(free, new), scale(keep, stretch));
            let ground = self.ground.relief.at([to[0], to[1]]);
            if to[2] >= ground[0] {
                let stretch = scale(keep, self.touch.stretch);
                self.touch = Touch::in_the_air(&law.compliance, stretch);
                self.touch.ground = Some(ground);
                return;
            }
            below = Some(ground);
        }
        let shortened_m = self.shaft.shortened_m(start);
        let tip = old.tip(start, shortened_m);
        let foot = sub(tip, old.vector(self.touch.stretch));
        let known = self.touch.ground;
        let part = Part {
            pose: new,
            step,
            dt_s: part_s,
            law,
            touching,
            friction: self.ground.surface.friction_at(self.touch.slip_m_s),
            start,
            free,
            stretch,
            foot,
            ground: known.unwrap_or_else(|| self.ground.relief.at([foot[0], foot[1]])),
            carried: sub(sub(new.tip(start, shortened_m), stretch), foot),
        };
        let near = NEAR * self.ground.relief.finest_m;
        if touching && self.touch.stuck {
            to = foot;
        }
        let (mut missed, mut relax) = (None, 1.0);
        for round in 1..=ROUNDS {
            let ground = match below.take() {
                Some(ground) => ground,
                None => self.ground.relief.at([to[0], to[1]]),
            };
            let slopes = secant([foot[0], foot[1]], part.ground, [to[0], to[1]], ground);
            let solved = self.solve(&part, Frame::new(slopes), end);
            let next = [0, 1].map(|i| free[i] + step.response * solved.pushed[i]);
            let bend = length2([next[0] - end[0], next[1] - end[1]]);
            end = next;
            let tip = self.shaft.tip(end, new);
            let next = sub(tip, solved.stretch);
            let miss = [next[0] - to[0], next[1] - to[1]];
            let moved = length2(miss);
            if let Some(old) = missed.replace(miss) {
                relax = relaxed(relax, old, miss);
            }
            if round == ROUNDS || (self.shaft.turn(bend) < NEAR_RAD && moved < near) {
                self.state.push(step, solved.pushed);
                let ground = self.ground.relief.at([next[0], next[1]]);
                self.touch = settled(&part, &solved, ground, next);
                if self.state.limit(&self.shaft) {
                    self.touch.ground = None;
                }
                return;
            }
            to = [to[0] + relax * miss[0], to[1] + relax * miss[1], 0.0];
        }
    }
}

/// The share of the next round, from the misses of two rounds with `share`
/// between them.
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

/// Brings the foot to the ground, as far as the energy allows.
fn settled(part: &Part<'_>, solved: &Solved, ground: [f64; 3], foot: V3) -> Touch {
    let Solved { frame, force, .. } = solved;
    // Straight up or down: the ground is known there.
    let deep = ground[0] - foot[2];
    let body = part.pose.components(solved.stretch);
    let left_j = solved.left_j.max(0.0);
    // A foot in the air stays there.
    let normal_n = force.local[0];
    let deep = if normal_n > 0.0 { deep } else { deep.max(0.0) };
    let up = part.pose.components([0.0, 0.0, -deep]);
    let (stretch, paid) = part.law.compliance.within(left_j, body, up);
    Touch {
        force: frame.plate(force.local),
        normal_n,
        stuck: force.stuck,
        slip_m_s: solved.problem.slipped(force) / part.dt_s,
        ground: Some(ground),
        lowered_m: (1.0 - paid) * deep,
        ..Touch::in_the_air(&part.law.compliance, stretch)
    }
}
