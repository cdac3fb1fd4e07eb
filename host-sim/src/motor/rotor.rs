//! A rotor under constant torque, linear damping and Coulomb friction, solved exactly.

/// dω/dt = push − rate ω − friction sgn ω, while it lasts constant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Law {
    /// Acceleration at standstill without friction, rad/s².
    pub(super) push: f64,
    /// Damping, 1/s, not negative.
    pub(super) rate: f64,
    /// Coulomb friction, rad/s², not negative.
    pub(super) friction: f64,
}

/// Angle in radians, unlimited, and speed in rad/s.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Rotor {
    pub(super) angle: f64,
    pub(super) speed: f64,
    /// The last product of a rate and a time, which seldom changes, and its [`decays`].
    last: Option<(f64, [f64; 3])>,
}

/// (1 − e^−x)/x, its like of second order, (x − 1 + e^−x)/x², and e^−x, for x ≥ 0.
fn decays(x: f64) -> [f64; 3] {
    let left = libm::exp(-x);
    if x < 1e-2 {
        // Terms to x⁴: relative error below 1e-12; the quotients would cancel.
        let first = 1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0)));
        let second = 0.5 - x / 6.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0 * (1.0 - x / 6.0)));
        [first, second, left]
    } else {
        let first = -libm::expm1(-x) / x;
        [first, (1.0 - first) / x, left]
    }
}

impl Rotor {
    /// Lets `dt` seconds pass.
    ///
    /// Friction takes the speed to zero but never through it: a rotor that
    /// comes to rest stays there unless the push exceeds the friction, and then
    /// sets off with the push. Under a constant law that happens once at most.
    pub(super) fn advance(&mut self, law: &Law, dt: f64) {
        let left = self.run_down(law, dt);
        if left > 0.0 && law.push.abs() > law.friction {
            let push = law.push - law.friction.copysign(law.push);
            self.run(push, law.rate, left);
        }
    }

    /// Holds it between two angles, rad; it comes to rest at either.
    pub(super) fn stop_at(&mut self, [lowest, highest]: [f64; 2]) {
        if self.angle < lowest {
            self.angle = lowest;
            self.speed = self.speed.max(0.0);
        } else if self.angle > highest {
            self.angle = highest;
            self.speed = self.speed.min(0.0);
        }
    }

    /// Moves on with the present direction until the time is up, or to rest; returns the time left.
    fn run_down(&mut self, law: &Law, dt: f64) -> f64 {
        if self.speed == 0.0 {
            return dt;
        }
        let before = self.speed;
        let push = law.push - law.friction.copysign(before);
        let stops = push * before < 0.0;
        // ω reaches 0 where e^(rate t) = 1 − rate ω/push.
        let ratio = -before / push;
        let time = if !stops {
            f64::INFINITY
        } else if law.rate * ratio > 1e-9 {
            libm::log1p(law.rate * ratio) / law.rate
        } else {
            ratio
        };
        self.run(push, law.rate, time.min(dt));
        // Rounding may leave a trace of speed, or of the other sign, at the stop.
        if time <= dt || self.speed * before < 0.0 {
            self.speed = 0.0;
        }
        (dt - time).max(0.0)
    }

    /// dω/dt = push − rate ω for `t` seconds.
    fn run(&mut self, push: f64, rate: f64, t: f64) {
        let x = rate * t;
        let [first, second, left] = match self.last {
            Some((of, decays)) if of == x => decays,
            _ => decays(x),
        };
        self.last = Some((x, [first, second, left]));
        self.angle += self.speed * t * first + push * t * t * second;
        self.speed = self.speed * left + push * t * first;
    }
}

#[cfg(test)]
mod tests {
    use super::{Law, Rotor, decays};
    use proptest::prelude::*;

    #[test]
    fn series_and_quotients_meet() {
        for x in [1e-12, 1e-4, 0.009_999, 0.010_001, 0.1] {
            // Taylor series to ten terms as the truth.
            let (mut first, mut second, mut term) = (0.0, 0.0, 1.0);
            for n in 1..=10 {
                first += term / f64::from(n);
                second += term / f64::from(n * (n + 1));
                term *= -x / f64::from(n);
            }
            let found = decays(x);
            assert!((found[0] - first).abs() < 1e-12, "{x}");
            assert!((found[1] - second).abs() < 1e-11, "{x}");
        }
    }

    #[test]
    fn friction_and_push_are_those_of_the_textbook() {
        for (push, friction, speed, dt, expected) in [
            // Stopped by friction alone after ω²/(2 a).
            (0.0, 50.0, 10.0, 1.0, [1.0, 0.0]),
            (0.0, 50.0, -10.0, 1.0, [-1.0, 0.0]),
            // Braked at 40 for 0.5 s over 5 rad, then −20 for 1 s: −10 rad, −20 rad/s.
            (-30.0, 10.0, 20.0, 1.5, [-5.0, -20.0]),
        ] {
            let (rate, still) = (0.0, Rotor::default());
            let mut rotor = Rotor { speed, ..still };
            rotor.advance(
                &Law {
                    push,
                    rate,
                    friction,
                },
                dt,
            );
            assert!((rotor.angle - expected[0]).abs() < 1e-12, "{rotor:?}");
            assert!((rotor.speed - expected[1]).abs() < 1e-12, "{rotor:?}");
        }
    }

    proptest! {
        /// Many small steps and one large one agree: the solution is exact.
        #[test]
        fn steps_compose(
            push in -1e4_f64..1e4,
            rate in prop_oneof![Just(0.0), 1e-6_f64..1e3],
            friction in 0.0_f64..1e4,
            speed in -1e3_f64..1e3,
            dt in 1e-5_f64..0.1,
        ) {
            let law = Law { push, rate, friction };
            let start = Rotor { speed, ..Rotor::default() };
            let (mut once, mut often) = (start, start);
            once.advance(&law, dt);
            for _ in 0..64 {
                often.advance(&law, dt / 64.0);
            }
            let scale = 1.0 + speed.abs() + push.abs() * dt;
            prop_assert!((once.speed - often.speed).abs() < 1e-9 * scale);
            prop_assert!((once.angle - often.angle).abs() < 1e-9 * scale);
        }
    }
}
