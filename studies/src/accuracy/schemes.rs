//! What is measured: the product's integrators in every number format.

use anyhow::{Result, ensure};
use whisking::{Fix, Integrator, Number, Settings};

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

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Scheme {
    pub(super) integrator: Integrator,
    pub(super) format: Format,
}

impl Scheme {
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let formats = |integrator| Format::ALL.map(|format| Self { integrator, format });
        [Integrator::Euler, Integrator::Exact]
            .into_iter()
            .flat_map(formats)
    }

    pub(super) fn name(self) -> String {
        let integrator = match self.integrator {
            Integrator::Euler => "euler",
            Integrator::Exact => "exact",
        };
        format!("{integrator} {}", self.format.name())
    }

    /// Largest error of θ' in degrees over ten whisks of `case`, coupled and without noise and
    /// gates.
    pub(super) fn error(
        self,
        case: &Case,
        truth: &Truth,
        frequency_hz: f64,
        tick_hz: f64,
    ) -> Result<f64> {
        let settings = Settings {
            tick_hz,
            frequency_hz,
            integrator: self.integrator,
            coupling: true,
            noise: 0.0,
            rcp: None,
            cia: None,
        };
        match self.format {
            Format::F64 => error::<f64>(&settings, case, truth),
            Format::F32 => error::<f32>(&settings, case, truth),
            Format::Fixed => error::<Fix>(&settings, case, truth),
        }
    }
}

fn error<R: Number>(settings: &Settings, case: &Case, truth: &Truth) -> Result<f64> {
    let config = settings.build::<R>()?;
    let start = settings.start(&case.psi, &[&[case.gain][..]; 2]);
    let mut state = whisking::State::<R>::new(&start?, 1);
    // Points of the truth a tick.
    let points = GRID as f64 * settings.frequency_hz / settings.tick_hz;
    let stride = points.round() as usize;
    let is_on_grid = stride > 0 && (points - points.round()).abs() < 1e-6;
    ensure!(is_on_grid, "{settings:?} is not on the grid");
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
