//! What tables are looked up by: their axes, and the cells of a piece's blocks.

use std::vec::Vec;

use super::pieces::Piece;
use super::trial::CHANNELS;
use crate::binner::Binner;
use crate::model_buf::{Axis, TableSource};
use crate::quantiser::Quantiser;

/// The share of codes that lies below, and above, a table's range.
const OUTSIDE: f64 = 0.002;

/// A table without its content.
pub(super) struct Shape {
    pub(super) source: TableSource,
    pub(super) axes: [Axis; CHANNELS],
    binners: [Binner; CHANNELS],
    /// How often it is looked up in a block.
    pub(super) lookups: usize,
}

/// x and y together, and their roughness together. Ranges are from the quantiles of what was felt.
pub(super) fn shapes(pieces: &[Piece<'_>], bins: usize, block: u32) -> [Shape; 2] {
    let sources = [
        (TableSource::Samples, block as usize),
        (TableSource::Roughness, 1),
    ];
    sources.map(|(source, lookups)| {
        let axes = core::array::from_fn(|channel| {
            let codes = pieces.iter().flat_map(|piece| codes(source, piece));
            let codes = codes.map(|codes| codes[channel]).collect();
            Axis::new(channel, bins, range(codes, bins))
        });
        Shape {
            source,
            axes,
            binners: axes.map(|axis: Axis| {
                let codes = Quantiser::of_codes(axis.low, axis.high);
                // The span is wide enough for the bins.
                codes.binner(axis.bins).unwrap_or_default()
            }),
            lookups,
        }
    })
}

fn codes<'p>(source: TableSource, piece: &'p Piece<'_>) -> &'p [[i32; CHANNELS]] {
    match source {
        TableSource::Samples => &piece.blocks.samples,
        TableSource::Roughness => &piece.blocks.roughness,
    }
}

/// The range between the quantiles, widened where bins would be narrower than the
/// two codes that the module's binning needs.
fn range(mut codes: Vec<i32>, bins: usize) -> [i32; 2] {
    codes.sort_unstable();
    let last = codes.len().saturating_sub(1);
    let below = (OUTSIDE * last as f64) as usize;
    let (low, high) = (codes[below], codes[last - below]);
    let least = 2 * bins as i32 + 1;
    let span = high.saturating_sub(low);
    if span >= least {
        return [low, high];
    }
    let low = low.saturating_sub((least - span) / 2);
    [low, low.saturating_add(least)]
}

impl Shape {
    pub(super) fn cells(&self) -> usize {
        self.axes.iter().map(|axis| axis.bins).product()
    }

    pub(super) fn cells_of(&self, piece: &Piece<'_>) -> Vec<usize> {
        let cell = |codes: &[i32; CHANNELS]| {
            let bin = |n: usize| self.binners[n].bin(codes[n], self.axes[n].bins - 1);
            bin(0) * self.axes[1].bins + bin(1)
        };
        codes(self.source, piece).iter().map(cell).collect()
    }
}
