//! Bending modes of a tapered Euler–Bernoulli beam on a hinge spring.
//!
//! Glossary:
//!
//! - *w(z)*: deflection across the shaft at the distance z from the base, m, in
//!   axes that move with the base;
//! - *mode* k: shape φ_k, scaled so that ∫ ρ A φ_j φ_k dz is 1 for j = k and 0
//!   otherwise; its unit is 1/√kg, and w = Σ φ_k q_k;
//! - *residual*: the part of the static response that the kept modes leave out.
//!
//! The base is held in place and turns against the spring k_θ of the follicle:
//!
//! ρ A ∂²w/∂t² + ∂²/∂z² (E I ∂²w/∂z²) = f, w(0) = 0, E I w″(0) = k_θ w′(0),
//!
//! with A = π d²/4, I = π d⁴/64 and a diameter d that is linear in z. Cubic
//! (Hermite) finite elements; their frequencies err with the fourth power of an
//! element's length. Rotary inertia and shear are left out: for d/L of 1/40 they
//! take 0.1 % off the first frequency.

use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};

use crate::error::BadSetting;
use crate::grid::{Grid, NODES};
use crate::shaft::Shaft;
use crate::shapes::{MODES, STATIC, Shapes};

const ELEMENTS: usize = 40;

/// Nodes and weights of Gauss' quadrature on −1..1, exact to degree 9: the mass
/// of an element is of degree 8.
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683, 0.478_628_670_499_366_5),
    (-0.538_469_310_105_683, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// One bending mode.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BendingMode {
    /// Undamped angular frequency ω, rad/s.
    pub omega_rad_s: f64,
    /// φ at the tip, 1/√kg; positive.
    pub tip: f64,
    /// ∫ ρ A φ dz, √kg: force of the mode, with a minus, for an acceleration of
    /// the base of 1 m/s².
    pub translation: f64,
    /// ∫ ρ A z φ dz, m √kg: the same for an angular acceleration of 1 rad/s².
    pub rotation: f64,
}

/// Bending modes from the lowest, and the static response to a force at the tip.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// The modes.
    pub modes: Vec<BendingMode>,
    /// Static deflection of the tip, m/N.
    pub tip_m_n: f64,
    /// Static rotation of the base, rad/N: L/k_θ.
    pub base_rad_n: f64,
    /// Part of `tip_m_n` that the modes leave out, m/N.
    pub residual_tip_m_n: f64,
    /// The first modes and the static shapes, as they bend before a plate.
    pub(crate) shapes: Shapes,
}

impl Shaft {
    /// The first `count` bending modes, 1 to 12, and the static response.
    ///
    /// Frequencies of the first three are within 1e-4 of the closed forms for
    /// uniform beams and cones.
    ///
    /// # Errors
    /// A setting out of its range, or `count`.
    pub fn modes(&self, count: usize) -> Result<Modes, BadSetting> {
        self.check()?;
        if !(1..=12).contains(&count) {
            return Err(BadSetting("count"));
        }
        solve(self, count).ok_or(BadSetting("shaft"))
    }
}

/// Values, first and second derivatives of the four shape functions of an
/// element of length h at s in 0..1, for degrees of freedom w, w′, w, w′.
fn shapes(s: f64, h: f64) -> [[f64; 4]; 3] {
    let (s2, s3) = (s * s, s * s * s);
    [
        [
            1.0 - 3.0 * s2 + 2.0 * s3,
            h * (s - 2.0 * s2 + s3),
            3.0 * s2 - 2.0 * s3,
            h * (s3 - s2),
        ],
        [
            6.0 * (s2 - s) / h,
            1.0 - 4.0 * s + 3.0 * s2,
            6.0 * (s - s2) / h,
            3.0 * s2 - 2.0 * s,
        ],
        [
            (12.0 * s - 6.0) / (h * h),
            (6.0 * s - 4.0) / h,
            (6.0 - 12.0 * s) / (h * h),
            (6.0 * s - 2.0) / h,
        ],
    ]
}

