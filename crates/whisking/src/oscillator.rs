//! The two coupled oscillators (BIOTACT eqs. 1 to 5).
//!
//! In Cartesian form dψ_i/dt = ((1 − r)/(τ_r r)) ψ_i + ω J ψ_i + (ψ_j1 − ψ_i1, 0)/τ_11
//! with ω = 2π f_W, J = (0, −1; 1, 0) and τ_r = τ_11 = 2 T_W: no angle, sine or
//! cosine in the tick. At the origin, where eq. 3 has no direction, the radial
//! force pushes along +ψ_1.
//!
//! Two integrators. [`Euler`] is the papers', step for step. [`Exact`] splits
//! the field in two parts, each solved exactly: the linear part L (the sum of
//! the sides rotates, their difference rotates and decays: a 2 × 2 exponential)
//! and the radial relaxation R, r → 1 + (r − 1) exp(−T/τ_r). A tick is the
//! symmetric product L½ R L½; as each half of L meets the next tick's, what is
//! kept is χ = L½⁻¹ ψ, which a tick takes to R L χ, and ψ = L½ χ is worked out
//! where it is asked for. Without noise the limit cycle has radius one to
//! rounding, at any f_W T.

use crate::Real;
use crate::linalg::{Matrix, exponential, identity, scaled};

/// ψ of one side: drive state and recovery state.
pub type Psi<R> = [R; 2];

/// Radial and coupling time constants in whisk periods, τ_r/T_W = τ_11/T_W = 2.
const TAU_PERIODS: f64 = 2.0;

/// The oscillators of all sides: ψ for [`Euler`], χ for [`Exact`], and what
/// rounding took from their sums.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State<R: Real, const S: usize> {
    kept: [Psi<R>; S],
    carry: [[R::Carry; 2]; S],
}

impl<R: Real, const S: usize> State<R, S> {
    /// From what [`Config::keep`] made of the ψ to start from.
    pub fn new(kept: [Psi<R>; S]) -> Self {
        Self {
            kept,
            carry: [[R::Carry::default(); 2]; S],
        }
    }
}

/// Which integrator steps the oscillators, with its constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Config<R: Real> {
    /// Forward Euler.
    Euler(Euler<R>),
    /// Exact parts, symmetrically composed.
    Exact(Exact<R>),
}

/// Forward Euler: every right-hand side at the state before the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Euler<R: Real> {
    /// T/τ_r.
    pub relax: R::Coefficient,
    /// 2π f_W T.
    pub turn: R::Coefficient,
    /// T/τ_11; zero without coupling.
    pub couple: R::Coefficient,
}

/// The structure-preserving step, in increments (coefficients near one would
/// cost formats with few digits several of them).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exact<R: Real> {
    /// A whole tick of L.
    pub tick: Linear<R>,
    /// Half a tick.
    pub half: Linear<R>,
    /// 1 − exp(−T/τ_r).
    pub relax: R::Coefficient,
}

/// Half of exp(A t) − 1, for the sum and for the difference of the sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Linear<R: Real> {
    /// Of the sum: a rotation.
    pub sum: [[R::Coefficient; 2]; 2],
    /// Of the difference: rotation and decay.
    pub difference: [[R::Coefficient; 2]; 2],
}

/// The pull of `share` of the way towards the unit circle; along +ψ_1 at the origin.
#[inline]
fn pull<R: Real>([a, b]: Psi<R>, share: R::Coefficient) -> Psi<R> {
    match R::unit(a, b) {
        Some([x, y]) => [(x - a).times(share), (y - b).times(share)],
        None => [R::ONE.times(share), R::ZERO],
    }
}

/// `m v` of a 2 × 2 matrix.
#[inline]
fn apply<R: Real>(m: &[[R::Coefficient; 2]; 2], [a, b]: Psi<R>) -> Psi<R> {
    [
        a.times(m[0][0]) + b.times(m[0][1]),
        a.times(m[1][0]) + b.times(m[1][1]),
    ]
}

