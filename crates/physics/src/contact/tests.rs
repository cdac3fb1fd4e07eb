//! The force of a contact against its own law.

use proptest::prelude::*;

use super::{Frame, Problem};
use crate::vector::{dot, length};

/// The response of a tip that moves along two ways, as a shaft's does.
fn response(ways: [[f64; 3]; 2], give: f64) -> [[f64; 3]; 3] {
    let entry = |i: usize, j: usize| give * (ways[0][i] * ways[0][j] + ways[1][i] * ways[1][j]);
    core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)))
}

/// Gap and stretch at the end, without slip.
fn end(problem: &Problem, force: [f64; 3]) -> [f64; 3] {
    let start = [problem.gap, problem.stretch[0], problem.stretch[1]];
    core::array::from_fn(|i| {
        let row = problem.response[i];
        start[i] + row[0] * force[0] + row[1] * force[1] + row[2] * force[2]
    })
}

#[test]
fn a_tip_that_only_presses_has_springs_in_series() {
    let problem = Problem {
        gap: -1e-3,
        stretch: [0.0; 2],
        response: response([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], 0.5),
        springs: [0.1, 0.2],
        friction: 0.3,
        near: [0.0; 2],
    };
    let force = problem.solve();
    assert!((force.local[0] - 1e-3 / 0.6).abs() < 1e-15);
    assert!(force.local[1..] == [0.0; 2] && force.stuck);
    // Drawn aside by less than what friction holds, and by more.
    let aside = |first: f64| {
        let stretch = [first, 0.0];
        Problem { stretch, ..problem }.solve()
    };
    let limit = 0.3 * 1e-3 / 0.6 * 0.7;
    let held = aside(0.99 * limit);
    assert!(held.stuck && (held.local[1] + 0.99 * limit / 0.7).abs() < 1e-12);
    let slid = aside(1.01 * limit);
    assert!(!slid.stuck && (slid.local[1] + 0.3 * 1e-3 / 0.6).abs() < 1e-12);
    let stretch = [1.01 * limit, 0.0];
    let slipped = Problem { stretch, ..problem }.slipped(&slid);
    assert!((slipped - 0.01 * limit).abs() < 1e-12);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn the_force_obeys_its_law(
        ways in prop::array::uniform2(prop::array::uniform3(-1.0..1.0_f64)),
        give in -8.0..1.0_f64,
        springs in [-9.0..0.0_f64, -9.0..0.0],
        gap in -6.0..-2.0_f64,
        stretch in [-1e-2..1e-2_f64, -1e-2..1e-2],
        friction in 0.0..2.0_f64,
    ) {
        let springs = springs.map(|s| 10.0_f64.powf(s));
        let problem = Problem {
            gap: -10.0_f64.powf(gap),
            stretch,
            response: response(ways, 10.0_f64.powf(give)),
            springs,
            friction,
            near: [0.0; 2],
        };
        let force = problem.solve();
        let [n, a, b] = force.local;
        prop_assert!(n.is_finite() && n >= 0.0);
        let [gap, s, t] = end(&problem, force.local);
        let size = 1e-9 * (problem.gap.abs() + stretch[0].hypot(stretch[1])) + 1e-6 * springs[0] * n;
        // N = −k g.
        prop_assert!((gap + springs[0] * n).abs() <= size + 1e-9 * n, "{force:?}");
        if force.stuck {
            prop_assert!((s + springs[1] * a).abs() < 1e-7 && (t + springs[1] * b).abs() < 1e-7);
        } else {
            // On the cone, and what it slips is not along the force: it takes
            // energy.
            prop_assert!(a.hypot(b) <= friction * n * (1.0 + 1e-9));
            let slip = [s + springs[1] * a, t + springs[1] * b];
            let work = slip[0] * a + slip[1] * b;
            prop_assert!(work <= 1e-6 * slip[0].hypot(slip[1]) * a.hypot(b) + 1e-15, "{work}");
            let aside = slip[0] * b - slip[1] * a;
            prop_assert!(aside.abs() <= 1e-6 * slip[0].hypot(slip[1]) * a.hypot(b) + 1e-15, "{aside}");
        }
    }

    #[test]
    fn a_frame_is_orthonormal_and_its_normal_that_of_the_ground(p in -5.0..5.0_f64, q in -5.0..5.0_f64) {
        let frame = Frame::new([p, q]);
        for (i, a) in frame.axes.iter().enumerate() {
            prop_assert!((length(*a) - 1.0).abs() < 1e-12);
            for b in &frame.axes[..i] {
                prop_assert!(dot(*a, *b).abs() < 1e-12);
            }
        }
        // Ways up the ground along both coordinates.
        prop_assert!(dot(frame.axes[0], [1.0, 0.0, p]).abs() < 1e-12);
        prop_assert!(dot(frame.axes[0], [0.0, 1.0, q]).abs() < 1e-12);
        prop_assert!((frame.axes[0][2] - frame.upright).abs() < 1e-15);
        let v = [0.3, -0.2, 0.9];
        let back = frame.plate(frame.local(v));
        for (v, back) in v.iter().zip(back) {
            prop_assert!((v - back).abs() < 1e-12);
        }
    }
}
