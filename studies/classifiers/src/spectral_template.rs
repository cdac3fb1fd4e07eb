//! Spectral templates: the class whose mean training spectrum is nearest, by
//! the sum of squared errors over the bins that are used.
//!
//! | spectrum | block | source |
//! |---|---|---|
//! | [`Measure::Magnitude`], \|X\| | the whole trial | POSE eq. 2 |
//! | [`Measure::Power`], \|X\|² | 400 ms = 800 samples | LEP12 section 5.1 |
//!
//! LEP12's root-mean-square error is smallest where the sum of squared errors
//! is. Bins of several channels are added up, all weighing the same.
//!
//! A board steps a [`Bank`] a channel and sums errors once a block. In single
//! precision the error of a class differs from that in double precision by
//! what the bank's bins do (see [`crate::spectrum`]) and, from adding C B
//! squares, at most C B · 6e-8 of itself.
//!
//! Training, and the same for a PC: `spectral_train` (feature `train`).

use crate::choice::Choice;
use crate::spectrum::{Bank, BankState, Measure};

/// K templates of C channels and B bins: the bank and, read in place, the
/// means; 4 K C B bytes of flash.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectralTemplate<'a, const C: usize, const B: usize, const K: usize> {
    bank: Bank<B>,
    measure: Measure,
    means: &'a [[[f32; B]; C]; K],
}

/// What changes as samples come in: C (8 B + 4) bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectralState<const C: usize, const B: usize> {
    banks: [BankState<B>; C],
}

impl<'a, const C: usize, const B: usize, const K: usize> SpectralTemplate<'a, C, B, K> {
    /// Joins a bank and the mean spectra of the classes, in what the bank's
    /// bins are measured by.
    pub const fn new(bank: Bank<B>, measure: Measure, means: &'a [[[f32; B]; C]; K]) -> Self {
        Self {
            bank,
            measure,
            means,
        }
    }

    /// The state before the first sample.
    pub const fn state(&self) -> SpectralState<C, B> {
        SpectralState {
            banks: [self.bank.state(); C],
        }
    }

    /// Takes one sample of all channels; the last one of a block decides. At
    /// the end of a signal there is no decision: the spectrum of an open block is
    /// another than those trained on, and the next signal takes a new state.
    #[inline]
    pub fn push(&self, state: &mut SpectralState<C, B>, sample: &[f32; C]) -> Option<Choice> {
        let mut complete = false;
        for (bank, &x) in state.banks.iter_mut().zip(sample) {
            complete = self.bank.push(bank, x);
        }
        if complete { self.decide(state) } else { None }
    }

    #[inline(never)]
    fn decide(&self, state: &mut SpectralState<C, B>) -> Option<Choice> {
        let mut errors = [0.0_f32; K];
        for (channel, bank) in state.banks.iter().enumerate() {
            let bins = self.bank.read(bank, self.measure);
            for (error, means) in errors.iter_mut().zip(self.means) {
                for (x, mean) in means.get(channel).into_iter().flatten().zip(bins) {
                    let d = x - mean;
                    *error += d * d;
                }
            }
        }
        *state = self.state();
        Choice::least(&errors, self.bank.block())
    }
}
