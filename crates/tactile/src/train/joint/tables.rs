//! Joint histograms, and what they say of blocks that they have not counted.

use std::vec;
use std::vec::Vec;

use super::pieces::Piece;
use super::trial::CHANNELS;
use crate::binner::Binner;
use crate::format::LOG_FLOOR;
use crate::quantiser::Quantiser;
use crate::train::gaussian;
use crate::train_error::TrainError;

/// The share of codes that lies below, and above, a table's range.
const OUTSIDE: f64 = 0.002;

/// What a table is looked up by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableSource {
    /// The codes of a sample; its log-likelihoods are averaged over a block.
    Samples,
    /// The codes of the roughness of a block.
    Roughness,
}

/// An axis of a table: equal bins over a range of codes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// The channel.
    pub channel: usize,
    /// How many bins.
    pub bins: usize,
    /// The scale of the channel's codes, and the range of the axis in codes: of the
    /// channel, or of its roughness.
    pub range: Quantiser,
}

/// A table of log₂ p.
#[derive(Debug, Clone, PartialEq)]
pub struct LogTable {
    /// What it is looked up by.
    pub source: TableSource,
    /// Its axes.
    pub axes: [Axis; CHANNELS],
    /// log₂ p, `[bin of the first axis][bin of the second][class]`, at least that
    /// of [`LOG_FLOOR`].
    pub log2_p: Vec<f64>,
}

/// The axes of the tables of samples and of roughness.
pub(super) struct Axes {
    samples: [Axis; CHANNELS],
    roughness: [Axis; CHANNELS],
}

