//! Scenes as they are given in Python: a name, a path, a TOML text, or a dictionary.

use std::path::{Path, PathBuf};

use host_sim::Error;
use host_sim::loaded::Loaded;
use pyo3::create_exception;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use scene::{Override, Problem, Scene, file};

use crate::model;
use crate::outside::file_error;

create_exception!(
    vibrissa,
    SceneError,
    PyValueError,
    "What is wrong with a scene, one problem a line; `problems` has them singly."
);

/// With its problems as Python has them.
fn scene_error(py: Python<'_>, message: String, problems: &[Problem]) -> PyErr {
    let error = SceneError::new_err(message);
    let given = || {
        let class = py.import("vibrissa._scenes")?.getattr("Problem")?;
        let each = problems.iter().map(|problem| {
            let Problem {
                file,
                line,
                key,
                found,
                allowed,
            } = problem;
            class.call1((file, line, key, found, allowed))
        });
        error
            .value(py)
            .setattr("problems", each.collect::<PyResult<Vec<_>>>()?)
    };
    match given() {
        Ok(()) => error,
        Err(other) => other,
    }
}

/// An error of the simulator as an exception.
pub(crate) fn raised(py: Python<'_>, error: Error) -> PyErr {
    match error {
        Error::Input(message) => scene_error(py, message, &[]),
        Error::Work(message) => PyRuntimeError::new_err(message),
        Error::Write { .. } => PyOSError::new_err(error.to_string()),
    }
}

/// A scene as it was given: what is checked, and where its model is looked for.
pub(crate) struct Given {
    pub(crate) file: String,
    pub(crate) text: String,
    pub(crate) set: Vec<Override>,
    pub(crate) folder: PathBuf,
}

impl Given {
    /// Reads `scene`, with the keys of `set` in place of its own.
    pub(crate) fn new(scene: &Bound<'_, PyAny>, set: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let mut given = Self::of(scene)?;
        for (key, value) in set.into_iter().flatten() {
            let key: String = key.extract()?;
            // None, as in a dictionary of a scene: the scene's own stays.
            if value.is_none() {
                continue;
            }
            let source = format!("set[{key:?}]");
            let value = literal(&source, &value)?;
            given.set.push(Override::new(source, &key, &value));
        }
        Ok(given)
    }

    fn of(scene: &Bound<'_, PyAny>) -> PyResult<Self> {
        let beside = |file: &str, text: String| Self {
            file: file.to_owned(),
            text,
            set: Vec::new(),
            folder: PathBuf::new(),
        };
        if let Ok(table) = scene.cast::<PyDict>() {
            let mut given = beside("scene", String::new());
            flatten(table, "scene", "", &mut given.set)?;
            return Ok(given);
        }
        if let Ok(text) = scene.extract::<String>()
            && is_text(&text)
        {
            return Ok(beside("scene", text));
        }
        let path: PathBuf = scene.extract().map_err(|_| {
            let found = scene.get_type();
            PyTypeError::new_err(format!(
                "scene: found {found}, allowed: a name, a path, TOML text or a dict"
            ))
        })?;
        let path = match scene.extract::<String>() {
            Ok(name) if is_name(&name) && !path.is_file() => {
                let scenes = scene.py().import("vibrissa._scenes")?;
                scenes.call_method1("named", (name,))?.extract()?
            }
            _ => path,
        };
        Ok(Self {
            file: path.display().to_string(),
            text: file::read_text(&path).map_err(|error| file_error(&path, error))?,
            set: Vec::new(),
            folder: path.parent().map(Path::to_owned).unwrap_or_default(),
        })
    }

    /// The scene alone, as a recording needs it.
    pub(crate) fn scene(&self, py: Python<'_>, seed: Option<u64>) -> PyResult<Scene> {
        let read = Scene::from_str_with(&self.file, &self.text, &self.set);
        let (mut scene, _) =
            read.map_err(|all| scene_error(py, all.to_string(), all.as_slice()))?;
        let path = Path::new(&self.file);
        config::check(&scene).map_err(|fault| raised(py, Error::file(path, fault)))?;
        scene.seed = seed.unwrap_or(scene.seed);
        Ok(scene)
    }

