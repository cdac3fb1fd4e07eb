//! One part of a step in contact: where the foot goes.
//!
//! Glossary:
//!
//! - *place*: of the shaft, which touches: where it runs along the mean plane at the end of
//!   the part, or the tip;
//! - *stretch*: of the massless spring, follicle and ground in series;
//! - *foot*: where the place stands on the ground, the place less the stretch.
//!
//! A foot that slides moves along a plane through the ground at both ends of its
//! path, so that the plane rises as far as the ground does. The far end is
//! found by iteration: the force on a plane ([`super::law`]), where it brings the
//! foot, the plane to there. Steep ground throws the foot about from round to
//! round; it is then moved by only a share of that (Aitken's method for vectors:
//! Irons and Tuck 1969).
//!
//! Beyond the place where an elastica is pressed on a plane it lies straight along it: its
//! lowest place is not defined, and where it runs along the plane depends on where it is
//! pressed. Both are found together by Newton's method, in the rounds of the same iteration.
//!
//! Heights are read where the shaft touches first, and from then on where the material that
//! touched has slid to: a shaft that lays itself along the plate bridges its grains, and feels
//! them only as it slides.
//!
//! Ways are those in the middle of the part: times a change of the amplitudes they are
//! the place's displacement but for the third order of the change. A round that changes the
//! middle by too much is repeated.
//!
//! # Energy on any ground
//!
//! The stretch's energy does not depend on how the ground slopes, and it gains no
//! more than the work of the force ([`super::law`]), which acts on the shapes by the
//! same ways as it is displaced by, whatever they are. Where the iteration has not
//! quite found the end, or another place now touches, the foot is off the ground. It is
//! brought there as far as the part has dissipated the energy for it, and the rest waits
//! for later parts. So at the end of a part
//!
//! shapes + stretch ≤ shapes + stretch before + work of the base,
//!
//! whatever surface, stiffness, speed and step.

use super::body::{Body, Touch};
use super::law::{Moves, Part, Solved};
use super::secant::secant;
use crate::contact::Frame;
use crate::modal::{ModalStep, pushed};
use crate::pose::PlatePose;
use crate::shapes::Amplitudes;
use crate::vector::{V3, add, dot, length, length2, scale, sub};

/// Most rounds of the iteration for the end of a part; mostly one or two.
const ROUNDS: usize = 8;

/// The iteration ends once the foot moves by less than this share of the distance
/// of the finest octave, and is off where ways bring it by less than this share of
/// what the force displaces it by.
const NEAR: f64 = 0.1;
const OFF: f64 = 1e-4;

/// The same for a place that moves along the shaft, as a share of the length.
const SHIFT: f64 = 1e-4;

/// As far as a place moves towards the base in a round at most, as a share of the length.
const MOST: f64 = 0.1;

/// Smallest share of a round.
const LEAST: f64 = 0.05;

