//! Limits of a board's motor that would not protect it, by the names of their keys. The board
//! itself checks what comes of them.

use std::ops::RangeInclusive;

use firmware::allowed;
use scene::MotorSection;
use whisking::motor::MOST_FRICTION;

/// A key whose value would leave a motor without one of its guards.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("motor.{key}: found {found}; allowed on a board: {allowed}")]
#[expect(missing_docs, reason = "the message says it")]
pub struct Unprotected {
    pub key: &'static str,
    pub found: f64,
    pub allowed: String,
}

pub(crate) fn check(motor: &MotorSection, degrees_per_count: f64) -> Result<(), Unprotected> {
    let within = |key, found: f64, range: RangeInclusive<f64>| {
        let allowed = || format!("{} to {}", range.start(), range.end());
        let is_within = range.contains(&found).then_some(());
        is_within.ok_or_else(|| Unprotected {
            key,
            found,
            allowed: allowed(),
        })
    };
    for (key, found, range) in [
        ("min_deg", motor.min_deg, allowed::ANGLES_DEG),
        ("max_deg", motor.max_deg, allowed::ANGLES_DEG),
        (
            "travel_margin_deg",
            motor.travel_margin_deg,
            allowed::MARGIN_DEG,
        ),
        (
            "following_limit_deg",
            motor.following_limit_deg,
            allowed::FOLLOWING_DEG,
        ),
        (
            "top_speed_deg_s",
            motor.top_speed_deg_s,
            allowed::TOP_SPEED_DEG_S,
        ),
        (
            "continuous_duty",
            motor.continuous_duty,
            allowed::CONTINUOUS_DUTY,
        ),
    ] {
        within(key, found, range)?;
    }
    let is_gentle = motor.duty_limit <= allowed::GENTLE_DUTY;
    let is_coarse = degrees_per_count > allowed::COARSEST_DEG;
    // Both ways together.
    let unmoved = 2.0 * MOST_FRICTION * motor.duty_limit;
    if is_coarse || is_gentle && motor.unmoved_duty >= unmoved {
        // Nothing is expected of it.
        return Ok(());
    }
    let most = motor.top_speed_deg_s / allowed::ACCELERATION_DEG_S2;
    within("time_constant_s", motor.time_constant_s, 1e-3..=most)?;
    within(
        "unmoved_duty",
        motor.unmoved_duty,
        0.0..=allowed::UNMOVED_DUTY.min(unmoved),
    )
}
