//! One run of a scene, tick by tick.

use std::iter;

use host_sim::Error;
use host_sim::columns::Column;
use host_sim::decisions::Decided;
use host_sim::loaded::Loaded;
use host_sim::run::Run;
use host_sim::trace::{self, TraceLine, TraceWriter, WhiskerRow};
use host_sim::{decisions, pressing, recording};
use numpy::PyArray2;
use parking_lot::{Mutex, MutexGuard};
use physics::Bent;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use scene::{Scene, Texture};
use tactile::Posteriors;

use crate::outside::{self, wrong};
use crate::recipe::{self, Call, GAIN, LAY, Parts, SETPOINT, Script};
use crate::scenes::{Given, raised};
use crate::table::{self, Kind, Layout, RunTables};

/// A run, and what it has decided so far.
struct State {
    run: Run,
    done: u64,
    seed: u64,
    whiskers: Vec<WhiskerRow>,
    decided: Vec<Decided>,
    last: Option<Posteriors>,
    /// The rows of their table.
    posteriors: Vec<u8>,
    /// What was done to it since its start.
    script: Script,
}

impl State {
    /// Does again what was done.
    fn repeat(&mut self, (_, kind, whisker, value): Call) -> Result<(), Error> {
        match kind {
            SETPOINT => {
                let degrees = (!value.is_nan()).then_some(value);
                self.run.set_setpoint_deg(whisker, degrees)
            }
            GAIN => self.run.set_gain(whisker, value),
            _ => {
                let name = Texture::NAMES.get(whisker);
                if let Some(texture) = name.and_then(|name| Texture::named(name)) {
                    self.run.lay(texture);
                }
                Ok(())
            }
        }
    }

    /// The same for the first time: it is kept.
    fn call(&mut self, kind: u8, whisker: usize, value: f64) -> Result<(), Error> {
        let call = (self.done, kind, whisker, value);
        self.repeat(call)?;
        self.script.add(call);
        Ok(())
    }

    /// One tick, with a row or without; its decisions begin at the index that is returned.
    fn tick(&mut self, has_row: bool) -> usize {
        if has_row {
            self.run.tick();
        } else {
            self.run.pass();
        }
        self.done += 1;
        let first = self.decided.len();
        self.decided.extend(self.run.decisions());
        if self.run.samples().iter().any(Option::is_some) {
            let now = self.run.posteriors();
            if let Some(posteriors) = now.filter(|_| now != self.last) {
                let cells = iter::once(self.run.t_s()).chain(posteriors.to_f64());
                self.posteriors.extend(cells.flat_map(f64::to_ne_bytes));
            }
            self.last = now;
        }
        first
    }

    /// The row of the last tick, whose decisions begin at the index.
    fn line(&mut self, first: usize) -> TraceLine<'_> {
        self.run.look_at_whiskers(&mut self.whiskers);
        let fell = self.decided.get(first..).unwrap_or_default();
        self.run.trace_line(fell, &self.whiskers)
    }

    fn left(&self) -> u64 {
        self.run.ticks().saturating_sub(self.done)
    }
}

/// A scene in motion: the firmware's module on simulated sensors, motors and surfaces.
///
/// `scene` is a name of SCENES or of `scenes/NAME.toml` here, a path, TOML text or a dictionary of
/// the same keys; `seed` and the keys of `set` (such as {"plant.stiffness": 0.2}) take the place
/// of the scene's own. `model` is a Model, its bytes or a path, in place of the one that the scene
/// names.
///
/// Raises SceneError for a scene that is wrong.
#[pyclass(frozen, module = "vibrissa")]
pub(crate) struct Sim {
    state: Mutex<State>,
    tables: RunTables,
    classes: Vec<String>,
    given: Given,
    loaded: Loaded,
    posteriors: Layout,
}

impl Sim {
    /// Before its first tick.
    fn of(py: Python<'_>, given: Given, loaded: Loaded) -> PyResult<Self> {
        let raised = |error| raised(py, error);
        let scene = &loaded.scene;
        let run = Run::new(scene, loaded.classifier().map_err(raised)?);
        let mut run = run.map_err(raised)?;
        let last = run.posteriors();
        let classes = run.classes().to_vec();
        let name = |class| if class == "t_s" { "t_s_" } else { class };
        let of_class = classes.iter().map(|class| name(class.as_str()));
        let columns = iter::once("t_s").chain(of_class);
        Ok(Self {
            tables: RunTables::of(scene, &classes),
            posteriors: Layout::new(columns.map(|name| (name, Kind::Number))),
            classes,
            state: Mutex::new(State {
                run,
                done: 0,
                seed: scene.seed,
                whiskers: Vec::new(),
                decided: Vec::new(),
                last,
                posteriors: Vec::new(),
                script: Script::default(),
            }),
            given,
            loaded,
        })
    }

