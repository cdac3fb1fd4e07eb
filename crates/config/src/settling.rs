//! Gains under which a motor does not settle, with those under which it does.

use std::fmt;

use whisking::motor::{GuardSettings, ModelConfig};
use whisking::pd::{self, Unborne};

use crate::edge;

/// More than any gain that is suggested.
const MOST: f64 = 10.0;

/// A motor that would not settle after a step of its setpoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unsettled {
    /// What is to change.
    pub what: Unborne,
    /// The gains and the slew that were found.
    pub found: pd::Settings,
    /// The largest k_p with the other values; 0: none.
    pub kp: f64,
    /// The smallest and the largest k_d with the other values, if there is one.
    pub kd: Option<[f64; 2]>,
}

impl std::error::Error for Unsettled {}

impl fmt::Display for Unsettled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pd::Settings {
            kp, kd, slew_per_s, ..
        } = self.found;
        let key = match self.what {
            Unborne::Kp => "kp",
            Unborne::Kd => "kd",
            Unborne::Slew => "slew_per_s",
        };
        write!(
            f,
            "motor.{key}: found kp {kp}, kd {kd}, slew_per_s {slew_per_s}; after a step the motor \
             would overshoot by far, or not come to rest; allowed: "
        )?;
        let most = rounded_down(self.kp);
        let kp = (most > 0.0).then(|| format!("kp at most {most}"));
        let kd = self.kd.map(|[least, most]| {
            let (least, most) = (rounded_up(least), rounded_down(most));
            format!("kd from {least} to {most}")
        });
        let each: Vec<String> = [kp, kd].into_iter().flatten().collect();
        if each.is_empty() {
            return f.write_str("no kp or kd with the other values as they are");
        }
        f.write_str(&each.join(", or "))?;
        f.write_str(", with the other values as they are")
    }
}

fn rounded_down(value: f64) -> f64 {
    to_two_digits(value, f64::floor)
}

fn rounded_up(value: f64) -> f64 {
    to_two_digits(value, f64::ceil)
}

fn to_two_digits(value: f64, round: fn(f64) -> f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    let power = 1 - value.log10().floor() as i32;
    // A power of ten that is a whole number divides without an error of its own.
    let scale = 10_f64.powi(power.abs());
    if power < 0 {
        round(value / scale) * scale
    } else {
        round(value * scale) / scale
    }
}

pub(crate) fn check(
    found: &pd::Settings,
    guards: &GuardSettings,
    tick_hz: f64,
) -> Result<(), Unsettled> {
    let model = guards.model;
    let model = model.and_then(|model| model.build(tick_hz, guards.degrees_per_count));
    let Some(model) = model else {
        return Ok(());
    };
    let settles = |pd: pd::Settings| settles(&pd, &model, tick_hz);
    let Err(what) = settles(*found) else {
        return Ok(());
    };
    let with_kp = |kp| settles(pd::Settings { kp, ..*found }).is_ok();
    let with_kd = |kd| settles(pd::Settings { kd, ..*found });
    // Below the smallest, kp is too large for it; above the largest, it is itself.
    let least = edge(MOST, |kd| with_kd(kd) == Err(Unborne::Kp));
    let most = edge(MOST, |kd| with_kd(kd) != Err(Unborne::Kd));
    let kd = [least, most];
    Err(Unsettled {
        what,
        found: *found,
        kp: edge(MOST, with_kp),
        kd: with_kd(f64::midpoint(least, most)).is_ok().then_some(kd),
    })
}

fn settles(pd: &pd::Settings, model: &ModelConfig<f64>, tick_hz: f64) -> Result<(), Unborne> {
    // Settings out of range were refused before.
    pd.build(tick_hz).map_or(Ok(()), |pd| pd.settles(model))
}
