//! Whether a motor bears its gains: how the position control answers a step, by a model of the
//! motor.
//!
//! The model, τ d²x/dt² = ω₀ u − dx/dt, under u = k_p (s − x) − k_d dx/dt is late in two places:
//! a duty acts a tick and a half after the angle that it comes from (T), and the low-pass on the
//! velocity takes more of the same time (T_v in all). To the first power of both it is
//!
//! (τ − ω₀ k_d T_v) d²x/dt² + (1 + ω₀ k_d − ω₀ k_p T) dx/dt + ω₀ k_p x = ω₀ k_p s.
//!
//! A damping ratio of [`DAMPING`] is asked of it, and that the delays and the slew of the duty stay
//! small beside how fast it swings. So much leaves room for motors that are not as the model
//! has them: with speed and time constant wrong by 30 %, each way, a step of 5, 20 or 80 degrees
//! overshoots by at most 0.7 of it, by less than a half in 99 of 100 combinations of motor, gains,
//! encoder and rate, and then moves within a tenth of it or four counts of the encoder
//! (`tests/tests/suite/gains.rs`). Friction only damps.

use super::Config;
use crate::Real;
use crate::motor::ModelConfig;

/// Least damping ratio, 0.3, times two, squared; Q24 as all here.
const DAMPING: i32 = 6_039_798;
/// Most of the inertia that the delay of the derivative may take: 0.75.
const LATE_VELOCITY: i32 = 12_582_912;
/// Most radians that the natural frequency goes through in the delay, 0.5, squared.
const LATE: i32 = 4_194_304;
/// The fastest change of the duty, of what a swing at the natural frequency takes: 2.5 at least,
/// squared; half of it.
const SLEW: i32 = 52_428_800;
/// The motor's speed, of the model's, which is weak: 4/3.
const SPEED: i32 = 22_369_621;

/// What a motor does not bear.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unborne {
    /// k_p is too large, for this k_d at least.
    Kp,
    /// k_d is too large.
    Kd,
    /// The duty changes too slowly for k_p.
    Slew,
}

impl<R: Real> Config<R> {
    /// Whether the motor of a model settles after a step of its setpoint.
    ///
    /// # Errors
    /// What is to change. Of numbers within the bounds of a configuration there is always an
    /// answer; where they are too large for the number format it is a refusal.
    #[inline(never)]
    pub fn settles(&self, model: &ModelConfig<R>) -> Result<(), Unborne> {
        let q24 = R::from_q24;
        // Per tick: 1/τ, ω₀/τ, and with the gains.
        let rate = times(R::ONE, model.rate);
        let drive = product(times(rate, model.speed), q24(SPEED));
        let (damps, pulls) = (times(drive, self.kd), times(drive, self.kp));
        // 1/smooth ticks and a half is T_v: all is multiplied by it.
        let smooth = times(R::ONE, self.smooth);
        let late = R::ONE + smooth.halved();
        let damps_late = product(damps, late);
        if damps_late > product(smooth, q24(LATE_VELOCITY)) {
            return Err(Unborne::Kd);
        }
        let turns = product(product(pulls.clamp(R::ZERO, R::ONE), late), late);
        if turns > product(product(smooth, smooth), q24(LATE)) {
            return Err(Unborne::Kp);
        }
        let damping = rate + damps - pulls - pulls.halved();
        let damped = product(product(damping, damping), smooth);
        let inertia = product(product(pulls, smooth - damps_late), q24(DAMPING));
        if damping < R::ZERO || damped < inertia {
            return Err(Unborne::Kp);
        }
        // An error of a hundred degrees is one.
        let swing = times(R::ONE, self.kp).clamp(R::ZERO, q24(self.limit));
        let needed = product(product(product(pulls, q24(SLEW)), swing), swing);
        let slew = q24(self.slew);
        if product(slew, slew.halved()) < needed {
            return Err(Unborne::Slew);
        }
        Ok(())
    }
}

fn product<R: Real>(x: R, y: R) -> R {
    x * y
}

fn times<R: Real>(x: R, factor: R::Coefficient) -> R {
    x.times(factor)
}
