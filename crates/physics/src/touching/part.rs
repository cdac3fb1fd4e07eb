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
//! Heights are read where the shaft touches first, and from then on where it has slid to. A
//! shaft that lays itself along the plate bridges its grains; one that slides lengthwise keeps
//! its place in space, and so the grains that it lies on: both change no height. Away from the tip
//! only what it slides sideways counts, and its side has no slope lengthwise. So it comes to feel
//! another place of the ground than it is over; one that leaves the ground goes on so until it is
//! above what it is over too, or else it would be thrown out of a grain.
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
use super::second::{DEEP, sum};
use crate::contact::Frame;
use crate::grid::Place;
use crate::modal::{ModalStep, pushed};
use crate::outline::Tangent;
use crate::pose::PlatePose;
use crate::shapes::{Amplitudes, Angles, Curve};
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

/// Another place takes over where it is lower by more than this share of the length: where a
/// shaft lies straight along the plate, its shapes bring it near to straight.
const DEEPER: f64 = 2e-2;

/// As far as a place moves towards the base in a round at most, as a share of the length.
const MOST: f64 = 0.1;

/// Smallest share of a round.
const LEAST: f64 = 0.05;

/// A place of the ground, with its height and slopes.
type Known = (V3, [f64; 3]);

/// What a round has found.
struct Round {
    /// Which place of the ground the foot feels at the end.
    felt: [f64; 2],
    /// Where the foot was expected, where it is, and how far that is apart on ground that it feels.
    there: V3,
    next: V3,
    miss: [f64; 2],
    /// How far the place is off where its ways bring it, m.
    off_m: f64,
    /// Where on the shaft it would rather be, m from the base.
    better_m: f64,
    solved: Solved,
    /// The force along x, y and z, and on each shape.
    force: V3,
    forces: Amplitudes,
    /// The state at the end.
    end: Amplitudes,
    curve: Curve,
}

/// Where a contact has been found, and how it ends: what the last round has found of it.
#[derive(Clone)]
pub(super) struct Found {
    pub(super) place: Place,
    felt: [f64; 2],
    better_m: f64,
    pub(super) next: V3,
    pub(super) solved: Solved,
    pub(super) force: V3,
    pub(super) forces: Amplitudes,
    pub(super) end: Amplitudes,
}

impl Body {
    /// One part of a step, from one pose to the next.
    pub(super) fn part(&mut self, old: &PlatePose, new: &PlatePose, step: &ModalStep, part_s: f64) {
        let before = self.curve.take();
        let before = before.unwrap_or_else(|| self.state.curve(&self.shaft));
        self.join();
        let tangent = self.tangent(&before, old);
        let seen = tangent.map(|tangent| [tangent.see(old), tangent.see(new)]);
        let poses = seen.as_ref().map_or([old, new], |[old, new]| [old, new]);
        let mut part = self.free_part(&before, tangent, poses, step, part_s);
        let (place, ground, end);
        if part.touching {
            // Forces change little from part to part.
            let forces = sum(&self.touch.forces, &self.other.forces);
            end = pushed(&part.free, &part.responses, &forces);
            place = self.expected(part.before, new);
            ground = None;
        } else {
            let Some(touched) = self.touched(&part, new) else {
                return;
            };
            end = part.free;
            (place, ground) = (touched.0, Some(touched.1));
        }
        let mut first = self.find(&mut part, place, end, ground);
        let mut forces = first.forces;
        if !self.is_alone(new, &first) {
            if let Some(both) = self.both([old, new], &mut part, &first) {
                forces = sum(&both.0.forces, &both.1);
                first = both.0;
            } else {
                self.other = Touch::default();
            }
        }
        self.state.push(step, &part.responses, &forces);
        self.settle(&part, &first);
        if self.other.is_contact() && !self.touch.is_contact() {
            self.touch = core::mem::take(&mut self.other);
        }
        if !self.touch.is_contact() {
            // In the air static shapes spring back, and a force that follows starts there.
            self.state.keep(part.law.kept());
            self.curve = None;
        }
        if self.state.limit(&self.shaft) {
            self.touch = Touch::default();
            self.other = Touch::default();
            self.curve = None;
        }
    }

