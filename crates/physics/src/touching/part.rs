//! One part of a step in contact: where the foot goes, by [`super::rounds`].
//!
//! Glossary:
//!
//! - *place*: of the shaft, which touches: where it runs along the mean plane at the end of
//!   the part, or the tip;
//! - *stretch*: of the massless spring, follicle and ground in series;
//! - *foot*: where the place stands on the ground, the place less the stretch.
//!
//! Heights are read where the shaft touches first, and from then on where it has slid to. A
//! shaft that lays itself along the plate bridges its grains; one that slides lengthwise keeps
//! its place in space, and so the grains that it lies on: both change no height. Away from the tip
//! only what it slides sideways counts, and its side has no slope lengthwise. So it comes to feel
//! another place of the ground than it is over; one that leaves the ground goes on so until it is
//! above what it is over too, or else it would be thrown out of a grain.
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
use super::law::{Part, Solved};
use super::rounds::{Found, Known, bowed};
use super::second::{DEEP, sum};
use crate::grid::Place;
use crate::modal::{ModalStep, pushed};
use crate::outline::Tangent;
use crate::pose::PlatePose;
use crate::shapes::Curve;
use crate::vector::{V3, scale, sub};

/// Another place takes over where it is lower by more than this share of the length: where a
/// shaft lies straight along the plate, its shapes bring it near to straight.
const DEEPER: f64 = 2e-2;

impl Body {
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
    pub(super) fn foot(&self, part: &Part<'_>, at: V3) -> V3 {
        sub(part.old.place(at), part.old.vector(self.touch.stretch))
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
