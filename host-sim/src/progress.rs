//! Progress on standard error, for work that takes more than a second.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

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
    bar: ProgressBar,
    verbosity: Verbosity,
}

impl Progress {
    /// Work that takes no longer than this shows no bar.
    const SILENT: Duration = Duration::from_secs(1);
    /// Steps that a run counts before it reports them.
    const REPORTED: u64 = 1024;

    /// Work of `total` steps.
    pub fn new(verbosity: Verbosity, message: &'static str, total: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
        let mut bar = bar.with_message(message);
        if let Ok(style) = ProgressStyle::with_template("{msg} [{bar:40}] {percent}% {eta} left") {
            bar = bar.with_style(style.progress_chars("=> "));
        }
        Self { bar, verbosity }
    }

    /// `done` steps are done. Call it a few hundred times in all, not every step.
    pub fn set(&mut self, done: u64) {
        self.appear();
        self.bar.set_position(done);
    }

    /// Tick `done` of a run is done: to be called at every one.
    pub fn tick(&mut self, done: u64) {
        if done.is_multiple_of(Self::REPORTED) {
            self.set(done);
        }
    }

    /// Of one of several runs, on any thread, what is to be called after each step.
    pub(crate) fn counter(&self) -> impl FnMut() + '_ {
        let mut steps = 0;
        move || {
            steps += 1;
            if steps % Self::REPORTED == 0 {
                self.appear();
                self.bar.inc(Self::REPORTED);
            }
        }
    }

    fn appear(&self) {
        let is_long = self.bar.elapsed() >= Self::SILENT;
        if is_long && self.verbosity == Verbosity::Normal && self.bar.is_hidden() {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }

    /// Runs `print` with the bar hidden.
    pub fn pause(&self, print: impl FnOnce()) {
        self.bar.suspend(print);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