    /// The force at a place and where it brings the foot, by rounds from where the shapes end
    /// about. Keeps how the shaft is then bent.
    pub(super) fn find(
        &mut self,
        part: &mut Part<'_>,
        mut place: Place,
        mut end: Amplitudes,
        mut ground: Option<Known>,
    ) -> Found {
        let length_m = self.shaft.length_m;
        let near = NEAR * self.finest_m();
        let (mut missed, mut relax, mut to) = (None, 1.0, None);
        let mut n = 0;
        loop {
            n += 1;
            let round = self.round(part, &place, &end, to, ground.take());
            end = round.end;
            let miss = round.miss;
            if let Some(old) = missed.replace(miss) {
                relax = relaxed(relax, old, miss);
            }
            let small = OFF * part.response * length(round.force);
            let better_m = round.better_m;
            let still = n > 2 || (better_m.min(length_m) - place.at_m).abs() <= SHIFT * length_m;
            if n == ROUNDS || (round.off_m <= small && length2(miss) < near && still) {
                self.curve = Some(round.curve);
                return Found {
                    place,
                    felt: round.felt,
                    better_m,
                    next: round.next,
                    solved: round.solved,
                    force: round.force,
                    forces: round.forces,
                    end,
                };
            }
            if still {
                to = Some([0, 1].map(|i| round.there[i] + relax * miss[i]));
            } else {
                place = self.shaft.grid.place(better_m);
                (missed, to) = (None, None);
            }
        }
    }

