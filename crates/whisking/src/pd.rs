//! Position control: proportional to the error, derivative on the measurement
//! (so that a jump of the setpoint does not kick), limited in size and slew.
//!
//! Positions are protractions θ (θ' = 100 θ + 50 degrees); the output is a duty within ±1:
//! u = ⟨k_p (⟨s⟩ − x) − k_d dx/dt⟩, dx/dt smoothed by a first-order low-pass because the steps of
//! an encoder are coarse compared with a tick. The duty and its limits are integers in every number
//! format, as a timer's register takes them.

mod response;

use serde::{Deserialize, Serialize};

pub use response::Unborne;

use crate::motor::Duty;
use crate::ranges::pd as ranges;
use crate::{DEGREES_PER_UNIT, Error, Parameter, Real, protraction};

const VELOCITY_CORNER_HZ: f64 = 100.0;

/// A duty of one in the controller's state: Q24, so that the slowest slew is not lost in rounding.
pub const FULL: f64 = 16_777_216.0;

/// Gains and limits in physical units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// k_p, duty per degree of error, within [`ranges::KP`].
    pub kp: f64,
    /// k_d, duty per degree per second, within [`ranges::KD`].
    pub kd: f64,
    /// Largest duty, within [`ranges::LIMIT`].
    pub limit: f64,
    /// Largest change of the duty per second, within [`ranges::SLEW_PER_S`].
    pub slew_per_s: f64,
    /// Lowest setpoint in degrees θ', within [`ranges::ANGLE_DEG`].
    pub min_deg: f64,
    /// Highest setpoint in degrees θ', `min_deg` or more, within [`ranges::ANGLE_DEG`].
    pub max_deg: f64,
    /// Degrees of the whisker per count of the encoder, within
    /// [`ranges::DEGREES_PER_COUNT`].
    pub degrees_per_count: f64,
}

/// The same per tick and per unit of protraction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Config<R: Real> {
    /// k_p, duty per unit of error.
    pub kp: R::Coefficient,
    /// k_d, duty per unit per tick.
    pub kd: R::Coefficient,
    /// Weight of a new velocity in the smoothed one.
    pub smooth: R::Coefficient,
    /// Protraction per count of the encoder.
    pub theta_per_count: R::Coefficient,
    /// Lowest setpoint.
    pub min: R,
    /// Highest setpoint.
    pub max: R,
    /// Largest duty, Q24.
    pub limit: i32,
    /// Largest change of the duty per tick, Q24.
    pub slew: i32,
}

/// The controller's state, with the terms of the last tick for a log. The default
/// is that of a motor that is off.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct State<R> {
    /// Protraction x.
    pub measured: R,
    /// Following error ⟨s⟩ − x.
    pub error: R,
    /// Proportional term k_p (⟨s⟩ − x), a duty before its limits.
    pub p: R,
    /// Derivative term −k_d dx/dt, a duty before its limits.
    pub d: R,
    /// dx/dt, smoothed: protraction per tick.
    pub velocity: R,
    /// The duty after its limits, Q24.
    pub command: i32,
}

impl Settings {
    /// The constants at `tick_hz` ticks per second.
    ///
    /// # Errors
    /// [`Parameter::Pd`] if a value is outside its range in
    /// [`ranges::pd`](crate::ranges::pd), or the highest setpoint is below the
    /// lowest.
    pub fn build<R: Real>(&self, tick_hz: f64) -> Result<Config<R>, Error> {
        let check = |value, range: &_| Error::check(Parameter::Pd, value, range);
        check(tick_hz, &(f64::MIN_POSITIVE..=f64::MAX))?;
        check(self.kp, &ranges::KP)?;
        check(self.kd, &ranges::KD)?;
        check(self.limit, &ranges::LIMIT)?;
        check(self.slew_per_s, &ranges::SLEW_PER_S)?;
        check(self.min_deg, &ranges::ANGLE_DEG)?;
        check(self.max_deg, &(self.min_deg..=*ranges::ANGLE_DEG.end()))?;
        check(self.degrees_per_count, &ranges::DEGREES_PER_COUNT)?;
        let smooth = -libm::expm1(-core::f64::consts::TAU * VELOCITY_CORNER_HZ / tick_hz);
        Ok(Config {
            kp: R::coefficient(self.kp * DEGREES_PER_UNIT),
            kd: R::coefficient(self.kd * DEGREES_PER_UNIT * tick_hz),
            smooth: R::coefficient(smooth),
            theta_per_count: R::coefficient(self.degrees_per_count / DEGREES_PER_UNIT),
            min: R::from_f64(protraction(self.min_deg)),
            max: R::from_f64(protraction(self.max_deg)),
            limit: (self.limit * FULL) as i32,
            slew: ((self.slew_per_s / tick_hz).min(2.0) * FULL) as i32,
        })
    }
}

