//! Whether the limits that protect a motor can do it: what a configuration for a board must not
//! leave open. Then a motor whose encoder stands still is not driven for long, whatever it is
//! told (`tests/tests/suite/limits.rs` has the time).
//!
//! The times of guards have no key: a quarter of a second is the most that one can be. What has a
//! key has the range that [`allowed`] names.

use whisking::Real;
use whisking::motor::{GuardConfig, HomingConfig, ModelConfig};
use whisking::pd::{self, Unborne};

use super::MotionConfig;
use super::check::Field;

/// The ranges of keys on a board, in the units of the keys, with the reason for each.
pub mod allowed {
    use core::ops::RangeInclusive;

    /// `min_deg` and `max_deg`, degrees: half a turn to either side of straight out.
    pub const ANGLES_DEG: RangeInclusive<f64> = -90.0..=270.0;
    /// `travel_margin_deg`: a whisker that is braked from 4,000 degrees a second stops within 31.
    pub const MARGIN_DEG: RangeInclusive<f64> = 0.0..=45.0;
    /// `following_limit_deg`: twice a whisk, 84 degrees, and a little more.
    pub const FOLLOWING_DEG: RangeInclusive<f64> = 1.0..=90.0;
    /// `top_speed_deg_s`: calibration is tested with motors of 4,000 to 20,000 degrees a second;
    /// half of the slowest to some twice the fastest.
    pub const TOP_SPEED_DEG_S: RangeInclusive<f64> = 2.5e3..=6e4;
    /// `top_speed_deg_s` by `time_constant_s` at least: a little less than the slowest of those has.
    /// Of a motor that is slower nothing would be missed within half a whisk.
    pub const ACCELERATION_DEG_S2: f64 = 5e4;
    /// `unmoved_duty` at most: four times the friction of the papers'
    /// motor. From more on a board expects nothing of a motor, which it must.
    pub const UNMOVED_DUTY: f64 = 0.5;
    /// Up to this `duty_limit` a board need not expect anything.
    pub const GENTLE_DUTY: f64 = 0.25;
    /// `continuous_duty`: half of the heat at full duty, which a motor bears for 5.4 s.
    pub const CONTINUOUS_DUTY: RangeInclusive<f64> = 0.0..=0.7;
    /// Degrees a count of the coarsest encoder that can show whether a motor moves.
    pub const COARSEST_DEG: f64 = 0.7;
}

type Protected = Result<(), Field>;

fn require(field: Field, holds: bool) -> Protected {
    if holds { Ok(()) } else { Err(field) }
}

/// So many hundredths of a degree as protraction, Q24.
const fn degrees(hundredths: i32) -> i32 {
    hundredths * 1_678
}

/// So many hundredths of a full duty, Q24.
const fn duty(hundredths: i32) -> i32 {
    hundredths * 167_773
}

/// What counts of an encoder are, Q24.
struct Encoder<R: Real>(R::Coefficient);

impl<R: Real> Encoder<R> {
    // Small rather than fast, as all here.
    #[inline(never)]
    fn turns_by(&self, counts: i32) -> i32 {
        R::from_counts(counts, self.0).to_q24()
    }

    /// Whether so many counts are as much protraction, Q24, at most, or one more.
    fn is_within(&self, counts: u32, most: i32) -> bool {
        let counts = i32::try_from(counts).unwrap_or(i32::MAX);
        self.turns_by(counts - 1) <= most
    }
}

/// Whether ticks last so many milliseconds at most, but for rounding.
#[inline(never)]
const fn lasts(ticks: u16, milliseconds: u32, tick_hz: u32) -> bool {
    1_000 * ticks as u32 <= milliseconds * tick_hz + 1_000
}

#[inline(never)]
fn times<R: Real>(x: R, factor: R::Coefficient) -> R {
    x.times(factor)
}

