//! Steps that are run one after the other, and the time each took.

use std::time::{Duration, Instant};

use crate::run::{Fault, no_faults};

/// Steps run so far.
#[derive(Default)]
pub(crate) struct Steps {
    /// Parts of the names of the steps that are wanted; none: all are.
    wanted: Vec<String>,
    done: Vec<(&'static str, Duration)>,
    faults: Vec<String>,
}

impl Steps {
    /// Of all steps those whose name contains one of `wanted`, or all.
    pub(crate) fn new(wanted: Vec<String>) -> Self {
        Self {
            wanted,
            ..Self::default()
        }
    }

    /// Runs a step, if it is wanted, and notes its time.
    pub(crate) fn run(
        &mut self,
        name: &'static str,
        step: impl FnOnce() -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        if !self.wanted.is_empty() && !self.wanted.iter().any(|part| name.contains(part)) {
            return Ok(());
        }
        println!("== {name}");
        let begun = Instant::now();
        let result = step();
        self.done.push((name, begun.elapsed()));
        if result.is_err() {
            self.print();
        }
        result
    }

    /// Runs a step, and goes on after a failure, which [`Steps::end`] tells.
    pub(crate) fn try_run(&mut self, name: &'static str, step: impl FnOnce() -> Result<(), Fault>) {
        if let Err(fault) = self.run(name, step) {
            println!("{fault}");
            self.faults.push(format!("{name}: {fault}"));
        }
    }

    /// Prints the table of times.
    pub(crate) fn end(self) -> Result<(), Fault> {
        self.print();
        no_faults(&self.faults)
    }

    fn print(&self) {
        println!();
        for (name, time) in &self.done {
            println!("{:>7.1} s  {name}", time.as_secs_f64());
        }
        let whole: Duration = self.done.iter().map(|(_, time)| *time).sum();
        println!("{:>7.1} s  in all", whole.as_secs_f64());
    }
}
