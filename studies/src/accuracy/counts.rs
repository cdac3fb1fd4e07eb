//! Instructions of a call, as `cargo xtask count` counted them in an emulator.

use std::path::Path;

use anyhow::Result;
use host_sim::Error;
use serde::Deserialize;
use whisking::Integrator;

use super::schemes::{Format, Scheme};

#[derive(Clone, Copy)]
pub(crate) struct Target {
    pub(super) name: &'static str,
    column: &'static str,
}

pub(crate) const TARGETS: [Target; 2] = [
    Target {
        name: "Cortex-M4F",
        column: "cortex-m4f",
    },
    Target {
        name: "Cortex-M0+",
        column: "cortex-m0",
    },
];

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
    /// Reads `path`: `kernel,format,target,mean,…` by the names of its header.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read(path).map_err(|error| Error::file(path, error))?;
        Self::parse(&text)
    }

    pub(crate) fn parse(text: &[u8]) -> Result<Self> {
        let rows = csv::Reader::from_reader(text).into_deserialize();
        Ok(Self(rows.collect::<Result<_, _>>()?))
    }

    pub(crate) fn mean_and_worst(
        &self,
        kernel: &str,
        format: &str,
        target: Target,
    ) -> Option<(f64, f64)> {
        let wanted = (kernel, format, target.column);
        let mut rows = self.0.iter();
        let row = rows.find(|row| (&*row.kernel, &*row.format, &*row.target) == wanted);
        row.map(|row| (row.mean, row.worst))
    }

    /// Mean instructions of a tick of the pattern generator, two sides with a
    /// whisker each, gates included.
    pub(super) fn tick(&self, scheme: Scheme, target: Target) -> Option<f64> {
        let kernel = match scheme.integrator {
            Integrator::Exact => "whisking 2 sides 1 whisker",
            Integrator::Euler => "whisking 2 sides 1 whisker (euler)",
        };
        let format = match scheme.format {
            Format::F64 => "f64",
            Format::F32 => "f32",
            Format::Fixed => "fix",
        };
        Some(self.mean_and_worst(kernel, format, target)?.0)
    }
}

pub(super) fn cell(count: Option<f64>) -> String {
    count.map_or_else(|| "not counted".to_owned(), |count| format!("{count:.0}"))
}
