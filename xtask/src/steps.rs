//! Steps that are run one after the other, and the time each took.

use std::time::{Duration, Instant};

use crate::run::Fault;

/// Steps run so far.
#[derive(Default)]
pub(crate) struct Steps {
    done: Vec<(&'static str, Duration)>,
    faults: Vec<String>,
}

impl Steps {
    /// Runs a step and notes its time.
    ///
    /// # Errors
    /// The step's, after the table of times.
    pub(crate) fn run(
        &mut self,
        name: &'static str,
        step: impl FnOnce() -> Result<(), Fault>,
    ) -> Result<(), Fault> {
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
    ///
    /// # Errors
    /// All failures that [`Steps::try_run`] went over.
    pub(crate) fn end(self) -> Result<(), Fault> {
        self.print();
        if self.faults.is_empty() {
            Ok(())
        } else {
            Err(self.faults.join("\n"))
        }
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
