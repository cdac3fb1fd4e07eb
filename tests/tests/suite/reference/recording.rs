//! Recordings: labelled samples of two channels, read from comma-separated text.
//!
//! Glossary. *Stream*: rows of one label and trial that follow each other, in
//! time order.

use serde::Deserialize;

#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(crate) struct Sample {
    pub(crate) label: String,
    pub(crate) trial: String,
    pub(crate) x: f64,
    pub(crate) y: f64,
}

impl Sample {
    pub(crate) const fn channels(&self) -> [f64; 2] {
        [self.x, self.y]
    }
}

/// Reads a recording: a header with at least `label,trial,x,y`, in any order,
/// then a sample a row.
pub(crate) fn read_recording(text: &str) -> Result<Vec<Sample>, String> {
    let mut reader = csv::ReaderBuilder::new();
    let mut table = reader.trim(csv::Trim::All).from_reader(text.as_bytes());
    let samples: Result<_, csv::Error> = table.deserialize().collect();
    samples.map_err(|error| error.to_string())
}

/// The streams: runs of rows of one label and trial.
pub(crate) fn streams(recording: &[Sample]) -> impl Iterator<Item = &[Sample]> {
    recording.chunk_by(|one, next| one.label == next.label && one.trial == next.trial)
}
