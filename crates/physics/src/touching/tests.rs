//! Whiskers against closed forms, and what no contact may do.

mod closed_forms;
mod elastica;
mod energy;
mod rough;

use super::TouchingWhisker;
use crate::{Material, Plate, Pose, SensorSettings, Shaft, Surface};

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

/// A floor.
pub(super) fn floor(surface: Surface) -> Plate {
    Plate {
        point_m: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
        along: [1.0, 0.0, 0.0],
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
