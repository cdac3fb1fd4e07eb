//! Recordings from files, and from and to arrays.

use std::path::PathBuf;

use host_sim::cells::Cells as _;
use host_sim::doubts;
use host_sim::recording::{self, COLUMNS, Stream, Tokens, touches};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scene::file;
use tactile::ModelBuf;

use crate::outside::{self, file_error};
use crate::table::{Kind, Layout};

/// A recording as the Python side has prepared it.
#[derive(FromPyObject)]
pub(crate) struct Prepared<'py> {
    name: String,
    streams: Vec<Rows>,
    /// x and y.
    samples: PyReadonlyArray2<'py, f64>,
    contact: Option<PyReadonlyArray1<'py, f64>>,
    touch: Option<PyReadonlyArray1<'py, u16>>,
}

/// Label, trial, first row, the one after the last, the pose, and how what was touched stood.
type Rows = (
    String,
    String,
    usize,
    usize,
    Option<String>,
    Option<[f64; 2]>,
);

impl Prepared<'_> {
    /// Its name and its streams.
    pub(crate) fn read(&self) -> PyResult<(String, Vec<Stream>)> {
        let wrong = |row: usize, fault: &str| {
            outside::wrong(format_args!("{}: row {row}: {fault}", self.name))
        };
        let samples: &[f64] = self.samples.as_slice()?;
        let (samples, _) = samples.as_chunks::<2>();
        let contact = self
            .contact
            .as_ref()
            .map(PyReadonlyArray1::as_slice)
            .transpose()?;
        let touch = self
            .touch
            .as_ref()
            .map(PyReadonlyArray1::as_slice)
            .transpose()?;
        if let Some(row) = samples
            .iter()
            .position(|xy| !xy.iter().all(|v| v.is_finite()))
        {
            return Err(wrong(row, "x or y is not a finite number"));
        }
        let is_wide = |contact: &f64| !(*contact as f32).is_finite();
        if let Some(row) = contact.and_then(|all| all.iter().position(is_wide)) {
            return Err(wrong(
                row,
                "contact is not a finite number of single precision",
            ));
        }
        if samples.is_empty() {
            return Err(outside::wrong(format_args!("{}: no samples", self.name)));
        }
        let stream = |(label, trial, first, end, pose, stands): &Rows| {
            let tokens = Tokens {
                label,
                trial,
                pose: pose.as_deref(),
            };
            tokens.check().map_err(|fault| wrong(*first, &fault))?;
            if stands.is_some_and(|stands| !stands.iter().all(|of| of.is_finite())) {
                return Err(wrong(
                    *first,
                    "tilt_deg or depth_deg is not a finite number",
                ));
            }
            let rows = *first..*end;
            Ok(Stream {
                label: label.clone(),
                trial: trial.clone(),
                samples: samples.get(rows.clone()).unwrap_or_default().to_vec(),
                contact: contact.map(|all| all.get(rows.clone()).unwrap_or_default().to_vec()),
                touch: touch.map(|all| all.get(rows.clone()).unwrap_or_default().to_vec()),
                pose: pose.clone(),
                stands: *stands,
            })
        };
        let mut streams = self
            .streams
            .iter()
            .map(stream)
            .collect::<PyResult<Vec<_>>>()?;
        touches::tell_apart(&mut streams);
        Ok((self.name.clone(), streams))
    }
}

/// Warns of what is odd about recordings, by row.
pub(crate) fn warn(
    py: Python<'_>,
    recordings: &[(String, Vec<Stream>)],
    channels: &[String; 2],
) -> PyResult<()> {
    let channels = channels.each_ref().map(String::as_str);
    for doubt in py.detach(|| doubts::doubts(recordings, channels)) {
        let name = recordings.get(doubt.recording).map_or("", |(name, _)| name);
        warn_of(py, name, doubt.sample, &doubt.said)?;
    }
    Ok(())
}

/// The same of recordings that a model is to judge, and of samples outside of its range.
pub(crate) fn warn_before(
    py: Python<'_>,
    recordings: &[(String, Vec<Stream>)],
    channels: &[String; 2],
    model: &ModelBuf,
) -> PyResult<()> {
    warn(py, recordings, channels)?;
    let channels = channels.each_ref().map(String::as_str);
    for (name, streams) in recordings {
        if let Some((row, said)) = py.detach(|| doubts::outside(model, streams, channels)) {
            warn_of(py, name, row, &said)?;
        }
    }
    Ok(())
}

