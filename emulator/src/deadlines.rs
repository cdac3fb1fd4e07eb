//! How a board keeps its time over minutes of a scene.

use std::path::Path;

use host_sim::Error;
use host_sim::progress::{Progress, Verbosity};

use crate::chip::Ps;
use crate::deployment::flashed;
use crate::meter::Tally;
use crate::session::Session;
use crate::talk::wrong;

/// Runs the scene in `path` on the board for `minutes` of its time, whatever its
/// own duration, and measures every tick. Returns `what,mean,worst`, a line each, where what has no
/// mean leaves it out; as a table to read, if not as `csv`. The stack is by its paint, times by the
/// cycle model, the rest are instructions.
pub(crate) fn measure(
    path: &Path,
    program: &Path,
    minutes: f64,
    csv: bool,
    verbosity: Verbosity,
) -> Result<Vec<String>, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    loaded.scene.duration_s = 60.0 * minutes;
    let mut session = Session::running(&loaded.scene, Vec::new(), &program)?;
    let ticks = session.run.ticks();
    let mut progress = Progress::new(verbosity, "measuring", ticks);
    for n in 0..ticks {
        session.tick()?;
        // The probe keeps up.
        drop(session.log());
        progress.tick(n);
    }
    let board = session.board_mut();
    let machine = &board.machine;
    let meter = &board.meter;
    let cycles = |time: Ps| time / machine.cycle.max(1);
    let missed = board.missed()?;
    let mean = |tally: &Tally| (Some(tally.mean()), tally.worst);
    let rows = [
        ("ticks", (None, ticks)),
        ("ticks missed", (None, missed.into())),
        (
            "bytes of stack by its paint",
            (None, machine.stack_used()?.into()),
        ),
        ("latency cycles", (None, cycles(meter.latency.worst))),
        ("tick cycles", (None, cycles(meter.length.worst))),
        ("tick's handler", mean(&meter.tick)),
        ("handler at the end of a frame", mean(&meter.handlers)),
        ("idle without a line to log", mean(&meter.idle)),
        ("whole tick", mean(&meter.whole)),
        ("idle while it logs", mean(&meter.logging)),
    ];
    let lines = rows.map(|(what, (mean, worst))| {
        let mean = mean.map_or(String::new(), |mean| format!("{mean:.1}"));
        if csv {
            format!("{what},{mean},{worst}")
        } else {
            format!("{what:<30} {mean:>9} {worst:>8}")
        }
    });
    if missed > 0 {
        return wrong(lines.join("\n"));
    }
    Ok(lines.to_vec())
}
