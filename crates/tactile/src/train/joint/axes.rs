//! What tables are looked up by: their axes, and the cells of a piece's blocks.

use std::vec;
use std::vec::Vec;

use super::pieces::Piece;
use super::trial::CHANNELS;
use crate::binner::Binner;
use crate::model_buf::{Axis, TableSource};
use crate::quantiser::Quantiser;

/// The share of codes that lies below, and above, a table's range.
const OUTSIDE: f64 = 0.002;

pub(super) struct Axes {
    samples: [Axis; CHANNELS],
    roughness: [Axis; CHANNELS],
}

impl Axes {
    /// Ranges from the quantiles of what was felt.
    pub(super) fn of(pieces: &[Piece<'_>], bins: usize) -> Self {
        let axis = |channel: usize, codes: Vec<i32>| {
            let (low, high) = range(codes, bins);
            Axis::new(channel, bins, [low, high])
        };
        let samples = |channel: usize| {
            let codes = pieces.iter().flat_map(|piece| &piece.blocks.samples);
            axis(channel, codes.map(|codes| codes[channel]).collect())
        };
        let roughness = |channel: usize| {
            let codes = pieces.iter().flat_map(|piece| &piece.blocks.roughness);
            axis(channel, codes.map(|codes| codes[channel]).collect())
        };
        Self {
            samples: [samples(0), samples(1)],
            roughness: [roughness(0), roughness(1)],
        }
    }
}

/// The range between the quantiles, widened where bins would be narrower than the
/// two codes that the module's binning needs.
fn range(mut codes: Vec<i32>, bins: usize) -> (i32, i32) {
    codes.sort_unstable();
    let last = codes.len().saturating_sub(1);
    let below = (OUTSIDE * last as f64) as usize;
    let (low, high) = (codes[below], codes[last - below]);
    let least = 2 * bins as i32 + 1;
    let span = high.saturating_sub(low);
    if span >= least {
        return (low, high);
    }
    let low = low.saturating_sub((least - span) / 2);
    (low, low.saturating_add(least))
}

/// A table without its content.
pub(super) struct Shape {
    pub(super) source: TableSource,
    pub(super) axes: [Axis; CHANNELS],
    binners: [Binner; CHANNELS],
    /// How often it is looked up in a block.
    pub(super) lookups: usize,
}

impl Shape {
    fn new(source: TableSource, axes: [Axis; CHANNELS], lookups: usize) -> Self {
        Self {
            source,
            axes,
            binners: axes.map(|axis| {
                let codes = Quantiser::of_codes(axis.low, axis.high);
                // The span is wide enough for the bins.
                codes.binner(axis.bins).unwrap_or_default()
            }),
            lookups,
        }
    }

    pub(super) fn cells(&self) -> usize {
        self.axes.iter().map(|axis| axis.bins).product()
    }

    fn cell(&self, codes: [i32; CHANNELS]) -> usize {
        let bin = |n: usize| self.binners[n].bin(codes[n], self.axes[n].bins - 1);
        bin(0) * self.axes[1].bins + bin(1)
    }

    pub(super) fn cells_of(&self, piece: &Piece<'_>) -> Vec<usize> {
        let codes = match self.source {
            TableSource::Samples => &piece.blocks.samples,
            TableSource::Roughness => &piece.blocks.roughness,
        };
        codes.iter().map(|codes| self.cell(*codes)).collect()
    }
}

pub(super) struct Layout {
    pub(super) shapes: Vec<Shape>,
}

impl Layout {
    /// x and y together, and their roughness together.
    pub(super) fn joint(axes: &Axes, block: u32) -> Self {
        Self {
            shapes: vec![
                Shape::new(TableSource::Samples, axes.samples, block as usize),
                Shape::new(TableSource::Roughness, axes.roughness, 1),
            ],
        }
    }

    pub(super) fn sources(&self) -> Vec<TableSource> {
        self.shapes.iter().map(|shape| shape.source).collect()
    }
}