/// What the elements sum to; w and w′ of node n are rows 2 n and 2 n + 1.
struct Assembly {
    stiffness: DMatrix<f64>,
    mass: DMatrix<f64>,
    /// ∫ w′² dz as a quadratic form.
    slope: DMatrix<f64>,
    /// ∫ ρ A w dz and ∫ ρ A z w dz as linear forms.
    drive: [DVector<f64>; 2],
}

impl Assembly {
    fn new(shaft: &Shaft) -> Self {
        let size = 2 * ELEMENTS + 2;
        let mut sum = Self {
            stiffness: DMatrix::zeros(size, size),
            mass: DMatrix::zeros(size, size),
            slope: DMatrix::zeros(size, size),
            drive: [DVector::zeros(size), DVector::zeros(size)],
        };
        let h = shaft.length_m / ELEMENTS as f64;
        for element in 0..ELEMENTS {
            for (node, weight) in GAUSS {
                let s = f64::midpoint(node, 1.0);
                let z = (element as f64 + s) * h;
                sum.add(shaft, 2 * element, z, shapes(s, h), weight * h / 2.0);
            }
        }
        if shaft.follicle.rotation_n_m_rad.is_finite() {
            sum.stiffness[(1, 1)] += shaft.follicle.rotation_n_m_rad;
        }
        sum
    }

    /// Adds the point z of an element whose first row is `first`.
    fn add(&mut self, shaft: &Shaft, first: usize, z: f64, shapes: [[f64; 4]; 3], dz: f64) {
        let diameter = shaft.diameter_m(z);
        let area = core::f64::consts::FRAC_PI_4 * diameter * diameter;
        let line_mass = shaft.density_kg_m3 * area;
        let rigidity = shaft.youngs_pa * area * diameter * diameter / 16.0;
        let [value, slope, bend] = shapes;
        for i in 0..4 {
            self.drive[0][first + i] += dz * line_mass * value[i];
            self.drive[1][first + i] += dz * line_mass * z * value[i];
            for j in 0..4 {
                let at = (first + i, first + j);
                self.stiffness[at] += dz * rigidity * bend[i] * bend[j];
                self.mass[at] += dz * line_mass * value[i] * value[j];
                self.slope[at] += dz * slope[i] * slope[j];
            }
        }
    }

    fn hold(self, held: usize) -> Self {
        let square = |m: DMatrix<f64>| m.remove_rows(0, held).remove_columns(0, held);
        Self {
            stiffness: square(self.stiffness),
            mass: square(self.mass),
            slope: square(self.slope),
            drive: self.drive.map(|d| d.remove_rows(0, held)),
        }
    }
}