    /// Does again what was done to another, up to the same tick.
    fn replay(&self, calls: &[Call], done: u64) -> PyResult<()> {
        let mut from = 0;
        for call in calls {
            let until = call.0.min(done);
            self.pass(until - from)?;
            from = until;
            let mut state = self.state();
            let repeated = state.call(call.1, call.2, call.3);
            repeated.map_err(wrong)?;
        }
        self.pass(done - from)
    }

    fn pass(&self, ticks: u64) -> PyResult<()> {
        self.each_tick(ticks, |state, _| {
            state.tick(false);
            Ok(())
        })
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock()
    }

    const fn scene(&self) -> &Scene {
        &self.loaded.scene
    }

    /// Makes so many ticks, in parts: between two of them handlers of signals run, and whoever
    /// asks for the state gets it.
    fn each_tick(
        &self,
        ticks: u64,
        mut tick: impl FnMut(&mut State, u64) -> PyResult<()>,
    ) -> PyResult<()> {
        let mut done = 0;
        while done < ticks {
            let part = (ticks - done).min(outside::HEEDED);
            let mut state = self.state();
            for n in done + 1..=done + part {
                tick(&mut state, n)?;
            }
            MutexGuard::unlock_fair(state);
            done += part;
            outside::heed()?;
        }
        Ok(())
    }

    /// Makes ticks, of which every `every`th has a row.
    fn rows(&self, ticks: u64, every: u64) -> PyResult<Vec<u8>> {
        let tables = &self.tables;
        let count = usize::try_from(ticks / every).unwrap_or(usize::MAX);
        let mut rows = outside::room(count.saturating_mul(tables.trace.bytes()))?;
        self.each_tick(ticks, |state, n| {
            let has_row = n.is_multiple_of(every);
            let first = state.tick(has_row);
            if has_row {
                tables.row(&mut rows, &state.line(first));
            }
            Ok(())
        })?;
        Ok(rows)
    }

    fn bent(&self, py: Python<'_>, whisker: i64) -> PyResult<Bent> {
        let whisker = outside::whole("whisker", whisker)?;
        let bent = py.detach(|| self.state().run.bent(whisker));
        bent.ok_or_else(|| {
            let fault = format!(
                "whisker {whisker}, counted from 0, left side first: scene {:?} has none that bends",
                self.scene().name
            );
            wrong(fault)
        })
    }
}

#[pymethods]
impl Sim {
    #[new]
    #[pyo3(signature = (scene, *, seed=None, model=None, set=None))]
    fn new(
        py: Python<'_>,
        scene: &Bound<'_, PyAny>,
        seed: Option<&Bound<'_, PyAny>>,
        model: Option<&Bound<'_, PyAny>>,
        set: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let given = Given::new(scene, set)?;
        let seed = seed.map(|n| outside::seed("seed", n)).transpose()?;
        let loaded = given.loaded(py, seed, model)?;
        Self::of(py, given, loaded)
    }