    /// Moves on without a force, and says what is known of the part then.
    fn free_part<'a>(
        &mut self,
        before: &'a Curve,
        tangent: Option<Tangent>,
        [old, new]: [&'a PlatePose; 2],
        step: &ModalStep,
        part_s: f64,
    ) -> Part<'a> {
        let law = self.law(step, part_s);
        let share = law.share(1.0);
        let touching = self.touch.is_contact();
        let start = self.state.x;
        self.state.free(step);
        self.state.keep(if touching {
            1.0 - 1.0 / share
        } else {
            law.kept()
        });
        Part {
            old,
            pose: new,
            before,
            dt_s: part_s,
            touching,
            friction: self.ground.surface.friction_at(self.touch.slip_m_s),
            start,
            free: self.state.x,
            responses: step.responses(share),
            response: step.response,
            stretch: new.vector(self.touch.stretch),
            foot: [0.0; 3],
            ground: [0.0; 3],
            carried: [0.0; 3],
            tangent,
            law,
        }
    }

    /// Where a shaft that touches is expected to touch at the end of the part.
    pub(super) fn expected(&self, before: &Curve, pose: &PlatePose) -> Place {
        let place = self.shaft.grid.place(self.touch.next_m);
        let (nearest, tangent) = self.nearest(before, pose);
        let other = self.other.place.filter(|_| self.other.is_contact());
        let way_m = |place: &Place| (nearest.at_m - place.at_m).abs();
        if other.is_some_and(|other| way_m(&other) < way_m(&place)) {
            // The other's.
            return place;
        }
        let share = if other.is_some() { DEEP } else { DEEPER };
        let most = share * self.shaft.length_m;
        let (deeper, most) = match tangent {
            None => (before.deeper_m(&place, &nearest, pose.up()), most),
            Some(tangent) => {
                let here = self.outline.tangent(pose.place(before.at(&place)));
                (here.above_m - tangent.above_m, tangent.deeper_m(most))
            }
        };
        if deeper > most { nearest } else { place }
    }

    /// Where a shaft that was in the air is below the ground at the end of the part; if it is
    /// not, it stays in the air.
    fn touched(&mut self, part: &Part<'_>, pose: &PlatePose) -> Option<(Place, Known)> {
        let curve = self.shaft.shapes.curve(&part.free);
        let (place, _) = self.nearest(&curve, pose);
        let kept = part.law.kept();
        let to = sub(part.pose.place(curve.at(&place)), scale(kept, part.stretch));
        let below = [to[0], to[1]];
        let felt = self.touch.felt.map_or(below, |felt| {
            let foot = self.foot(part, part.before.at(&place));
            [0, 1].map(|i| felt[i] + to[i] - foot[i])
        });
        let ground = bowed(part.tangent.as_ref(), self.ground.relief.at(felt), to);
        if to[2] < ground[0] {
            return Some((place, (to, ground)));
        }
        let stretch = scale(kept, self.touch.stretch);
        let inside = to[2] < bowed(part.tangent.as_ref(), self.ground.relief.at(below), to)[0];
        self.touch = Touch {
            felt: inside.then_some(felt),
            ..Touch::in_the_air(&part.law.compliance, stretch)
        };
        self.curve = Some(curve);
        None
    }

    /// Where the foot is at the start of a part, of a place that is there from the base.
    #[inline]
    fn foot(&self, part: &Part<'_>, at: V3) -> V3 {
        sub(part.old.place(at), part.old.vector(self.touch.stretch))
    }

    /// One round: the force at a place, on a plane to where the foot is expected, for shapes
    /// that end about as they do in `end`.
    fn round(
        &mut self,
        part: &mut Part<'_>,
        place: &Place,
        end: &Amplitudes,
        to: Option<[f64; 2]>,
        known: Option<Known>,
    ) -> Round {
        let shapes = &self.shaft.shapes;
        let new = part.pose;
        let at = part.before.at(place);
        let foot = self.foot(part, at);
        let felt = self.touch.felt.unwrap_or([foot[0], foot[1]]);
        let middle = shapes.angles(&between(&part.start, end));
        let lengthwise = part.touching && place.at_m < self.shaft.length_m;
        let along = lengthwise.then(|| level(new.vector(middle.along(place))));
        let relief = &mut self.ground.relief;
        let tangent = part.tangent;
        let mut ground_at = |at: V3| {
            let [x, y] = aside(along, [at[0] - foot[0], at[1] - foot[1]]);
            bowed(tangent.as_ref(), relief.at([felt[0] + x, felt[1] + y]), at)
        };
        let kept = self
            .touch
            .ground
            .map(|ground| bowed(tangent.as_ref(), ground, foot));
        let ground = kept.unwrap_or_else(|| ground_at(foot));
        part.foot = foot;
        part.ground = ground;
        part.carried = sub(sub(new.place(at), part.stretch), foot);
        let moves = Moves::new(&shapes.ways(&middle, place), part);
        let (there, ground) = known.unwrap_or_else(|| {
            let there = match to {
                Some([x, y]) => [x, y, 0.0],
                None if self.touch.stuck => foot,
                None => {
                    let moved = new.vector(moves.between(&part.start, end));
                    add(add(foot, 1.0, part.carried), 1.0, moved)
                }
            };
            (there, ground_at(there))
        });
        let way = aside(along, [there[0] - foot[0], there[1] - foot[1]]);
        let slopes = aside(along, secant([0.0; 2], part.ground, way, ground));
        let solved = self.solve(part, Frame::new(slopes), &moves);
        let force = new.components(solved.frame.plate(solved.force.local));
        let forces = moves.forces(force);
        let end = pushed(&part.free, &part.responses, &forces);
        let straight = add(at, 1.0, moves.under(force));
        let angles = shapes.angles(&end);
        let curve = angles.curve();
        let bent = curve.at(place);
        let next = sub(new.place(bent), solved.stretch);
        let went = [0, 1].map(|i| next[i] - foot[i]);
        let slid = aside(along, went);
        Round {
            felt: [0, 1].map(|i| felt[i] + slid[i]),
            miss: aside(along, [0, 1].map(|i| next[i] - there[i])),
            there,
            next,
            off_m: length(sub(bent, straight)),
            better_m: self.better_m(part, place, force, &moves, &angles, &curve),
            solved,
            force,
            forces,
            end,
            curve,
        }
    }

    /// Where the shaft would run along the plane if it were pressed there, m from the base, by
    /// Newton's method; beyond the length where the tip points at the plane.
    fn better_m(
        &self,
        part: &Part<'_>,
        place: &Place,
        force: V3,
        moves: &Moves,
        angles: &Angles,
        curve: &Curve,
    ) -> f64 {
        let up = part.pose.up();
        let [mut rise, mut bend] = curve.rise(place, up);
        let along = part.tangent.as_ref().map(|tangent| {
            // Along the surface, which falls away from the plane.
            let at_m = part.pose.place(curve.at(place))[0];
            let along = part.pose.vector(curve.along(place))[0];
            let [slope, change] = tangent.falls(at_m);
            rise -= slope * along;
            bend -= change * along * along;
            (tangent, at_m, along)
        });
        if place.at_m == self.shaft.length_m && rise <= 0.0 {
            return place.at_m;
        }
        let turns = self.shaft.shapes.turns(angles, place);
        let steep = bend + dot(force, up) * moves.turned(&turns, up, &part.responses);
        let mut shift = if steep > 0.0 { -rise / steep } else { 0.0 };
        if let Some((tangent, at_m, along)) = along.filter(|(.., along)| *along != 0.0) {
            shift = (tangent.on(at_m + shift * along) - at_m) / along;
        }
        place.at_m + shift.max(-MOST * self.shaft.length_m)
    }

    /// Brings the foot to the ground, as far as the energy allows.
    pub(super) fn settle(&mut self, part: &Part<'_>, found: &Found) {
        let Found {
            place,
            solved,
            felt,
            next,
            better_m,
            ..
        } = found;
        let Solved { frame, force, .. } = solved;
        // Straight up or down: the ground is known there.
        let ground = self.ground.relief.at(*felt);
        let deep = bowed(part.tangent.as_ref(), ground, *next)[0] - next[2];
        let body = part.pose.components(solved.stretch);
        let left_j = solved.left_j.max(0.0);
        // A foot in the air stays there.
        let normal_n = force.local[0];
        let deep = if normal_n > 0.0 { deep } else { deep.max(0.0) };
        let up = part.pose.components([0.0, 0.0, -deep]);
        let (stretch, paid) = part.law.compliance.within(left_j, body, up);
        let went = place.at_m - self.touch.place.map_or(place.at_m, |last| last.at_m);
        self.touch = Touch {
            place: Some(*place),
            next_m: better_m + went,
            force: frame.plate(force.local),
            forces: found.forces,
            foot: *next,
            felt: Some(*felt),
            ground: Some(ground),
            normal_n,
            stuck: force.stuck,
            slip_m_s: solved.problem.slipped(force) / part.dt_s,
            lowered_m: (1.0 - paid) * deep,
            ..Touch::in_the_air(&part.law.compliance, stretch)
        };
    }
}

/// The ground at a place, where the body is round too.
#[inline]
fn bowed(tangent: Option<&Tangent>, ground: [f64; 3], at: V3) -> [f64; 3] {
    match tangent {
        Some(tangent) => tangent.bowed(ground, at[0]),
        None => ground,
    }
}

/// The direction of a vector along the plate; none of a vector across it.
#[inline]
fn level(v: V3) -> [f64; 2] {
    let size = length2([v[0], v[1]]);
    let keep = if size > 1e-9 { 1.0 / size } else { 0.0 };
    [keep * v[0], keep * v[1]]
}

/// The part of a way on the plate that is not lengthwise, where there is a lengthwise.
#[inline]
fn aside(along: Option<[f64; 2]>, way: [f64; 2]) -> [f64; 2] {
    let Some(along) = along else {
        return way;
    };
    let far = along[0] * way[0] + along[1] * way[1];
    [0, 1].map(|i| way[i] - far * along[i])
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
