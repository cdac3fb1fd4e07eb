//! Recordings: labelled samples of two channels, read from comma-separated text.
//!
//! Glossary. *Stream*: rows of one label and trial that follow each other, in
//! time order.

use std::ops::Range;

/// A row of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Class name.
    pub label: String,
    /// Token of the trial.
    pub trial: String,
    /// The channels x and y.
    pub channels: [f64; 2],
}

/// Reads a recording: a header with at least `label,trial,x,y`, in any order,
/// then a sample a row.
///
/// # Errors
/// The number of the line that does not fit, and why.
pub fn read_recording(text: &str) -> Result<Vec<Sample>, String> {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or("").split(',').collect();
    let column = |name: &str| {
        let found = header.iter().position(|title| title.trim() == name);
        found.ok_or(format!("line 1: no column {name}"))
    };
    let columns = [
        column("label")?,
        column("trial")?,
        column("x")?,
        column("y")?,
    ];
    let mut samples = Vec::new();
    for (index, line) in lines.enumerate() {
        let line_number = index + 2;
        let cells: Vec<&str> = line.split(',').collect();
        let cell = |at: usize| {
            let found = cells.get(at).map(|cell| cell.trim());
            found.ok_or(format!("line {line_number}: too few columns"))
        };
        let number = |at: usize| {
            let value = cell(at)?.parse::<f64>();
            value.map_err(|error| format!("line {line_number}: {error}"))
        };
        samples.push(Sample {
            label: cell(columns[0])?.to_owned(),
            trial: cell(columns[1])?.to_owned(),
            channels: [number(columns[2])?, number(columns[3])?],
        });
    }
    Ok(samples)
}

/// Where the streams lie: runs of rows of one label and trial.
pub fn streams(recording: &[Sample]) -> Vec<Range<usize>> {
    let mut streams = Vec::new();
    let mut start = 0;
    for end in 1..=recording.len() {
        let last = &recording[end - 1];
        let goes_on = recording
            .get(end)
            .is_some_and(|next| next.label == last.label && next.trial == last.trial);
        if !goes_on {
            streams.push(start..end);
            start = end;
        }
    }
    streams
}