    /// For other processes, and for copies, which go on apart: the scene, the seed and what was
    /// done since the start, from which all ticks are made again.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let (seed, done, script) = py.detach(|| {
            let state = self.state();
            (state.seed, state.done, state.script.clone())
        });
        let Some(calls) = script.whole() else {
            let fault = "it got more than a million setpoints, gains and textures since its start, \
                         which are not all kept: reset it before it is copied";
            return Err(PyRuntimeError::new_err(fault));
        };
        let make = py.import("vibrissa._core")?.getattr("restored_sim")?;
        let parts = recipe::parts(py, &self.given, &self.loaded);
        Ok((make, (parts, seed, calls.to_vec(), done)))
    }

    /// Advances by `n` ticks, beyond the scene's end too, and returns every `every`th row of
    /// the trace as a structured array.
    #[pyo3(signature = (n=1, *, every=1))]
    fn step<'py>(&self, py: Python<'py>, n: i64, every: i64) -> PyResult<Bound<'py, PyAny>> {
        let (n, every) = (outside::whole("n", n)?, outside::whole("every", every)?);
        if every == 0 {
            return Err(wrong("every: found 0, allowed: above 0"));
        }
        let rows = py.detach(|| self.rows(n, every))?;
        self.tables.trace.array(py, rows)
    }

    /// Advances to the scene's end and returns every `every`th row of the trace.
    #[pyo3(signature = (*, every=1))]
    fn run<'py>(&self, py: Python<'py>, every: i64) -> PyResult<Bound<'py, PyAny>> {
        let left = py.detach(|| self.state().left());
        self.step(py, left.cast_signed(), every)
    }

    /// Starts again, with another seed if one is given: from here on all is as of a new Sim.
    /// Setpoints and gains that were set are undone.
    #[pyo3(signature = (seed=None))]
    fn reset(&self, py: Python<'_>, seed: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let seed = seed.map(|n| outside::seed("seed", n)).transpose()?;
        py.detach(|| {
            let state = &mut *self.state();
            state.seed = seed.unwrap_or(state.seed);
            state.run.reset(state.seed)?;
            state.done = 0;
            state.script.clear();
            state.decided.clear();
            state.last = state.run.posteriors();
            state.posteriors.clear();
            Ok(())
        })
        .map_err(|error| raised(py, error))
    }

    /// Sets θ′ of a whisker, degrees, from the next tick on, within the scene's
    /// `motor.min_deg` and `motor.max_deg`; None: the pattern generator's again. Whiskers are
    /// counted from 0, left side first.
    #[pyo3(signature = (degrees, whisker=0))]
    fn setpoint(&self, py: Python<'_>, degrees: Option<f64>, whisker: i64) -> PyResult<()> {
        let whisker = outside::whole("whisker", whisker)?;
        if let (Some(degrees), Some(motor)) = (degrees, &self.scene().motor) {
            outside::within("setpoint", degrees, motor.min_deg, motor.max_deg)?;
        }
        let value = degrees.unwrap_or(f64::NAN);
        let set = py.detach(|| self.state().call(SETPOINT, whisker, value));
        set.map_err(wrong)
    }

    /// Sets the nominal gain g of a whisker from the next tick on, 0 to 2.
    #[pyo3(signature = (gain, whisker=0))]
    fn gain(&self, py: Python<'_>, gain: f64, whisker: i64) -> PyResult<()> {
        let whisker = outside::whole("whisker", whisker)?;
        outside::within("gain", gain, 0.0, 2.0)?;
        let set = py.detach(|| self.state().call(GAIN, whisker, gain));
        set.map_err(wrong)
    }

    /// Has a texture laid in place of the present one, once that is not touched, and left there.
    fn lay(&self, py: Python<'_>, texture: &str) -> PyResult<()> {
        let textures = self.scene().plant.textures_to_lay();
        if textures.is_empty() {
            let fault = format!(
                "texture: scene {:?} has none to exchange",
                self.scene().name
            );
            return Err(wrong(fault));
        }
        let place = Texture::NAMES.iter().position(|name| *name == texture);
        let Some(place) = place.filter(|_| textures.contains(&texture)) else {
            let allowed = textures.join(", ");
            let fault = format!("texture: found {texture:?}, allowed: {allowed}");
            return Err(wrong(fault));
        };
        let laid = py.detach(|| self.state().call(LAY, place, 0.0));
        laid.map_err(wrong)
    }

    /// Points of a whisker's shaft as it is bent now, from base to tip, m: an array of shape
    /// (13, 3) with the columns x (against protraction), y (across it) and z (along the shaft as
    /// it is without a bend). Only with `plant.kind = "whisker"`.
    #[pyo3(signature = (whisker=0))]
    fn shaft<'py>(&self, py: Python<'py>, whisker: i64) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let points = self.bent(py, whisker)?.points_m.map(Vec::from);
        Ok(PyArray2::from_vec2(py, &points)?)
    }

    /// Where a whisker touches now: arc length from the base and place on the surface, m, as the
    /// trace has them of the first whiskers; None in the air.
    #[pyo3(signature = (whisker=0))]
    fn touch_at(&self, py: Python<'_>, whisker: i64) -> PyResult<Option<(f64, f64)>> {
        Ok(self.touches_at(py, whisker)?.first().copied())
    }

    /// All places in which a whisker touches now, as `touch_at` has them: none, one or two. The
    /// second is where the rest of the shaft whips onto a plate that lies nearly along it.
    #[pyo3(signature = (whisker=0))]
    fn touches_at(&self, py: Python<'_>, whisker: i64) -> PyResult<Vec<(f64, f64)>> {
        let contacts = self.bent(py, whisker)?.contacts;
        let places = contacts.iter().flatten();
        Ok(places.map(|at| (at.arc_m, at.plate_m[0])).collect())
    }

    /// `trace.csv` from here to the scene's end, byte for byte as host-sim writes it.
    fn trace_csv<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let written = py.detach(|| {
            let mut table = TraceWriter::new(Vec::new(), self.tables.shape)?;
            let left = self.state().left();
            self.each_tick(left, |state, _| {
                let first = state.tick(true);
                Ok(table.line(&state.line(first))?)
            })?;
            PyResult::Ok(table.into_inner())
        });
        Ok(PyBytes::new(py, &written?))
    }

    /// The decisions since the start, with the columns of `decisions.csv`.
    #[getter]
    fn decisions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let decided = py.detach(|| self.state().decided.clone());
        table::decisions(py, &[(None, &decided)], self.tables.decisions)
    }

    /// `t_s` and, under the name of each of `classes` (of one called t_s: `t_s_`), its posterior: a
    /// row whenever a block has changed them, of the first whisker or of all together.
    #[getter]
    fn posteriors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let bytes = py.detach(|| self.state().posteriors.clone());
        self.posteriors.array(py, bytes)
    }

    /// The names of the classes that are decided among.
    #[getter]
    fn classes(&self) -> Vec<String> {
        self.classes.clone()
    }

    /// The scene's name.
    #[getter]
    fn name(&self) -> &str {
        &self.scene().name
    }

    /// Ticks a second.
    #[getter]
    const fn tick_hz(&self) -> u32 {
        self.scene().tick_hz
    }

    /// The seed of this run.
    #[getter]
    fn seed(&self, py: Python<'_>) -> u64 {
        py.detach(|| self.state().seed)
    }

    /// How many ticks the scene lasts.
    #[getter]
    fn ticks(&self) -> u64 {
        self.scene().ticks()
    }

    /// How many ticks have passed.
    #[getter]
    fn ticks_done(&self, py: Python<'_>) -> u64 {
        py.detach(|| self.state().done)
    }

    /// Whether the scene has ended: `while not sim.done: sim.step(100)`. It can still be stepped.
    #[getter]
    fn done(&self, py: Python<'_>) -> bool {
        py.detach(|| self.state().left()) == 0
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let done = py.detach(|| self.state().done);
        let (name, ticks) = (&self.scene().name, self.scene().ticks());
        format!("<vibrissa.Sim {name:?}: tick {done} of {ticks}>")
    }
}