impl<R> State<R> {
    /// The duty after its limits.
    #[inline]
    pub const fn duty(&self) -> Duty {
        Duty::from_q24(self.command)
    }
}

impl<R: Real> Config<R> {
    /// The nearest setpoint within the range.
    #[inline]
    pub fn clamp(&self, setpoint: R) -> R {
        setpoint.clamp(self.min, self.max)
    }

    /// One tick, from the setpoint as a protraction, the measured angle in encoder counts from
    /// θ = 0, and the counts `moved` since the last tick (0 in the first). The duty is within
    /// ±`limit` and differs from the last one by at most `slew`.
    #[inline]
    pub fn step(&self, state: &mut State<R>, setpoint: R, counts: i32, moved: i32) -> Duty {
        self.follow(state, self.clamp(setpoint), counts, moved)
    }

    /// The state of a motor that was off, of a whisker that has `moved` by so many counts since
    /// the last tick.
    #[inline]
    pub fn at_speed(&self, moved: i32) -> State<R> {
        let velocity = R::from_counts(moved, self.theta_per_count);
        State {
            velocity: velocity.clamp(-R::ONE, R::ONE),
            ..State::default()
        }
    }

    /// The protraction at `counts` from θ = 0.
    #[inline]
    pub fn measured(&self, counts: i32) -> R {
        R::from_counts(counts, self.theta_per_count)
    }

    /// The same as [`step`](Self::step) with a setpoint that may be outside the range: a
    /// whisker that was turned out of it comes back slowly.
    #[inline]
    pub fn follow(&self, state: &mut State<R>, setpoint: R, counts: i32, moved: i32) -> Duty {
        self.measure(state, setpoint, counts, moved);
        self.command(state, (state.p + state.d).to_q24())
    }

    /// The part of [`follow`](Self::follow) that comes before the duty.
    #[inline]
    pub fn measure(&self, state: &mut State<R>, setpoint: R, counts: i32, moved: i32) {
        let measured = self.measured(counts);
        let moved = R::from_counts(moved, self.theta_per_count);
        let velocity = state.velocity + (moved - state.velocity).times(self.smooth);
        state.velocity = if velocity.is_within(R::TWO) {
            velocity
        } else {
            R::ZERO
        };
        state.measured = measured;
        state.error = setpoint - measured;
        state.p = state.error.times(self.kp);
        state.d = -state.velocity.times(self.kd);
    }

    /// Brings the duty to the `wanted` one, Q24, as fast as it may change.
    #[inline]
    pub fn command(&self, state: &mut State<R>, wanted: i32) -> Duty {
        // Not `clamp`, which panics where a limit is negative.
        let limited = |duty: i32| duty.min(self.limit).max(-self.limit);
        let change = limited(wanted).wrapping_sub(state.command);
        let change = change.min(self.slew).max(-self.slew);
        // Last of all, so that it holds whatever bits the last command has.
        state.command = limited(state.command.wrapping_add(change));
        state.duty()
    }
}

#[cfg(test)]
mod tests {
    use super::{Config, Settings, State};
    use crate::{Fix, Real};

    const SETTINGS: Settings = Settings {
        kp: 0.05,
        kd: 0.001,
        limit: 0.8,
        slew_per_s: 400.0,
        min_deg: 30.0,
        max_deg: 150.0,
        degrees_per_count: 0.01,
    };
    /// A step of the duty, plus half a step of rounding.
    const STEP: f64 = 5e-5;

    fn fraction<R: Real>(
        pd: &Config<R>,
        state: &mut State<R>,
        setpoint: R,
        counts: i32,
        moved: i32,
    ) -> f64 {
        f64::from(pd.step(state, setpoint, counts, moved).q15()) / 32_767.0
    }

    #[test]
    fn proportional_action_has_the_sign_and_size_of_the_error() {
        fn check<R: Real>(within: f64) {
            let pd = SETTINGS.build::<R>(2_000.0).unwrap();
            // 100 degrees are θ = 0.5, 5000 counts. One degree of error gives
            // kp, reached within one slew step of 0.2.
            for (setpoint, duty) in [(0.51, 0.05), (0.49, -0.05)] {
                let setpoint = R::from_f64(setpoint);
                let found = fraction(&pd, &mut State::default(), setpoint, 5_000, 0);
                assert!((found - duty).abs() < within, "{found} {duty}");
            }
        }
        check::<f64>(STEP);
        check::<f32>(STEP);
        // The angle per count has 16 bits: an error of 3e-5 of half a unit, times k_p.
        check::<Fix>(STEP + 8e-5);
    }

