//! What is measured: the product's integrators in every number format.

use anyhow::{Result, bail};
use whisking::{Integrator, Number, Settings};

use super::reference::{Case, GRID, Truth, WHISKS};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    F64,
    F32,
    Fixed,
}

impl Format {
    pub(super) const ALL: [Self; 3] = [Self::F64, Self::F32, Self::Fixed];

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

pub(super) const fn name(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::Euler => "euler",
        Integrator::Exact => "exact",
    }
}

/// Both integrators, the papers' first.
pub(super) const INTEGRATORS: [Integrator; 2] = [Integrator::Euler, Integrator::Exact];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Scheme {
    pub(super) integrator: Integrator,
    pub(super) format: Format,
}

impl Scheme {
    /// All of them, Euler first.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let formats = |integrator| Format::ALL.map(|format| Self { integrator, format });
        INTEGRATORS.into_iter().flat_map(formats)
    }

    pub(super) fn name(self) -> String {
        format!("{} {}", name(self.integrator), self.format.name())
    }

    /// Largest error of θ' in degrees over ten whisks of `case`.
    pub(super) fn error(self, case: &Case, truth: &Truth, pace: Pace) -> Result<f64> {
        let settings = pace.settings(self.integrator);
        in_format!(self.format, error(&settings, case, truth, pace))
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

fn error<R: Number>(settings: &Settings, case: &Case, truth: &Truth, pace: Pace) -> Result<f64> {
    let config = settings.build::<R>()?;
    let start = settings.start(&case.psi, &[&[case.gain][..]; 2]);
    let mut state = whisking::State::<R>::new(&start?, 1);
    let stride = pace.stride()?;
    let mut worst = 0.0_f64;
    for n in 1..=WHISKS * GRID / stride {
        config.step(&mut state, &[]);
        let expected = truth.theta(n * stride).unwrap_or([f64::NAN; 2]);
        for (found, expected) in state.theta().zip(expected) {
            let error = 100.0 * (found.to_f64() - expected).abs();
            // Not `max`, which drops a NaN.
            if error > worst || error.is_nan() {
                worst = error;
            }
        }
    }
    Ok(worst)
}
