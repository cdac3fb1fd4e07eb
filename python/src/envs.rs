//! Many runs of a scene side by side, as an agent meets them.

use std::process;
use std::sync::Arc;

use host_sim::Error;
use host_sim::classifier::Classifier;
use host_sim::loaded::Loaded;
use host_sim::run::Run;
use host_sim::trace::WhiskerRow;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use parking_lot::Mutex;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use scene::Scene;

use crate::outside::{self, wrong};
use crate::recipe::{self, Parts};
use crate::scenes::{Given, raised};

/// What is observed of a whisker: angle, x, y, contact.
const OBSERVED: usize = 4;

/// Runs that a thread takes at once: a tick is shorter than handing it over.
const AT_ONCE: usize = 16;

/// The threads of all environments, and the process that has them: one that was forked off has no
/// threads but its own.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

fn pool() -> PyResult<Arc<ThreadPool>> {
    let mut pool = POOL.lock();
    let process = process::id();
    if let Some((of, pool)) = &*pool
        && *of == process
    {
        return Ok(Arc::clone(pool));
    }
    let new = ThreadPoolBuilder::new().build();
    let new = new.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    let new = Arc::new(new);
    let before = pool.replace((process, Arc::clone(&new)));
    // Its end would wait for threads that are not here.
    std::mem::forget(before);
    Ok(new)
}

#[derive(Clone, Copy, PartialEq)]
enum Action {
    Setpoint,
    Gain,
}

const ACTIONS: [(&str, Action); 2] = [("setpoint", Action::Setpoint), ("gain", Action::Gain)];

struct Member {
    run: Run,
    left: u64,
    whiskers: Vec<WhiskerRow>,
    seed: u64,
    /// What it did since its start: as many as fit into the scene.
    acts: Vec<f64>,
}

impl Member {
    /// Before the first tick of a scene.
    fn new(scene: &Scene, classifier: Option<Classifier>) -> Result<Self, Error> {
        let run = Run::new(scene, classifier)?;
        Ok(Self {
            left: run.ticks(),
            run,
            whiskers: Vec::new(),
            seed: scene.seed,
            acts: Vec::new(),
        })
    }

    fn reset(&mut self, seed: u64) -> Result<(), Error> {
        self.run.reset(seed)?;
        self.left = self.run.ticks();
        self.seed = seed;
        self.acts.clear();
        Ok(())
    }

    /// Acts for so many ticks.
    fn step(&mut self, action: Action, values: &[f64], ticks: u64) -> Result<(), Error> {
        for (n, value) in values.iter().enumerate() {
            match action {
                Action::Setpoint => self.run.set_setpoint_deg(n, Some(*value))?,
                Action::Gain => self.run.set_gain(n, *value)?,
            }
        }
        if self.left > 0 {
            self.acts.extend_from_slice(values);
        }
        let ticks = ticks.min(self.left);
        // No row of the trace: what is observed of a whisker does without it.
        for _ in 0..ticks {
            self.run.pass();
        }
        self.left -= ticks;
        Ok(())
    }

    fn observe(&mut self, seen: &mut [f32]) {
        self.run.look_at_whiskers(&mut self.whiskers);
        for (seen, w) in seen.chunks_exact_mut(OBSERVED).zip(&self.whiskers) {
            let [x, y] = w.codes;
            seen.copy_from_slice(&[w.angle_deg, x, y, w.contact].map(|value| value as f32));
        }
    }
}

/// `count` runs of a scene side by side, stepped on all cores; an action is a setpoint in degrees
/// or a gain for each whisker, held for `ticks` ticks.
#[pyclass(frozen, module = "vibrissa._core")]
pub(crate) struct Envs {
    members: Mutex<Vec<Member>>,
    action: Action,
    ticks: u64,
    given: Given,
    loaded: Loaded,
    count: usize,
    limits: [f64; 2],
}

