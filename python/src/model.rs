//! A model: the bytes that a board runs, and what held-out trials say of it.

use std::path::PathBuf;

use host_sim::cells::Cells as _;
use host_sim::classifier;
use host_sim::training::TrainedModel;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use scene::file;
use tactile::ModelBuf;
use tactile::train::joint::{AtThreshold, Report};

use crate::outside::{self, file_error};
use crate::table::{Kind, Layout};

/// A model, of its bytes or its file; `train` makes one. `bytes(model)` are what a board runs.
#[pyclass(frozen, module = "vibrissa")]
pub(crate) struct Model {
    model: ModelBuf,
    report: Option<Report>,
}

impl From<TrainedModel> for Model {
    fn from(trained: TrainedModel) -> Self {
        Self {
            model: trained.model,
            report: trained.joint.map(|joint| joint.report),
        }
    }
}

impl Model {
    pub(crate) fn as_bytes(&self) -> &[u8] {
        self.model.as_bytes()
    }
}

type Figure = (&'static str, Kind, fn(&AtThreshold) -> f64);

/// The columns of [`Model::calibration`].
const FIGURES: [Figure; 9] = [
    ("threshold", Kind::Number, |at| at.threshold),
    ("stated", Kind::Number, |at| at.stated),
    ("found", Kind::Number, |at| at.found.share),
    ("low", Kind::Number, |at| at.found.low),
    ("high", Kind::Number, |at| at.found.high),
    ("decisions", Kind::Whole, |at| at.found.count as f64),
    ("samples", Kind::Number, |at| at.samples),
    ("unknown", Kind::Number, |at| at.unknown.share),
    ("undecided", Kind::Number, |at| at.undecided.share),
];

#[pymethods]
impl Model {
    #[new]
    fn new(source: &Bound<'_, PyAny>) -> PyResult<Self> {
        Ok(Self {
            model: given(source)?,
            report: None,
        })
    }

    fn __bytes__<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, self.as_bytes())
    }

    /// For other processes: its bytes alone, without what held-out trials said.
    fn __getnewargs__<'py>(&self, py: Python<'py>) -> (Bound<'py, PyBytes>,) {
        (self.__bytes__(py),)
    }

    /// Writes the bytes to a file.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        std::fs::write(&path, self.as_bytes()).map_err(|error| file_error(&path, error))
    }

    /// The names of its classes.
    #[getter]
    fn classes(&self) -> Vec<String> {
        classifier::names(&self.model)
    }

    /// Of trials that were held out, at each threshold: the probability that decisions stated,
    /// the share that was found right with its 95 % interval, mean samples, and the shares of
    /// decisions for unknown and of trials without one. None of a model that was not just
    /// trained, or of single tables.
    #[getter]
    fn calibration<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(report) = &self.report else {
            return Ok(None);
        };
        let columns = FIGURES.map(|(name, kind, _)| (name, kind));
        let (layout, mut rows) = (Layout::new(columns), Vec::new());
        for at in &report.calibration {
            let found = FIGURES.map(|(.., figure)| figure(at));
            layout.row(&mut rows).numbers(&found, 0);
        }
        layout.array(py, rows).map(Some)
    }

    fn __repr__(&self) -> String {
        let (classes, bytes) = (self.classes().join(", "), self.as_bytes().len());
        format!("<vibrissa.Model of {classes}: {bytes} bytes>")
    }
}

/// Whether it is a model, bytes that should be one, or a file of one, and no recording.
#[pyfunction]
pub(crate) fn is_model(source: &Bound<'_, PyAny>) -> bool {
    if source.is_instance_of::<Model>() || source.is_instance_of::<PyBytes>() {
        return true;
    }
    let path = source.extract::<PathBuf>();
    path.is_ok_and(|path| {
        let read = file::read(&path, file::BINARY_BYTES);
        read.is_ok_and(|bytes| ModelBuf::from_bytes(&bytes).is_ok())
    })
}

/// The model of a [`Model`], of bytes or of a file.
///
/// # Errors
/// What is wrong with it, under the name `model` and, of a file, its path.
pub(crate) fn given(model: &Bound<'_, PyAny>) -> PyResult<ModelBuf> {
    if let Ok(model) = model.cast::<Model>() {
        return Ok(model.get().model.clone());
    }
    if let Ok(bytes) = model.cast::<PyBytes>() {
        let model = ModelBuf::from_bytes(bytes.as_bytes());
        return model.map_err(|error| outside::wrong(format_args!("model: {error}")));
    }
    let path: PathBuf = model.extract().map_err(|_| {
        let found = model.get_type();
        PyTypeError::new_err(format!(
            "model: found {found}, allowed: a Model, its bytes or a path"
        ))
    })?;
    let bytes = file::read(&path, file::BINARY_BYTES).map_err(|error| file_error(&path, error))?;
    let wrong = |error| outside::wrong(format_args!("model: {}: {error}", path.display()));
    ModelBuf::from_bytes(&bytes).map_err(wrong)
}
