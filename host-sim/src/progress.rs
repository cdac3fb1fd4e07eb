//! Progress on standard error, for work that takes more than a second.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Whether to show progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verbosity {
    /// A bar on a terminal, nothing elsewhere.
    Normal,
    /// Nothing.
    Quiet,
}

impl Verbosity {
    /// What the option `--quiet` asks for.
    pub const fn of(quiet: bool) -> Self {
        if quiet { Self::Quiet } else { Self::Normal }
    }
}

/// A bar that appears once the work has taken a second.
#[derive(Debug)]
pub struct Progress {
    bar: Option<ProgressBar>,
    verbosity: Verbosity,
    message: &'static str,
    total: u64,
    since: Instant,
}

impl Progress {
    /// Work that takes no longer than this shows no bar.
    const SILENT: Duration = Duration::from_secs(1);

    /// Work of `total` steps.
    pub fn new(verbosity: Verbosity, message: &'static str, total: u64) -> Self {
        Self {
            bar: None,
            verbosity,
            message,
            total,
            since: Instant::now(),
        }
    }

    /// `done` steps are done. Call it a few hundred times in all, not every step.
    pub fn set(&mut self, done: u64) {
        if self.verbosity == Verbosity::Quiet {
            return;
        }
        if self.bar.is_none() && self.since.elapsed() >= Self::SILENT {
            let bar = ProgressBar::new(self.total).with_message(self.message);
            if let Ok(style) =
                ProgressStyle::with_template("{msg} [{bar:40}] {percent}% {eta} left")
            {
                bar.set_style(style.progress_chars("=> "));
            }
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            bar.set_position(done);
        }
    }

    /// Tick `done` of a run is done: to be called at every one.
    pub fn tick(&mut self, done: u64) {
        if done.is_multiple_of(1024) {
            self.set(done);
        }
    }

    /// Runs `print` with the bar hidden.
    pub fn pause(&self, print: impl FnOnce()) {
        match &self.bar {
            Some(bar) => bar.suspend(print),
            None => print(),
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

#[derive(Debug)]
pub(crate) struct SharedProgress {
    bar: Mutex<Progress>,
    done: AtomicU64,
}

impl SharedProgress {
    /// Steps that a run counts before it reports them.
    const REPORTED: u64 = 1024;

    pub(crate) fn new(verbosity: Verbosity, message: &'static str, total: u64) -> Self {
        let bar = Mutex::new(Progress::new(verbosity, message, total));
        let done = AtomicU64::new(0);
        Self { bar, done }
    }

    /// Of one run what is to be called after each step.
    pub(crate) fn counter(&self) -> impl FnMut() + '_ {
        let mut steps = 0;
        move || {
            steps += 1;
            if steps % Self::REPORTED == 0 {
                let done = self.done.fetch_add(Self::REPORTED, Ordering::Relaxed) + Self::REPORTED;
                if let Ok(mut bar) = self.bar.lock() {
                    bar.set(done);
                }
            }
        }
    }
}