impl<R: Real> Euler<R> {
    /// For `cycles` = f_W T whisks a tick.
    pub(crate) fn new(cycles: f64, coupling: bool) -> Self {
        let rate = cycles / TAU_PERIODS;
        Self {
            relax: R::coefficient(rate),
            turn: R::coefficient(core::f64::consts::TAU * cycles),
            couple: R::coefficient(if coupling { rate } else { 0.0 }),
        }
    }

    /// T dψ/dt of a side beside whose drive state the other's is `other`.
    #[inline]
    fn rate(&self, [a, b]: Psi<R>, other: R) -> Psi<R> {
        let [x, y] = pull([a, b], self.relax);
        [
            x - b.times(self.turn) + (other - a).times(self.couple),
            y + a.times(self.turn),
        ]
    }

    #[inline]
    fn increments<const S: usize>(&self, psi: &[Psi<R>; S]) -> [Psi<R>; S] {
        // A lone side pulls on itself, which is nothing.
        core::array::from_fn(|side| self.rate(psi[side], psi[(side + 1) % S][0]))
    }
}

impl<R: Real> Linear<R> {
    fn new(cycles: f64, coupling: bool, ticks: f64) -> Self {
        let omega = core::f64::consts::TAU * cycles;
        let couple = if coupling {
            2.0 * cycles / TAU_PERIODS
        } else {
            0.0
        };
        let half = |m: Matrix<2>| m.map(|row| row.map(|x| R::coefficient(x / 2.0)));
        Self {
            sum: half(grown(omega, 0.0, ticks)),
            difference: half(grown(omega, couple, ticks)),
        }
    }

    /// What L adds to every side.
    #[inline]
    fn increments<const S: usize>(&self, at: &[Psi<R>; S]) -> [Psi<R>; S] {
        let mut out = *at;
        if let ([l, r], [left, right]) = (&at[..], &mut out[..]) {
            let [s0, s1] = apply(&self.sum, [l[0] + r[0], l[1] + r[1]]);
            let [d0, d1] = apply(&self.difference, [l[0] - r[0], l[1] - r[1]]);
            *left = [s0 + d0, s1 + d1];
            *right = [s0 - d0, s1 - d1];
        } else {
            for side in &mut out {
                let [a, b] = apply(&self.sum, *side);
                *side = [a + a, b + b];
            }
        }
        out
    }
}

/// exp(A t) − 1 of the linear field on the sum (`couple` 0) or the difference
/// (`couple` 2 T/τ_11), `ticks` long.
fn grown(omega: f64, couple: f64, ticks: f64) -> Matrix<2> {
    let mut m = exponential(&scaled(&[[-couple, -omega], [omega, 0.0]], ticks));
    for (x, one) in m.iter_mut().flatten().zip(identity::<2>().iter().flatten()) {
        *x -= one;
    }
    m
}

impl<R: Real> Exact<R> {
    /// For `cycles` = f_W T whisks a tick.
    pub(crate) fn new(cycles: f64, coupling: bool) -> Self {
        Self {
            tick: Linear::new(cycles, coupling, 1.0),
            half: Linear::new(cycles, coupling, 0.5),
            relax: R::coefficient(-libm::expm1(-cycles / TAU_PERIODS)),
        }
    }

    #[inline]
    fn increments<const S: usize>(&self, chi: &[Psi<R>; S]) -> [Psi<R>; S] {
        let mut change = self.tick.increments(chi);
        for (change, chi) in change.iter_mut().zip(chi) {
            let [x, y] = pull([chi[0] + change[0], chi[1] + change[1]], self.relax);
            *change = [change[0] + x, change[1] + y];
        }
        change
    }
}

