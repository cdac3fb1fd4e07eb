//! Record, train, classify, evaluate: the commands of host-sim on arrays.

use host_sim::classifier::{self, Fault};
use host_sim::decisions::{Columns, Decided, UNKNOWN};
use host_sim::doubts;
use host_sim::evaluation::{self, Evaluation};
use host_sim::rate;
use host_sim::recording::{self, Recorder, Stream};
use host_sim::replay::Replay;
use host_sim::run::Run;
use host_sim::training::{EXPECTED, How, Tables};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scene::Rule;
use tactile::ModelBuf;
use tactile::score::Interval;
use tactile::train::TrainError;

use crate::model::{self, Model};
use crate::outside::{self, wrong};
use crate::recordings::{self, Prepared};
use crate::scenes::{Given, raised};
use crate::table;

/// Runs a scene and returns what its whiskers feel that are heard, the air included: a recording
/// to train on. The scene's classifier is not used. Its type knows the rate,
/// `dtype.metadata["tick_hz"]`, which train goes by.
#[pyfunction]
#[pyo3(signature = (scene, *, seed=None, set=None))]
pub(crate) fn record<'py>(
    py: Python<'py>,
    scene: &Bound<'py, PyAny>,
    seed: Option<&Bound<'_, PyAny>>,
    set: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let seed = seed.map(|n| outside::seed("seed", n)).transpose()?;
    let scene = Given::new(scene, set)?.scene(py, seed)?;
    let run = Run::new(&scene, None);
    let mut run = run.map_err(|error| raised(py, error))?;
    let streams = py.detach(|| {
        let mut recorder = Recorder::default();
        for n in 1..=run.ticks() {
            if n.is_multiple_of(outside::HEEDED) {
                outside::heed()?;
            }
            run.pass();
            recorder.take(&mut run);
        }
        PyResult::Ok(recorder.into_streams())
    });
    recordings::at_rate(
        &recordings::array(py, &streams?, recording::CHANNELS)?,
        scene.tick_hz,
    )
}

/// Trains a model from recordings that the Python side has prepared.
#[pyfunction]
#[pyo3(signature = (data, *, channels, tables, bins, smooth, block, gate, gap, expect, rate))]
#[allow(clippy::too_many_arguments, reason = "they are Python's keywords")]
pub(crate) fn train(
    py: Python<'_>,
    data: Vec<Prepared<'_>>,
    channels: [String; 2],
    tables: &str,
    bins: Option<i64>,
    smooth: Option<f64>,
    block: Option<i64>,
    gate: Option<f64>,
    gap: Option<f64>,
    expect: &str,
    rate: i64,
) -> PyResult<Model> {
    let rate = outside::whole("rate", rate)?;
    let known = [("joint", Tables::Joint), ("single", Tables::Single)];
    let tables = outside::one_of("tables", tables, &known)?;
    let known = EXPECTED.map(|(word, meant, _)| (word, meant));
    let expect = outside::one_of("expect", expect, &known)?;
    let how = How {
        bins: bins.map(|n| outside::whole("bins", n)).transpose()?,
        smooth,
        block: block.map(|n| outside::whole("block", n)).transpose()?,
        gate,
        gap,
        expect,
        ..How::of(tables)
    };
    how.check().map_err(wrong)?;
    if rate == 0 {
        return Err(wrong("rate: found 0, allowed: above 0"));
    }
    let read: PyResult<Vec<_>> = data.iter().map(Prepared::read).collect();
    let read = read?;
    let mut streams = read.iter().flat_map(|(_, streams)| streams);
    if streams.any(|stream| stream.label == UNKNOWN) {
        let fault = format!("label: {UNKNOWN:?} is what a decision for none of the classes says");
        return Err(wrong(fault));
    }
    let trained = py.detach(|| how.train(&read, rate));
    recordings::warn(py, &read, &channels)?;
    trained.map(Model::from).map_err(|fault| match fault {
        TrainError::TooShort { .. } => wrong(format!("{fault}; {}", doubts::short(&read))),
        TrainError::Range { channel } if channel < channels.len() => wrong(format!(
            "{}: its range is too wide or too narrow",
            channels[channel]
        )),
        _ => wrong(fault),
    })
}

/// Whether a recording, if it says its samples a second, has those of the model.
fn at_its_rate(model: &ModelBuf, rate: Option<u32>) -> PyResult<()> {
    let model = ("model".to_owned(), model.rate_hz());
    let recording = ("the recording: tick_hz".to_owned(), rate);
    rate::agreed([model, recording]).map(drop).map_err(wrong)
}