    /// The measured velocity passes a first-order low-pass at 100 Hz.
    #[test]
    fn derivative_acts_on_the_measurement_alone() {
        let pd = SETTINGS.build::<f64>(2_000.0).unwrap();
        let mut state = State::default();
        for n in 1..=200 {
            // 100 degrees a second, 5e-4 units a tick; the setpoint moves with it, so no error.
            let counts = 5 * n;
            let duty = fraction(&pd, &mut state, f64::from(counts) * 1e-4, counts, 5);
            let smoothed = 1.0 - (-core::f64::consts::TAU * 0.05 * f64::from(n)).exp();
            assert!((duty + 0.1 * smoothed).abs() < STEP, "{n}: {duty}");
            assert!((state.d + 0.1 * smoothed).abs() < 1e-9 && state.p.abs() < 1e-9);
            assert!((state.velocity - 5e-4 * smoothed).abs() < 1e-9);
        }
    }

    #[test]
    fn output_setpoint_and_slew_are_limited() {
        let pd = SETTINGS.build::<f64>(2_000.0).unwrap();
        let mut state = State::default();
        for n in 1..=10 {
            let duty = fraction(&pd, &mut state, 1.0, 0, 0);
            let expected = (0.2 * f64::from(n)).min(0.8);
            assert!((duty - expected).abs() < STEP, "{duty}");
        }
        // Beyond the limits of the setpoint nothing changes: 150 degrees is θ = 1.
        for (far, end) in [(9.0, 1.0), (-9.0, -0.2)] {
            let [far, end] = [far, end].map(|theta| {
                let mut state = State::default();
                fraction(&pd, &mut state, theta, 9_900, 0)
            });
            assert_eq!(far, end);
        }
    }

    /// A slew of one per second at 20 kHz is 838.9 per tick in Q24, less than two
    /// steps of the duty.
    #[test]
    fn the_slowest_slew_is_kept() {
        let mut settings = SETTINGS;
        settings.slew_per_s = 1.0;
        let pd = settings.build::<f32>(20_000.0).unwrap();
        let mut state = State::default();
        let mut duty = 0.0;
        for _ in 0..10_000 {
            duty = fraction(&pd, &mut state, 1.0, 0, 0);
        }
        assert!((duty - 0.5).abs() < 1e-3, "{duty}");
    }

    /// Whatever bits its last command has, the next is within the limit, and in as many ticks
    /// as the slew takes all is as it was; so with the velocity, of which half is left after
    /// 2.2 ticks.
    #[test]
    fn the_limit_holds_whatever_bits_the_state_has() {
        fn check<R: Real>(spoilt: impl Fn(u32) -> R) {
            let pd = SETTINGS.build::<R>(2_000.0).unwrap();
            let half = R::ONE.halved();
            let settled = || {
                let mut state = State::default();
                for _ in 0..100 {
                    pd.step(&mut state, half, 4_500, 0);
                }
                state
            };
            let undisturbed = settled();
            for bit in 0..32 {
                let (mut command, mut velocity) = (settled(), settled());
                command.command ^= 1 << bit;
                velocity.velocity = spoilt(1 << bit);
                for state in [&mut command, &mut velocity] {
                    for _ in 0..120 {
                        let duty = pd.step(state, half, 4_500, 0);
                        let most = SETTINGS.limit * 32_767.0 + 1.0;
                        assert!(f64::from(duty.magnitude()) <= most, "{bit}: {duty:?}");
                    }
                    // To 1e-4 of full drive: in fixed point a velocity rests within some steps.
                    let away = state.command.abs_diff(undisturbed.command);
                    assert!(away < 1_678, "{bit}: {state:?}");
                }
            }
        }
        for all in [0, u32::MAX, 0x7F80_0000, 0xFF80_0000, 0x7F7F_FFFF] {
            check::<f32>(|bit| f32::from_bits(bit ^ all));
            check::<Fix>(|bit| Fix((bit ^ all).cast_signed()));
        }
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
        assert!(bad(|s| s.degrees_per_count = -1.0));
        assert!(!bad(|_| ()));
    }
}