impl<R: Real> Config<R> {
    /// One tick. `noise` is T P_i (eq. 5); each state is limited to ±1.5
    /// afterwards, NaN included.
    #[inline]
    pub fn step<const S: usize>(&self, state: &mut State<R, S>, noise: Option<&[Psi<R>; S]>) {
        let mut change = match self {
            Self::Euler(euler) => euler.increments(&state.kept),
            Self::Exact(exact) => exact.increments(&state.kept),
        };
        // Loops over constant bounds: the compiler unrolls them, as it does not
        // flattened iterators.
        for side in 0..S {
            for k in 0..2 {
                if let Some(noise) = noise {
                    change[side][k] = change[side][k] + noise[side][k];
                }
                let x = &mut state.kept[side][k];
                x.accumulate(&mut state.carry[side][k], change[side][k]);
                *x = x.clamp(-R::PSI_LIMIT, R::PSI_LIMIT);
            }
        }
    }

    /// ψ of every side.
    #[inline]
    pub fn psi<const S: usize>(&self, state: &State<R, S>) -> [Psi<R>; S] {
        let mut psi = state.kept;
        if let Self::Exact(exact) = self {
            let half = exact.half.increments(&state.kept);
            for side in 0..S {
                for k in 0..2 {
                    // χ may stand in a corner of its square, from which L½ leads out.
                    let x = psi[side][k] + half[side][k];
                    psi[side][k] = x.clamp(-R::PSI_LIMIT, R::PSI_LIMIT);
                }
            }
        }
        psi
    }
}

/// What the integrator of `config` keeps of the ψ to start from: ψ itself, or
/// χ = L½⁻¹ ψ. `cycles` is f_W T.
pub(crate) fn keep<R: Real, const S: usize>(
    config: &Config<R>,
    psi: &[Psi<f64>; S],
    cycles: f64,
    coupling: bool,
) -> [Psi<f64>; S] {
    let mut kept = *psi;
    if let Config::Exact(_) = config {
        let back = Linear::<f64>::new(cycles, coupling, -0.5).increments(psi);
        for (x, back) in kept.iter_mut().flatten().zip(back.iter().flatten()) {
            *x += back;
        }
    }
    kept
}

/// The continuous field dψ/dt in ticks, f64; `cycles` is f_W T.
pub(crate) fn field<const S: usize>(
    psi: &[Psi<f64>; S],
    cycles: f64,
    coupling: bool,
) -> [Psi<f64>; S] {
    Euler::new(cycles, coupling).increments(psi)
}

#[cfg(test)]
mod tests {
    use super::{Config, Euler, Exact, Psi, State, keep};
    use crate::{Fix, Real};

    /// Oscillators at work: configuration and state.
    struct Running<R: Real, const S: usize>(Config<R>, State<R, S>);

    impl<R: Real, const S: usize> Running<R, S> {
        fn exact(cycles: f64, psi: [Psi<f64>; S]) -> Self {
            Self::new(Config::Exact(Exact::new(cycles, true)), cycles, psi)
        }

        fn euler(cycles: f64, psi: [Psi<f64>; S]) -> Self {
            Self::new(Config::Euler(Euler::new(cycles, true)), cycles, psi)
        }

        fn new(config: Config<R>, cycles: f64, psi: [Psi<f64>; S]) -> Self {
            let kept = keep(&config, &psi, cycles, true);
            Self(config, State::new(kept.map(|p| p.map(R::from_f64))))
        }

        fn run(&mut self, ticks: usize) -> [Psi<f64>; S] {
            for _ in 0..ticks {
                self.0.step(&mut self.1, None);
            }
            self.0.psi(&self.1).map(|p| p.map(R::to_f64))
        }
    }

    fn radius([a, b]: Psi<f64>) -> f64 {
        a.hypot(b)
    }

