//! A step before a plate: how finely it is cut, and what happens in its parts.

use super::part::Touch;
use super::{POWERS, TouchingWhisker};
use crate::pose::{Plate, Pose, Seen};
use crate::relief::Relief;
use crate::vector::{V3, dot, length, sub};

/// Longest way of the tip in a part, in distances of the finest octave: heights
/// change from hill to valley over one.
const TRAVEL: f64 = 0.25;

/// Largest phase of the highest mode in a part, rad.
const PHASE: f64 = 1.0;

/// How a plate was seen last.
#[derive(Debug, Clone, Copy)]
pub(super) struct Last {
    pub(super) seen: Seen,
    /// Modal tip above the mean plane, m.
    above: f64,
}

impl TouchingWhisker {
    /// A step before a plate.
    pub(super) fn before(&mut self, pose: &Pose, plate: &Plate, dt_s: f64) {
        let finite = |v: V3| v.iter().all(|x| x.is_finite());
        if !(finite(plate.point_m) && finite(plate.normal) && finite(plate.along)) {
            self.state.free(&self.reach.1[0]);
            return;
        }
        let surface = plate.surface.limited();
        if self.relief.0 != surface {
            self.relief = (surface, Relief::new(&surface, self.shape.tip_radius_m));
            self.touch.ground = None;
        }
        let seen = plate.see(pose, self.shape.length_m);
        if self.last.is_none() {
            self.lean(&seen);
        }
        let last = self.last.map_or(seen, |last| last.seen);
        let above = self.last.map(|last| last.above);
        let mut free = self.state;
        free.free(&self.reach.1[0]);
        let end = self.shape.tip(self.shape.deflections(&free), &seen);
        let start = above.unwrap_or(end[2]);
        if !self.contact() {
            let clear = start.min(end[2]) - (end[2] - start).abs();
            if clear > self.relief.1.top_m {
                self.state = free;
                self.touch = Touch::default();
                self.last = Some(Last {
                    seen,
                    above: end[2],
                });
                return;
            }
        }
        let way = length(sub(seen.tip, last.tip));
        let power = self.power(way, dt_s);
        let parts = 1_u32 << power;
        self.parts = parts;
        let part_s = dt_s / f64::from(parts);
        let mut here = last;
        for part in 1..=parts {
            let old = here;
            here = if part == parts {
                seen
            } else {
                last.towards(&seen, f64::from(part) / f64::from(parts))
            };
            self.part(&old, &here, power, part_s);
        }
        let above = self.shape.tip(self.shape.deflections(&self.state), &seen)[2];
        self.last = Some(Last { seen, above });
    }

    /// Where a plate that was not there holds the tip below its surface, bends
    /// the shaft statically out of it: the contact would throw it out. What is
    /// left presses the ground in.
    fn lean(&mut self, seen: &Seen) {
        for _ in 0..4 {
            let tip = self.shape.tip(self.shape.deflections(&self.state), seen);
            let deep = self.relief.1.at([tip[0], tip[1]])[0] - tip[2];
            if deep <= 0.0 {
                return;
            }
            let ways = self.shape.ways(self.shape.deflections(&self.state), seen);
            let up = ways.map(|way| way[2]);
            // Against a plate straight ahead no bend helps much.
            let square = (up[0] * up[0] + up[1] * up[1]).max(0.04);
            let more = self.shape.bent(up.map(|up| deep * up / square));
            self.state.lean(&more);
            self.state.limit(&self.shape);
        }
        let tip = self.shape.tip(self.shape.deflections(&self.state), seen);
        let deep = self.relief.1.at([tip[0], tip[1]])[0] - tip[2];
        if deep > 0.0 {
            let give = self.shape.give(1.0 / self.relief.0.stiffness_n_m);
            let stretch = seen.body([0.0, 0.0, -deep]);
            self.touch.spring_j = -0.5 * dot(give.force(stretch), stretch);
            self.touch.stretch = stretch;
            self.touch.normal_n = deep / give.across;
        }
    }

    /// How often a step is halved in which the base carries the tip this far.
    fn power(&self, way_m: f64, dt_s: f64) -> usize {
        let own = self.state.speed(&self.shape) * dt_s;
        let grains = (way_m + own) / (TRAVEL * self.relief.1.finest_m);
        let phase = self.shape.highest_rad_s * dt_s / PHASE;
        let wanted = grains.max(phase).clamp(1.0, 64.0);
        let power = libm::ceil(libm::log2(wanted)) as usize + self.finer as usize;
        power.min(POWERS - 1)
    }
}
