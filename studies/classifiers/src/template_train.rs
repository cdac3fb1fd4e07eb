//! Training templates in double precision, and matching them on a PC.
//!
//! See [`crate::template`] for the rule and the words.

use std::vec;
use std::vec::Vec;

use crate::choice::Choice;
use crate::error::Error;
use crate::means::{Means, check_segment, check_window, squared_errors};
use crate::recogniser::{Outcome, Recogniser};
use crate::template::add_squares;
use tactile::Quantiser;

/// Adds up the training signals.
#[derive(Debug, Clone)]
pub struct TemplateTrainer {
    channels: usize,
    window: usize,
    means: Means,
    /// Least and largest value of each channel, and whether all are whole.
    ranges: Vec<(f64, f64)>,
    whole: bool,
}

impl TemplateTrainer {
    /// For signals of so many channels and, from where they are aligned, so
    /// many samples.
    ///
    /// # Errors
    ///
    /// No channels, or the window is out of range.
    pub fn new(channels: usize, window: usize) -> Result<Self, Error> {
        check_window(channels, window)?;
        Ok(Self {
            channels,
            window,
            means: Means::new(channels * window),
            ranges: vec![(f64::INFINITY, f64::NEG_INFINITY); channels],
            whole: true,
        })
    }

    /// Adds a signal of a class, sample by sample. What is beyond the window
    /// is left out.
    ///
    /// # Errors
    ///
    /// It is shorter than the window, or a number is not finite; it is then
    /// not added.
    pub fn add(&mut self, class: usize, segment: &[f64]) -> Result<(), Error> {
        check_segment(segment, self.channels, self.window)?;
        let length = self.channels * self.window;
        self.means
            .add(class, segment.iter().copied().take(length))?;
        for sample in segment.chunks_exact(self.channels).take(self.window) {
            for (range, &x) in self.ranges.iter_mut().zip(sample) {
                *range = (range.0.min(x), range.1.max(x));
                self.whole &= x.trunc() == x;
            }
        }
        Ok(())
    }

    /// Trains the templates.
    ///
    /// # Errors
    ///
    /// A class has no signal, or a range cannot be scaled.
    pub fn train(&self) -> Result<Templates, Error> {
        let means = self.means.means()?;
        let quantisers = quantisers(&self.ranges, self.whole).ok_or(Error::Range)?;
        let classes = means.len();
        let mut table = vec![0; self.window * classes * self.channels];
        let samples = table.chunks_exact_mut(classes * self.channels);
        for (t, templates) in samples.enumerate() {
            let templates = templates.chunks_exact_mut(self.channels);
            for (template, mean) in templates.zip(&means) {
                let mean = mean.iter().skip(t * self.channels);
                for ((entry, quantiser), &mean) in template.iter_mut().zip(&quantisers).zip(mean) {
                    *entry = code(quantiser, mean);
                }
            }
        }
        Ok(Templates {
            channels: self.channels,
            window: self.window,
            means,
            quantisers,
            table,
        })
    }
}

/// One scale for all channels, as their errors are added; room for twice the
/// range of training. Whole numbers of 15 bits keep their own codes, or whole
/// multiples of them, so that a board needs no arithmetic to make one.
fn quantisers(ranges: &[(f64, f64)], whole: bool) -> Option<Vec<Quantiser>> {
    let make = |origin, exponent| Quantiser {
        origin,
        exponent,
        low: i32::from(i16::MIN),
        high: i32::from(i16::MAX),
    };
    let largest = ranges
        .iter()
        .fold(0.0_f64, |most, (low, high)| most.max(-low).max(*high));
    if whole && largest < 32768.0 {
        let exponent = (0..=8)
            .take_while(|&e| largest * f64::from(1 << e) <= 16384.0)
            .last();
        return Some(vec![make(0.0, exponent.unwrap_or(0)); ranges.len()]);
    }
    let span = ranges
        .iter()
        .fold(0.0_f64, |most, (low, high)| most.max(high - low));
    if span != 0.0 && !(1e-280..=1e280).contains(&span) {
        return None;
    }
    // The exponent field of a normal number: span < 2^(e + 1) becomes at most
    // 2¹⁵ codes.
    let e = (span.to_bits() >> 52) as i32 - 1023;
    let exponent = if span == 0.0 { 0 } else { 14 - e };
    let middle = |(low, high): &(f64, f64)| f64::midpoint(*low, *high);
    Some(ranges.iter().map(|r| make(middle(r), exponent)).collect())
}

/// The code of a value, saturated to 16 bits.
fn code(quantiser: &Quantiser, x: f64) -> i16 {
    let code = quantiser.code_from_f64(x);
    code.clamp(quantiser.low, quantiser.high) as i16
}

/// Templates as trained.
#[derive(Debug, Clone, PartialEq)]
pub struct Templates {
    channels: usize,
    window: usize,
    /// Of each class, sample by sample.
    means: Vec<Vec<f64>>,
    quantisers: Vec<Quantiser>,
    /// `[sample][class][channel]`.
    table: Vec<i16>,
}

impl Templates {
    /// Number of classes K.
    pub fn classes(&self) -> usize {
        self.means.len()
    }

    /// From samples to codes, channel by channel; `low` and `high` are where
    /// codes saturate.
    pub fn quantisers(&self) -> &[Quantiser] {
        &self.quantisers
    }

    /// The table for a [`crate::template::Template`] of C channels and K classes.
    pub fn table(&self) -> &[i16] {
        &self.table
    }

    /// The mean signal of a class, sample by sample.
    pub fn mean(&self, class: usize) -> Option<&[f64]> {
        self.means.get(class).map(Vec::as_slice)
    }

    /// The sum of squared errors of a signal under each class (BIOTACT
    /// eq. 17), by the exact means, in units of the samples squared; over the
    /// window or over a shorter signal.
    pub fn errors(&self, segment: &[f64]) -> Vec<f64> {
        squared_errors(&self.means, segment)
    }

    /// A recogniser that gives what a board gives, to the bit.
    pub fn recogniser(&self) -> TemplateRecogniser<'_> {
        TemplateRecogniser {
            templates: self,
            at: 0,
            errors: vec![0; self.classes()],
        }
    }
}

/// Matches templates by the arithmetic of the board, for any number of
/// channels and classes.
#[derive(Debug, Clone)]
pub struct TemplateRecogniser<'t> {
    templates: &'t Templates,
    at: u32,
    errors: Vec<u64>,
}

impl Recogniser for TemplateRecogniser<'_> {
    fn push(&mut self, sample: &[f64]) -> Option<Outcome> {
        let Templates {
            channels,
            window,
            quantisers,
            table,
            ..
        } = self.templates;
        if sample.len() != *channels {
            return None;
        }
        let codes: Vec<i16> = quantisers
            .iter()
            .zip(sample)
            .map(|(q, &x)| code(q, x))
            .collect();
        let row = self.errors.len() * channels;
        let templates = table.chunks_exact(row).nth(self.at as usize)?;
        for (error, template) in self
            .errors
            .iter_mut()
            .zip(templates.chunks_exact(*channels))
        {
            *error = add_squares(*error, &codes, template);
        }
        self.at += 1;
        if self.at as usize == *window {
            return self.finish();
        }
        None
    }

    fn finish(&mut self) -> Option<Outcome> {
        let choice = Choice::least(&self.errors, self.at);
        self.reset();
        choice.map(Outcome::from)
    }

    fn reset(&mut self) {
        self.at = 0;
        self.errors.fill(0);
    }
}