    #[test]
    fn the_limit_cycle_is_the_unit_circle_at_any_step_and_in_any_format() {
        fn check<R: Real>(rounding: f64) {
            for cycles in [1e-4, 1e-3, 1.25e-2, 0.1] {
                let mut running = Running::<R, 2>::exact(cycles, [[1.0, 0.0]; 2]);
                let whisk = (1.0 / cycles) as usize;
                for _ in 0..8 {
                    for psi in running.run(whisk / 8 + 1) {
                        assert!(
                            (radius(psi) - 1.0).abs() < rounding,
                            "{cycles}: {}",
                            radius(psi)
                        );
                    }
                }
            }
        }
        check::<f64>(1e-12);
        check::<f32>(3e-7);
        check::<Fix>(3e-7);
    }

    #[test]
    fn a_start_inside_or_outside_relaxes_with_two_whisk_periods() {
        for start in [0.3, 1.4] {
            let mut running = Running::<f64, 2>::exact(1e-3, [[start, 0.0]; 2]);
            let [left, _] = running.run(2_000);
            let expected = 1.0 + (start - 1.0) * (-1.0_f64).exp();
            assert!((radius(left) - expected).abs() < 1e-7, "{start}");
        }
    }

    #[test]
    fn protraction_comes_first_and_recovery_follows() {
        let [left, _] = Running::<f64, 2>::exact(1e-3, [[1.0, 0.0]; 2]).run(125);
        let eighth = core::f64::consts::FRAC_1_SQRT_2;
        assert!(
            (left[0] - eighth).abs() < 1e-12 && (left[1] - eighth).abs() < 1e-12,
            "{left:?}"
        );
    }

    /// The text's "time constant of one whisking period" is 2.0 T_W of the phase
    /// difference: 1.995 at 0.2 rad in a DOP853 reference.
    #[test]
    fn phase_difference_decays_with_two_whisk_periods() {
        let offset = 0.2_f64;
        let start = [[1.0, 0.0], [offset.cos(), offset.sin()]];
        let [l, r] = Running::<f64, 2>::exact(1e-3, start)
            .run(2_000)
            .map(|p| p[1].atan2(p[0]));
        let tau = -2.0 / ((r - l).abs() / offset).ln();
        assert!((tau - 1.995).abs() < 0.01, "{tau} whisk periods");
    }

    #[test]
    fn euler_sits_outside_the_circle() {
        let [left, _] = Running::<f64, 2>::euler(5e-3, [[1.0, 0.0]; 2]).run(20_000);
        assert!(
            (radius(left) - 1.25).abs() < 0.01,
            "10 Hz at 2 kHz: {}",
            radius(left)
        );
    }

    #[test]
    fn the_origin_is_left_along_protraction_in_every_format() {
        fn check<R: Real>() {
            for mut running in [
                Running::<R, 2>::exact(1e-3, [[0.0; 2]; 2]),
                Running::<R, 2>::euler(1e-3, [[0.0; 2]; 2]),
            ] {
                let [[a, b], _] = running.run(1);
                assert!(a > 1e-4 && b.abs() < 1e-5, "{a} {b}");
                for psi in running.run(20_000) {
                    assert!((radius(psi) - 1.0).abs() < 0.05, "{psi:?}");
                }
            }
        }
        check::<f64>();
        check::<f32>();
        check::<Fix>();
    }

    #[test]
    fn one_side_alone_is_the_same_oscillator() {
        for (mut one, mut two) in [
            (
                Running::<f64, 1>::exact(1e-3, [[0.6, 0.2]]),
                Running::<f64, 2>::exact(1e-3, [[0.6, 0.2]; 2]),
            ),
            (
                Running::<f64, 1>::euler(1e-3, [[0.6, 0.2]]),
                Running::<f64, 2>::euler(1e-3, [[0.6, 0.2]; 2]),
            ),
        ] {
            let ([one], [two, _]) = (one.run(700), two.run(700));
            for k in 0..2 {
                assert!((one[k] - two[k]).abs() < 1e-12);
            }
        }
    }
}
