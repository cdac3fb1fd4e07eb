//! Scenes as they are given in Python: a name, a path, a TOML text, or a dictionary.

use std::path::{Path, PathBuf};

use host_sim::Error;
use host_sim::loaded::Loaded;
use pyo3::create_exception;
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple, PyType};
use scene::{Override, Problems, Scene, file};

use crate::model;
use crate::outside::file_error;

create_exception!(
    vibrissa,
    SceneError,
    PyValueError,
    "What is wrong with a scene, one problem a line; `problems` has them singly."
);

/// The fields of a [`Problem`], in order.
type Fields = (String, Option<usize>, String, String, String);

/// One thing wrong with a scene.
#[pyclass(frozen, get_all, module = "vibrissa")]
#[derive(Clone)]
pub(crate) struct Problem {
    /// The scene's file, or where in the arguments it stands.
    file: String,
    /// Line, counted from 1; None for what is not in a file.
    line: Option<usize>,
    /// The key with its section, such as `head.sides`.
    key: String,
    /// What was found.
    found: String,
    /// What is allowed.
    allowed: String,
}

#[pymethods]
impl Problem {
    #[new]
    fn new(file: String, line: Option<usize>, key: String, found: String, allowed: String) -> Self {
        Self {
            file,
            line,
            key,
            found,
            allowed,
        }
    }

    /// For other processes.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyType>, Fields) {
        let its = slf.get().clone();
        let fields = (its.file, its.line, its.key, its.found, its.allowed);
        (slf.get_type(), fields)
    }

    fn __repr__(&self) -> String {
        let Self {
            file,
            line,
            key,
            found,
            allowed,
        } = self;
        let line = line.map_or("None".to_owned(), |line| line.to_string());
        format!(
            "Problem(file={file:?}, line={line}, key={key:?}, found={found:?}, allowed={allowed:?})"
        )
    }
}

fn scene_error(py: Python<'_>, message: String, problems: Vec<Problem>) -> PyErr {
    let error = SceneError::new_err(message);
    match error.value(py).setattr("problems", problems) {
        Ok(()) => error,
        Err(other) => other,
    }
}

/// An error of the simulator as an exception.
pub(crate) fn raised(py: Python<'_>, error: Error) -> PyErr {
    match error {
        Error::Input(message) => scene_error(py, message, Vec::new()),
        Error::Work(message) => PyRuntimeError::new_err(message),
        Error::Write { .. } => PyOSError::new_err(error.to_string()),
    }
}

fn refused(py: Python<'_>, problems: &Problems) -> PyErr {
    let each = problems.as_slice().iter().map(|problem| Problem {
        file: problem.file.clone(),
        line: problem.line,
        key: problem.key.clone(),
        found: problem.found.clone(),
        allowed: problem.allowed.clone(),
    });
    scene_error(py, problems.to_string(), each.collect())
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
            given
                .set
                .push(Override::new(source, &key, &literal(&value)?));
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
            Ok(name) if is_name(&name) && !path.is_file() => named(scene.py(), &name)?,
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
        let (mut scene, _) = read.map_err(|problems| refused(py, &problems))?;
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

/// The file of a scene that is given by its name: one of the package, or `scenes/NAME.toml` here.
///
/// # Errors
/// `FileNotFoundError` with the names that are most like it.
fn named(py: Python<'_>, name: &str) -> PyResult<PathBuf> {
    let all = py.import("vibrissa")?.getattr("SCENES")?;
    if let Ok(path) = all.get_item(name) {
        return path.extract();
    }
    let here = Path::new("scenes").join(format!("{name}.toml"));
    if here.is_file() {
        return Ok(here);
    }
    let mut known: Vec<String> = all
        .try_iter()?
        .map(|name| name?.extract())
        .collect::<PyResult<_>>()?;
    let beside = std::fs::read_dir("scenes").into_iter().flatten().flatten();
    let beside = beside.map(|entry| entry.path()).filter(|path| {
        path.extension()
            .is_some_and(|extension| extension == "toml")
    });
    known.extend(beside.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned())));
    known.sort();
    known.dedup();
    let matches = py.import("difflib")?.getattr("get_close_matches")?;
    let nearest: Vec<String> = matches.call1((name, &known))?.extract()?;
    let allowed = if nearest.is_empty() {
        format!("a path, or a name: {}", known.join(", "))
    } else {
        format!("a path, or a name; nearest: {}", nearest.join(", "))
    };
    let fault = format!("scene: found {name:?}, allowed: {allowed}");
    Err(PyFileNotFoundError::new_err(fault))
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
            set.push(Override::new(place, &key, &literal(&value)?));
        }
    }
    Ok(())
}

/// A value as TOML has it. NumPy's truths, numbers and arrays are taken as Python's own, and paths
/// as text.
fn literal(value: &Bound<'_, PyAny>) -> PyResult<String> {
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
        let items = value.try_iter()?.map(|item| literal(&item?));
        return Ok(format!(
            "[{}]",
            items.collect::<PyResult<Vec<_>>>()?.join(", ")
        ));
    }
    let found = value.get_type();
    Err(PyTypeError::new_err(format!(
        "found {found}, allowed: a number, text, truth or list"
    )))
}