/// What makes a copy: the function and its arguments, the last being the seed of each environment
/// and what it did since its start.
type Reduced<'py> = (Bound<'py, PyAny>, (Parts<'py>, String, u64, Vec<Did>));

/// A seed, and actions one after the other.
type Did = (u64, Vec<f64>);

/// Environments as others were that were made from `parts`.
#[pyfunction]
pub(crate) fn restored_envs(
    py: Python<'_>,
    parts: Parts<'_>,
    action: &str,
    ticks: u64,
    did: Vec<Did>,
) -> PyResult<Envs> {
    let recipe = recipe::loaded(py, parts)?;
    let envs = Envs::of(py, recipe, did.len(), action, ticks)?;
    let pool = pool()?;
    let replayed = py.detach(|| {
        let mut members = envs.members.lock();
        let members = members.par_iter_mut().zip(&did);
        pool.install(|| {
            members.try_for_each(|(member, (seed, acts))| {
                member.reset(*seed)?;
                let mut acts = acts.chunks_exact(envs.whiskers().max(1));
                acts.try_for_each(|values| member.step(envs.action, values, ticks))
            })
        })
    });
    replayed.map_err(|error: Error| wrong(error))?;
    Ok(envs)
}

type Stepped<'py> = (Bound<'py, PyArray2<f32>>, Bound<'py, PyArray1<bool>>);

impl Envs {
    /// So many of a scene, before their first tick.
    fn of(
        py: Python<'_>,
        (given, loaded): (Given, Loaded),
        count: usize,
        action: &str,
        ticks: u64,
    ) -> PyResult<Self> {
        let action = outside::one_of("action", action, &ACTIONS)?;
        for (name, number) in [("count", count as u64), ("ticks", ticks)] {
            if number == 0 {
                return Err(wrong(format!("{name}: found 0, allowed: above 0")));
            }
        }
        let raise = |error| raised(py, error);
        let classifier = loaded.classifier().map_err(raise)?;
        let Scene { motor, .. } = &loaded.scene;
        let limits = match (action, motor) {
            (_, Some(motor)) if !motor.arms_at_start() => {
                return Err(wrong(
                    "scene: its motors are armed by a command, which no action is; allowed: \
                     motor.arm = \"at-start\"",
                ));
            }
            (Action::Gain, Some(_)) => [0.0, 2.0],
            (Action::Setpoint, Some(motor)) => [motor.min_deg, motor.max_deg],
            (_, None) => {
                return Err(wrong(
                    "scene: its whiskers are passive; an action needs [whisking]",
                ));
            }
        };
        let member = |_| Member::new(&loaded.scene, classifier.clone());
        let members = py.detach(|| (0..count).map(member).collect::<Result<_, Error>>());
        Ok(Self {
            members: Mutex::new(members.map_err(raise)?),
            action,
            ticks,
            given,
            loaded,
            count,
            limits,
        })
    }
}

#[pymethods]
impl Envs {
    #[new]
    #[pyo3(signature = (scene, count, *, action="setpoint", ticks=1, model=None, set=None))]
    fn new(
        py: Python<'_>,
        scene: &Bound<'_, PyAny>,
        count: i64,
        action: &str,
        ticks: i64,
        model: Option<&Bound<'_, PyAny>>,
        set: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let given = Given::new(scene, set)?;
        let loaded = given.loaded(py, None, model)?;
        let (count, ticks) = (
            outside::whole("count", count)?,
            outside::whole("ticks", ticks)?,
        );
        Self::of(py, (given, loaded), count, action, ticks)
    }

    /// For other processes, and for copies, which go on apart: the scene, and of each environment
    /// its seed and what it did since its start.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let did = py.detach(|| {
            let members = self.members.lock();
            let did = members.iter().map(|one| (one.seed, one.acts.clone()));
            did.collect::<Vec<Did>>()
        });
        let make = py.import("vibrissa._core")?.getattr("restored_envs")?;
        let (action, _) = ACTIONS[usize::from(self.action == Action::Gain)];
        let parts = recipe::parts(py, &self.given, &self.loaded);
        Ok((make, (parts, action.to_owned(), self.ticks, did)))
    }

    /// Restarts those that `begin` names, with their `seeds`; the others act, `actions` having
    /// the shape (envs, whiskers), or stay as they are where there are none. Returns what each
    /// whisker then feels, of shape (envs, 4 × whiskers), and whether the scene has ended.
    fn step<'py>(
        &self,
        py: Python<'py>,
        actions: Option<PyReadonlyArray2<'py, f64>>,
        begin: PyReadonlyArray1<'py, bool>,
        seeds: PyReadonlyArray1<'py, u64>,
    ) -> PyResult<Stepped<'py>> {
        let actions = actions
            .as_ref()
            .map(PyReadonlyArray2::as_slice)
            .transpose()?;
        let (begin, seeds, each) = (begin.as_slice()?, seeds.as_slice()?, self.whiskers());
        let width = OBSERVED * each;
        let fits = actions.is_none_or(|actions| actions.len() == self.count * each);
        if !fits || [begin.len(), seeds.len()] != [self.count; 2] {
            let fault = format!("actions: allowed: the shape ({}, {each})", self.count);
            return Err(wrong(fault));
        }
        let mut seen = vec![0.0; self.count * width];
        let mut ended = vec![false; self.count];
        let acts: Vec<Option<&[f64]>> = match actions {
            Some(actions) => actions.chunks_exact(each).map(Some).collect(),
            None => vec![None; self.count],
        };
        for (values, begin) in acts.iter().zip(begin) {
            let mut values = values.iter().copied().flatten().filter(|_| !begin);
            if let Some(value) = values.find(|value| !value.is_finite()) {
                let fault = format!("actions: found {value}, allowed: finite numbers");
                return Err(wrong(fault));
            }
        }
        let pool = pool()?;
        py.detach(|| {
            let mut members = self.members.lock();
            let given = acts.into_par_iter().zip(begin).zip(seeds);
            let shown = seen.par_chunks_exact_mut(width).zip(&mut ended);
            let all = members
                .par_iter_mut()
                .zip(given)
                .zip(shown)
                .with_min_len(AT_ONCE);
            pool.install(|| {
                all.try_for_each(|((member, ((values, begin), seed)), (seen, ended))| {
                    if *begin {
                        member.reset(*seed)?;
                    } else if let Some(values) = values {
                        member.step(self.action, values, self.ticks)?;
                    }
                    member.observe(seen);
                    *ended = member.left == 0;
                    Ok(())
                })
            })
        })
        .map_err(|error: Error| wrong(error))?;
        let seen = seen.into_pyarray(py).reshape((self.count, width))?;
        Ok((seen, ended.into_pyarray(py)))
    }

    /// Actions a second.
    #[getter]
    fn rate_hz(&self) -> f64 {
        f64::from(self.loaded.scene.tick_hz) / self.ticks as f64
    }

    /// How many whiskers a side has.
    #[getter]
    const fn whiskers_per_side(&self) -> usize {
        self.loaded.scene.head.whiskers_per_side
    }

    /// How many whiskers each has.
    #[getter]
    fn whiskers(&self) -> usize {
        self.loaded.scene.whiskers()
    }

    /// The least and the largest action.
    #[getter]
    const fn limits(&self) -> [f64; 2] {
        self.limits
    }
}