/// The decisions of a model on a recording that the Python side has prepared.
#[pyfunction]
#[pyo3(signature = (model, data, *, channels, threshold, window, rate))]
pub(crate) fn classify<'py>(
    py: Python<'py>,
    model: &Bound<'py, PyAny>,
    data: Prepared<'py>,
    channels: [String; 2],
    threshold: f64,
    window: Option<i64>,
    rate: Option<u32>,
) -> PyResult<Bound<'py, PyAny>> {
    let (name, rule) = match window.map(|n| outside::whole("window", n)).transpose()? {
        Some(samples) => ("window", Rule::Window { samples }),
        None => ("threshold", Rule::Sequential { threshold }),
    };
    let model = model::given(model)?;
    at_its_rate(&model, rate)?;
    let has_pose = model.has_pose();
    let read = [data.read()?];
    recordings::warn_before(py, &read, &channels, &model)?;
    let [(_, streams)] = &read;
    let replay = Replay::new(model, rule);
    let mut replay = replay.map_err(|fault| match fault {
        Fault::Model(fault) => wrong(format!("model: {fault}")),
        Fault::Rule(fault) => wrong(format!("{name}: {fault}")),
    })?;
    let decided = py.detach(|| {
        let each = streams.iter().map(|stream| replay.stream(stream));
        each.collect::<Result<Vec<Vec<Decided>>, _>>()
    });
    let decided = decided.map_err(wrong)?.concat();
    let columns = Columns::of_recording(has_pose);
    table::decisions(py, &[(None, &decided)], columns)
}

/// What a model is worth on recordings that the Python side has prepared, which puts it into arrays.
#[pyfunction]
#[pyo3(signature = (model, data, *, channels, threshold, rate))]
pub(crate) fn evaluate<'py>(
    py: Python<'py>,
    model: &Bound<'py, PyAny>,
    data: Vec<Prepared<'py>>,
    channels: [String; 2],
    threshold: f64,
    rate: Option<u32>,
) -> PyResult<Bound<'py, PyDict>> {
    let model = model::given(model)?;
    at_its_rate(&model, rate)?;
    let classes = classifier::names(&model);
    let read: PyResult<Vec<_>> = data.iter().map(Prepared::read).collect();
    let read = read?;
    recordings::warn_before(py, &read, &channels, &model)?;
    let streams: Vec<Stream> = read.into_iter().flat_map(|(_, streams)| streams).collect();
    let presented = py.detach(|| evaluation::presentations(&model, threshold, &streams));
    let presented = presented.map_err(wrong)?;
    let found = Evaluation::new(&classes, &presented);
    let dict = PyDict::new(py);
    dict.set_item("hits", found.hits)?;
    dict.set_item("left_out", found.left_out())?;
    dict.set_item("samples", found.samples)?;
    dict.set_item("samples_error", found.samples_error)?;
    let shares = [
        ("refused", found.refused),
        ("strange", found.strange),
        ("undecided", found.undecided),
        ("found", found.calibration.found),
    ];
    let parts = |of: Interval| (of.share, of.low, of.high, of.count);
    for (name, share) in shares {
        dict.set_item(name, parts(share))?;
    }
    dict.set_item("stated", found.calibration.stated)?;
    let shown = presented.iter().map(|shown| shown.label.as_str());
    let labels = classes.iter().map(String::as_str).chain(shown);
    dict.set_item("labels", labels.chain([UNKNOWN]).collect::<Vec<_>>())?;
    let decided = presented.iter().flat_map(|shown| &shown.decided);
    let pairs = decided.map(|decided| (&decided.label, &decided.decision));
    dict.set_item("decided", pairs.collect::<Vec<_>>())?;
    let bins = found.calibration.bins.iter();
    let bins = bins.map(|bin| (bin.low, bin.high, bin.stated, parts(bin.found)));
    dict.set_item("calibration", bins.collect::<Vec<_>>())?;
    let classes = found.classes.iter().map(|class| {
        let samples = class.samples.map_or(f64::NAN, |samples| samples.mean);
        let counts = (&class.name, class.presented, class.hits.count);
        let shares = (
            class.hits.share,
            samples,
            class.refused.share,
            class.undecided.share,
        );
        (counts, shares)
    });
    dict.set_item("classes", classes.collect::<Vec<_>>())?;
    Ok(dict)
}
