//! What is compared: the product's integrators in every number format, and two
//! schemes from outside for scale.

use anyhow::{Result, bail};
use whisking::{Integrator, Number, Settings};

use super::reference::{Case, GRID, PEAK_GAIN, State, Truth, WHISKS};
use super::split::Split;

/// A number format of the product.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    F64,
    F32,
    Fixed,
}

impl Format {
    pub(super) const ALL: [Self; 3] = [Self::F64, Self::F32, Self::Fixed];

    /// As the report calls it.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::F64 => "f64",
            Self::F32 => "f32",
            Self::Fixed => "fixed",
        }
    }
}

/// A function of a number type, called with that of a format.
macro_rules! in_format {
    ($format:expr, $function:ident($($argument:expr),*)) => {
        match $format {
            Format::F64 => $function::<f64>($($argument),*),
            Format::F32 => $function::<f32>($($argument),*),
            Format::Fixed => $function::<whisking::Fix>($($argument),*),
        }
    };
}
pub(super) use in_format;

/// As the report calls it.
pub(super) const fn name(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::Euler => "euler",
        Integrator::Exact => "exact",
    }
}

/// Both integrators, the papers' first.
pub(super) const INTEGRATORS: [Integrator; 2] = [Integrator::Euler, Integrator::Exact];

/// A way to step the equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scheme {
    /// The product's.
    Product(Integrator, Format),
    /// The classical Runge-Kutta method in f64: four evaluations a tick.
    RungeKutta,
    /// Rotation with radial relaxation, coupling in two halves, and the muscle's
    /// linear part, each exact; the force at the middle of the tick; f64.
    Split,
}

impl Scheme {
    /// The product's integrators, Euler first, then the comparisons.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let formats = |integrator| Format::ALL.map(|format| Self::Product(integrator, format));
        let product = INTEGRATORS.into_iter().flat_map(formats);
        product.chain([Self::RungeKutta, Self::Split])
    }

    /// As the report calls it.
    pub(super) fn name(self) -> String {
        match self {
            Self::Product(integrator, format) => format!("{} {}", name(integrator), format.name()),
            Self::RungeKutta => "comparison: Runge-Kutta f64".to_owned(),
            Self::Split => "comparison: split step f64".to_owned(),
        }
    }

    /// Largest error of θ' in degrees over ten whisks of `case`.
    pub(super) fn error(self, case: &Case, truth: &Truth, pace: Pace) -> Result<f64> {
        let cycles = pace.frequency_hz / pace.tick_hz;
        let push = PEAK_GAIN * case.gain;
        match self {
            Self::Product(integrator, format) => {
                let settings = pace.settings(integrator);
                in_format!(format, product(&settings, case, truth, pace))
            }
            Self::RungeKutta => outside(case, truth, pace, |s| s.runge_kutta(cycles, [push; 3])),
            Self::Split => {
                let split = Split::new(cycles, push);
                outside(case, truth, pace, |state| split.step(state))
            }
        }
    }
}

/// How fast: f_W and the tick rate, Hz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pace {
    pub(super) frequency_hz: f64,
    pub(super) tick_hz: f64,
}

/// 2 Hz at 2 kHz, as in all of BIOTACT.
pub(super) const PAPERS: Pace = Pace::new(2.0, 2_000.0);

impl Pace {
    /// From f_W and the tick rate, Hz.
    pub(super) const fn new(frequency_hz: f64, tick_hz: f64) -> Self {
        Self {
            frequency_hz,
            tick_hz,
        }
    }

    /// Coupled, without noise and gates.
    pub(super) fn settings(self, integrator: Integrator) -> Settings {
        Settings {
            tick_hz: self.tick_hz,
            frequency_hz: self.frequency_hz,
            integrator,
            coupling: true,
            noise: 0.0,
            rcp: None,
            cia: None,
        }
    }

    /// Points of the truth a tick.
    pub(super) fn stride(self) -> Result<usize> {
        let stride = GRID as f64 * self.frequency_hz / self.tick_hz;
        if (stride - stride.round()).abs() < 1e-6 && stride.round() >= 1.0 {
            Ok(stride.round() as usize)
        } else {
            bail!("{self:?} is not on the grid")
        }
    }
}

fn product<R: Number>(settings: &Settings, case: &Case, truth: &Truth, pace: Pace) -> Result<f64> {
    let config = settings.build::<R>()?;
    let start = settings.start(&case.psi, &[&[case.gain][..]; 2]);
    let mut state = whisking::State::<R>::new(&start?, 1);
    worst(truth, pace, || {
        config.step(&mut state, &[]);
        [0, 1].map(|side| state.whiskers[side].muscle.theta.to_f64())
    })
}

fn outside(case: &Case, truth: &Truth, pace: Pace, step: impl Fn(&State) -> State) -> Result<f64> {
    let mut state = State::new(case);
    worst(truth, pace, || {
        state = step(&state);
        state.theta()
    })
}

fn worst(truth: &Truth, pace: Pace, mut tick: impl FnMut() -> [f64; 2]) -> Result<f64> {
    let stride = pace.stride()?;
    let mut worst = 0.0_f64;
    for n in 1..=WHISKS * GRID / stride {
        let found = tick();
        let expected = truth.theta(n * stride).unwrap_or([f64::NAN; 2]);
        for (found, expected) in found.iter().zip(expected) {
            let error = 100.0 * (found - expected).abs();
            // Not `max`, which drops a NaN.
            if error > worst || error.is_nan() {
                worst = error;
            }
        }
    }
    Ok(worst)
}

#[cfg(test)]
mod tests {
    use super::{Pace, Scheme};
    use crate::accuracy::integrators::NEAR;
    use crate::accuracy::reference::Truth;
    use whisking::Integrator::Euler;

    /// What other programs measured for the same runs.
    #[test]
    fn the_comparisons_have_their_known_errors() {
        let truth = Truth::solve(&NEAR);
        let euler = Scheme::Product(Euler, super::Format::F64);
        for (scheme, frequency_hz, tick_hz, known) in [
            (Scheme::RungeKutta, 2.0, 2_000.0, 6.7e-8),
            (Scheme::RungeKutta, 25.0, 2_000.0, 2.3e-3),
            (Scheme::RungeKutta, 25.0, 500.0, 1.5),
            (euler, 2.0, 2_000.0, 0.48),
            (euler, 25.0, 500.0, 51.0),
        ] {
            let pace = Pace::new(frequency_hz, tick_hz);
            let found = scheme.error(&NEAR, &truth, pace).unwrap();
            assert!(
                (found / known - 1.0).abs() < 0.05,
                "{scheme:?}: {found:e} of {known:e}"
            );
        }
    }

    /// A split of second order: half the tick, a quarter of the error.
    #[test]
    fn the_split_step_is_of_second_order() {
        let truth = Truth::solve(&NEAR);
        let error = |tick_hz| {
            let pace = Pace::new(8.0, tick_hz);
            Scheme::Split.error(&NEAR, &truth, pace).unwrap()
        };
        let ratio = error(1_000.0) / error(2_000.0);
        assert!((ratio - 4.0).abs() < 0.2, "{ratio}");
    }
}
