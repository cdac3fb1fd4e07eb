//! The massless spring between shaft and foot: its compliance, its energy, and how
//! coarse a part is for it and for the static shapes.

use crate::vector::{V3, add, dot};

/// Compliances of ground, and of shaft and ground in series, m/N; positive.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Compliance {
    pub(crate) across: f64,
    pub(crate) along: f64,
    /// Transverse to the shaft at its tip, with that of the static shapes.
    pub(crate) rest: f64,
}

impl Compliance {
    #[inline]
    pub(crate) fn least(&self) -> f64 {
        self.across.min(self.along)
    }

    /// An entry of C in axes in which the shaft has the direction `z`.
    #[inline]
    pub(crate) fn at(&self, z: V3, i: usize, j: usize) -> f64 {
        let own = if i == j { self.across } else { 0.0 };
        own + (self.along - self.across) * z[i] * z[j]
    }

    /// Force of a stretch along the axes x, y and z, N.
    #[inline]
    pub(crate) fn force(&self, [x, y, z]: V3) -> V3 {
        [-x / self.across, -y / self.across, -z / self.along]
    }

    /// w for a part in which 1 N moves the modal tip by `response`, m: above ½ by
    /// the square of the part's length, so that the second order stays, and near
    /// 1 where the modes give way by far more than the spring.
    #[inline]
    pub(crate) fn weight(&self, response: f64) -> f64 {
        let coarse = 0.25 * response / self.rest;
        (0.5 + coarse) / (1.0 + coarse)
    }

    /// τ = 2 ζ/ω of a tip that rings on its stretch with ω² = mobility/C, s; zero
    /// for one that does not move.
    #[inline]
    pub(crate) fn lag_s(&self, damping: f64, mobility: f64) -> f64 {
        if mobility > 0.0 {
            2.0 * damping * (self.rest / mobility).sqrt()
        } else {
            0.0
        }
    }

    /// A stretch with as much of a change, 0 to 1, as an energy allows; less
    /// than the stretch, where it does not allow that.
    #[inline]
    pub(crate) fn within(&self, energy_j: f64, stretch: V3, change: V3) -> (V3, f64) {
        // E = a + b s + c s².
        let force = self.force(stretch);
        let a = -0.5 * dot(force, stretch);
        let b = -dot(force, change);
        let c = -0.5 * dot(self.force(change), change);
        if a + b + c <= energy_j {
            return (add(stretch, 1.0, change), 1.0);
        }
        let room = energy_j - a;
        if room <= 0.0 {
            let keep = (energy_j.max(0.0) / a.max(f64::MIN_POSITIVE))
                .sqrt()
                .min(1.0);
            return (stretch.map(|s| keep * s), 0.0);
        }
        // The larger root of c s² + b s = room, which is below 1.
        let root = (b * b + 4.0 * c * room).sqrt();
        let share = if b > 0.0 {
            2.0 * room / (b + root)
        } else {
            (root - b) / (2.0 * c)
        };
        let share = share.clamp(0.0, 1.0);
        (add(stretch, share, change), share)
    }
}
