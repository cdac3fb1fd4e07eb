//! A whisker pad of Psikharpax: 33 vibrissae in eight arcs, and the fixed head
//! that sweeps it over a sheet of sandpaper by turning its neck.
//!
//! # Glossary
//!
//! - **arc**: vibrissae of one length, from back (longest) to front.
//! - **row**: from top (0) to bottom (4); short arcs have the lower rows only
//!   (PSIK Table 1).
//! - **pan**: the angle of the neck, anticlockwise from where the middle of the
//!   pad faces the sheet.
//! - **lean**: how far a vibrissa points back from the radius through its tip,
//!   against the sweep, so that its tip trails.
//!
//! Frame of the neck: its axis is z, upwards, at the origin. All tips of a pad
//! lie at one distance from the origin, as fits "an appropriate angle to
//! provide contact with a maximum number of whiskers" (section 3.2.1).

use serde::Deserialize;

use super::chance::Chance;
use super::read::{OutOfRange, Rig, within};
use crate::paper::psik::{ARCS, RATE_HZ};
use crate::rigs::frame::{direction, turn};
use physics::Pose;
use physics::vector::{add, cross};

/// Rows of a full arc.
const ROWS: usize = 5;

/// Where vibrissae sit.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "each key is documented in rigs/pad.toml")]
pub struct Layout {
    pub tip_radius_m: f64,
    pub lean_deg: f64,
    pub arc_step_deg: f64,
    pub row_step_deg: f64,
    pub centre_deg: f64,
    pub tip_diameter_m: f64,
}

/// One vibrissa of a pad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vibrissa {
    /// Its arc, from 0.
    pub arc: usize,
    /// Its row, 0 to 4.
    pub row: usize,
    /// Its length, m.
    pub length_m: f64,
    /// Base and axes in the frame of the neck, for the left pad.
    pub pose: Pose,
}

impl Layout {
    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        within("tip_radius_m", self.tip_radius_m, 0.01, 2.0)?;
        within("lean_deg", self.lean_deg, -90.0, 90.0)?;
        within("arc_step_deg", self.arc_step_deg, 0.0, 20.0)?;
        within("row_step_deg", self.row_step_deg, 0.0, 20.0)?;
        within("centre_deg", self.centre_deg, -180.0, 180.0)?;
        within("tip_diameter_m", self.tip_diameter_m, 1e-5, 2e-3)?;
        Ok(())
    }

    /// The vibrissae, arc by arc from the back.
    pub fn vibrissae(&self) -> Vec<Vibrissa> {
        let mut all = Vec::new();
        let middle = (ARCS.len() as f64 - 1.0) / 2.0;
        for (arc, (count, length_mm)) in ARCS.into_iter().enumerate() {
            // The back of a left pad is further to the left.
            let azimuth = self.centre_deg + (middle - arc as f64) * self.arc_step_deg;
            for row in ROWS.saturating_sub(count)..ROWS {
                let elevation = (2.0 - row as f64) * self.row_step_deg;
                let length_m = length_mm / 1000.0;
                let tip = direction(azimuth, elevation).map(|part| part * self.tip_radius_m);
                let shaft = direction(azimuth - self.lean_deg, elevation);
                let x = direction(azimuth - self.lean_deg + 90.0, 0.0);
                let pose = Pose {
                    base_m: add(tip, -length_m, shaft),
                    x,
                    y: cross(shaft, x),
                };
                all.push(Vibrissa {
                    arc,
                    row,
                    length_m,
                    pose,
                });
            }
        }
        all
    }
}

/// The pose after a turn about the neck.
pub fn panned(pose: &Pose, radians: f64) -> Pose {
    Pose {
        base_m: turn(pose.base_m, radians),
        x: turn(pose.x, radians),
        y: turn(pose.y, radians),
    }
}

/// The fixed head; see `studies/rigs/pad.toml` for each key.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "each key is documented in rigs/pad.toml")]
pub struct Pad {
    pub distance_m: f64,
    pub distance_spread_m: f64,
    pub position_spread_m: f64,
    pub sweep_deg: f64,
    pub sweep_s: f64,
    pub bits: u32,
    pub full_scale_rad: f64,
    pub layout: Layout,
}

