//! Scenes that forward Euler cannot carry, or carries badly.
//!
//! The papers' integrator is explicit: with too long a tick its oscillators leave their circle, its
//! muscles swing up, its gates overshoot. The tick's clamps keep every state in bounds even then.
//! Muscles that swing up no longer follow the equations, so such a scene is refused. Oscillators
//! and gates that the clamps hold are still the papers' integrator; they get a warning. The limits
//! follow from the constants of the tick itself (f64), not from a second copy of them:
//!
//! - *oscillators* (BIOTACT eq. 3): a step takes r to
//!   √((r + k (1 − r))² + (φ r)²), with k = T/τ_r and φ = 2π f_W T. It leaves
//!   r = k/(√(1 − φ²) − 1 + k) alone, about 1/(1 − 4π² f_W T): 1.04 for the
//!   papers' 2 Hz at 500 µs. It must not exceed the limit of ψ, 1.5, which it
//!   reaches at f_W T = 0.0084375, or 16.9 Hz at 2 kHz.
//! - *muscles* (eqs. 7 and 8): poles −ω_n (2 ± √3), ω_n = 10 f_W, so a step
//!   multiplies the faster mode by 1 − 10 f_W T (2 + √3), which must stay
//!   above −1: f_W T < 0.0536.
//! - *gates* (eqs. 10 and 13): 1 − T/τ must not be negative: τ ≥ T.

#[cfg(test)]
mod tests;

use std::fmt;

use whisking::{Error, GateSettings, Integrator, Settings, muscle, oscillator};

/// What rounding may add to a value that stands on its limit.
const ROUNDING: f64 = 1e-9;

/// What forward Euler cannot carry in a scene, or carries badly; at least one entry.
///
/// It prints one line an entry, `whisking.integrator: what was found; what is
/// allowed`, without a newline at the end.
#[derive(Debug, Clone, PartialEq)]
pub struct Unstable {
    tick_hz: f64,
    frequency_hz: f64,
    list: Vec<Instability>,
}

/// One part of the model that forward Euler cannot carry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Instability {
    /// The oscillators' limit cycle lies beyond the limit of their states.
    Oscillators {
        /// Its radius; `None` where there is none, and ψ runs from limit to limit.
        radius: Option<f64>,
        /// The lowest tick rate that keeps it within, Hz.
        tick_hz: f64,
    },
    /// The muscles' faster mode grows.
    Muscles {
        /// What a tick multiplies it by, −1 or below.
        factor: f64,
        /// The lowest tick rate at which it decays, Hz.
        tick_hz: f64,
    },
    /// A gate's time constant is shorter than a tick.
    Gate {
        /// Its section of the scene, `rcp` or `cia`.
        section: &'static str,
        /// Its time constant, s.
        tau_s: f64,
        /// The lowest tick rate whose tick is no longer than that, Hz; `None`
        /// where it is higher than any module's.
        tick_hz: Option<f64>,
    },
}

impl Unstable {
    /// The entries: oscillators, muscles, gates.
    pub fn as_slice(&self) -> &[Instability] {
        &self.list
    }
}

impl Instability {
    /// Whether it grows without bound but for the clamps.
    pub const fn is_fatal(&self) -> bool {
        matches!(self, Self::Muscles { .. })
    }
}

impl fmt::Display for Unstable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, entry) in self.list.iter().enumerate() {
            if i > 0 {
                f.write_str("\n")?;
            }
            write!(
                f,
                "whisking.integrator: found \"euler\" at {} Hz with tick_hz = {}: ",
                self.frequency_hz, self.tick_hz
            )?;
            entry.fmt(f)?;
        }
        Ok(())
    }
}

