//! Steps that are run one after the other, the time each took, and how busy it kept the processors.

use std::num::NonZero;
use std::time::{Duration, Instant};
use std::{fs, thread};

use crate::run::{Fault, no_faults};

/// What a step took.
#[derive(Clone, Copy, Default)]
struct Took {
    time: Duration,
    /// Of all processors, for all programs that the step started and waited for.
    processors: Duration,
}

impl Took {
    /// By how much of the time that all processors have they were busy, percent.
    fn busy(self) -> f64 {
        let all = thread::available_parallelism().map_or(1, NonZero::get) as f64;
        100.0 * self.processors.as_secs_f64() / (all * self.time.as_secs_f64()).max(1e-9)
    }
}

/// Steps run so far.
#[derive(Default)]
pub(crate) struct Steps {
    /// Parts of the names of the steps that are wanted; none: all are.
    wanted: Vec<String>,
    done: Vec<(&'static str, Took)>,
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
        let (begun, before) = (Instant::now(), processors());
        let result = step();
        let took = Took {
            time: begun.elapsed(),
            processors: processors().saturating_sub(before),
        };
        self.done.push((name, took));
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
        let mut all = Took::default();
        for (name, took) in &self.done {
            print(name, *took);
            all.time += took.time;
            all.processors += took.processors;
        }
        print("in all", all);
    }
}

fn print(name: &str, took: Took) {
    let seconds = took.time.as_secs_f64();
    println!("{seconds:>7.1} s {:>4.0} %  {name}", took.busy());
}

/// The processors' time of all programs that have ended so far; zero where no system says it.
fn processors() -> Duration {
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // Fields 16 and 17, of which the second, in brackets, may hold spaces.
    let (_, fields) = stat.rsplit_once(')').unwrap_or_default();
    let hundredths = fields.split_whitespace().skip(13).take(2);
    Duration::from_millis(
        10 * hundredths
            .filter_map(|n| n.parse::<u64>().ok())
            .sum::<u64>(),
    )
}
