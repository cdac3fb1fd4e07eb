//! Joint histograms, and what they say of blocks that they have not counted.

use std::vec;
use std::vec::Vec;

use super::axes::Shape;
use super::pieces::Piece;
use super::trial::CHANNELS;
use crate::format::LOG_FLOOR;
use crate::model_buf::{Axis, TableSource};
use crate::train::{gaussian, smoothed};

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

#[derive(Clone)]
pub(super) struct Evidence {
    pub(super) class: usize,
    pub(super) fold: usize,
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

/// Gives classes of one group the mean of what is said of them; `first` has for each class the first
/// one of its group.
pub(super) fn unite(of_classes: &mut [f64], first: &[usize]) {
    for row in of_classes.chunks_exact_mut(first.len()) {
        let mean = |group: &usize| {
            let of = row.iter().zip(first).filter(|(_, of)| *of == group);
            of.clone().map(|(value, _)| value).sum::<f64>() / of.count() as f64
        };
        let means: Vec<f64> = first.iter().map(mean).collect();
        row.copy_from_slice(&means);
    }
}

pub(super) struct Tables {
    classes: usize,
    kernel: Vec<f64>,
    all: Vec<Table>,
}

struct Table {
    shape: Shape,
    /// Of each piece the cells of its blocks.
    cells: Vec<Vec<usize>>,
    /// Histogram of each class.
    of_class: Vec<Vec<f64>>,
}

impl Tables {
    pub(super) fn count(
        shapes: [Shape; 2],
        pieces: &[Piece<'_>],
        classes: usize,
        smooth: f64,
    ) -> Self {
        let count = |shape: Shape| {
            let cells: Vec<_> = pieces.iter().map(|piece| shape.cells_of(piece)).collect();
            let mut of_class = vec![vec![0.0; shape.cells()]; classes];
            for (piece, cells) in pieces.iter().zip(&cells) {
                for &cell in cells {
                    of_class[piece.class][cell] += 1.0;
                }
            }
            Table {
                shape,
                cells,
                of_class,
            }
        };
        Self {
            classes,
            kernel: gaussian(smooth),
            all: shapes.into_iter().map(count).collect(),
        }
    }

    pub(super) fn finished(&self) -> Vec<LogTable> {
        let finished = |table: &Table| LogTable {
            source: table.shape.source,
            axes: table.shape.axes,
            log2_p: self.log2_p(&table.shape, &table.of_class),
        };
        self.all.iter().map(finished).collect()
    }

    /// What tables that have not counted its fold say of each piece.
    pub(super) fn held_out(&self, pieces: &[Piece<'_>]) -> Vec<Evidence> {
        let tables = self.all.len();
        let mut evidence: Vec<Evidence> = pieces
            .iter()
            .map(|piece| Evidence {
                class: piece.class,
                fold: piece.fold,
                tables,
                classes: self.classes,
                means: vec![0.0; piece.blocks.len() * tables * self.classes],
            })
            .collect();
        let folds = pieces.iter().map(|piece| piece.fold + 1).max();
        for fold in 0..folds.unwrap_or(0) {
            let within = || (0..pieces.len()).filter(|&n| pieces[n].fold == fold);
            for (n_table, table) in self.all.iter().enumerate() {
                let Table { shape, cells, .. } = table;
                let mut of_class = table.of_class.clone();
                for n in within() {
                    for &cell in &cells[n] {
                        of_class[pieces[n].class][cell] -= 1.0;
                    }
                }
                let log2_p = self.log2_p(shape, &of_class);
                for n in within() {
                    let rows = evidence[n].means.chunks_exact_mut(tables * self.classes);
                    for (row, cells) in rows.zip(cells[n].chunks_exact(shape.lookups)) {
                        let means = &mut row[n_table * self.classes..][..self.classes];
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
