//! How much there is to simulate, said before it begins.

use scene::Scene;

use crate::progress::Verbosity;
use crate::report;

/// Ticks that are simulated before anyone wonders.
const SHORT: u64 = 2_000_000;

/// Nothing of short runs. `file`: what is written, and about how many bytes of it a tick brings.
pub(super) fn tell(scene: &Scene, runs: u64, file: Option<(&str, u64)>, verbosity: Verbosity) {
    let ticks = scene.ticks().saturating_mul(runs);
    if verbosity != Verbosity::Normal || ticks <= SHORT {
        return;
    }
    let times = if runs == 1 {
        String::new()
    } else {
        format!("{runs} runs of ")
    };
    let file = file.map_or(String::new(), |(name, bytes)| {
        let megabytes = bytes.saturating_mul(ticks) / 1_000_000;
        format!("; {name} will have about {megabytes} MB")
    });
    report::warn(format_args!(
        "{}: {times}{} s to simulate, {ticks} ticks{file}",
        scene.name, scene.duration_s
    ));
}
