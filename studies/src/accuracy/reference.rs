//! The truth of the accuracy report: the continuous equations, solved in f64 so
//! finely that rounding is all that is left.
//!
//! Time is in whisks and velocity in units of the natural frequency, so that
//! neither frequency nor tick appears: with m = T_W²/100 and τ = 2 T_W
//! (BIOTACT eqs. 3, 4, 7 as mended) every whisk frequency has the same solution.

use std::f64::consts::TAU;

/// Points of the solution a whisk: a multiple of the ticks of every row of the report.
pub(super) const GRID: usize = 40_000;
pub(super) const WHISKS: usize = 10;
/// 1.45 (BIOTACT eq. 8).
const PEAK_GAIN: f64 = 1.45;
/// ω_n/f_W, rad.
const STIFFNESS: f64 = 10.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Case {
    pub(super) psi: [[f64; 2]; 2],
    pub(super) gain: f64,
}

/// ψ of the left and the right, then (θ, v) of both.
type State = [f64; 8];

/// Change a whisk under the gain `push` = 1.45 g.
fn rate([a, b, c, d, theta_l, v_l, theta_r, v_r]: State, push: f64) -> State {
    let side = |[a, b]: [f64; 2], other: f64| {
        let pull = (1.0 / libm::sqrt(a * a + b * b) - 1.0) / 2.0;
        [pull * a - TAU * b + (other - a) / 2.0, pull * b + TAU * a]
    };
    let whisker = |psi_1: f64, theta: f64, v: f64| {
        let force = push * force(psi_1, theta);
        [STIFFNESS * v, STIFFNESS * (force - theta - 4.0 * v)]
    };
    let ([da, db], [dc, dd]) = (side([a, b], c), side([c, d], a));
    let ([to_l, pull_l], [to_r, pull_r]) = (whisker(a, theta_l, v_l), whisker(c, theta_r, v_r));
    [da, db, dc, dd, to_l, pull_l, to_r, pull_r]
}

fn moved(state: State, h: f64, rate: State) -> State {
    core::array::from_fn(|n| state[n] + h * rate[n])
}

fn runge_kutta(state: State, h: f64, push: f64) -> State {
    let k1 = rate(state, push);
    let k2 = rate(moved(state, h / 2.0, k1), push);
    let k3 = rate(moved(state, h / 2.0, k2), push);
    let k4 = rate(moved(state, h, k3), push);
    let parts = [(1.0, k1), (2.0, k2), (2.0, k3), (1.0, k4)].into_iter();
    parts.fold(state, |sum, (weight, k)| moved(sum, weight * h / 6.0, k))
}

/// f = W exp(−θ²) of eqs. 6 and 8.
fn force(psi_1: f64, theta: f64) -> f64 {
    f64::midpoint(libm::tanh(2.0 * psi_1), 1.0) * libm::exp(-theta * theta)
}

/// θ of both sides at every point of the grid.
pub(super) struct Truth(Vec<[f64; 2]>);

impl Truth {
    pub(super) fn solve(case: &Case) -> Self {
        let [[a, b], [c, d]] = case.psi;
        let mut state = [a, b, c, d, 0.0, 0.0, 0.0, 0.0];
        let mut theta = vec![[0.0; 2]];
        for _ in 0..WHISKS * GRID {
            state = runge_kutta(state, 1.0 / GRID as f64, PEAK_GAIN * case.gain);
            theta.push([state[4], state[6]]);
        }
        Self(theta)
    }

    pub(super) fn theta(&self, point: usize) -> Option<[f64; 2]> {
        self.0.get(point).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::{GRID, Truth};
    use crate::accuracy::integrators::NEAR;

    /// Rows of an independent solver (DOP853 at 1e-13), ticks of 0.5 ms.
    const DOP853: [(usize, &str); 3] = [
        (2, include_str!("../../../tests/reference/whisk_2hz.csv")),
        (8, include_str!("../../../tests/reference/whisk_8hz.csv")),
        (25, include_str!("../../../tests/reference/whisk_25hz.csv")),
    ];

    #[test]
    fn the_truth_is_that_of_an_independent_solver() {
        let truth = Truth::solve(&NEAR);
        let mut worst = 0.0_f64;
        for (frequency_hz, text) in DOP853 {
            assert!(text.lines().count() > 300);
            for row in text.lines().skip(1) {
                let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
                let point = cells[0] as usize * GRID * frequency_hz / 2_000;
                let theta = truth.theta(point).unwrap();
                for side in 0..2 {
                    worst = worst.max((100.0 * theta[side] + 50.0 - cells[side + 1]).abs());
                }
            }
        }
        assert!(worst < 1e-10, "{worst:e} degrees");
    }
}