impl<R: Real> MotionConfig<R> {
    #[inline(never)]
    pub(super) fn protects(&self, tick_hz: u32) -> Protected {
        let servo = &self.servo;
        let encoder = Encoder::<R>(servo.pd.theta_per_count);
        require(Field::Encoder, encoder.turns_by(256) > 0)?;
        let [least, most] = [servo.pd.min, servo.pd.max].map(R::to_q24);
        // Protraction is 0 at 50 degrees.
        let is_near = least >= degrees(-14_001) && most <= degrees(22_001);
        require(Field::Angles, is_near)?;
        let retry = servo.retry;
        let rests = u32::from(retry.rest) >= tick_hz && retry.window >= 60 * tick_hz;
        require(Field::Retry, rests)?;
        guards(&servo.guards, &servo.pd, &encoder, tick_hz)?;
        if let Some(model) = &servo.guards.model {
            expects(model, &encoder, tick_hz)?;
            settles(&servo.pd, model)?;
        } else {
            let is_coarse = encoder.turns_by(1) > degrees(69);
            require(Field::Friction, is_coarse || servo.pd.limit <= duty(25))?;
        }
        let homing = servo.homing.as_ref();
        homing.map_or(Ok(()), |homing| homes(homing, servo.pd.limit, tick_hz))
    }
}

fn guards<R: Real>(
    guards: &GuardConfig<R>,
    pd: &pd::Config<R>,
    encoder: &Encoder<R>,
    tick_hz: u32,
) -> Protected {
    let hard = i32::from(guards.stall.threshold.magnitude()) << 10;
    let is_found = hard <= pd.limit.saturating_add(1 << 10)
        && encoder.is_within(guards.against, degrees(4_550))
        && lasts(guards.stall.ticks.max(guards.error_ticks), 250, tick_hz);
    require(Field::Guards, is_found)?;
    require(Field::Following, guards.error.to_q24() <= degrees(9_001))?;
    let [lowest, highest] = guards.travel;
    let [least, most] = [pd.min.to_q24().min(0), pd.max.to_q24().max(0)];
    let margin = degrees(4_550);
    let is_near = encoder.turns_by(lowest) >= least - margin
        && encoder.turns_by(highest.saturating_sub(1)) <= most + margin;
    require(Field::Travel, is_near)?;
    // 600 units a second are too many for 32 bits: 120, and five ticks.
    let fastest = (120_u32 << 24) / tick_hz.max(1);
    let is_slow = encoder.is_within(guards.speed / 5, fastest.cast_signed());
    require(Field::TopSpeed, is_slow)?;
    // 0.7 squared; 12 s.
    let cools = guards.heat <= 526_150_000 && 1_u32 << (guards.heat_shift & 31) <= 12 * tick_hz;
    require(Field::Heat, cools)
}

/// Whether it misses motion soon. Its own constants are those of every model.
fn expects<R: Real>(model: &ModelConfig<R>, encoder: &Encoder<R>, tick_hz: u32) -> Protected {
    let is_small = model.friction.to_q24() <= duty(25);
    require(Field::Friction, is_small)?;
    // Of the least speed and acceleration 0.6 is expected.
    let unit = (1 << 24) / tick_hz.max(1);
    let speed = times(R::ONE, model.speed);
    let is_fast = speed.to_q24().unsigned_abs() >= 14 * unit;
    require(Field::TopSpeed, is_fast)?;
    let gains = times(speed, model.rate).to_q24().unsigned_abs();
    let is_quick = gains >= (298 * unit / tick_hz.max(1)).saturating_sub(1);
    require(Field::TimeConstant, is_quick)?;
    let missing = model.missing.max(model.doubt).to_q24();
    let shown = R::from_counts(100, model.shown).to_q24();
    let is_kept = missing <= degrees(301)
        && shown <= encoder.turns_by(260)
        && model.turned >= 3
        && lasts(model.stroke.max(model.grace), 250, tick_hz);
    require(Field::Guards, is_kept)
}

fn settles<R: Real>(pd: &pd::Config<R>, model: &ModelConfig<R>) -> Protected {
    pd.settles(model).map_err(|unborne| match unborne {
        Unborne::Kp => Field::Kp,
        Unborne::Kd => Field::Kd,
        Unborne::Slew => Field::Slew,
    })
}

/// Whether it is looked for gently, and not for long.
fn homes(homing: &HomingConfig, limit: i32, tick_hz: u32) -> Protected {
    let hard = i32::from(homing.duty.magnitude()) << 10;
    let is_gentle = hard <= limit.saturating_add(1 << 10) && lasts(homing.time_out, 3_000, tick_hz);
    require(Field::Homing, is_gentle)
}
