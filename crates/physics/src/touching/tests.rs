//! Whiskers against closed forms, and what no contact may do.

mod bar;
mod bent;
mod closed_forms;
mod elastica;
mod energy;
mod rough;
mod whip;

use super::TouchingWhisker;
use crate::{Facing, Material, Outline, Plate, Pose, SensorSettings, Shaft, Surface};

pub(super) const DT: f64 = 5e-4;

pub(super) const QUIET: SensorSettings = SensorSettings {
    full_scale_rad: [0.5; 2],
    noise_codes: 0.0,
    refresh_s: 0.0,
};

/// Along the first axis of space; the sensor's x is up, its y is the second axis.
pub(super) fn level(base_m: [f64; 3]) -> Pose {
    Pose {
        base_m,
        x: [0.0, 0.0, 1.0],
        y: [0.0, -1.0, 0.0],
    }
}

/// The robot's whisker with its straight tip at a place. It points down by 0.05 rad, more than
/// a tip turns that is pressed by 5 mm: so it is the tip that touches.
pub(super) fn nosed(tip_m: [f64; 3]) -> Pose {
    let (sine, cosine) = 0.05_f64.sin_cos();
    let length_m = Shaft::floor_robot().length_m;
    let [x, y, z] = tip_m;
    Pose {
        base_m: [x - length_m * cosine, y, z + length_m * sine],
        x: [sine, 0.0, cosine],
        y: [0.0, -1.0, 0.0],
    }
}

pub(super) fn slanted(slant_deg: f64) -> Facing {
    Facing {
        slant_deg,
        tilt_deg: 0.0,
        elevation_deg: 0.0,
    }
}

pub(super) fn floor(surface: Surface) -> Plate {
    Plate {
        point_m: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
        along: [1.0, 0.0, 0.0],
        outline: Outline::PLANE,
        surface,
    }
}

pub(super) fn flat(stiffness_n_m: f64, damping: f64, hold: f64, friction: f64) -> Surface {
    Surface {
        stiffness_n_m,
        damping,
        hold,
        friction,
        ..Surface::of(Material::Flat)
    }
}

pub(super) fn robot() -> TouchingWhisker {
    TouchingWhisker::new(&Shaft::floor_robot(), &QUIET, 1).unwrap()
}
