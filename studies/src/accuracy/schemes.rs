//! What is measured: the product's integrators in every number format; and the instructions of a
//! call, as `cargo xtask count` counted them in an emulator.

use std::path::Path;

use anyhow::{Result, ensure};
use host_sim::Error;
use serde::Deserialize;
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
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Scheme {
    pub(super) integrator: Integrator,
    pub(super) format: Format,
}

impl Scheme {
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let formats = |integrator| Format::ALL.map(|format| Self { integrator, format });
        let integrators = [Integrator::Euler, Integrator::Exact];
        integrators.into_iter().flat_map(formats)
    }

    pub(super) fn name(self) -> String {
        let Self { integrator, format } = self;
        format!("{integrator:?} {format:?}").to_lowercase()
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

pub(crate) const TARGETS: [(&str, &str); 2] =
    [("Cortex-M4F", "cortex-m4f"), ("Cortex-M0+", "cortex-m0")];

#[derive(Debug, Deserialize)]
struct Row {
    kernel: String,
    format: String,
    target: String,
    mean: f64,
    worst: f64,
}

pub(crate) struct Counts(Vec<Row>);

impl Counts {
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read(path).map_err(|error| Error::file(path, error))?;
        let rows = csv::Reader::from_reader(&text[..]).into_deserialize();
        Ok(Self(rows.collect::<Result<_, _>>()?))
    }

    pub(crate) fn mean_and_worst(&self, wanted: [&str; 3]) -> Option<(f64, f64)> {
        let is_wanted = |row: &&Row| [&*row.kernel, &*row.format, &*row.target] == wanted;
        let row = self.0.iter().find(is_wanted);
        row.map(|row| (row.mean, row.worst))
    }

    /// Mean instructions of a tick of the pattern generator, two sides with a whisker each, gates
    /// included.
    pub(super) fn tick(&self, scheme: Scheme, target: &str) -> Option<f64> {
        let kernel = match scheme.integrator {
            Integrator::Exact => "whisking 2 sides 1 whisker",
            Integrator::Euler => "whisking 2 sides 1 whisker (euler)",
        };
        let format = match scheme.format {
            Format::Fixed => "fix",
            Format::F32 => "f32",
            Format::F64 => "f64",
        };
        Some(self.mean_and_worst([kernel, format, target])?.0)
    }
}

pub(crate) fn cell(count: Option<f64>) -> String {
    count.map_or_else(|| "not counted".to_owned(), |count| format!("{count:.0}"))
}
