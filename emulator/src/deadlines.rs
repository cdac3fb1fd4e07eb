//! How a board keeps its time over minutes of a scene.

use std::fmt;
use std::path::Path;

use host_sim::Error;
use host_sim::progress::{Progress, Verbosity};

use crate::chip::Ps;
use crate::deployment::flashed;
use crate::emulate::start;
use crate::meter::{Figures, Tally};

/// What was measured.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Deadlines {
    /// Ticks that happened.
    ticks: u64,
    /// Ticks that did not, as the module itself counts them.
    pub missed: u32,
    /// The most bytes that the stack has held.
    stack: u32,
    /// A cycle of the core.
    cycle: Ps,
    /// The figures.
    figures: Figures,
}

/// Runs the scene in `path` on the board for `minutes` of its time, whatever its
/// own duration, and measures every tick.
///
/// # Errors
/// [`Error::Input`] for a scene that is wrong, [`Error::Work`] for what the
/// board cannot go along with, a reset among it.
pub fn measure(
    path: &Path,
    program: &Path,
    minutes: f64,
    verbosity: Verbosity,
) -> Result<Deadlines, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    loaded.scene.duration_s = 60.0 * minutes;
    let mut run = start(&loaded.scene, Vec::new(), &program)?;
    let mut progress = Progress::new(verbosity, "measuring", run.ticks());
    for n in 0..run.ticks() {
        run.tick();
        let board = run.module_mut();
        board.check()?;
        // The probe keeps up.
        drop(board.take_log());
        progress.tick(n);
    }
    let ticks = run.ticks();
    let emulated = run.module_mut();
    Ok(Deadlines {
        ticks,
        missed: emulated.board.missed()?,
        stack: emulated.board.machine.stack_used()?,
        cycle: emulated.board.machine.cycle,
        figures: emulated.meter.figures.clone(),
    })
}

impl Deadlines {
    /// `what,mean,worst`, a line each; what has no mean leaves it out.
    pub fn csv(&self) -> String {
        let figures = &self.figures;
        let cycles = |ps: Ps| ps / self.cycle.max(1);
        let line =
            |what: &str, extent: &Tally| format!("{what},{:.1},{}\n", extent.mean(), extent.worst);
        [
            format!("ticks,,{}\n", self.ticks),
            format!("ticks missed,,{}\n", self.missed),
            format!("bytes of stack by its paint,,{}\n", self.stack),
            format!("latency cycles,,{}\n", cycles(figures.latency.worst)),
            format!("tick cycles,,{}\n", cycles(figures.length.worst)),
            line("tick's handler", &figures.tick),
            line("handler at the end of a frame", &figures.handlers),
            line("idle without a line to log", &figures.idle),
            line("whole tick", &figures.whole),
            line("idle while it logs", &figures.logging),
        ]
        .concat()
        .trim_end()
        .to_owned()
    }
}

impl fmt::Display for Deadlines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let figures = &self.figures;
        let cycles = |ps: Ps| ps / self.cycle.max(1);
        writeln!(f, "{} ticks, {} missed", self.ticks, self.missed)?;
        writeln!(f, "stack, by its paint: {} bytes", self.stack)?;
        writeln!(
            f,
            "interrupt latency: worst {} cycles ({:.2} us)",
            cycles(figures.latency.worst),
            figures.latency.worst as f64 / 1e6
        )?;
        writeln!(
            f,
            "longest tick: {} cycles ({:.2} us) by the cycle model",
            cycles(figures.length.worst),
            figures.length.worst as f64 / 1e6
        )?;
        writeln!(f, "instructions{:>32} {:>8}", "mean", "worst")?;
        let mut line = |name: &str, extent: &Tally| {
            writeln!(f, "  {name:<32} {:>9.1} {:>8}", extent.mean(), extent.worst)
        };
        line("tick's handler", &figures.tick)?;
        line("other handlers, a tick", &figures.handlers)?;
        line("idle, a tick", &figures.idle)?;
        line("whole tick", &figures.whole)?;
        line("idle in a tick in which it logs", &figures.logging)
    }
}