impl Axes {
    /// Ranges from the quantiles of what was felt.
    pub(super) fn of(
        pieces: &[Piece<'_>],
        scales: [Quantiser; CHANNELS],
        bins: usize,
    ) -> Result<Self, TrainError> {
        let axis = |channel: usize, codes: Vec<i32>| -> Result<Axis, TrainError> {
            let (low, high) = range(codes, bins);
            let range = Quantiser {
                low,
                high,
                ..scales[channel]
            };
            range
                .check(bins)
                .map_err(|_| TrainError::Range { channel })?;
            Ok(Axis {
                channel,
                bins,
                range,
            })
        };
        let samples = |channel: usize| {
            let codes = pieces.iter().flat_map(|piece| &piece.blocks.samples);
            axis(channel, codes.map(|codes| codes[channel]).collect())
        };
        let roughness = |channel: usize| {
            let codes = pieces.iter().flat_map(|piece| &piece.blocks.roughness);
            axis(channel, codes.map(|codes| codes[channel]).collect())
        };
        Ok(Self {
            samples: [samples(0)?, samples(1)?],
            roughness: [roughness(0)?, roughness(1)?],
        })
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
    source: TableSource,
    axes: [Axis; CHANNELS],
    binners: [Binner; CHANNELS],
    /// How often it is looked up in a block.
    lookups: usize,
}

impl Shape {
    fn new(source: TableSource, axes: [Axis; CHANNELS], lookups: usize) -> Self {
        Self {
            source,
            axes,
            // The ranges are checked.
            binners: axes.map(|axis| axis.range.binner(axis.bins).unwrap_or_default()),
            lookups,
        }
    }

    fn cells(&self) -> usize {
        self.axes.iter().map(|axis| axis.bins).product()
    }

    fn cell(&self, codes: [i32; CHANNELS]) -> usize {
        let bin = |n: usize| self.binners[n].bin(codes[n], self.axes[n].bins - 1);
        bin(0) * self.axes[1].bins + bin(1)
    }

    /// The cells that it is looked up at, block after block.
    fn cells_of(&self, piece: &Piece<'_>) -> Vec<usize> {
        let codes = match self.source {
            TableSource::Samples => &piece.blocks.samples,
            TableSource::Roughness => &piece.blocks.roughness,
        };
        codes.iter().map(|codes| self.cell(*codes)).collect()
    }
}

/// The tables of a model.
pub(super) struct Layout {
    shapes: Vec<Shape>,
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

    /// What each table is looked up by.
    pub(super) fn sources(&self) -> Vec<TableSource> {
        self.shapes.iter().map(|shape| shape.source).collect()
    }
}

/// What the tables say of the blocks of a piece.
pub(super) struct Evidence {
    /// The piece's class.
    pub(super) class: usize,
    pub(super) tables: usize,
    pub(super) classes: usize,
    /// Mean of log₂ p, `[block][table][class]`.
    pub(super) means: Vec<f64>,
}

impl Evidence {
    /// Of each block, `[table][class]`.
    pub(super) fn blocks(&self) -> impl Iterator<Item = &[f64]> {
        self.means.chunks_exact(self.tables * self.classes)
    }
}

/// What was counted: of each table and piece.
pub(super) struct Tables<'l> {
    layout: &'l Layout,
    classes: usize,
    kernel: Vec<f64>,
    /// Of each table.
    counted: Vec<Counted>,
}

struct Counted {
    /// Of each piece the cells of its blocks.
    cells: Vec<Vec<usize>>,
    /// Histogram of each class.
    of_class: Vec<Vec<f64>>,
}

impl<'l> Tables<'l> {
    /// Counts all pieces.
    pub(super) fn count(
        layout: &'l Layout,
        pieces: &[Piece<'_>],
        classes: usize,
        smooth: f64,
    ) -> Self {
        let count = |shape: &Shape| {
            let cells: Vec<_> = pieces.iter().map(|piece| shape.cells_of(piece)).collect();
            let mut of_class = vec![vec![0.0; shape.cells()]; classes];
            for (piece, cells) in pieces.iter().zip(&cells) {
                for &cell in cells {
                    of_class[piece.class][cell] += 1.0;
                }
            }
            Counted { cells, of_class }
        };
        Self {
            layout,
            classes,
            kernel: gaussian(smooth),
            counted: layout.shapes.iter().map(count).collect(),
        }
    }

    /// Tables of all that was counted.
    pub(super) fn finished(&self) -> Vec<LogTable> {
        let tables = self.layout.shapes.iter().zip(&self.counted);
        tables
            .map(|(shape, counted)| LogTable {
                source: shape.source,
                axes: shape.axes,
                log2_p: self.log2_p(shape, &counted.of_class),
            })
            .collect()
    }

    /// What tables that have not counted its fold say of each piece.
    pub(super) fn held_out(&self, pieces: &[Piece<'_>]) -> Vec<Evidence> {
        let tables = self.layout.shapes.len();
        let mut evidence: Vec<Evidence> = pieces
            .iter()
            .map(|piece| Evidence {
                class: piece.class,
                tables,
                classes: self.classes,
                means: vec![0.0; piece.blocks.len() * tables * self.classes],
            })
            .collect();
        let folds = pieces.iter().map(|piece| piece.fold + 1).max();
        for fold in 0..folds.unwrap_or(0) {
            let within = || (0..pieces.len()).filter(|&n| pieces[n].fold == fold);
            for (table, (shape, counted)) in
                self.layout.shapes.iter().zip(&self.counted).enumerate()
            {
                let mut of_class = counted.of_class.clone();
                for n in within() {
                    for &cell in &counted.cells[n] {
                        of_class[pieces[n].class][cell] -= 1.0;
                    }
                }
                let log2_p = self.log2_p(shape, &of_class);
                for n in within() {
                    let rows = evidence[n].means.chunks_exact_mut(tables * self.classes);
                    for (row, cells) in rows.zip(counted.cells[n].chunks_exact(shape.lookups)) {
                        let means = &mut row[table * self.classes..][..self.classes];
                        for &cell in cells {
                            let entries = &log2_p[cell * self.classes..][..self.classes];
                            for (mean, entry) in means.iter_mut().zip(entries) {
                                *mean += entry / shape.lookups as f64;
                            }
                        }
                    }
                }
            }
        }
        evidence
    }

    /// log₂(p + floor), `[cell][class]`, of the histograms of the classes.
    fn log2_p(&self, shape: &Shape, of_class: &[Vec<f64>]) -> Vec<f64> {
        let columns = shape.axes[1].bins;
        let mut log2_p = vec![0.0; shape.cells() * self.classes];
        for (class, histogram) in of_class.iter().enumerate() {
            let p = smoothed(histogram, columns, &self.kernel);
            for (cell, p) in p.iter().enumerate() {
                log2_p[cell * self.classes + class] = (p + LOG_FLOOR).log2();
            }
        }
        log2_p
    }
}

/// Convolution along both axes with a symmetric kernel, zero outside; sum one.
fn smoothed(histogram: &[f64], columns: usize, kernel: &[f64]) -> Vec<f64> {
    let rows = histogram.len() / columns;
    let along = |from: &[f64], stride: usize, length: usize, place: &dyn Fn(usize) -> usize| {
        let mut to = vec![0.0; from.len()];
        for (cell, &count) in from.iter().enumerate() {
            if count == 0.0 {
                continue;
            }
            let at = place(cell);
            to[cell] += count * kernel[0];
            for (k, &weight) in kernel.iter().enumerate().skip(1) {
                if at >= k {
                    to[cell - k * stride] += count * weight;
                }
                if at + k < length {
                    to[cell + k * stride] += count * weight;
                }
            }
        }
        to
    };
    let within = along(histogram, 1, columns, &|cell| cell % columns);
    let both = along(&within, columns, rows, &|cell| cell / columns);
    let sum: f64 = both.iter().sum();
    // A class may have nothing left when a fold is taken out: nothing is known then.
    let even = 1.0 / both.len() as f64;
    both.iter()
        .map(|x| if sum > 0.0 { x / sum } else { even })
        .collect()
}
