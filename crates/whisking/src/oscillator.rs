//! The two coupled oscillators (BIOTACT eqs. 1 to 5).
//!
//! In Cartesian form dψ_i/dt = ((1 − r)/(τ_r r)) ψ_i + ω J ψ_i + (ψ_j1 − ψ_i1, 0)/τ_11
//! with ω = 2π f_W, J = (0, −1; 1, 0) and τ_r = τ_11 = 2 T_W: no angle, sine or
//! cosine in the tick. At the origin, where eq. 3 has no direction, the radial
//! force pushes along +ψ_1.
//!
//! Two integrators. [`Euler`] is the papers', step for step. [`Exact`] splits
//! the field in two parts, each solved exactly: the linear part (the sum of
//! the sides rotates, their difference rotates and decays: a 2 × 2 exponential)
//! in two halves around the radial relaxation, r → 1 + (r − 1) exp(−T/τ_r).
//! Without noise its limit cycle has radius one to rounding, at any f_W T.

use crate::Real;
use crate::linalg::{Matrix, exponential, identity, scaled};

/// ψ of one side: drive state and recovery state.
pub type Psi<R> = [R; 2];

/// Radial and coupling time constants in whisk periods, τ_r/T_W = τ_11/T_W = 2.
const TAU_PERIODS: f64 = 2.0;

/// Which integrator steps the oscillators, with its constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Config<R> {
    /// Forward Euler.
    Euler(Euler<R>),
    /// Exact parts, symmetrically composed.
    Exact(Exact<R>),
}

/// Forward Euler: every right-hand side at the state before the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Euler<R> {
    /// T/τ_r.
    pub relax: R,
    /// 2π f_W T.
    pub turn: R,
    /// T/τ_11; zero without coupling.
    pub couple: R,
}

/// The structure-preserving step, in increments (coefficients near one would
/// cost single precision several digits).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exact<R> {
    /// exp(A_s T/2) − 1 of the sum of the sides.
    pub sum: [[R; 2]; 2],
    /// exp(A_d T/2) − 1 of their difference.
    pub difference: [[R; 2]; 2],
    /// 1 − exp(−T/τ_r).
    pub relax: R,
}

/// The linear field on the sum (`coupling` 0) or the difference (`coupling` 2/τ_11).
fn generator(omega: f64, coupling: f64) -> Matrix<2> {
    [[-coupling, -omega], [omega, 0.0]]
}

impl<R: Real> Euler<R> {
    /// For `cycles` = f_W T whisks a tick.
    pub(crate) fn new(cycles: f64, coupling: bool) -> Self {
        let rate = cycles / TAU_PERIODS;
        Self {
            relax: R::from_f64(rate),
            turn: R::from_f64(core::f64::consts::TAU * cycles),
            couple: R::from_f64(if coupling { rate } else { 0.0 }),
        }
    }

    #[inline]
    fn step<const S: usize>(&self, psi: &mut [Psi<R>; S], noise: &[Psi<R>; S]) {
        let old = *psi;
        for (side, p) in psi.iter_mut().enumerate() {
            let [a, b] = old[side];
            let pull = relaxation(self.relax, [a, b]);
            // The other side; a lone side pulls on itself, which is nothing.
            let other = old[(side + 1) % S][0];
            p[0] = a + (pull[0] - self.turn * b + self.couple * (other - a) + noise[side][0]);
            p[1] = b + (pull[1] + self.turn * a + noise[side][1]);
        }
    }
}

/// `rate` (1/r − 1) ψ, the pull towards the unit circle; along +ψ_1 at the origin.
#[inline]
fn relaxation<R: Real>(rate: R, [a, b]: Psi<R>) -> Psi<R> {
    let r2 = a * a + b * b;
    if r2 > R::ORIGIN {
        let k = rate * (r2.inv_sqrt() - R::ONE);
        [k * a, k * b]
    } else {
        [rate, R::ZERO]
    }
}

/// `m v` of a 2 × 2 matrix.
#[inline]
fn apply<R: Real>(m: &[[R; 2]; 2], v: Psi<R>) -> Psi<R> {
    [
        m[0][0] * v[0] + m[0][1] * v[1],
        m[1][0] * v[0] + m[1][1] * v[1],
    ]
}

impl<R: Real> Exact<R> {
    /// For `cycles` = f_W T whisks a tick.
    pub(crate) fn new(cycles: f64, coupling: bool) -> Self {
        let omega = core::f64::consts::TAU * cycles;
        let rate = cycles / TAU_PERIODS;
        let half = |coupling: f64| {
            let mut e = exponential(&scaled(&generator(omega, coupling), 0.5));
            for (x, one) in e.iter_mut().flatten().zip(identity::<2>().iter().flatten()) {
                *x -= one;
            }
            e.map(|row| row.map(R::from_f64))
        };
        Self {
            sum: half(0.0),
            difference: half(if coupling { 2.0 * rate } else { 0.0 }),
            relax: R::from_f64(-libm::expm1(-rate)),
        }
    }

    #[inline]
    fn half_linear<const S: usize>(&self, psi: &mut [Psi<R>; S]) {
        if let [left, right] = &mut psi[..] {
            let sum = [left[0] + right[0], left[1] + right[1]];
            let difference = [left[0] - right[0], left[1] - right[1]];
            let (s, d) = (apply(&self.sum, sum), apply(&self.difference, difference));
            for k in 0..2 {
                left[k] += R::HALF * (s[k] + d[k]);
                right[k] += R::HALF * (s[k] - d[k]);
            }
        } else {
            for p in psi.iter_mut() {
                let s = apply(&self.sum, *p);
                p[0] += s[0];
                p[1] += s[1];
            }
        }
    }

