//! The height field of a surface, as a round tip feels it.
//!
//! A height is the sum of up to three octaves of value noise: independent random
//! heights at the points of a lattice, smoothly interpolated. A hash of the
//! lattice point and the seed gives each one, so that a place has the
//! same height whenever, however fast and from wherever it is visited, and nothing
//! is stored but the last cell of each octave, which is only to save time. An
//! Ornstein–Uhlenbeck profile along the tip's path has no such memory.
//!
//! A tip of radius R does not reach the ground between two crests λ apart: it
//! sinks by λ²/(8 R), the sagitta of the arc. Where grains of the spread h are
//! closer than ℓ = √(8 R h), it rides on the highest of each n = (ℓ/grain)², whose
//! spread is about h/√(1 + 2 ln n) (the largest of n normal numbers); the first
//! octave then is ℓ long. Octaves below are cut to 0.3 of their sagitta, the root
//! mean square of an arc.

use crate::surface::Surface;

/// Octaves from the grain down, each with half the length and height.
const OCTAVES: usize = 3;

/// Uniform numbers in ±√3 have a variance of 1.
const UNIT: f64 = 1.732_050_807_568_877_2;

/// Interpolation by 3 s² − 2 s³ in both directions keeps (26/35)² of the
/// variance of the lattice's numbers, in the mean over all places.
const SMOOTHING: f64 = 35.0 / 26.0;

/// Octaves are turned against each other by this angle, so that no direction is
/// along all lattices; its cosine and sine.
const TURN: [f64; 2] = [0.8, 0.6];

/// A cell of the lattice: its lower corner, in lattice points, and the numbers
/// of its four corners.
#[derive(Debug, Clone, Copy)]
struct Cell {
    low: [f64; 2],
    corners: [[f64; 2]; 2],
}

impl Default for Cell {
    /// Nowhere: no place is in it.
    fn default() -> Self {
        Self {
            low: [f64::NAN; 2],
            corners: [[0.0; 2]; 2],
        }
    }
}

#[derive(Debug, Clone, Copy, Default)]
struct Octave {
    per_m: f64,
    /// Height of a lattice number of 1, m.
    height_m: f64,
    turn: [f64; 2],
    seed: u64,
    /// The cell of the last place: the next one mostly lies in it too.
    cell: Cell,
}

#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Relief {
    octaves: [Octave; OCTAVES],
    used: usize,
    /// No height is above this, m.
    pub(crate) top_m: f64,
    /// Shortest distance between lattice points, m; infinite if flat.
    pub(crate) finest_m: f64,
}

/// Mixes all bits (the finaliser of SplitMix64).
#[inline]
fn mix(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    bits ^ (bits >> 31)
}

impl Octave {
    /// A lattice point's number, uniform in ±√3.
    #[inline]
    fn number(row: u64, j: u64) -> f64 {
        let bits = mix(row ^ j.wrapping_mul(0xC2B2_AE3D_27D4_EB4F));
        UNIT * ((bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    }

    /// The cell whose lower corner is at the whole numbers `low`.
    fn cell(&self, low: [f64; 2]) -> Cell {
        // Wraps at the ends of the integers, far from any place in a room.
        let [i, j] = low.map(|low| low as i64 as u64);
        let row = |i: u64| {
            let row = mix(self.seed ^ i.wrapping_mul(0x9E37_79B9_7F4A_7C15));
            [Self::number(row, j), Self::number(row, j.wrapping_add(1))]
        };
        Cell {
            low,
            corners: [row(i), row(i.wrapping_add(1))],
        }
    }

    #[inline]
    fn at(&mut self, place: [f64; 2]) -> [f64; 3] {
        let [c, s] = self.turn;
        let u = self.per_m * (c * place[0] + s * place[1]);
        let v = self.per_m * (c * place[1] - s * place[0]);
        let inside = |at: f64| (0.0..1.0).contains(&at);
        if !(inside(u - self.cell.low[0]) && inside(v - self.cell.low[1])) {
            self.cell = self.cell([u.floor(), v.floor()]);
        }
        let Cell { low, corners } = &self.cell;
        let ease = |s: f64| (s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s));
        let ((wa, da), (wb, db)) = (ease(u - low[0]), ease(v - low[1]));
        let rise = corners.map(|row| row[1] - row[0]);
        let low = corners[0][0] + wb * rise[0];
        let high = corners[1][0] + wb * rise[1];
        let cross = (1.0 - wa) * rise[0] + wa * rise[1];
        let height = self.height_m * (low + wa * (high - low));
        let scale = self.height_m * self.per_m;
        let (du, dv) = (scale * da * (high - low), scale * db * cross);
        [height, c * du - s * dv, s * du + c * dv]
    }
}

impl Relief {
    /// Heights of a surface with values in their ranges, for a tip of a radius.
    pub(crate) fn new(surface: &Surface, tip_radius_m: f64) -> Self {
        let mut relief = Self {
            finest_m: f64::INFINITY,
            ..Self::default()
        };
        if surface.height_m <= 0.0 {
            return relief;
        }
        let radius = tip_radius_m.max(0.0);
        let reach = (8.0 * radius * surface.height_m).sqrt();
        let length = surface.grain_m.max(reach);
        let rivals = (length / surface.grain_m).powi(2);
        let ridden = surface.height_m / (1.0 + 2.0 * libm::log(rivals)).sqrt();
        // 1 + 1/4 + 1/16 of the first octave's variance.
        let first = ridden / (21.0_f64 / 16.0).sqrt();
        let mut turn = [1.0, 0.0];
        for (n, octave) in relief.octaves.iter_mut().enumerate() {
            let share = 0.5_f64.powi(n as i32);
            let spacing = length * share;
            let sink = 0.3 * spacing * spacing / (8.0 * radius.max(1e-12));
            let height = if n == 0 {
                first
            } else {
                (first * share).min(sink)
            };
            turn = [
                TURN[0] * turn[0] - TURN[1] * turn[1],
                TURN[1] * turn[0] + TURN[0] * turn[1],
            ];
            *octave = Octave {
                per_m: 1.0 / spacing,
                height_m: SMOOTHING * height,
                turn,
                seed: mix(surface.seed.wrapping_add(n as u64).wrapping_add(1)),
                cell: Cell::default(),
            };
            relief.used = n + 1;
            relief.finest_m = spacing;
            relief.top_m += UNIT * SMOOTHING * height;
            // What would follow is a quarter of this or less.
            if height < first * share {
                break;
            }
        }
        relief
    }

    /// Height (m) and slopes along the two coordinates at a place.
    #[inline]
    pub(crate) fn at(&mut self, place: [f64; 2]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for octave in self.octaves.iter_mut().take(self.used) {
            let part = octave.at(place);
            for (sum, part) in sum.iter_mut().zip(part) {
                *sum += part;
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests;
