//! The truth of the accuracy report: the continuous equations, solved in f64 so
//! finely that rounding is all that is left.
//!
//! Time is in whisks and velocity in units of the natural frequency, so that
//! neither frequency nor tick appears: with m = T_W²/100 and τ = 2 T_W
//! (BIOTACT eqs. 3, 4, 7 as mended) every whisk frequency has the same solution.

use std::f64::consts::TAU;

/// Points of the solution a whisk: a multiple of the ticks of every row of the
/// report.
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

/// ψ and (θ, v) of both sides.
#[derive(Debug, Clone, Copy, PartialEq)]
struct State {
    psi: [[f64; 2]; 2],
    whisker: [[f64; 2]; 2],
}

impl State {
    /// Change a whisk under the gain `push` = 1.45 g.
    fn rate(&self, push: f64) -> Self {
        let side = |side: usize| {
            let [a, b] = self.psi[side];
            let other = self.psi[1 - side][0];
            let pull = (1.0 / libm::sqrt(a * a + b * b) - 1.0) / 2.0;
            [pull * a - TAU * b + (other - a) / 2.0, pull * b + TAU * a]
        };
        let whisker = |side: usize| {
            let [theta, v] = self.whisker[side];
            let force = push * force(self.psi[side][0], theta);
            [STIFFNESS * v, STIFFNESS * (force - theta - 4.0 * v)]
        };
        Self {
            psi: [side(0), side(1)],
            whisker: [whisker(0), whisker(1)],
        }
    }

    fn moved(&self, h: f64, rate: &Self) -> Self {
        let sum = |x: [f64; 2], k: [f64; 2]| [x[0] + h * k[0], x[1] + h * k[1]];
        let both = |x: [[f64; 2]; 2], k: [[f64; 2]; 2]| [sum(x[0], k[0]), sum(x[1], k[1])];
        Self {
            psi: both(self.psi, rate.psi),
            whisker: both(self.whisker, rate.whisker),
        }
    }

    /// One step of `h` whisks by the classical Runge-Kutta method.
    fn runge_kutta(&self, h: f64, push: f64) -> Self {
        let k1 = self.rate(push);
        let k2 = self.moved(h / 2.0, &k1).rate(push);
        let k3 = self.moved(h / 2.0, &k2).rate(push);
        let k4 = self.moved(h, &k3).rate(push);
        [(1.0, k1), (2.0, k2), (2.0, k3), (1.0, k4)]
            .iter()
            .fold(*self, |sum, (weight, k)| sum.moved(weight * h / 6.0, k))
    }

    fn theta(&self) -> [f64; 2] {
        self.whisker.map(|[theta, _]| theta)
    }
}

/// f = W exp(−θ²) of eqs. 6 and 8.
fn force(psi_1: f64, theta: f64) -> f64 {
    f64::midpoint(libm::tanh(2.0 * psi_1), 1.0) * libm::exp(-theta * theta)
}

/// θ of both sides at every point of the grid.
#[derive(Debug)]
pub(super) struct Truth(Vec<[f64; 2]>);

impl Truth {
    /// [`WHISKS`] whisks of `case`.
    pub(super) fn solve(case: &Case) -> Self {
        let mut state = State {
            psi: case.psi,
            whisker: [[0.0; 2]; 2],
        };
        let mut theta = vec![state.theta()];
        for _ in 0..WHISKS * GRID {
            state = state.runge_kutta(1.0 / GRID as f64, PEAK_GAIN * case.gain);
            theta.push(state.theta());
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
