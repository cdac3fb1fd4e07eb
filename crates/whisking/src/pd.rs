//! Position control: proportional to the error, derivative on the measurement
//! (a jump of the setpoint does not kick), limited in size and in slew.
//!
//! Positions are protractions θ (θ' = 100 θ + 50 degrees), the output is a duty
//! in −1..=1: u = ⟨k_p (⟨s⟩ − x) − k_d dx/dt⟩, dx/dt smoothed by a first-order
//! low-pass because an encoder's steps are coarse against one tick.

use crate::{DEGREES_PER_UNIT, Error, Parameter, Real, protraction};

/// Corner of the low-pass on the measured velocity, Hz.
const VELOCITY_CORNER_HZ: f64 = 100.0;

/// Gains and limits in physical units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// k_p, duty a degree of error.
    pub kp: f64,
    /// k_d, duty a degree a second.
    pub kd: f64,
    /// Largest duty, 0 to 1.
    pub limit: f64,
    /// Largest change of the duty, a second.
    pub slew_per_s: f64,
    /// Lowest setpoint, degrees θ'.
    pub min_deg: f64,
    /// Highest setpoint, degrees θ'.
    pub max_deg: f64,
}

/// The same a tick and a unit of protraction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Config<R: Real> {
    /// Duty a unit of error.
    pub kp: R::Coefficient,
    /// Duty a unit a tick.
    pub kd: R::Coefficient,
    /// Share of a new velocity reading in the smoothed one.
    pub smooth: R::Coefficient,
    /// Largest duty.
    pub limit: R,
    /// Largest change of the duty a tick.
    pub slew: R,
    /// Lowest setpoint.
    pub min: R,
    /// Highest setpoint.
    pub max: R,
}

/// What the controller remembers. The default is a motor that is off.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct State<R> {
    measured: Option<R>,
    velocity: R,
    output: R,
}

impl Settings {
    /// Constants for `tick_hz` ticks a second.
    ///
    /// # Errors
    /// [`Parameter::Pd`] if a value is not finite, negative where it must not
    /// be, or the lowest setpoint is not below the highest.
    pub fn build<R: Real>(&self, tick_hz: f64) -> Result<Config<R>, Error> {
        let check = |value, lo, hi| Error::check(Parameter::Pd, value, lo, hi);
        check(tick_hz, f64::MIN_POSITIVE, f64::MAX)?;
        check(self.kp, 0.0, 1e6)?;
        check(self.kd, 0.0, 1e6)?;
        check(self.limit, 0.0, 1.0)?;
        check(self.slew_per_s, 0.0, 1e12)?;
        check(self.min_deg, -1e4, 1e4)?;
        check(self.max_deg, self.min_deg, 1e4)?;
        let smooth = -libm::expm1(-core::f64::consts::TAU * VELOCITY_CORNER_HZ / tick_hz);
        Ok(Config {
            kp: R::coefficient(self.kp * DEGREES_PER_UNIT),
            kd: R::coefficient(self.kd * DEGREES_PER_UNIT * tick_hz),
            smooth: R::coefficient(smooth),
            limit: R::from_f64(self.limit),
            slew: R::from_f64((self.slew_per_s / tick_hz).min(2.0)),
            min: R::from_f64(protraction(self.min_deg)),
            max: R::from_f64(protraction(self.max_deg)),
        })
    }
}

impl<R: Real> Config<R> {
    /// One tick: where the whisker should be and where it is, as protractions,
    /// to a duty within ±`limit` that differs from the last by at most `slew`.
    #[inline]
    pub fn step(&self, state: &mut State<R>, setpoint: R, measured: R) -> R {
        let moved = measured - state.measured.unwrap_or(measured);
        state.measured = Some(measured);
        let velocity = state.velocity + (moved - state.velocity).times(self.smooth);
        // No whisker turns a unit a tick; the limit is there so that no reading stays for ever.
        state.velocity = velocity.clamp(-R::ONE, R::ONE);
        let error = setpoint.clamp(self.min, self.max) - measured;
        let wanted = error.times(self.kp) - state.velocity.times(self.kd);
        let wanted = wanted.clamp(-self.limit, self.limit);
        state.output = state.output + (wanted - state.output).clamp(-self.slew, self.slew);
        state.output
    }
}

#[cfg(test)]
mod tests {
    use super::{Settings, State};

    const SETTINGS: Settings = Settings {
        kp: 0.05,
        kd: 0.001,
        limit: 0.8,
        slew_per_s: 400.0,
        min_deg: 30.0,
        max_deg: 150.0,
    };

    #[test]
    fn proportional_action_has_the_sign_and_size_of_the_error() {
        let pd = SETTINGS.build::<f64>(2_000.0).unwrap();
        let mut state = State::default();
        // One degree is 0.01: the duty is kp, reached within one slew step of 0.2.
        assert!((pd.step(&mut state, 0.51, 0.5) - 0.05).abs() < 1e-12);
        assert!((pd.step(&mut State::default(), 0.49, 0.5) + 0.05).abs() < 1e-12);
    }

    #[test]
    fn derivative_acts_on_the_measurement_alone() {
        let pd = SETTINGS.build::<f64>(2_000.0).unwrap();
        let mut state = State::default();
        // 100 degrees a second for long enough; the setpoint moves with it, so no error.
        let mut duty = 0.0;
        for n in 0..2_000 {
            let x = f64::from(n) * 0.0005;
            duty = pd.step(&mut state, x.min(1.0), x);
        }
        assert!((duty + 0.1).abs() < 1e-6, "{duty}");
    }

    #[test]
    fn output_setpoint_and_slew_are_limited() {
        let pd = SETTINGS.build::<f64>(2_000.0).unwrap();
        let mut state = State::default();
        let mut last = 0.0;
        for n in 1..=10 {
            let duty = pd.step(&mut state, 1.0, 0.0);
            assert!((duty - (0.2 * f64::from(n)).min(0.8)).abs() < 1e-12);
            last = duty;
        }
        assert!((last - 0.8).abs() < 1e-12);
        // Beyond the limits of the setpoint nothing changes: 150 degrees is θ = 1.
        let mut far = State::default();
        assert_eq!(
            pd.step(&mut far, 9.0, 0.99),
            pd.step(&mut State::default(), 1.0, 0.99)
        );
    }

    #[test]
    fn a_reading_that_is_not_a_number_does_not_stay() {
        let pd = SETTINGS.build::<f32>(2_000.0).unwrap();
        let mut state = State::default();
        pd.step(&mut state, 0.5, f32::NAN);
        let mut duty = 0.0;
        for _ in 0..1_000 {
            duty = pd.step(&mut state, 0.51, 0.5);
        }
        assert!((duty - 0.05).abs() < 1e-4, "{duty}");
    }

    #[test]
    fn settings_out_of_range_are_refused() {
        let bad = |change: fn(&mut Settings)| {
            let mut settings = SETTINGS;
            change(&mut settings);
            settings.build::<f32>(2_000.0).is_err()
        };
        assert!(bad(|s| s.kp = f64::NAN));
        assert!(bad(|s| s.limit = 1.1));
        assert!(bad(|s| s.max_deg = s.min_deg - 1.0));
        assert!(!bad(|_| ()));
    }
}
