//! One format's long run: extremes of every stretch, and the phase.

use anyhow::Result;
use serde::{Deserialize, Serialize};
use whisking::{Integrator, Number, State};

use crate::accuracy::integrators::NEAR;
use crate::accuracy::schemes::{Format, Pace};

/// Ticks of a minute at 2 kHz.
pub(super) const MINUTE_TICKS: u64 = 120_000;

/// How long to run: stretches after each of which a row is written.
#[derive(Debug, Clone, Copy)]
pub(in crate::accuracy) struct Length {
    pub(super) stretches: u64,
    pub(super) minutes: u64,
}

/// The state of a run after a stretch; extremes are those of the stretch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Row {
    pub(super) format: String,
    pub(super) frequency_hz: f64,
    /// Since the run settled.
    pub(super) minutes: u64,
    /// Phase ahead of the exact frequency, and whisks since the first crossing.
    pub(super) phase_whisks: f64,
    pub(super) whisks: f64,
    pub(super) radius_low: f64,
    pub(super) radius_high: f64,
    pub(super) theta_low_deg: f64,
    pub(super) theta_high_deg: f64,
}

pub(super) fn run<R: Number>(format: Format, pace: Pace, length: Length) -> Result<Vec<Row>> {
    let settings = pace.settings(Integrator::Exact);
    let config = settings.build::<R>()?;
    let start = settings.start(&NEAR.psi, &[&[NEAR.gain][..]; 2])?;
    let mut state = State::new(&start, 1);
    // A minute: sides in phase, radius one, to rounding.
    for _ in 0..MINUTE_TICKS {
        config.step(&mut state, &[]);
    }
    let mut rows = Vec::new();
    let mut phase = Phase::default();
    let mut ticks = 0_u64;
    for stretch in 1..=length.stretches {
        let mut square = [f64::INFINITY, f64::NEG_INFINITY];
        let mut theta = square;
        for _ in 0..length.minutes {
            for _ in 0..MINUTE_TICKS {
                config.step(&mut state, &[]);
                ticks += 1;
                let psi = config.oscillators.psi(&state.oscillators);
                for side in &psi {
                    let [a, b] = side.map(R::to_f64);
                    widen(&mut square, a * a + b * b);
                }
                for angle in state.theta() {
                    widen(&mut theta, angle.to_f64());
                }
                phase.see(ticks, psi[0][0].to_f64());
            }
        }
        let [radius_low, radius_high] = square.map(libm::sqrt);
        let [theta_low_deg, theta_high_deg] = theta.map(whisking::degrees);
        rows.push(Row {
            format: format.name().to_owned(),
            frequency_hz: pace.frequency_hz,
            minutes: stretch * length.minutes,
            phase_whisks: phase.ahead(pace.frequency_hz / pace.tick_hz),
            whisks: phase.whisks as f64,
            radius_low,
            radius_high,
            theta_low_deg,
            theta_high_deg,
        });
    }
    Ok(rows)
}

fn widen([low, high]: &mut [f64; 2], value: f64) {
    *low = low.min(value);
    *high = high.max(value);
}

/// Upward crossings of zero. Times are a tick and a part of one, so that a day
/// costs no digits.
#[derive(Debug, Default)]
struct Phase {
    before: f64,
    first: Option<(u64, f64)>,
    last: (u64, f64),
    /// Since the first.
    whisks: u64,
}

impl Phase {
    fn see(&mut self, tick: u64, now: f64) {
        // The first sample has nothing before it: zero, which is no crossing.
        if self.before < 0.0 && now >= 0.0 {
            self.last = (tick, now / (now - self.before));
            if self.first.is_none() {
                self.first = Some(self.last);
            } else {
                self.whisks += 1;
            }
        }
        self.before = now;
    }

    /// Whisks ahead of `cycles` = f_W T a tick.
    fn ahead(&self, cycles: f64) -> f64 {
        let (tick, part) = self.first.unwrap_or(self.last);
        // A crossing lies its part of a tick before the tick that shows it.
        let ticks = (self.last.0 - tick) as f64 - (self.last.1 - part);
        self.whisks as f64 - ticks * cycles
    }
}

#[cfg(test)]
mod tests {
    use super::Phase;
    use std::f64::consts::TAU;

    #[test]
    fn a_frequency_off_by_ten_ppm_is_seen_with_its_sign() {
        for ppm in [10.0, -10.0, 0.0] {
            let mut phase = Phase::default();
            let rate = (1.0 + 1e-6 * ppm) / 1_000.0;
            for tick in 1..=100_000_u64 {
                phase.see(tick, (TAU * rate * tick as f64 - 1.0).sin());
            }
            let found = 1e6 * phase.ahead(1e-3) / phase.whisks as f64;
            assert_eq!(phase.whisks, 99);
            assert!((found - ppm).abs() < 0.01, "{ppm}: {found}");
        }
    }
}
