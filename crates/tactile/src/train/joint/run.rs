//! The rule in double precision, over evidence that was held out.

use std::vec;
use std::vec::Vec;

use super::pieces::Piece;
use super::tables::Evidence;
use crate::format::ENTRY_OFFSET_BITS;
use crate::model_buf::TableSource;

/// When to decide.
#[derive(Clone)]
pub(super) struct Rule {
    /// On the posterior.
    pub(super) threshold: f64,
    /// On a deficit at the onset of a touch.
    pub(super) limit_bits: f64,
    /// Samples of a block.
    pub(super) block: u32,
    pub(super) weights: Vec<f64>,
    /// Of each table.
    pub(super) sources: Vec<TableSource>,
}

/// A decision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Decided {
    /// The piece that it fell in.
    pub(super) piece: usize,
    pub(super) truth: usize,
    pub(super) class: usize,
    pub(super) posterior: f64,
    pub(super) samples: u32,
    /// Mean of the leader's weighted entries since the onset of the touch, bits: of
    /// the tables of samples, and of roughness.
    pub(super) entries: [f64; 2],
}

/// The decisions over the pieces, one after the other. Within a recording evidence
/// goes on: a piece begins with the onset of a touch, and that is all that is known.
pub(super) fn decisions(pieces: &[Piece<'_>], evidence: &[Evidence], rule: &Rule) -> Vec<Decided> {
    let mut found = Vec::new();
    let mut state: Option<State<'_>> = None;
    let mut last = None;
    for (n, (piece, evidence)) in pieces.iter().zip(evidence).enumerate() {
        if last != Some(piece.recording) {
            state = None;
            last = Some(piece.recording);
        }
        let state = state.get_or_insert_with(|| State::new(rule, evidence.classes));
        let mut touch = None;
        for (block, &of) in evidence.blocks().zip(&piece.blocks.touches) {
            if touch != Some(of) {
                state.onset();
                touch = Some(of);
            }
            if let Some((class, posterior, blocks)) = state.block(block) {
                found.push(Decided {
                    piece: n,
                    truth: piece.class,
                    class,
                    posterior,
                    samples: blocks * rule.block,
                    entries: state.entries(class),
                });
            }
        }
    }
    found
}

/// Evidence so far.
struct State<'r> {
    rule: &'r Rule,
    /// Bits behind the leader.
    deficits: Vec<f64>,
    /// Blocks since a decision.
    blocks: u32,
    /// Blocks of the touch, and the sums of their weighted entries, by source.
    touched: u32,
    sums: [Vec<f64>; 2],
}

impl<'r> State<'r> {
    fn new(rule: &'r Rule, classes: usize) -> Self {
        Self {
            rule,
            deficits: vec![0.0; classes],
            blocks: 0,
            touched: 0,
            sums: [vec![0.0; classes], vec![0.0; classes]],
        }
    }

    fn onset(&mut self) {
        for deficit in &mut self.deficits {
            *deficit = deficit.min(self.rule.limit_bits);
        }
        self.touched = 0;
        self.sums.iter_mut().for_each(|sums| sums.fill(0.0));
    }

    /// Adds a block, `[table][class]`; class, posterior and blocks of a decision.
    fn block(&mut self, means: &[f64]) -> Option<(usize, f64, u32)> {
        let classes = self.deficits.len();
        let tables = means.chunks_exact(classes).zip(&self.rule.weights);
        for ((table, weight), source) in tables.zip(&self.rule.sources) {
            let sums = &mut self.sums[*source as usize];
            let of_classes = self.deficits.iter_mut().zip(sums).zip(table);
            for ((deficit, sum), mean) in of_classes {
                *deficit -= weight * mean;
                *sum += weight * (mean + f64::from(ENTRY_OFFSET_BITS));
            }
        }
        self.blocks += 1;
        self.touched += 1;
        let least = self.deficits.iter().copied().fold(f64::INFINITY, f64::min);
        let mut leader = 0;
        for (class, deficit) in self.deficits.iter_mut().enumerate().rev() {
            *deficit -= least;
            if *deficit == 0.0 {
                leader = class;
            }
        }
        let total: f64 = self.deficits.iter().map(|deficit| (-deficit).exp2()).sum();
        let posterior = 1.0 / total;
        if posterior <= self.rule.threshold {
            return None;
        }
        self.deficits.fill(0.0);
        Some((leader, posterior, core::mem::take(&mut self.blocks)))
    }

    /// Mean weighted entries of a class since the onset, by source.
    fn entries(&self, class: usize) -> [f64; 2] {
        [0, 1].map(|source| self.sums[source][class] / f64::from(self.touched.max(1)))
    }
}
