//! The product's own rule on BIOTACT's textures, by the left front whisker alone.

use anyhow::Result;
use host_sim::recording::Stream;

use super::whisks::{Visits, Whisk};
use crate::experiment::product::{section, stream};
use crate::page::Page;
use crate::paper::biotact::{STRATEGIES, TEXTURES};
use crate::rigs::CHANNELS;

/// Says what it makes of each strategy, the first `most` whisks to train on.
pub(super) fn of_one_whisker(
    page: &mut Page,
    visits: &Visits,
    rate_hz: f64,
    most: usize,
) -> Result<()> {
    let order: Vec<usize> = (0..visits.count()).collect();
    let (training, testing) = order.split_at(most.min(order.len()));
    let streams = |strategy: usize, numbers: &[usize]| -> Result<Vec<Stream>> {
        let one = |(n, (texture, _, samples)): (usize, &Whisk)| {
            let pairs = samples.chunks_exact(CHANNELS).map(|all| [all[0], all[1]]);
            stream(TEXTURES[*texture].0, n, pairs.collect(), Some(rate_hz))
        };
        visits
            .some(strategy, numbers)
            .enumerate()
            .map(one)
            .collect()
    };
    let mut tasks = Vec::new();
    for (strategy, (name, _)) in STRATEGIES.iter().enumerate() {
        let name = format!("texture by one whisker, {name}");
        let (training, testing) = (streams(strategy, training)?, streams(strategy, testing)?);
        tasks.push((name, training, testing));
    }
    section(page, rate_hz, tasks)
}