impl Rig for Pad {
    const FILE: &'static str = "pad.toml";
    const DEFAULT: &'static str = include_str!("../../rigs/pad.toml");

    fn check(&self) -> Result<(), OutOfRange> {
        within("distance_m", self.distance_m, 0.01, 2.0)?;
        within("distance_spread_m", self.distance_spread_m, 0.0, 0.5)?;
        within("position_spread_m", self.position_spread_m, 0.0, 5.0)?;
        within("sweep_deg", self.sweep_deg, 1.0, 90.0)?;
        within("sweep_s", self.sweep_s, 0.01, 100.0)?;
        within("bits", f64::from(self.bits), 2.0, 14.0)?;
        within("full_scale_rad", self.full_scale_rad, 1e-4, 3.0)?;
        self.layout.check()
    }
}

/// One sweep: how far the sheet is, and where along it the head is set up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sweep {
    /// From the neck to the sheet, m.
    pub distance_m: f64,
    /// Origin of the sheet's texture, m, along it and upwards.
    pub origin_m: [f64; 2],
}

impl Pad {
    /// Ticks of a sweep.
    pub fn ticks(&self) -> usize {
        (self.sweep_s * RATE_HZ).round() as usize
    }

    /// Draws a sweep.
    pub fn sweep(&self, chance: &mut Chance) -> Sweep {
        let (spread, aside) = (self.distance_spread_m, self.position_spread_m);
        Sweep {
            distance_m: self.distance_m + chance.between(-spread, spread),
            origin_m: [chance.between(-aside, aside), chance.between(-aside, aside)],
        }
    }

    /// The pan at a tick, radians: from −`sweep_deg` to `sweep_deg`, with the
    /// speed of half a cosine.
    pub fn pan(&self, tick: usize) -> f64 {
        let share = tick as f64 / self.ticks().max(1) as f64;
        -self.sweep_deg.to_radians() * libm::cos(core::f64::consts::PI * share)
    }
}

#[cfg(test)]
mod tests {
    use super::{Pad, panned};
    use crate::paper::psik::VIBRISSAE;
    use crate::rigs::read::{Rig, parse};
    use physics::vector::{add, cross, dot};
    use std::path::Path;

    fn rig() -> Pad {
        parse(Path::new(Pad::FILE), Pad::DEFAULT).unwrap()
    }

    #[test]
    fn all_tips_lie_on_one_sphere_and_axes_are_right_handed() {
        let layout = rig().layout;
        let all = layout.vibrissae();
        assert_eq!(all.len(), VIBRISSAE);
        for vibrissa in &all {
            let shaft = cross(vibrissa.pose.x, vibrissa.pose.y);
            let tip = add(vibrissa.pose.base_m, vibrissa.length_m, shaft);
            assert!((dot(tip, tip).sqrt() - layout.tip_radius_m).abs() < 1e-12);
            assert!((dot(shaft, shaft) - 1.0).abs() < 1e-12);
            assert!(dot(vibrissa.pose.x, vibrissa.pose.y).abs() < 1e-12);
        }
        let rows: Vec<_> = all.iter().filter(|v| v.arc == 7).map(|v| v.row).collect();
        assert_eq!(rows, [3, 4], "D7 and E8");
    }

    /// Every vibrissa is off the sheet at both ends of a sweep and on it in
    /// between, at the middle distance.
    #[test]
    fn a_sweep_brings_every_tip_onto_the_sheet_and_off_again() {
        let rig = rig();
        for vibrissa in rig.layout.vibrissae() {
            let beyond = |tick| {
                let pose = panned(&vibrissa.pose, rig.pan(tick));
                let tip = add(pose.base_m, vibrissa.length_m, cross(pose.x, pose.y));
                tip[0] - rig.distance_m
            };
            assert!(beyond(0) < 0.0 && beyond(rig.ticks()) < 0.0);
            let most = (0..rig.ticks()).map(beyond).fold(f64::MIN, f64::max);
            assert!(most > 0.002, "{vibrissa:?}: {most}");
        }
    }
}
