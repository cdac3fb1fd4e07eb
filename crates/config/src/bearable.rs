//! Whisking that a motor cannot bear: its winding is too hot before it has whisked for long.
//!
//! A whisk of amplitude A at ω asks the position control u = k_p (s − x) − k_d dx/dt of a motor
//! τ d²x/dt² = ω₀ u − dx/dt for
//!
//! |u| = A k_p |τ (jω)² + jω| / |τ (jω)² + (1 + k_d ω₀) jω + k_p ω₀|
//!
//! of duty. Friction is left out, which counts where whisking is slow and bearable. Of the simulated
//! motor with a gain of 1 the mean square is within 4 % from 10 to 16 Hz (unit test).

use core::f64::consts::{SQRT_2, TAU};

use scene::{MotorSection, WhiskingSection};
use whisking::motor::WINDING_S;

use crate::module::TOP_SPEED;

/// Amplitude of the fundamental of a whisk with a gain of 1, degrees.
const AMPLITUDE_DEG: f64 = 21.0;

/// For how long a motor must bear its whisking, s: a bout of a rat's lasts for some seconds.
const BOUT_S: f64 = 6.0;

/// The lowest frequency that a scene may have, Hz.
const SLOWEST_HZ: f64 = 0.05;

/// Whisking that is too fast for a motor.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "whisking.frequency_hz: found {found}; the motor bears it for {bears_s:.1} s, with {duty:.2} of \
     duty where motor.continuous_duty is {continuous}; allowed: {}", self.allowed()
)]
pub struct Unbearable {
    /// The scene's frequency, Hz.
    pub found: f64,
    /// How long the winding bears it, s.
    pub bears_s: f64,
    /// Root of the mean square of the duty.
    pub duty: f64,
    /// What the winding bears for ever.
    pub continuous: f64,
    /// The highest that it bears, Hz.
    pub most: f64,
}

impl Unbearable {
    fn allowed(&self) -> String {
        if self.most < SLOWEST_HZ {
            return "more of motor.continuous_duty, or a motor of more top_speed_deg_s".to_owned();
        }
        format!("at most {:.1} with these gains", self.most)
    }
}

pub(crate) fn check(whisking: &WhiskingSection, motor: &MotorSection) -> Result<(), Unbearable> {
    let gain = whisking.gain.iter().copied().fold(0.0, f64::max);
    let bears = |frequency_hz| {
        let duty = gain * duty(motor, frequency_hz);
        // Driven at its limit one way and the other.
        bears_s(duty.min(motor.duty_limit), motor.continuous_duty)
    };
    let found = whisking.frequency_hz;
    if bears(found) >= BOUT_S {
        return Ok(());
    }
    Err(Unbearable {
        found,
        bears_s: bears(found),
        duty: gain * duty(motor, found),
        continuous: motor.continuous_duty,
        most: crate::edge(found, |frequency_hz| bears(frequency_hz) >= BOUT_S),
    })
}

fn bears_s(duty: f64, continuous: f64) -> f64 {
    let share = (continuous / duty).powi(2);
    if share < 1.0 {
        -WINDING_S * (-share).ln_1p()
    } else {
        f64::INFINITY
    }
}

/// Root of the mean square of the duty that whisking with a gain of 1 takes.
fn duty(motor: &MotorSection, frequency_hz: f64) -> f64 {
    let omega = TAU * frequency_hz;
    let speed = motor.top_speed_deg_s / TOP_SPEED;
    let inertia = motor.time_constant_s * omega * omega;
    let wanted = motor.kp * inertia.hypot(omega);
    let stiff = motor.kp * speed - inertia;
    let damped = (1.0 + motor.kd * speed) * omega;
    AMPLITUDE_DEG / SQRT_2 * wanted / stiff.hypot(damped)
}

#[cfg(test)]
mod tests {
    use super::{Unbearable, bears_s, duty};
    use crate::tests::scene;
    use scene::{MotorSection, Scene};

    fn at(frequency_hz: f64) -> Scene {
        let frequency = format!("whisking.frequency_hz={frequency_hz:?}");
        scene(&[&frequency, "whisking.gain=1"])
    }

    fn motor() -> MotorSection {
        at(8.0).motor.unwrap()
    }

    fn check(frequency_hz: f64) -> Result<(), Unbearable> {
        super::check(&at(frequency_hz).whisking.unwrap(), &motor())
    }

    /// What the simulated motor took, in two seconds of whisking.
    #[test]
    fn the_duty_of_whisking_is_that_of_the_simulated_motor() {
        for (hz, simulated) in [(10.0, 0.283), (12.0, 0.382), (14.0, 0.496), (16.0, 0.613)] {
            let found = duty(&motor(), hz);
            assert!((found / simulated - 1.0).abs() < 0.05, "{hz}: {found}");
        }
        // Heat came after 8.57 s at 14 Hz, after 4.50 s at 16 Hz.
        for (duty, after) in [(0.496, 8.57), (0.613, 4.50)] {
            assert!((bears_s(duty, 0.4) / after - 1.0).abs() < 0.05);
        }
    }

    #[test]
    fn what_a_motor_bears_is_taken_and_what_it_does_not_is_refused_by_name() {
        for frequency_hz in [0.05, 8.0, 14.0] {
            assert_eq!(check(frequency_hz), Ok(()));
        }
        for frequency_hz in [16.0, 20.0, 25.0] {
            let refused = check(frequency_hz).unwrap_err();
            assert!((14.0..16.0).contains(&refused.most), "{refused}");
            let says = refused.to_string();
            assert!(says.starts_with("whisking.frequency_hz: found"));
        }
    }
}
