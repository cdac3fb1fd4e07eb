//! A simple split step in f64, for comparison: rotation with radial relaxation,
//! coupling in two halves around it, and the muscle's linear part, each exact;
//! the force at the middle of the tick. Of second order.

use std::f64::consts::TAU;

use super::reference::{STIFFNESS, State, force};

/// Its constants.
pub(super) struct Split {
    turn: [f64; 2],
    /// What remains of r − 1 after a tick, and of ψ_left1 − ψ_right1 after half of one.
    decay: f64,
    whole: [[f64; 2]; 2],
    half: [[f64; 2]; 2],
    push: f64,
}

impl Split {
    /// For `cycles` = f_W T and the gain `push` = 1.45 g.
    pub(super) fn new(cycles: f64, push: f64) -> Self {
        let (sin, cos) = libm::sincos(TAU * cycles);
        Self {
            turn: [cos, sin],
            decay: libm::exp(-cycles / 2.0),
            whole: propagator(STIFFNESS * cycles),
            half: propagator(STIFFNESS * cycles / 2.0),
            push,
        }
    }

    /// One tick.
    pub(super) fn step(&self, state: &State) -> State {
        let mut psi = self.coupled(state.psi);
        let [cos, sin] = self.turn;
        for [a, b] in &mut psi {
            let r = libm::sqrt(*a * *a + *b * *b);
            let scale = (1.0 + (r - 1.0) * self.decay) / r;
            [*a, *b] = [scale * (cos * *a - sin * *b), scale * (sin * *a + cos * *b)];
        }
        let psi = self.coupled(psi);
        let mut whisker = state.whisker;
        for (side, whisker) in whisker.iter_mut().enumerate() {
            let before = force(state.psi[side][0], whisker[0]);
            let [theta, _] = answer(&self.half, *whisker, self.push * before);
            let middle = f64::midpoint(state.psi[side][0], psi[side][0]);
            *whisker = answer(&self.whole, *whisker, self.push * force(middle, theta));
        }
        State { psi, whisker }
    }

    /// Half a tick of the coupling alone.
    fn coupled(&self, [[a, b], [c, d]]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
        let give = (a - c) / 2.0 * (1.0 - self.decay);
        [[a - give, b], [c + give, d]]
    }
}

/// exp(A) of A = h (0, 1; −1, −4), by its eigenvalues −h (2 ± √3).
fn propagator(h: f64) -> [[f64; 2]; 2] {
    let root = libm::sqrt(3.0);
    let [slow, fast] = [root - 2.0, -root - 2.0];
    let [e_slow, e_fast] = [libm::exp(h * slow), libm::exp(h * fast)];
    // (e_slow (A/h − fast) − e_fast (A/h − slow))/(slow − fast).
    let entry =
        |a: f64, one: f64| (e_slow * (a - fast * one) - e_fast * (a - slow * one)) / (slow - fast);
    [
        [entry(0.0, 1.0), entry(1.0, 0.0)],
        [entry(-1.0, 0.0), entry(-4.0, 1.0)],
    ]
}

/// The linear muscle's answer to a constant force.
fn answer(m: &[[f64; 2]; 2], [theta, v]: [f64; 2], push: f64) -> [f64; 2] {
    let off = theta - push;
    [
        push + m[0][0] * off + m[0][1] * v,
        m[1][0] * off + m[1][1] * v,
    ]
}