/// The modes of a checked shaft; `None` if its matrix cannot be factored.
///
/// K φ = ω² M φ is solved as L⁻¹ M L⁻ᵀ y = ω⁻² y with K = L Lᵀ, so that the
/// rounding of the matrices falls on the highest modes, not on the lowest.
fn solve(shaft: &Shaft, count: usize) -> Option<Modes> {
    let clamped = !shaft.follicle.rotation_n_m_rad.is_finite();
    let held = if clamped { 2 } else { 1 };
    let beam = Assembly::new(shaft).hold(held);
    let size = beam.drive[0].len();
    let tip = size - 2;

    let factors = Cholesky::new(beam.stiffness.clone())?;
    let lower = factors.l();
    let half = lower.solve_lower_triangular(&beam.mass)?;
    let mut matrix = lower.solve_lower_triangular(&half.transpose())?;
    matrix = 0.5 * (&matrix + matrix.transpose());
    let eigen = SymmetricEigen::new(matrix);
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));

    let base_rotation = |shape: &DVector<f64>| if clamped { 0.0 } else { shape[0] };
    let shape = |index: &usize| {
        let inverse = eigen.eigenvalues[*index];
        let shape = lower.tr_solve_lower_triangular(&eigen.eigenvectors.column(*index))?;
        // φᵀ M φ = yᵀ y ω⁻² before scaling.
        let scale = (1.0 / inverse).sqrt().copysign(shape[tip]);
        Some((scale * shape, (1.0 / inverse).sqrt()))
    };
    let kept = order.iter().take(count).map(shape);
    let kept: Vec<(DVector<f64>, f64)> = kept.collect::<Option<_>>()?;
    let modes: Vec<BendingMode> = kept
        .iter()
        .map(|(shape, omega_rad_s)| BendingMode {
            omega_rad_s: *omega_rad_s,
            tip: shape[tip],
            translation: beam.drive[0].dot(shape),
            rotation: beam.drive[1].dot(shape),
        })
        .collect();
    let whole = modes
        .iter()
        .all(|m| m.omega_rad_s.is_finite() && m.omega_rad_s > 0.0);
    if !whole {
        return None;
    }

    let mut force = DVector::zeros(size);
    force[tip] = 1.0;
    let bent = factors.solve(&force);
    let (tip_m_n, base_rad_n) = (bent[tip], base_rotation(&bent));
    let shares = modes.iter().map(|m| (m.tip / m.omega_rad_s).powi(2));
    let residual_tip_m_n = (tip_m_n - shares.sum::<f64>()).max(0.0);
    let mut couple = DVector::zeros(size);
    couple[tip + 1] = 1.0;
    let along = factors.solve(&(&beam.slope * &bent));
    let mut loads = vec![bent.clone(), along, factors.solve(&couple)];
    if !clamped {
        loads.push(turned(shaft.length_m, size));
    }
    let moving = kept.get(..MODES).unwrap_or(&kept);
    let mut shapes = Shapes::default();
    let rest = rest(&beam.stiffness, moving, loads);
    let all = moving.iter().map(|(shape, _)| shape);
    for (k, shape) in all.chain(&rest).enumerate() {
        let k = if k < moving.len() {
            k
        } else {
            MODES + k - moving.len()
        };
        let slopes = slopes(shape, shaft.length_m, held);
        shapes.set(k, slopes, base_rotation(shape), shape[tip]);
    }
    Some(Modes {
        modes,
        tip_m_n,
        base_rad_n,
        residual_tip_m_n,
        shapes,
    })
}

/// A straight shaft turned by 1 rad about its base, which only the hinge is held by.
fn turned(length_m: f64, size: usize) -> DVector<f64> {
    let h = length_m / ELEMENTS as f64;
    let row = |row: usize, _| {
        if row.is_multiple_of(2) {
            1.0
        } else {
            h * row.div_ceil(2) as f64
        }
    };
    DVector::from_fn(size, row)
}

/// What modes with their frequencies leave out of these shapes, with an energy of ½ each and
/// none between them.
fn rest(
    stiffness: &DMatrix<f64>,
    modes: &[(DVector<f64>, f64)],
    shapes: Vec<DVector<f64>>,
) -> Vec<DVector<f64>> {
    let mut found: Vec<DVector<f64>> = Vec::with_capacity(STATIC);
    for mut shape in shapes {
        let first = shape.dot(&(stiffness * &shape));
        // Twice, as rounding leaves some of the first.
        for _ in 0..2 {
            for (mode, omega) in modes {
                let part = mode.dot(&(stiffness * &shape)) / (omega * omega);
                shape -= part * mode;
            }
            for other in &found {
                let part = other.dot(&(stiffness * &shape));
                shape -= part * other;
            }
        }
        let energy = shape.dot(&(stiffness * &shape));
        // What the others span already is only rounding.
        if energy > 1e-12 * first {
            found.push(shape / energy.sqrt());
        }
    }
    found
}

/// w′ of a shape at the nodes of a shaft, for a beam whose first `held` rows are left out.
fn slopes(shape: &DVector<f64>, length_m: f64, held: usize) -> [f64; NODES] {
    let h = length_m / ELEMENTS as f64;
    Grid::new(length_m).nodes.map(|z| {
        let element = ((z / h) as usize).min(ELEMENTS - 1);
        let [_, slope, _] = shapes(z / h - element as f64, h);
        let known = |i: usize| {
            (2 * element + i)
                .checked_sub(held)
                .map_or(0.0, |row| shape[row])
        };
        (0..4).map(|i| slope[i] * known(i)).sum()
    })
}

#[cfg(test)]
mod tests;
