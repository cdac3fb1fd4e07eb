//! A whisker's motor in its position loop: what the pattern generator asks for
//! and what the whisker then does.
//!
//! The controller and the driver are the module's own ([`whisking::pd`],
//! [`HBridge`]); motor, gear and encoder are [`SimMotor`]'s. A whisker that is
//! bent pulls back on its motor.

use firmware::AngleInput;
use serde::Deserialize;
use whisking::motor::{HBridge, MotorDriver};
use whisking::pd;

use super::read::{OutOfRange, within};
use host_sim::motor::{MotorSettings, SimDir, SimEncoder, SimMotor, SimPwm};

/// The position loop; see `studies/rigs/head.toml` for each key.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "each key is documented in rigs/head.toml")]
pub struct Loop {
    pub follows: bool,
    pub kp: f64,
    pub kd: f64,
    pub slew_per_s: f64,
    pub min_deg: f64,
    pub max_deg: f64,
}

impl Loop {
    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        within("kp", self.kp, 0.0, 1e3)?;
        within("kd", self.kd, 0.0, 1e3)?;
        within("slew_per_s", self.slew_per_s, 1.0, 1e6)?;
        within("min_deg", self.min_deg, -180.0, 180.0)?;
        within("max_deg", self.max_deg, self.min_deg, 360.0)?;
        Ok(())
    }
}

/// A motor that follows.
#[derive(Debug)]
pub(super) struct Follower {
    config: pd::Config<f64>,
    state: pd::State<f64>,
    driver: HBridge<SimPwm, SimDir>,
    encoder: SimEncoder,
    counts: i32,
    motor: SimMotor,
}

impl Follower {
    /// A motor at rest at θ' = 50 degrees; what refuses a setting otherwise.
    pub(super) fn new(settings: &Loop, tick_hz: f64) -> Result<Self, String> {
        let motor = MotorSettings::DEFAULT;
        let pd = pd::Settings {
            kp: settings.kp,
            kd: settings.kd,
            limit: 1.0,
            slew_per_s: settings.slew_per_s,
            min_deg: settings.min_deg,
            max_deg: settings.max_deg,
            degrees_per_count: motor.degrees_per_count(),
        };
        let config = pd.build(tick_hz).map_err(|error| error.to_string())?;
        let (motor, pins) = SimMotor::brushed(motor).map_err(|error| error.to_string())?;
        Ok(Self {
            config,
            state: pd::State::default(),
            driver: HBridge::new(pins.pwm, pins.dir),
            encoder: pins.encoder,
            counts: 0,
            motor,
        })
    }

    /// One tick towards the protraction θ against a torque on the whisker, N·m,
    /// positive towards protraction; the angle θ' after it, degrees.
    pub(super) fn step(&mut self, theta: f64, load_nm: f64, dt_s: f64) -> f64 {
        let counts = self.encoder.counts();
        let moved = counts.wrapping_sub(std::mem::replace(&mut self.counts, counts));
        let duty = self.config.step(&mut self.state, theta, counts, moved);
        // Pins of a simulated bridge do not fail; a duty that is not taken is
        // the last one again.
        let _ = self.driver.drive(duty);
        self.motor.set_load_nm(load_nm);
        self.motor.advance(dt_s);
        self.motor.angle_deg()
    }
}

#[cfg(test)]
mod tests {
    use super::{Follower, Loop};
    use whisking::protraction;

    const LOOP: Loop = Loop {
        follows: true,
        kp: 0.05,
        kd: 0.0004,
        slew_per_s: 400.0,
        min_deg: 30.0,
        max_deg: 160.0,
    };

    /// At rest the duty k_p e balances load and friction: the drive is
    /// k U/R · k_p e at the rotor, so that a load of τ leaves an error between
    /// (τ/G ± τ_c)/(k_p k U/R).
    #[test]
    fn a_load_leaves_the_error_that_the_gain_allows() {
        let mut follower = Follower::new(&LOOP, 2000.0).unwrap();
        let load = -2e-3_f64;
        let mut angle = 0.0;
        for _ in 0..4000 {
            angle = follower.step(protraction(100.0), load, 5e-4);
        }
        let full = 2.5e-3 * 6.0 / 25.0 * LOOP.kp;
        let [least, most] = [-3e-5, 3e-5].map(|friction| (-load / 11.0 + friction) / full);
        let error = 100.0 - angle;
        assert!(
            (least - 0.1..most + 0.1).contains(&error),
            "{error}: {least} to {most}"
        );
    }

    #[test]
    fn a_loop_with_a_setting_out_of_range_is_refused() {
        assert!(
            Follower::new(
                &Loop {
                    kp: f64::NAN,
                    ..LOOP
                },
                2000.0
            )
            .is_err()
        );
        assert!(LOOP.check().is_ok());
        assert!(
            Loop {
                max_deg: 0.0,
                ..LOOP
            }
            .check()
            .is_err()
        );
    }
}
