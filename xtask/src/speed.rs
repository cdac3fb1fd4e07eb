//! How fast host-sim is.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use crate::emulate::variants;
use crate::run::{Fault, cargo, output, run, target, top};

/// The time that host-sim takes for a tick of a scene on the wall's clock, ns: the least of three
/// runs of so many ticks that the start of the program does not count.
pub(crate) fn ns_per_tick(scene: &Path) -> Result<u64, Fault> {
    let ticks = 100_000;
    let (program, long) = (released()?, variants::with_ticks(scene, ticks)?);
    let mut least = f64::INFINITY;
    for _ in 0..3 {
        let begun = Instant::now();
        let mut run = Command::new(&program);
        run.args(["run", "--quiet"]).arg(&long).arg("--out");
        output(run.arg(target().join("speed")).current_dir(top()))?;
        least = least.min(begun.elapsed().as_secs_f64());
    }
    Ok((1e9 * least / f64::from(ticks)) as u64)
}

fn released() -> Result<PathBuf, Fault> {
    let build = ["build", "--release", "--locked", "--quiet"];
    run(cargo(&build).args(["-p", "host-sim"]))?;
    Ok(target().join("release/host-sim"))
}
