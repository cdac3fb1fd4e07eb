//! The runs of what was asked for: each part's seeds by all arms, then the changes of what is
//! chosen.

use anyhow::Result;
use host_sim::progress::{Progress, Verbosity};

use super::asked::{Asked, Part};
use super::changes;
use super::data;
use super::record::{jobs, record};
use super::request::{Arm, Request};
use super::verdicts::Bodies;
use super::whole::{Done, evaluate, report};
use crate::page::{Files, Page};

fn evaluated(request: &Request) -> Result<Page> {
    let recordings = record(request, &jobs(request))?;
    evaluate(request, &recordings)
}

/// Runs all of it; the page comes last. `keep` takes the data of its figures, and recordings
/// where those are kept; `show` the page of what is done so far, as a run takes hours.
pub(crate) fn run(
    asked: &Asked,
    verbosity: Verbosity,
    keep: &mut dyn FnMut(&Files) -> Result<()>,
    show: &mut dyn FnMut(&Files) -> Result<()>,
) -> Result<()> {
    let parts = asked.parts();
    let count = |part: &Part| {
        let runs = part.seeds.end.saturating_sub(part.seeds.start) * asked.arms().len() as u64;
        runs + asked.changes * changes::of(part).len() as u64
    };
    let mut bar = Progress::new(verbosity, "runs", parts.iter().map(count).sum());
    let mut runs = 0;
    let mut ran = || {
        runs += 1;
        bar.set(runs);
    };
    let mut all = Vec::new();
    for part in parts {
        let mut bodies = Bodies::default();
        for seed in part.seeds.clone() {
            for &arm in asked.arms() {
                let request = asked.request(&part, seed, arm)?;
                let recordings = record(&request, &jobs(&request))?;
                if asked.recordings && arm == Arm::MAIN {
                    keep(&data::recordings(asked, seed, &recordings)?)?;
                }
                bodies.add(arm, evaluate(&request, &recordings)?);
                ran();
            }
        }
        keep(&data::figures(asked, &part, &bodies)?)?;
        let mut changed = Vec::new();
        for (_, keys) in changes::of(&part) {
            let mut bodies = Bodies::default();
            for seed in asked.seeds_of_changes() {
                let request = asked.changed(&part, seed, keys)?;
                bodies.add(Arm::MAIN, evaluated(&request)?);
                ran();
            }
            changed.push(bodies);
        }
        all.push(Done {
            part,
            bodies,
            changed,
        });
        show(&report(asked, &all)?)?;
    }
    Ok(())
}
