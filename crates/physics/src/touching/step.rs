//! A step before a plate: how finely it is cut, and what happens in its parts.

use super::body::{Body, Last, POWERS, Steps, Touch};
use crate::grid::Place;
use crate::modal::ModalState;
use crate::pose::PlatePose;
use crate::shapes::Curve;
use crate::vector::{dot, length, sub};

/// Longest travel of the tip in a part, in lattice distances of the finest octave:
/// heights change from hill to valley over one.
const TRAVEL: f64 = 0.25;

/// Largest phase of the highest mode in a part on flat ground, rad: errors of the base moment of
/// 3e-4 rms at pushes of 8 to 30° at 2 Hz, less than the shapes' own.
const PHASE: f64 = 3.0;

/// The same on rough ground, which makes all modes ring.
const ROUGH_PHASE: f64 = 1.0;

/// What touches may slide by this share of the way that the base carries a straight tip, beyond
/// what it slid last: a bent shaft's slides by a tenth of that. With all of it parts are two to four
/// times as many, and errors the same.
const SLIDES: f64 = 0.25;

/// Largest way of the tip in a part of a shaft that touches, as a share of the length: one that
/// whips about a place of contact is seen before it is far behind the plate.
const WHIPS: f64 = 0.02;

/// How often a shaft is bent out of a plate at most.
const CLEARING: usize = 8;

impl Body {
    /// A step before the ground to a pose in its coordinates. Returns into how
    /// many parts it was cut; none where the tip stays clear.
    pub(super) fn step(&mut self, pose: PlatePose, steps: &Steps) -> u32 {
        if self.last.is_none() {
            self.bend_clear(&pose);
        }
        let last = self.last.map_or(pose, |last| last.pose);
        if !self.touch.is_contact() && self.stays_clear(&pose, steps) {
            return 0;
        }
        let tip = [0.0, 0.0, self.shaft.length_m];
        let way = length(sub(pose.place(tip), last.place(tip)));
        let power = self.power(way, steps.dt_s);
        let Some(step) = steps.parts.get(power) else {
            return 0;
        };
        let parts = 1_u32 << power;
        let part_s = steps.dt_s / f64::from(parts);
        let mut here = last;
        for part in 1..=parts {
            let old = here;
            here = if part == parts {
                pose
            } else {
                last.towards(&pose, f64::from(part) / f64::from(parts))
            };
            self.part(&old, &here, step, part_s);
        }
        self.last = Some(Last {
            pose,
            above: self.above(&self.state, &pose),
        });
        parts
    }

    /// A height over the mean plane that no part of the shaft is below, m.
    fn above(&self, state: &ModalState, pose: &PlatePose) -> f64 {
        let tip = pose.base[2] + self.shaft.length_m * pose.z[2];
        pose.base[2].min(tip) - state.reach_m(&self.shaft)
    }

    /// Moves on freely, if the shaft is above every height of the ground at the start
    /// and at the end, with its travel to spare; says whether it did.
    fn stays_clear(&mut self, pose: &PlatePose, steps: &Steps) -> bool {
        let mut free = self.state;
        free.free(&steps.parts[0]);
        free.keep(0.0);
        let end = self.above(&free, pose);
        let start = self.last.map_or(end, |last| last.above);
        let clear = start.min(end) - (end - start).abs() > self.ground.relief.top_m;
        if clear {
            self.state = free;
            self.curve = None;
            self.touch = Touch::default();
            self.last = Some(Last {
                pose: *pose,
                above: end,
            });
        }
        clear
    }

    /// If a plate that was not there before has the shaft below its surface, bends it
    /// statically out of it, as the contact would throw it out. What
    /// depth is left presses the ground in.
    fn bend_clear(&mut self, pose: &PlatePose) {
        for round in 0..=CLEARING {
            let angles = self.shaft.shapes.angles(&self.state.x);
            let curve = angles.curve();
            let (place, tangent) = self.nearest(&curve, pose);
            let seen = tangent.map(|tangent| tangent.see(pose));
            let pose = seen.as_ref().unwrap_or(pose);
            let deep = self.deep(&curve, &place, pose);
            if deep <= 0.0 {
                return;
            }
            if round == CLEARING {
                let compliance = self.shaft.compliance(self.ground.compliance_m_n);
                self.touch.stretch = pose.components([0.0, 0.0, -deep]);
                let force = compliance.force(self.touch.stretch);
                self.touch.spring_j = -0.5 * dot(force, self.touch.stretch);
                self.touch.normal_n = deep / compliance.rest;
                self.touch.next_m = place.at_m;
                self.touch.place = Some(place);
                return;
            }
            let ways = self.shaft.shapes.ways(&angles, &place);
            let up = ways.towards(pose.up());
            // A tenth of the length at a time.
            let far = deep.min(0.1 * self.shaft.length_m);
            self.state.lean(&self.shaft, &up, far);
            self.state.limit(&self.shaft);
        }
    }

    /// How far a place is below the ground, m.
    pub(super) fn deep(&mut self, curve: &Curve, place: &Place, pose: &PlatePose) -> f64 {
        let [x, y, height] = pose.place(curve.at(place));
        self.ground.relief.at([x, y])[0] - height
    }

    /// How many times a step is halved in which the base carries the tip this far.
    fn power(&self, way_m: f64, dt_s: f64) -> usize {
        let bends_m = self.state.speed(&self.shaft) * dt_s;
        let (far_m, whips) = if self.touch.is_contact() {
            let far_m = SLIDES * way_m + self.touch.slip_m_s * dt_s;
            (far_m, bends_m / (WHIPS * self.shaft.length_m))
        } else {
            (way_m + bends_m, 0.0)
        };
        let grains = far_m / (TRAVEL * self.finest_m());
        let flat = self.ground.relief.finest_m.is_infinite();
        let most = if flat { PHASE } else { ROUGH_PHASE };
        let phase = self.shaft.highest_rad_s * dt_s / most;
        let wanted = grains.max(phase).max(whips);
        let enough = |power: &usize| wanted <= f64::from(1_u32 << power);
        let power = (0..POWERS - 1).find(enough).unwrap_or(POWERS - 1);
        (power + self.finer as usize).min(POWERS - 1)
    }
}