    #[inline]
    fn step<const S: usize>(&self, psi: &mut [Psi<R>; S], noise: &[Psi<R>; S]) {
        self.half_linear(psi);
        for (p, n) in psi.iter_mut().zip(noise) {
            let pull = relaxation(self.relax, *p);
            p[0] += pull[0] + n[0];
            p[1] += pull[1] + n[1];
        }
        self.half_linear(psi);
    }
}

impl<R: Real> Config<R> {
    /// One tick. `noise` is T P_i (eq. 5); each state is limited to ±1.5
    /// afterwards, NaN included.
    #[inline]
    pub fn step<const S: usize>(&self, psi: &mut [Psi<R>; S], noise: &[Psi<R>; S]) {
        match self {
            Self::Euler(euler) => euler.step(psi, noise),
            Self::Exact(exact) => exact.step(psi, noise),
        }
        for x in psi.iter_mut().flatten() {
            *x = x.clamp(-R::PSI_LIMIT, R::PSI_LIMIT);
        }
    }
}

/// The continuous field dψ/dt in ticks, f64; `cycles` is f_W T.
pub(crate) fn field<const S: usize>(
    psi: &[Psi<f64>; S],
    cycles: f64,
    coupling: bool,
) -> [Psi<f64>; S] {
    let mut change = *psi;
    let unit = Euler::<f64>::new(cycles, coupling);
    unit.step(&mut change, &[[0.0; 2]; S]);
    core::array::from_fn(|i| [change[i][0] - psi[i][0], change[i][1] - psi[i][1]])
}

#[cfg(test)]
mod tests {
    use super::{Config, Euler, Exact, Psi};

    const NO_NOISE: [Psi<f64>; 2] = [[0.0; 2]; 2];

    fn exact(cycles: f64) -> Config<f64> {
        Config::Exact(Exact::new(cycles, true))
    }

    #[test]
    fn the_limit_cycle_is_the_unit_circle_at_any_step() {
        for cycles in [1e-5, 1e-3, 1.25e-2, 0.1] {
            let config = exact(cycles);
            let mut psi = [[0.3, 0.0]; 2];
            for _ in 0..(20.0 / cycles) as usize {
                config.step(&mut psi, &NO_NOISE);
            }
            for [a, b] in psi {
                assert!((a.hypot(b) - 1.0).abs() < 1e-4, "{cycles}: {}", a.hypot(b));
            }
            let mut psi = [[1.0, 0.0]; 2];
            let turns = (0.25 / cycles) as usize;
            for _ in 0..turns {
                config.step(&mut psi, &NO_NOISE);
            }
            let phase = core::f64::consts::TAU * cycles * turns as f64;
            assert!(
                (psi[0][0] - phase.cos()).abs() < 1e-9,
                "protraction comes first"
            );
            assert!((psi[0][1] - phase.sin()).abs() < 1e-9, "recovery follows");
        }
    }

    /// BIOTACT: the coupling restores phase with a time constant of about one
    /// whisking period... of the drive states; of the phase difference it is 2.0 T_W.
    #[test]
    fn phase_difference_decays_with_two_whisk_periods() {
        let config = exact(1e-3);
        let offset = 0.2_f64;
        let mut psi = [[1.0, 0.0], [offset.cos(), offset.sin()]];
        let gap = |psi: &[Psi<f64>; 2]| {
            let [l, r] = psi.map(|p| p[1].atan2(p[0]));
            (r - l).abs()
        };
        for _ in 0..2_000 {
            config.step(&mut psi, &NO_NOISE);
        }
        let tau = -2.0 / (gap(&psi) / offset).ln();
        assert!((tau - 1.995).abs() < 0.01, "{tau} whisk periods");
    }

    #[test]
    fn euler_sits_outside_the_circle_as_its_eigenvalues_say() {
        // Each turn multiplies r by √(1 + φ²), the relaxation takes it back.
        let cycles = 5e-3;
        let config = Config::Euler(Euler::new(cycles, true));
        let mut psi = [[1.0, 0.0]; 2];
        for _ in 0..20_000 {
            config.step(&mut psi, &NO_NOISE);
        }
        let r = psi[0][0].hypot(psi[0][1]);
        assert!((r - 1.25).abs() < 0.01, "10 Hz at 2 kHz: r = {r}");
    }

    #[test]
    fn the_origin_is_left_along_protraction_and_nan_is_caught() {
        for config in [exact(1e-3), Config::Euler(Euler::new(1e-3, true))] {
            let mut psi = [[0.0; 2]; 2];
            config.step(&mut psi, &NO_NOISE);
            assert!(psi[0][0] > 0.0 && psi[0][1].abs() < 1e-5, "{psi:?}");
            let mut psi = [[f64::NAN, 1.0], [f64::INFINITY, 0.0]];
            for _ in 0..100 {
                config.step(&mut psi, &NO_NOISE);
            }
            assert!(psi.iter().flatten().all(|x| x.abs() <= 1.5), "{psi:?}");
        }
    }

    #[test]
    fn one_side_alone_is_the_same_oscillator() {
        for config in [exact(1e-3), Config::Euler(Euler::new(1e-3, true))] {
            let (mut one, mut two) = ([[0.6, 0.2]], [[0.6, 0.2]; 2]);
            for _ in 0..700 {
                config.step(&mut one, &[[0.0; 2]]);
                config.step(&mut two, &NO_NOISE);
            }
            for k in 0..2 {
                assert!((one[0][k] - two[0][k]).abs() < 1e-13);
            }
        }
    }
}
