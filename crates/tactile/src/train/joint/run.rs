//! The rule in double precision, over evidence that was held out.

use std::vec;
use std::vec::Vec;

use super::pieces::Piece;
use super::tables::Evidence;
use crate::format::ENTRY_OFFSET_BITS;

/// Most that a class may lie behind at the onset of a touch, bits.
pub(super) const LIMIT_BITS: f64 = 2.0;

#[derive(Clone)]
pub(super) struct Rule {
    pub(super) threshold: f64,
    pub(super) block: u32,
    /// Of the table of samples, and of that of roughness.
    pub(super) weights: Vec<f64>,
    /// A class that it does not know: what would be made of it is asked.
    pub(super) unknown: Option<usize>,
    /// Whether each piece is judged for itself; else evidence goes on within a recording.
    pub(super) apart: bool,
}

/// What was said of a part, by tables alone, with floors, or by the whole model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Decided {
    /// Which of the parts that were held out.
    pub(super) piece: usize,
    pub(super) truth: usize,
    pub(super) class: usize,
    pub(super) posterior: f64,
    pub(super) samples: u32,
    /// Not unknown.
    pub(super) is_named: bool,
    /// Mean of the leader's weighted entries since the onset of the touch, bits, by table.
    pub(super) entries: [f64; 2],
}

impl Decided {
    pub(super) const fn is_right(&self) -> bool {
        self.class == self.truth
    }
}

/// The mean entries, as [`Decided::entries`], of the class that was felt: at a decision,
/// right or wrong, or at the end of a piece without one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Felt {
    pub(super) piece: usize,
    pub(super) class: usize,
    pub(super) entries: [f64; 2],
}

pub(super) fn decisions(pieces: &[Piece<'_>], evidence: &[Evidence], rule: &Rule) -> Vec<Decided> {
    let mut found = Vec::new();
    follow(pieces, evidence, rule, |piece, state, verdict| {
        let Some(verdict) = verdict else {
            return;
        };
        found.push(Decided {
            piece,
            truth: pieces[piece].class,
            class: verdict.class,
            posterior: verdict.posterior,
            samples: verdict.blocks * rule.block,
            is_named: true,
            entries: state.entries(verdict.class),
        });
    });
    found
}

pub(super) fn felt(pieces: &[Piece<'_>], evidence: &[Evidence], rule: &Rule) -> Vec<Felt> {
    let mut all = Vec::new();
    follow(pieces, evidence, rule, |piece, state, _| {
        let class = pieces[piece].class;
        all.push(Felt {
            piece,
            class,
            entries: state.entries(class),
        });
    });
    all
}

/// What is decided on the pieces of a class that the rule does not know.
pub(super) fn of_unknown(
    class: usize,
    pieces: &[Piece<'_>],
    evidence: &[Evidence],
    rule: &Rule,
) -> Vec<Decided> {
    let rule = Rule {
        unknown: Some(class),
        ..rule.clone()
    };
    let mut found = decisions(pieces, evidence, &rule);
    found.retain(|decided| decided.truth == class);
    found
}

/// Runs the rule; calls `at` with each decision, and with `None` at the end of a piece that
/// had none. Of a piece only its beginning, the onset of a touch, is known.
fn follow(
    pieces: &[Piece<'_>],
    evidence: &[Evidence],
    rule: &Rule,
    mut at: impl FnMut(usize, &State<'_>, Option<Verdict>),
) {
    let mut state: Option<State<'_>> = None;
    let mut last = None;
    for (n, (piece, evidence)) in pieces.iter().zip(evidence).enumerate() {
        if rule.apart || last != Some(piece.recording) {
            state = None;
            last = Some(piece.recording);
        }
        let state = state.get_or_insert_with(|| State::new(rule, evidence.classes));
        let mut touch = None;
        let mut is_silent = true;
        for (block, &of) in evidence.blocks().zip(&piece.blocks.touches) {
            if touch != Some(of) {
                state.onset();
                touch = Some(of);
            }
            if let Some(verdict) = state.block(block) {
                is_silent = false;
                at(n, state, Some(verdict));
            }
        }
        if is_silent {
            at(n, state, None);
        }
    }
}

struct Verdict {
    class: usize,
    posterior: f64,
    /// Since the decision before.
    blocks: u32,
}

struct State<'r> {
    rule: &'r Rule,
    /// Bits behind the leader.
    deficits: Vec<f64>,
    blocks: u32,
    /// Blocks of the touch, and the sums of their weighted entries, by table.
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
            *deficit = deficit.min(LIMIT_BITS);
        }
        self.touched = 0;
        self.sums.iter_mut().for_each(|sums| sums.fill(0.0));
    }

    /// Adds a block, `[table][class]`.
    fn block(&mut self, means: &[f64]) -> Option<Verdict> {
        let classes = self.deficits.len();
        let tables = means.chunks_exact(classes).zip(&self.rule.weights);
        for ((table, weight), sums) in tables.zip(&mut self.sums) {
            let of_classes = self.deficits.iter_mut().zip(sums).zip(table);
            for ((deficit, sum), mean) in of_classes {
                *deficit -= weight * mean;
                *sum += weight * (mean + f64::from(ENTRY_OFFSET_BITS));
            }
        }
        self.blocks += 1;
        self.touched += 1;
        if let Some(unknown) = self.rule.unknown {
            self.deficits[unknown] = f64::INFINITY;
        }
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
        Some(Verdict {
            class: leader,
            posterior,
            blocks: core::mem::take(&mut self.blocks),
        })
    }

    /// Mean weighted entries of a class since the onset, by table.
    fn entries(&self, class: usize) -> [f64; 2] {
        [0, 1].map(|table| self.sums[table][class] / f64::from(self.touched.max(1)))
    }
}
