//! A scene by many seeds, on all cores.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, ScopedJoinHandle};
use std::time::Duration;

use host_sim::Error;
use host_sim::classifier::Classifier;
use host_sim::decisions::Decided;
use host_sim::run::Run;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::outside::{self, wrong};
use crate::scenes::{Given, raised};
use crate::table::{self, RunTables};

/// How often it is seen whether all is done, and whether an interrupt has come.
const GLANCE: Duration = Duration::from_millis(2);

/// Runs to its end, or until it `is_over`, of which every `every`th row is filled into `rows`;
/// returns its decisions.
fn fill(
    run: &mut Run,
    (tables, every): (&RunTables, u64),
    rows: &mut [u8],
    is_over: &AtomicBool,
) -> Vec<Decided> {
    let width = tables.trace.bytes();
    let (mut decided, mut whiskers) = (Vec::new(), Vec::new());
    let mut row = Vec::new();
    let mut places = rows.chunks_exact_mut(width);
    for n in 1..=run.ticks() {
        if n.is_multiple_of(outside::HEEDED) && is_over.load(Ordering::Relaxed) {
            break;
        }
        let is_kept = every > 0 && n.is_multiple_of(every);
        if is_kept {
            run.tick();
        } else {
            run.pass();
        }
        let first = decided.len();
        decided.extend(run.decisions());
        if !is_kept {
            continue;
        }
        run.look_at_whiskers(&mut whiskers);
        row.clear();
        let fell = decided.get(first..).unwrap_or_default();
        tables.row(&mut row, &run.trace_line(fell, &whiskers));
        if let Some(place) = places.next() {
            place.copy_from_slice(&row);
        }
    }
    decided
}

/// Runs a scene once for each seed, on all cores. `rows` is a structured array of shape
/// (seeds, rows) with every `every`th row of each trace (0: none); `decisions` has those of all
/// runs, with the seed before the columns of `decisions.csv`. Scene, model and set are as for
/// Sim.
#[pyfunction]
#[pyo3(signature = (scene, seeds, *, every=20, model=None, set=None))]
pub(crate) fn run_many<'py>(
    py: Python<'py>,
    scene: &Bound<'py, PyAny>,
    seeds: &Bound<'py, PyAny>,
    every: i64,
    model: Option<&Bound<'py, PyAny>>,
    set: Option<&Bound<'py, PyDict>>,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
    let seeds: Vec<u64> = seeds
        .try_iter()?
        .map(|seed| outside::seed("seeds", &seed?))
        .collect::<PyResult<_>>()?;
    let every = outside::whole("every", every)?;
    let loaded = Given::new(scene, set)?.loaded(py, None, model)?;
    let raise = |error| raised(py, error);
    let classifier = loaded.classifier().map_err(raise)?;
    let classes = classifier.as_ref().map(Classifier::classes);
    let tables = RunTables::of(&loaded.scene, classes.unwrap_or_default());
    let count = loaded.scene.ticks().checked_div(every).unwrap_or(0) as usize;
    let each = count * tables.trace.bytes();
    let Some(size) = each.checked_mul(seeds.len()) else {
        return Err(wrong("seeds: more rows than there is memory"));
    };
    let mut rows = outside::zeros(size)?;
    // No rows: still a place for each run.
    let places: Vec<&mut [u8]> = match each {
        0 => seeds.iter().map(|_| Default::default()).collect(),
        each => rows.chunks_exact_mut(each).collect(),
    };
    let mut decided: Vec<Vec<Decided>> = Vec::new();
    decided.resize_with(seeds.len(), Vec::new);
    let jobs = Mutex::new(seeds.iter().zip(places).zip(&mut decided));
    let is_over = AtomicBool::new(false);
    // A worker takes one run after the other, in its own module; an interrupt ends all.
    let work = || {
        let mut run: Option<Run> = None;
        loop {
            let job = jobs.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some(((seed, place), decided)) = job else {
                return Ok(());
            };
            let run = if let Some(run) = &mut run {
                run.reset(*seed)?;
                run
            } else {
                let mut scene = loaded.scene.clone();
                scene.seed = *seed;
                run.insert(Run::new(&scene, classifier.clone())?)
            };
            *decided = fill(run, (&tables, every), place, &is_over);
        }
    };
    let give_up = || {
        is_over.store(true, Ordering::Relaxed);
        let mut jobs = jobs.lock().unwrap_or_else(PoisonError::into_inner);
        while jobs.next().is_some() {}
    };
    thread::scope(|scope| {
        let count = rayon::current_num_threads().min(seeds.len());
        let workers: Vec<_> = (0..count).map(|_| scope.spawn(work)).collect();
        while !workers.iter().all(ScopedJoinHandle::is_finished) {
            py.detach(|| thread::sleep(GLANCE));
            py.check_signals().inspect_err(|_| give_up())?;
        }
        let ended = workers.into_iter().map(|worker| {
            let panicked = |_| Err(Error::Work("a run panicked".to_owned()));
            worker.join().unwrap_or_else(panicked).map_err(raise)
        });
        ended.collect::<PyResult<()>>()
    })?;
    let rows = tables.trace.array(py, rows)?;
    let rows = rows.call_method1("reshape", (seeds.len(), count))?;
    let runs = seeds.iter().zip(&decided);
    let runs: Vec<_> = runs
        .map(|(seed, decided)| (Some(*seed), decided.as_slice()))
        .collect();
    Ok((rows, table::decisions(py, &runs, tables.decisions)?))
}
