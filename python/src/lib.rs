//! `vibrissa._core`: the simulator, the trainer and the classifier for Python.
//!
//! What a scene, a column or a setting is called, its unit and its range are those of
//! host-sim; here is only what turns Python's values into them and rows into arrays.
//! Whatever takes longer than a moment runs without the interpreter's lock.

#![allow(clippy::needless_pass_by_value, reason = "Python's arguments come so")]

mod envs;
mod learning;
mod many;
mod model;
mod outside;
mod press;
mod recipe;
mod recordings;
mod scenes;
mod sim;
mod table;

use pyo3::prelude::pymodule;

#[pymodule]
mod _core {
    #[pymodule_export]
    #[allow(non_upper_case_globals, reason = "Python calls it so")]
    const __version__: &str = env!("CARGO_PKG_VERSION");

    #[pymodule_export]
    use crate::envs::{Envs, restored_envs};
    #[pymodule_export]
    use crate::learning::{classify, evaluate, record, train};
    #[pymodule_export]
    use crate::many::run_many;
    #[pymodule_export]
    use crate::model::{Model, is_model};
    #[pymodule_export]
    use crate::press::press;
    #[pymodule_export]
    use crate::recordings::read;
    #[pymodule_export]
    use crate::scenes::SceneError;
    #[pymodule_export]
    use crate::sim::{Sim, columns, restored_sim};
}
