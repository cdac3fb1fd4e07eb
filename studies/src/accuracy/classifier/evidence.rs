//! A variant at work: sums of entries, deficits, posteriors, decisions.

use scene::Rule;

use super::data::{CHANNELS, Recording};
use super::model::{Entry, Variant};

/// Sums of the entries of each block, `[stream][block][class]`.
pub(super) struct Sums(Vec<Vec<Vec<i64>>>);

impl Sums {
    /// Those of a recording in entries of a width.
    pub(super) fn new(recording: &Recording, entry: Entry) -> Self {
        let classes = recording.classes;
        let entries = recording.likelihoods.iter().map(|&p| entry.of(p));
        let table: Vec<i64> = entries.collect();
        let rows: Vec<&[i64]> = table.chunks(classes).collect();
        let sum_of = |bins: &[[usize; CHANNELS]]| {
            let mut sums = vec![0; classes];
            for bins in bins {
                for (channel, bin) in bins.iter().enumerate() {
                    let row = rows.get(bin * CHANNELS + channel).into_iter();
                    for (sum, entry) in sums.iter_mut().zip(row.copied().flatten()) {
                        *sum += entry;
                    }
                }
            }
            sums
        };
        let streams = (0..recording.streams.len()).map(|stream| {
            let blocks = 0..recording.blocks(stream);
            let bins = blocks.map(|block| recording.block(stream, block, |heard| &heard.bins));
            bins.map(sum_of).collect()
        });
        Self(streams.collect())
    }

    pub(super) fn of(&self, stream: usize, block: usize) -> &[i64] {
        let block = self.0.get(stream).and_then(|blocks| blocks.get(block));
        block.map_or(&[], Vec::as_slice)
    }
}

/// Evidence of a variant.
///
/// A class's level is its step minus its deficit; the new deficits are how far
/// the levels lie behind the highest, held at the largest that fits.
pub(super) struct Evidence {
    variant: Variant,
    block: u32,
    deficits: Vec<i64>,
    blocks: u32,
}

impl Evidence {
    /// All classes equal, in blocks of so many samples.
    pub(super) fn new(variant: Variant, block: u32, classes: usize) -> Self {
        Self {
            variant,
            block,
            deficits: vec![0; classes],
            blocks: 0,
        }
    }

    /// By how much each class lies behind the leader.
    #[cfg(test)]
    pub(super) fn deficits(&self) -> &[i64] {
        &self.deficits
    }

    pub(super) fn forget(&mut self) {
        self.deficits.fill(0);
        self.blocks = 0;
    }

    /// Samples since the last start.
    pub(super) fn samples(&self) -> u32 {
        self.blocks.saturating_mul(self.block)
    }

    /// Takes in a block's sums; the leader's deficit is zero again.
    pub(super) fn add(&mut self, sums: &[i64]) {
        let (to, from) = (
            self.variant.per_bit(self.block),
            self.variant.exact_per_bit(self.block),
        );
        // Sums are below 2³²: no product here comes near an i64's end.
        let step = |sum: i64| {
            if to == from {
                sum
            } else {
                (sum * to + from / 2) / from
            }
        };
        let levels = self.deficits.iter().zip(sums);
        let levels = levels.map(|(deficit, &sum)| step(sum) - deficit);
        let levels: Vec<i64> = levels.collect();
        let lead = levels.iter().copied().max().unwrap_or(0);
        let most = self.variant.deficit.most();
        self.deficits = levels
            .iter()
            .map(|level| (lead - level).min(most))
            .collect();
        self.blocks = self.blocks.saturating_add(1);
    }

    /// The first class without a deficit.
    pub(super) fn leader(&self) -> usize {
        self.deficits.iter().position(|&d| d == 0).unwrap_or(0)
    }

    fn in_bit(&self) -> impl Iterator<Item = f64> {
        let unit = 1.0 / self.variant.per_bit(self.block) as f64;
        self.deficits.iter().map(move |&d| d as f64 * unit)
    }

    /// Posterior of each class.
    pub(super) fn posteriors(&self) -> Vec<f64> {
        let terms = self.in_bit().map(|x| self.variant.exponential.term(x));
        let terms: Vec<f64> = terms.collect();
        let sum: f64 = terms.iter().sum();
        terms.iter().map(|t| t / sum).collect()
    }

    /// Whether a decision falls under `rule`.
    pub(super) fn decides(&self, rule: Rule) -> bool {
        match rule {
            Rule::Window { samples } => self.samples() >= samples,
            Rule::Sequential { threshold } => {
                let limit = (1.0 - threshold) / threshold;
                let leader = self.leader();
                let rivals = self.in_bit().enumerate();
                let rivals = rivals.filter_map(|(k, x)| (k != leader).then_some(x));
                self.variant.exponential.odds(rivals, limit) < limit
            }
        }
    }
}
