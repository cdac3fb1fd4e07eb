//! The runs of a protocol: each seed once as it is and once as a placebo, and some seeds of
//! every change of a rig.

use anyhow::Result;
use host_sim::progress::{Progress, Verbosity};

use super::changes::Changed;
use super::data;
use super::protocol::Protocol;
use super::record::{jobs, record};
use super::recording::Dataset;
use super::request::{Extent, Name, Request};
use super::variants::{VARIANTS, Variant};
use super::verdicts::Bodies;
use super::whole::{evaluate, report};
use crate::page::Files;
use crate::rigs::Setting;

/// Seeds of a change: the first of all.
const SEEDS_OF_CHANGES: u64 = 3;

/// The changes that are tried: those of rigs that the experiments have; a quick run has
/// none.
fn changes(protocol: &Protocol) -> Vec<&'static Variant> {
    let has = |variant: &&Variant| {
        let names = protocol.names();
        let mut datasets = names.iter().flat_map(|name| name.datasets());
        variant
            .dataset()
            .is_some_and(|of| datasets.any(|dataset| *dataset == of))
    };
    let all = VARIANTS
        .iter()
        .filter(|_| protocol.extent() == Extent::Full);
    all.filter(has).collect()
}

/// Runs all of it; the page comes last. `keep` takes the data of its figures, and recordings
/// where those are kept.
pub(crate) fn run(
    protocol: &Protocol,
    verbosity: Verbosity,
    keep: &mut dyn FnMut(&Files) -> Result<()>,
) -> Result<Files> {
    let changes = changes(protocol);
    let (first, count) = (protocol.seed, protocol.seeds);
    let of_changes = count.min(SEEDS_OF_CHANGES);
    let with_placebo = changes.iter().filter(|variant| variant.has_placebo).count();
    let runs = 2 * count + of_changes * (changes.len() + with_placebo) as u64;
    let mut bar = Progress::new(verbosity, "runs", runs);
    let mut done = 0;
    let mut one = |request: &Request, only: Option<Dataset>, keeps: bool| {
        let mut jobs = jobs(request);
        jobs.retain(|job| only.is_none_or(|dataset| job.dataset == dataset));
        let recordings = record(request, &jobs, Verbosity::Quiet)?;
        if keeps {
            keep(&data::recordings(protocol, request.seed, &recordings)?)?;
        }
        let page = evaluate(request, &recordings)?;
        done += 1;
        bar.set(done);
        anyhow::Ok(page)
    };
    let mut both = |seeds: u64, more: &[Setting], only: Option<&Variant>| {
        let mut bodies = Bodies::default();
        for seed in first..first.saturating_add(seeds) {
            let has_placebo = only.is_none_or(|variant| variant.has_placebo);
            for is_placebo in [false, true] {
                if is_placebo && !has_placebo {
                    continue;
                }
                let mut request = protocol.request(seed, more, is_placebo)?;
                if let Some(variant) = only {
                    let concerned = |name: &Name| {
                        name.datasets()
                            .iter()
                            .any(|one| Some(*one) == variant.dataset())
                    };
                    request.names.retain(concerned);
                }
                let keeps = protocol.recordings && only.is_none() && !is_placebo;
                let dataset = only.and_then(Variant::dataset);
                let page = one(&request, dataset, keeps)?;
                bodies.of(is_placebo).push(page);
            }
        }
        anyhow::Ok(bodies)
    };
    let plain = both(count, &[], None)?;
    let mut changed = Vec::new();
    for variant in changes {
        let bodies = both(of_changes, &variant.settings()?, Some(variant))?;
        changed.push(Changed { variant, bodies });
    }
    keep(&data::figures(protocol, &plain)?)?;
    report(protocol, plain, &changed)
}