fn warn_of(py: Python<'_>, name: &str, row: usize, said: &str) -> PyResult<()> {
    let keywords = PyDict::new(py);
    // At the line that has called the function of Python.
    keywords.set_item("stacklevel", 2)?;
    let text = format!("{name}: row {row}: {said}");
    let warnings = py.import("warnings")?;
    warnings.call_method("warn", (text,), Some(&keywords))?;
    Ok(())
}

/// The array with its rate beside its type, where slices and copies of it keep it.
pub(crate) fn at_rate<'py>(array: &Bound<'py, PyAny>, tick_hz: u32) -> PyResult<Bound<'py, PyAny>> {
    let py = array.py();
    let metadata = PyDict::new(py);
    metadata.set_item("tick_hz", tick_hz)?;
    let keywords = PyDict::new(py);
    keywords.set_item("metadata", metadata)?;
    let dtype = py.import("numpy")?.getattr("dtype")?;
    let dtype = dtype.call((array.getattr("dtype")?,), Some(&keywords))?;
    array.call_method1("view", (dtype,))
}

/// Streams with the columns of a recording's file that they have, of which two are `channels`.
pub(crate) fn array<'py>(
    py: Python<'py>,
    streams: &[Stream],
    channels: [&str; 2],
) -> PyResult<Bound<'py, PyAny>> {
    let label = Kind::text(streams.iter().map(|stream| stream.label.as_str()));
    let trial = Kind::text(streams.iter().map(|stream| stream.trial.as_str()));
    let poses = || streams.iter().filter_map(|stream| stream.pose.as_deref());
    let pose = Kind::text(poses());
    let if_any = |kind: Kind, has: fn(&Stream) -> bool| {
        let is_there = streams.iter().any(has);
        if is_there { kind } else { Kind::Absent }
    };
    let stands = if_any(Kind::Number, |stream| stream.stands.is_some());
    let mut kinds = [
        label,
        trial,
        Kind::Number,
        Kind::Number,
        if_any(Kind::Number, |stream| stream.contact.is_some()),
        if_any(Kind::Whole, |stream| stream.touch.is_some()),
        if_any(pose, |stream| stream.pose.is_some()),
        stands,
        stands,
    ];
    let mut names = COLUMNS.map(|column| column.name);
    names[2..4].copy_from_slice(&channels);
    // A channel may be another column too, which is there once.
    for (n, kind) in kinds.iter_mut().enumerate() {
        if names[..n].contains(&names[n]) {
            *kind = Kind::Absent;
        }
    }
    let layout = Layout::new(names.into_iter().zip(kinds));
    let mut rows = Vec::new();
    for stream in streams {
        for (n, [x, y]) in stream.samples.iter().enumerate() {
            let mut row = layout.row(&mut rows);
            row.text(&stream.label);
            row.text(&stream.trial);
            let contact = stream.contact.as_ref().and_then(|all| all.get(n));
            let touch = stream.touch.as_ref().and_then(|all| all.get(n));
            row.numbers(&[*x, *y, contact.copied().unwrap_or(1.0)], 0);
            row.number(touch.copied().unwrap_or(0).into(), 0);
            row.text(stream.pose.as_deref().unwrap_or_default());
            row.numbers(&stream.stands.unwrap_or([f64::NAN; 2]), 0);
        }
    }
    layout.array(py, rows)
}

/// Reads a recording's file, as `host-sim record` and `whisker capture` write it: its rows, as
/// `record` returns them, with the columns that the file has, and with its rate. `channels` are the columns that are read as the two channels.
#[pyfunction]
#[pyo3(signature = (path, *, channels=["x".to_owned(), "y".to_owned()]))]
#[pyo3(text_signature = "(path, *, channels=(\"x\", \"y\"))")]
pub(crate) fn read(
    py: Python<'_>,
    path: PathBuf,
    channels: [String; 2],
) -> PyResult<Bound<'_, PyAny>> {
    let channels = channels.each_ref().map(String::as_str);
    let wrong = |error| outside::wrong(format_args!("{}: {error}", path.display()));
    let recording = py.detach(|| {
        let bytes =
            file::read(&path, file::TABLE_BYTES).map_err(|error| file_error(&path, error))?;
        let read = recording::read_whole(bytes.as_slice(), channels);
        read.map_err(wrong)
    })?;
    let rows = array(py, &recording.streams, channels)?;
    match recording.tick_hz {
        Some(tick_hz) => at_rate(&rows, tick_hz),
        None => Ok(rows),
    }
}