    /// The scene with its model: `model` in place of the one that it names, if given.
    pub(crate) fn loaded(
        &self,
        py: Python<'_>,
        seed: Option<u64>,
        model: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Loaded> {
        // Problems singly; what follows has them as one text.
        self.scene(py, seed)?;
        // Before the scene's own model is looked for: what is wrong with it is not the scene's.
        let given = model.map(model::given).transpose()?;
        let named = |path: &Path| match &given {
            Some(model) => Ok(model.as_bytes().to_vec()),
            None => file::read(&self.folder.join(path), file::BINARY_BYTES)
                .map_err(|error| error.to_string()),
        };
        let loaded = Loaded::from_text(&self.file, &self.text, &self.set, named);
        let mut loaded = loaded.map_err(|error| raised(py, error))?;
        if given.is_some() {
            if loaded.scene.classifier.is_none() {
                let fault = "it has no [classifier], and so no use for a model";
                return Err(raised(py, Error::file(Path::new(&self.file), fault)));
            }
            loaded = loaded.with_deployed(Path::new("model"), given);
        }
        loaded.scene.seed = seed.unwrap_or(loaded.scene.seed);
        Ok(loaded)
    }
}

/// Whether it is TOML and no path: no path has a line break. One may have a key and its value, as
/// folders of a sweep do; then it is of a file that is there, or is called one.
fn is_text(scene: &str) -> bool {
    let path = Path::new(scene);
    let is_path = path
        .extension()
        .is_some_and(|extension| extension == "toml")
        || path.exists();
    scene.contains('\n') || scene.contains('=') && !is_path
}

/// Whether it may be a scene's name: a path has a separator or an extension.
fn is_name(scene: &str) -> bool {
    !scene.is_empty() && !scene.contains(['.', '/', '\\'])
}

/// The keys of a table, of which messages say where they stand; None is left out.
fn flatten(
    table: &Bound<'_, PyDict>,
    place: &str,
    section: &str,
    set: &mut Vec<Override>,
) -> PyResult<()> {
    for (name, value) in table {
        let name: String = name.extract()?;
        let place = format!("{place}[{name:?}]");
        let key = if section.is_empty() {
            name
        } else {
            format!("{section}.{name}")
        };
        if let Ok(table) = value.cast::<PyDict>() {
            flatten(table, &place, &key, set)?;
        } else if !value.is_none() {
            let value = literal(&place, &value)?;
            set.push(Override::new(place, &key, &value));
        }
    }
    Ok(())
}

/// A value as TOML has it. NumPy's truths, numbers and arrays are taken as Python's own, and paths
/// as text.
fn literal(place: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(truth) = value.extract::<bool>() {
        return Ok(truth.to_string());
    }
    if let Ok(text) = value.extract::<String>() {
        return Ok(toml::Value::String(text).to_string());
    }
    if value.hasattr("__fspath__")?
        && let Ok(path) = value.extract::<PathBuf>()
    {
        let text = path.display().to_string();
        return Ok(toml::Value::String(text).to_string());
    }
    if let Ok(whole) = value.extract::<i64>() {
        return Ok(whole.to_string());
    }
    if let Ok(number) = value.extract::<f64>() {
        return Ok(toml::Value::Float(number).to_string());
    }
    let is_list = value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>();
    if is_list || value.hasattr("tolist")? {
        let items = value.try_iter()?.map(|item| literal(place, &item?));
        return Ok(format!(
            "[{}]",
            items.collect::<PyResult<Vec<_>>>()?.join(", ")
        ));
    }
    let found = value.get_type();
    Err(PyTypeError::new_err(format!(
        "{place}: found {found}, allowed: a number, text, truth or list"
    )))
}
