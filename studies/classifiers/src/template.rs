//! Templates: the class whose mean training signal is nearest, by the sum of
//! squared errors over an aligned window (BIOTACT eq. 17, POSE eq. 1):
//! e(T_k) = Σ_t Σ_c (I_c(t) − T_k,c(t))², and the least wins.
//!
//! # Glossary
//!
//! - **template**: the mean of a class's training signals, sample by sample.
//! - **window**: the n samples of a template, counted from where its training
//!   signals were aligned (the start of a whisk, or a contact).
//! - **code**: a sample as a 16-bit integer.
//!
//! The errors are summed as samples come in, so no window is kept: the state
//! is 8 K + 8 bytes. A sample takes some 5 instructions a class and channel on a
//! Cortex-M4F (`docs/measured/instructions.csv`). The templates are the larger part: 2 n C K bytes.
//!
//! Sums are exact integers. What is lost is the rounding of a template to half
//! a code: e differs from that of the real mean by at most
//! Σ (|d| + 1/4), d being the differences in codes.
//!
//! Training, and the same for a PC: `template_train` (feature `train`).

use crate::choice::Choice;
use crate::error::Error;

/// K templates of C channels, read in place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Template<'a, const C: usize, const K: usize> {
    /// Of each sample, the classes' channels.
    table: &'a [[[i16; C]; K]],
}

/// What changes as samples come in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TemplateState<const K: usize> {
    /// The sample that comes next.
    at: u32,
    errors: [u64; K],
}

impl<'a, const C: usize, const K: usize> Template<'a, C, K> {
    /// From a table as it stands in flash: `[sample][class][channel]`.
    ///
    /// # Errors
    ///
    /// Not a whole number of samples.
    pub const fn new(table: &'a [i16]) -> Result<Self, Error> {
        let wrong = Error::Table {
            words: table.len(),
            a_sample: C * K,
        };
        if C == 0 || K == 0 || table.is_empty() || !table.len().is_multiple_of(C * K) {
            return Err(wrong);
        }
        let (channels, _) = table.as_chunks::<C>();
        let (table, _) = channels.as_chunks::<K>();
        if table.len() > u32::MAX as usize {
            return Err(wrong);
        }
        Ok(Self { table })
    }

    /// Samples in the window.
    pub const fn window(&self) -> usize {
        self.table.len()
    }

    /// The state before the first sample of a window.
    pub const fn state(&self) -> TemplateState<K> {
        TemplateState {
            at: 0,
            errors: [0; K],
        }
    }

    /// Takes one sample of all channels. The last one of the window decides;
    /// the next begins another.
    #[inline]
    pub fn push(&self, state: &mut TemplateState<K>, codes: &[i16; C]) -> Option<Choice> {
        let templates = self.table.get(state.at as usize)?;
        for (error, template) in state.errors.iter_mut().zip(templates) {
            *error = add_squares(*error, codes, template);
        }
        // A window is at most u32::MAX samples: each adds less than 2³² a
        // channel, so the sums stay below 2⁶⁴ for any memory there is.
        state.at += 1;
        if state.at as usize == self.table.len() {
            return self.finish(state);
        }
        None
    }

    /// The end of a signal before that of the window: decides by the samples
    /// so far (all templates have as many). `None` if there were none.
    pub fn finish(&self, state: &mut TemplateState<K>) -> Option<Choice> {
        let choice = Choice::least(&state.errors, state.at);
        *state = self.state();
        choice
    }
}

impl<const K: usize> TemplateState<K> {
    /// The error of each class so far, in codes².
    pub fn errors(&self) -> &[u64; K] {
        &self.errors
    }
}

/// `sum` + Σ_c (I_c − T_c)²; as signed numbers, whose long multiply and
/// accumulate is one instruction.
#[inline]
pub(crate) fn add_squares(sum: u64, codes: &[i16], template: &[i16]) -> u64 {
    let channels = codes.iter().zip(template);
    channels.fold(sum as i64, |sum, (&code, &template)| {
        // At most 65535 either way, so the square is below 2³².
        let d = i64::from(i32::from(code) - i32::from(template));
        sum.wrapping_add(d * d)
    }) as u64
}
