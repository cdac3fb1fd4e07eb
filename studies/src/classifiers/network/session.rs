//! One start of training: from first weights to the best ones on the way.

use anyhow::Result;
use std::cell::RefCell;

use argmin::core::{
    CostFunction, Executor, Gradient, IterState, KV, Problem, Solver, State, TerminationReason,
    TerminationStatus,
};
use argmin::solver::linesearch::MoreThuenteLineSearch;
use argmin::solver::quasinewton::LBFGS;

use super::gradient::{Samples, cost, cost_and_gradient};
use super::{Options, Shape};

/// Differences of weights and slopes that L-BFGS remembers.
const MEMORY: usize = 10;

/// Trains from a start; none if no finite error was met.
pub(super) fn session(
    shape: Shape,
    options: &Options,
    start: Vec<f64>,
    training: &Samples,
    held_out: &Samples,
) -> Option<Vec<f64>> {
    let best = RefCell::new(Best {
        error: f64::INFINITY,
        weights: None,
        misses: 0,
    });
    let solver = Stopping {
        inner: LBFGS::new(MoreThuenteLineSearch::new(), MEMORY),
        shape,
        held_out,
        patience: options.patience,
        best: &best,
    };
    let batch = Batch {
        shape,
        samples: training,
        decay: options.decay,
        last: RefCell::new(Last::default()),
    };
    // An error is a line search that finds nothing lower any more: the best weights so far are the
    // result all the same.
    let _ = Executor::new(batch, solver)
        .configure(|state| state.param(start).max_iters(options.iterations))
        .ctrlc(false)
        .run();
    best.into_inner().weights
}

struct Batch<'s> {
    shape: Shape,
    samples: &'s Samples,
    decay: f64,
    last: RefCell<Last>,
}

/// The solver asks for cost and gradient one after the other at the same place; one pass through
/// the samples gives both.
#[derive(Default)]
struct Last {
    weights: Vec<f64>,
    cost: f64,
    gradient: Vec<f64>,
}

impl Batch<'_> {
    fn at<T>(&self, weights: &[f64], take: impl FnOnce(&Last) -> T) -> T {
        let mut last = self.last.borrow_mut();
        if last.weights != weights {
            last.weights = weights.to_vec();
            last.gradient = vec![0.0; weights.len()];
            let Self {
                shape,
                samples,
                decay,
                ..
            } = *self;
            let gradient = Some(&mut last.gradient[..]);
            last.cost = cost_and_gradient(shape, weights, samples, decay, gradient);
        }
        take(&last)
    }
}

impl CostFunction for Batch<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, weights: &Vec<f64>) -> Result<f64> {
        Ok(self.at(weights, |last| last.cost))
    }
}

impl Gradient for Batch<'_> {
    type Param = Vec<f64>;
    type Gradient = Vec<f64>;

    fn gradient(&self, weights: &Vec<f64>) -> Result<Vec<f64>> {
        Ok(self.at(weights, |last| last.gradient.clone()))
    }
}

struct Best {
    error: f64,
    weights: Option<Vec<f64>>,
    /// Iterations since.
    misses: u32,
}

type Search = MoreThuenteLineSearch<Vec<f64>, Vec<f64>, f64>;
type Inner = LBFGS<Search, Vec<f64>, Vec<f64>, f64>;
type Weights = IterState<Vec<f64>, Vec<f64>, (), (), (), f64>;
type Stepped = Result<(Weights, Option<KV>)>;

/// L-BFGS that keeps the best weights, and ends when the samples held out are named no better any
/// more.
struct Stopping<'s> {
    inner: Inner,
    shape: Shape,
    held_out: &'s Samples,
    patience: u32,
    /// Outside, as a solver that fails takes everything with it.
    best: &'s RefCell<Best>,
}

impl<'s> Solver<Batch<'s>, Weights> for Stopping<'_> {
    fn name(&self) -> &'static str {
        "L-BFGS with early stopping"
    }

    fn init(&mut self, problem: &mut Problem<Batch<'s>>, state: Weights) -> Stepped {
        self.inner.init(problem, state)
    }

    fn next_iter(&mut self, problem: &mut Problem<Batch<'s>>, state: Weights) -> Stepped {
        self.inner.next_iter(problem, state)
    }

    fn terminate(&mut self, state: &Weights) -> TerminationStatus {
        let Some(weights) = state.get_param() else {
            return TerminationStatus::NotTerminated;
        };
        let stops = !self.held_out.classes.is_empty();
        let error = if stops {
            cost(self.shape, weights, self.held_out, 0.0)
        } else {
            state.get_cost()
        };
        let mut best = self.best.borrow_mut();
        if error < best.error {
            *best = Best {
                error,
                weights: Some(weights.clone()),
                misses: 0,
            };
        } else {
            best.misses = best.misses.saturating_add(1);
        }
        if stops && best.misses >= self.patience {
            return TerminationStatus::Terminated(TerminationReason::SolverExit(
                "held-out error rises".into(),
            ));
        }
        Solver::<Batch<'s>, Weights>::terminate(&mut self.inner, state)
    }
}
