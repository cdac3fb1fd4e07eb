//! The time that host-sim takes for a tick of a scene: what a scene leaves out
//! costs nothing there either.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use scene::Scene;

use crate::run::{Fault, cargo, output, read, target, top, write};

/// Runs of which the quickest counts: others are disturbed.
const RUNS: usize = 3;
/// Ticks of a run, whatever the scene's own length: so many that the start of
/// the program does not count.
const TICKS: u32 = 100_000;

/// Nanoseconds a tick, with the writing of its files.
pub(super) fn ns_per_tick(path: &Path, scene: &Scene) -> Result<u64, Fault> {
    let build = ["build", "--release", "--quiet", "--locked"];
    output(cargo(&build).args(["-p", "host-sim"]))?;
    let folder = target().join("size");
    let duration_s = f64::from(TICKS) / f64::from(scene.tick_hz);
    let long = folder.join("scene.toml");
    write(&long, lengthened(&read(&top().join(path))?, duration_s))?;
    let mut best = u128::MAX;
    for _ in 0..RUNS {
        let mut command = Command::new(target().join("release/host-sim"));
        command.args(["run", "--quiet"]).arg(&long);
        command.arg("--out").arg(folder.join("host"));
        // Models stand beside the scenes, or are named from the top.
        let from = match scene.model_path(&top().join("scenes")) {
            Some(model) if model.is_absolute() => top().join("scenes"),
            _ => top(),
        };
        let begun = Instant::now();
        output(command.current_dir(from))?;
        best = best.min(begun.elapsed().as_nanos());
    }
    Ok(u64::try_from(best / u128::from(TICKS)).unwrap_or(u64::MAX))
}

/// The text of a scene with another duration.
fn lengthened(text: &str, duration_s: f64) -> String {
    let line = |line: &str| {
        if line.trim_start().starts_with("duration_s") {
            format!("duration_s = {duration_s:?}\n")
        } else {
            format!("{line}\n")
        }
    };
    text.lines().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::lengthened;

    #[test]
    fn only_the_duration_changes() {
        let text = "name = \"a\"\nduration_s = 1.0 # short\nseed = 1\n";
        let expected = "name = \"a\"\nduration_s = 50.0\nseed = 1\n";
        assert_eq!(lengthened(text, 50.0), expected);
    }
}
