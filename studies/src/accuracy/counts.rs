//! Instructions of a call, as `cargo xtask count` counted them in an emulator.

use std::path::Path;

use serde::Deserialize;
use whisking::Integrator;

use super::schemes::Format;

/// A processor that was counted for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Target {
    M4F,
    M0,
}

impl Target {
    pub(crate) const ALL: [Self; 2] = [Self::M4F, Self::M0];

    /// As the report calls it.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::M4F => "Cortex-M4F",
            Self::M0 => "Cortex-M0+",
        }
    }

    /// As the table calls it.
    const fn column(self) -> &'static str {
        match self {
            Self::M4F => "cortex-m4f",
            Self::M0 => "cortex-m0",
        }
    }
}

/// A row, by the names of the header.
#[derive(Debug, Deserialize)]
struct Row {
    kernel: String,
    format: String,
    target: String,
    mean: f64,
    #[serde(default)]
    worst: f64,
}

/// The whole table; empty where there is none.
#[derive(Debug, Default)]
pub(crate) struct Counts(Vec<Row>);

impl Counts {
    /// Reads `path`: `kernel,format,target,mean,…` by the names of its header.
    /// A table that is not there or that lacks a column counts nothing.
    pub(crate) fn read(path: &Path) -> Self {
        std::fs::read(path).map_or_else(|_| Self::default(), |text| Self::parse(&text))
    }

    pub(crate) fn parse(text: &[u8]) -> Self {
        let mut reader = csv::Reader::from_reader(text);
        Self(reader.deserialize().flatten().collect())
    }

    /// Whether nothing was counted.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Mean instructions of a call of `kernel`.
    pub(super) fn of(&self, kernel: &str, format: &str, target: Target) -> Option<f64> {
        Some(self.mean_and_worst(kernel, format, target)?.0)
    }

    /// Mean and most instructions of a call of `kernel`.
    pub(crate) fn mean_and_worst(
        &self,
        kernel: &str,
        format: &str,
        target: Target,
    ) -> Option<(f64, f64)> {
        let wanted = (kernel, format, target.column());
        let mut rows = self.0.iter();
        let row = rows.find(|row| (&*row.kernel, &*row.format, &*row.target) == wanted);
        row.map(|row| (row.mean, row.worst))
    }

    /// Mean instructions of a tick of the pattern generator, two sides with a
    /// whisker each, gates included.
    pub(super) fn tick(
        &self,
        integrator: Integrator,
        format: Format,
        target: Target,
    ) -> Option<f64> {
        let kernel = match integrator {
            Integrator::Exact => "whisking 2 sides 1 whisker",
            Integrator::Euler => "whisking 2 sides 1 whisker (euler)",
        };
        self.of(kernel, column_name(format), target)
    }
}

/// The table's name of a number format.
pub(super) const fn column_name(format: Format) -> &'static str {
    match format {
        Format::F64 => "f64",
        Format::F32 => "f32",
        Format::Fixed => "fix",
    }
}

/// A cell for a count.
pub(super) fn cell(count: Option<f64>) -> String {
    count.map_or_else(|| "not counted".to_owned(), |count| format!("{count:.0}"))
}

#[cfg(test)]
mod tests {
    use super::{Counts, Target, cell};
    use crate::accuracy::schemes::Format;
    use whisking::Integrator::{Euler, Exact};

    #[test]
    fn columns_and_processors_are_found_by_name() {
        let table = b"kernel,format,target,mean,worst\n\
            drive,f32,cortex-m4f,26.5,30\n\
            whisking 2 sides 1 whisker,fix,cortex-m0,801,900\n";
        let counts = Counts::parse(table);
        assert_eq!(counts.of("drive", "f32", Target::M4F), Some(26.5));
        assert_eq!(counts.of("drive", "f32", Target::M0), None);
        assert_eq!(counts.tick(Exact, Format::Fixed, Target::M0), Some(801.0));
        assert_eq!(counts.tick(Euler, Format::Fixed, Target::M0), None);
        assert_eq!(cell(None), "not counted");
        assert!(Counts::parse(b"kernel,mean\nx,1\n").is_empty());
    }
}