/// What makes a copy: the function, and its arguments.
type Reduced<'py> = (Bound<'py, PyAny>, (Parts<'py>, u64, Vec<Call>, u64));

/// A simulation as another one was that was made from `parts` with `seed`, `calls` being what was
/// done to it in `done` ticks.
#[pyfunction]
pub(crate) fn restored_sim(
    py: Python<'_>,
    parts: Parts<'_>,
    seed: u64,
    calls: Vec<Call>,
    done: u64,
) -> PyResult<Sim> {
    let (given, mut loaded) = recipe::loaded(py, parts)?;
    loaded.scene.seed = seed;
    let sim = Sim::of(py, given, loaded)?;
    py.detach(|| sim.replay(&calls, done))?;
    Ok(sim)
}

/// Name to (unit, meaning) of every column: of "trace", "decisions", "recording" or "press". Those of
/// further whiskers of a side have their place for the `*`.
#[pyfunction]
pub(crate) fn columns<'py>(py: Python<'py>, table: &str) -> PyResult<Bound<'py, PyDict>> {
    let all: Vec<Column> = match table {
        "trace" => [
            &trace::FIRST[..],
            &trace::OF_RIGHT,
            &trace::SECOND,
            &trace::OF_WHISKER,
            &trace::OF_ELASTIC,
        ]
        .concat(),
        "decisions" => decisions::COLUMNS.to_vec(),
        "recording" => recording::COLUMNS.to_vec(),
        "press" => pressing::COLUMNS.to_vec(),
        _ => {
            let fault =
                format!("table: found {table:?}, allowed: trace, decisions, recording, press");
            return Err(wrong(fault));
        }
    };
    let dict = PyDict::new(py);
    for column in all {
        dict.set_item(column.name, (column.unit, column.meaning))?;
    }
    Ok(dict)
}
