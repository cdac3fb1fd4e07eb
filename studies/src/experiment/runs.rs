//! The runs of a protocol: each seed once as it is and once as a placebo.

use anyhow::Result;
use host_sim::progress::{Progress, Verbosity};

use super::data;
use super::protocol::Protocol;
use super::record::{jobs, record};
use super::verdicts::Bodies;
use super::whole::{evaluate, report};
use crate::page::Files;

/// Runs all of it; the page comes last. `keep` takes the data of its figures, and recordings
/// where those are kept.
pub(crate) fn run(
    protocol: &Protocol,
    verbosity: Verbosity,
    keep: &mut dyn FnMut(&Files) -> Result<()>,
) -> Result<Files> {
    let mut bar = Progress::new(verbosity, "runs", 2 * protocol.seeds);
    let mut bodies = Bodies::default();
    let mut done = 0;
    for seed in protocol.all_seeds() {
        for is_placebo in [false, true] {
            let request = protocol.request(seed, is_placebo)?;
            let recordings = record(&request, &jobs(&request), Verbosity::Quiet)?;
            if protocol.recordings && !is_placebo {
                keep(&data::recordings(protocol, seed, &recordings)?)?;
            }
            bodies.of(is_placebo).push(evaluate(&request, &recordings)?);
            done += 1;
            bar.set(done);
        }
    }
    keep(&data::figures(protocol, &bodies)?)?;
    report(protocol, bodies)
}
