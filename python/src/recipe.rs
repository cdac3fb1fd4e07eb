//! What a run was made of, and what was done to it: by these an equal one is made again, in this
//! process or another. A run depends on nothing else.

use host_sim::loaded::Loaded;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use scene::Override;
use tactile::ModelBuf;

use crate::scenes::Given;

/// A scene with its model in Python, and no file: the name and the text of the scene, keys and
/// values in place of its own, and the model's bytes.
pub(crate) type Parts<'py> = (
    String,
    String,
    Vec<(String, String)>,
    Option<Bound<'py, PyBytes>>,
);

/// A scene as it was given, and what was read of it, as Python has them.
pub(crate) fn parts<'py>(py: Python<'py>, given: &Given, loaded: &Loaded) -> Parts<'py> {
    let set = given.set.iter();
    let set = set.map(|one| (one.key().to_owned(), one.value().to_owned()));
    let model = loaded.model().map(ModelBuf::as_bytes);
    let model = model.map(|bytes| PyBytes::new(py, bytes));
    (given.file.clone(), given.text.clone(), set.collect(), model)
}

/// The same from Python.
pub(crate) fn loaded(py: Python<'_>, parts: Parts<'_>) -> PyResult<(Given, Loaded)> {
    let (file, text, set, model) = parts;
    let set = set.iter();
    let set = set.map(|(key, value)| Override::new("scene".to_owned(), key, value));
    let given = Given {
        file,
        text,
        set: set.collect(),
        folder: std::path::PathBuf::new(),
    };
    let model = model.map(Bound::into_any);
    let loaded = given.loaded(py, None, model.as_ref())?;
    Ok((given, loaded))
}

/// Something that was done to a run: before which tick, what, to which whisker, and its number.
pub(crate) type Call = (u64, u8, usize, f64);

/// A setpoint; not a number: the pattern generator's again.
pub(crate) const SETPOINT: u8 = 0;
/// A gain.
pub(crate) const GAIN: u8 = 1;
/// A texture, in place of the whisker by its place in the list of all.
pub(crate) const LAY: u8 = 2;

/// Most calls that are kept.
const MOST: usize = 1 << 20;

/// What was done to a run since its start.
#[derive(Clone, Default)]
pub(crate) struct Script {
    calls: Vec<Call>,
    /// There were more than are kept.
    is_cut: bool,
}

impl Script {
    /// Keeps one more. Of several of a kind before the same tick the last one counts.
    pub(crate) fn add(&mut self, call: Call) {
        let (tick, kind, whisker, _) = call;
        let mut before = self.calls.iter_mut().rev().take_while(|one| one.0 == tick);
        let same = before.find(|one| (one.1, one.2) == (kind, whisker) && kind != LAY);
        if let Some(same) = same {
            *same = call;
        } else if self.calls.len() < MOST {
            self.calls.push(call);
        } else {
            self.is_cut = true;
        }
    }

    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }

    /// All of them; none: there were too many.
    pub(crate) fn whole(&self) -> Option<&[Call]> {
        (!self.is_cut).then_some(&self.calls)
    }
}
