//! A step before a plate: how finely it is cut, and what happens in its parts.

use super::body::{Body, Last, POWERS, Steps, Touch};
use crate::pose::PlatePose;
use crate::vector::{dot, length, sub};

/// Longest travel of the tip in a part, in lattice distances of the finest octave:
/// heights change from hill to valley over one.
const TRAVEL: f64 = 0.25;

/// Largest phase of the highest mode in a part, rad.
const PHASE: f64 = 1.0;

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
        let way = length(sub(pose.tip, last.tip));
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
        let above = self.shaft.tip(self.shaft.deflections(&self.state), &pose)[2];
        self.last = Some(Last { pose, above });
        parts
    }

    /// Moves on freely, if the tip is above every height of the ground at the start
    /// and at the end, with its travel to spare; says whether it did.
    fn stays_clear(&mut self, pose: &PlatePose, steps: &Steps) -> bool {
        let mut free = self.state;
        free.free(&steps.parts[0]);
        let end = self.shaft.tip(self.shaft.deflections(&free), pose)[2];
        let start = self.last.map_or(end, |last| last.above);
        let clear = start.min(end) - (end - start).abs() > self.ground.relief.top_m;
        if clear {
            self.state = free;
            self.touch = Touch::default();
            self.last = Some(Last {
                pose: *pose,
                above: end,
            });
        }
        clear
    }

    /// If a plate that was not there before has the tip below its surface, bends
    /// the shaft statically out of it, as the contact would throw it out. What
    /// depth is left presses the ground in.
    fn bend_clear(&mut self, pose: &PlatePose) {
        for _ in 0..4 {
            let tip = self.shaft.tip(self.shaft.deflections(&self.state), pose);
            let deep = self.ground.relief.at([tip[0], tip[1]])[0] - tip[2];
            if deep <= 0.0 {
                return;
            }
            let ways = self.shaft.ways(self.shaft.deflections(&self.state), pose);
            let up = ways.map(|way| way[2]);
            // Against a plate straight ahead no bend helps much.
            let square = (up[0] * up[0] + up[1] * up[1]).max(0.04);
            let more = self.shaft.bent(up.map(|up| deep * up / square));
            self.state.add_amplitudes(&more);
            self.state.limit(&self.shaft);
        }
        let tip = self.shaft.tip(self.shaft.deflections(&self.state), pose);
        let deep = self.ground.relief.at([tip[0], tip[1]])[0] - tip[2];
        if deep > 0.0 {
            let compliance = self.shaft.compliance(self.ground.compliance_m_n);
            let stretch = pose.components([0.0, 0.0, -deep]);
            self.touch.spring_j = -0.5 * dot(compliance.force(stretch), stretch);
            self.touch.stretch = stretch;
            self.touch.normal_n = deep / compliance.across;
        }
    }

    /// How many times a step is halved in which the base carries the tip this far.
    fn power(&self, way_m: f64, dt_s: f64) -> usize {
        let own = self.state.speed(&self.shaft) * dt_s;
        let grains = (way_m + own) / (TRAVEL * self.ground.relief.finest_m);
        let phase = self.shaft.highest_rad_s * dt_s / PHASE;
        let wanted = grains.max(phase);
        let enough = |power: &usize| wanted <= f64::from(1_u32 << power);
        let power = (0..POWERS - 1).find(enough).unwrap_or(POWERS - 1);
        (power + self.finer as usize).min(POWERS - 1)
    }
}