impl Body {
    /// One part of a step, from one pose to the next.
    pub(super) fn part(&mut self, old: &PlatePose, new: &PlatePose, step: &ModalStep, part_s: f64) {
        let law = self.law(step, part_s);
        let share = law.share(1.0);
        let responses = step.responses(share);
        let touching = self.touch.is_contact();
        let start = self.state.x;
        let before = self.curve.take().unwrap_or_else(|| self.state.curve(&self.shaft));
        self.state.free(step);
        self.state.keep(if touching {
            1.0 - 1.0 / share
        } else {
            law.kept()
        });
        let free = self.state.x;
        let stretch = new.vector(self.touch.stretch);
        let up = new.up();
        let mut end = free;
        let (mut place, mut below);
        if touching {
            // Forces change little from part to part.
            end = pushed(&free, &responses, &self.touch.forces);
            place = self.shaft.grid.place(self.touch.next_m);
            below = None;
        } else {
            let bent = self.shaft.shapes.curve(&free);
            place = bent.lowest(&self.shaft.grid, up);
            let to = sub(new.place(bent.at(&place)), scale(law.kept(), stretch));
            let ground = self.ground.relief.at([to[0], to[1]]);
            if to[2] >= ground[0] {
                let stretch = scale(law.kept(), self.touch.stretch);
                self.touch = Touch::in_the_air(&law.compliance, stretch);
                self.curve = Some(bent);
                return;
            }
            below = Some((to, ground));
        }
        let mut part = Part {
            pose: new,
            dt_s: part_s,
            law,
            touching,
            friction: self.ground.surface.friction_at(self.touch.slip_m_s),
            start,
            free,
            responses,
            stretch,
            foot: [0.0; 3],
            ground: [0.0; 3],
            carried: [0.0; 3],
        };
        let near = NEAR * self.ground.relief.finest_m;
        let (mut missed, mut relax) = (None, 1.0);
        let mut to = None;
        for round in 1..=ROUNDS {
            let at = before.at(&place);
            let foot = sub(old.place(at), old.vector(self.touch.stretch));
            let rolled = if touching {
                let last = &self.touch;
                [0, 1].map(|i| last.rolled[i] + foot[i] - last.foot[i])
            } else {
                [0.0; 2]
            };
            let relief = &mut self.ground.relief;
            let mut ground_at = |at: V3| relief.at([at[0] - rolled[0], at[1] - rolled[1]]);
            part.foot = foot;
            part.ground = self.touch.ground.unwrap_or_else(|| ground_at(foot));
            part.carried = sub(sub(new.place(at), stretch), foot);
            let middle = self.shaft.shapes.curve(&between(&start, &end));
            let moves = Moves::new(self.shaft.shapes.ways(&middle, &place), &part);
            let (there, ground) = below.take().unwrap_or_else(|| {
                let there = to.unwrap_or_else(|| {
                    if self.touch.stuck {
                        foot
                    } else {
                        let moved = new.vector(moves.between(&start, &end));
                        add(add(foot, 1.0, part.carried), 1.0, moved)
                    }
                });
                (there, ground_at(there))
            });
            let way = [there[0], there[1]];
            let slopes = secant([foot[0], foot[1]], part.ground, way, ground);
            let solved = self.solve(&part, Frame::new(slopes), &moves);
            let force = new.components(solved.frame.plate(solved.force.local));
            let forces = moves.forces(force);
            end = pushed(&free, &responses, &forces);
            let straight = new.place(add(at, 1.0, moves.between(&start, &end)));
            let curve = self.shaft.shapes.curve(&end);
            let bent = new.place(curve.at(&place));
            let off = length(sub(bent, straight));
            let next = sub(bent, solved.stretch);
            let miss = [next[0] - there[0], next[1] - there[1]];
            let moved = length2(miss);
            if let Some(old) = missed.replace(miss) {
                relax = relaxed(relax, old, miss);
            }
            let small = OFF * step.response * length(force);
            let [rise, bend] = curve.rise(&place, up);
            let now_m = if place.at_m == self.shaft.length_m && rise <= 0.0 {
                place.at_m
            } else {
                let turns = self.shaft.shapes.turns(&curve, &place);
                let steep = bend + dot(force, up) * moves.turned(&turns, up, &responses);
                let shift = if steep > 0.0 { -rise / steep } else { 0.0 };
                place.at_m + shift.max(-MOST * self.shaft.length_m)
            };
            let shifted = (now_m.min(self.shaft.length_m) - place.at_m).abs();
            let still = round > 2 || shifted <= SHIFT * self.shaft.length_m;
            if round == ROUNDS || (off <= small && moved < near && still) {
                self.state.push(step, &responses, &forces);
                let ground = self.ground.relief.at([next[0] - rolled[0], next[1] - rolled[1]]);
                let went = place.at_m - self.touch.place.map_or(place.at_m, |last| last.at_m);
                self.touch = settled(&part, &solved, ground, next);
                self.touch.forces = forces;
                self.touch.next_m = now_m + went;
                self.touch.place = Some(place);
                self.touch.foot = next;
                self.touch.rolled = rolled;
                self.touch.ground = Some(ground);
                self.curve = Some(curve);
                if self.state.limit(&self.shaft) {
                    self.touch = Touch::default();
                    self.curve = None;
                }
                return;
            }
            if !still {
                place = self.shaft.grid.place(now_m);
                missed = None;
                to = None;
                continue;
            }
            to = Some([there[0] + relax * miss[0], there[1] + relax * miss[1], 0.0]);
        }
    }
}

/// Halfway between two states.
#[inline]
fn between(start: &Amplitudes, end: &Amplitudes) -> Amplitudes {
    core::array::from_fn(|k| [0, 1].map(|axis| 0.5 * start[k][axis] + 0.5 * end[k][axis]))
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
        lowered_m: (1.0 - paid) * deep,
        ..Touch::in_the_air(&part.law.compliance, stretch)
    }
}
