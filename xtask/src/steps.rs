//! Steps that are run one after the other or side by side, the time each took, and how busy all
//! of them kept the processors.

use std::num::NonZero;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
use std::{fs, thread};

use crate::run::{Fault, each, no_faults};

/// A name, and what is done.
pub(crate) type Step = (&'static str, fn() -> Result<(), Fault>);

/// Steps run so far.
pub(crate) struct Steps {
    /// Parts of the names of the steps that are wanted; none: all are.
    wanted: Vec<String>,
    begun: Instant,
    done: Mutex<Vec<(&'static str, Duration)>>,
    faults: Vec<Fault>,
}

impl Steps {
    pub(crate) fn new(wanted: Vec<String>) -> Self {
        Self {
            wanted,
            begun: Instant::now(),
            done: Mutex::default(),
            faults: Vec::new(),
        }
    }

    pub(crate) fn run(
        &self,
        name: &'static str,
        step: impl FnOnce() -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        if !self.wanted.is_empty() && !self.wanted.iter().any(|part| name.contains(part)) {
            return Ok(());
        }
        println!("== {name}");
        let begun = Instant::now();
        let result = step();
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        done.push((name, begun.elapsed()));
        result.map_err(|fault| format!("{name}: {fault}"))
    }

    /// Runs lists of steps side by side: where those of one wait for a link, a browser or a clock,
    /// those of another keep the processors busy. After a failure no list begins another step.
    pub(crate) fn beside(&self, lists: &[&[Step]]) -> Result<(), Fault> {
        let failed = AtomicBool::new(false);
        each(lists.to_vec(), lists.len(), |steps: &[Step]| {
            for &(name, step) in steps {
                if failed.load(Ordering::Relaxed) {
                    break;
                }
                self.run(name, step)
                    .inspect_err(|_| failed.store(true, Ordering::Relaxed))?;
            }
            Ok(())
        })
    }

    /// Runs a step, and goes on after a failure, which [`Steps::end`] reports.
    pub(crate) fn try_run(&mut self, name: &'static str, step: impl FnOnce() -> Result<(), Fault>) {
        if let Err(fault) = self.run(name, step) {
            println!("{fault}");
            self.faults.push(fault);
        }
    }

    pub(crate) fn end(self) -> Result<(), Fault> {
        let done = self.done.into_inner().unwrap_or_default();
        let has_run = |part: &String| done.iter().any(|(name, _)| name.contains(part));
        if let Some(part) = self.wanted.iter().find(|part| !has_run(part)) {
            return Err(format!("no step has {part:?} in its name"));
        }
        println!();
        for (name, took) in done {
            println!("{:>7.1} s  {name}", took.as_secs_f64());
        }
        let took = self.begun.elapsed().as_secs_f64();
        let all = thread::available_parallelism().map_or(1, NonZero::get) as f64;
        let busy = 100.0 * processors().as_secs_f64() / (all * took).max(1e-9);
        println!("{took:>7.1} s  in all, processors {busy:.0} % busy");
        no_faults(&self.faults)
    }
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

#[cfg(test)]
mod tests {
    use super::Steps;

    #[test]
    fn a_name_that_no_step_has_is_refused() {
        for (wanted, is_known) in [("", true), ("int", true), ("lint", true), ("lists", false)] {
            let steps = Steps::new(vec!["lints".to_owned(), wanted.to_owned()]);
            steps.run("lints", || Ok(())).unwrap();
            assert_eq!(steps.end().is_ok(), is_known, "{wanted}");
        }
    }
}