impl fmt::Display for Instability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rather = if self.is_fatal() { "allowed" } else { "better" };
        let or = format_args!("{rather}: integrator = \"exact\", or \"euler\" with");
        match *self {
            Self::Oscillators { radius, tick_hz } => {
                let limit = oscillator::PSI_LIMIT;
                match radius {
                    Some(r) => write!(f, "its oscillators circle at a radius of {r:.2}")?,
                    None => f.write_str("its oscillators have no circle to settle on")?,
                }
                write!(
                    f,
                    ", and the limit is {limit}; {or} tick_hz at least {tick_hz}"
                )
            }
            Self::Muscles { factor, tick_hz } => write!(
                f,
                "a tick multiplies the muscles' fast mode by {factor:.2}, so it grows; {or} \
                 tick_hz at least {tick_hz}"
            ),
            Self::Gate {
                section,
                tau_s,
                tick_hz,
            } => {
                write!(
                    f,
                    "{section}.tau_s = {tau_s} is shorter than a tick, and a decay overshoots; \
                     {or} {section}.tau_s at least a tick"
                )?;
                match tick_hz {
                    Some(tick_hz) => write!(f, " or tick_hz at least {tick_hz}"),
                    None => Ok(()),
                }
            }
        }
    }
}

/// What the integrator of `settings` cannot carry (`fatal`), or carries badly.
pub(crate) fn check(settings: &Settings, fatal: bool) -> Result<Option<Unstable>, Error> {
    let config = settings.build::<f64>()?;
    let oscillators = match &config.oscillators {
        oscillator::Config::Euler(euler) => oscillators(euler, settings.tick_hz),
        oscillator::Config::Exact(_) => None,
    };
    let muscles = match &config.muscle {
        muscle::Config::Euler(euler) => muscles(euler, settings.tick_hz),
        muscle::Config::Exact(_) => None,
    };
    let gate =
        |section, gate: Option<GateSettings>| gate.and_then(|gate| gates(section, gate, settings));
    let (rcp, cia) = (gate("rcp", settings.rcp), gate("cia", settings.cia));
    let entries = [oscillators, muscles, rcp, cia];
    let list = entries
        .into_iter()
        .flatten()
        .filter(|entry| entry.is_fatal() == fatal);
    let list: Vec<Instability> = list.collect();
    let unstable = Unstable {
        tick_hz: settings.tick_hz,
        frequency_hz: settings.frequency_hz,
        list,
    };
    Ok((!unstable.list.is_empty()).then_some(unstable))
}

fn oscillators(euler: &oscillator::Euler<f64>, tick_hz: f64) -> Option<Instability> {
    let limit = oscillator::PSI_LIMIT;
    let (k, turn) = (euler.relax, euler.turn);
    // NaN where a step turns by more than a radian; then no radius is left alone.
    let radius = k / ((1.0 - turn * turn).sqrt() - 1.0 + k);
    let settles = radius > 0.0;
    if settles && radius <= limit + ROUNDING {
        return None;
    }
    // Ticks of this share of the present one put the circle on the limit.
    let part = 2.0 * limit * (limit - 1.0) * k
        / ((limit - 1.0).powi(2) * k * k + limit * limit * turn * turn);
    Some(Instability::Oscillators {
        radius: settles.then_some(radius),
        tick_hz: (tick_hz / part).ceil(),
    })
}

fn muscles(euler: &muscle::Euler<f64>, tick_hz: f64) -> Option<Instability> {
    let half = euler.damping / 2.0;
    let fast = half + (half * half - euler.spring * euler.spring).sqrt();
    (fast >= 2.0).then(|| Instability::Muscles {
        factor: 1.0 - fast,
        tick_hz: (tick_hz * fast / 2.0).floor() + 1.0,
    })
}

fn gates(section: &'static str, gate: GateSettings, settings: &Settings) -> Option<Instability> {
    // The exact integrator's share, 1 − exp(−T/τ), never exceeds one.
    let share = 1.0 / (gate.tau_s * settings.tick_hz);
    if settings.integrator == Integrator::Exact || share <= 1.0 + ROUNDING {
        return None;
    }
    let tick_hz = (1.0 / gate.tau_s - ROUNDING).ceil();
    let faster = Settings {
        tick_hz,
        ..*settings
    };
    Some(Instability::Gate {
        section,
        tau_s: gate.tau_s,
        tick_hz: faster.build::<f64>().is_ok().then_some(tick_hz),
    })
}
