//! Five numbers that say something of a contact (POSE eq. 3–7), and a
//! polynomial of some of them that names a class.
//!
//! | feature | | says something of |
//! |---|---|---|
//! | f1 = max M(t) | peak deflection | speed |
//! | f2 = f1 / t(f1) | slope to the peak, a second | angle |
//! | f3 = arg max \|X\| | modulation centroid, Hz | texture |
//! | f4 = max \|X\| | its magnitude | texture |
//! | f5 = Σ \|X\| | total magnitude | texture |
//!
//! M(t) is the deflection, sample minus rest. The time of the peak counts from
//! contact: from the sample before the deflection first reaches `onset` (from
//! the start if it never does), so that it is at least one sample. X is the
//! discrete Fourier transform of M over the block, at the bins of the bank
//! (POSE: 6 Hz to 1 kHz).
//!
//! Everything streams: the peak is two comparisons a sample, the spectrum is a
//! [`Bank`]. Single precision: f1 is exact but for the subtraction; f2 is within
//! 1e-6 of itself where no other sample is as high as the peak, or as near to
//! the onset, to that precision; f4 is as [`crate::spectrum`] says, f5 that as
//! often as there are bins; f3 is another where two bins are equal to that
//! precision.
//!
//! POSE notched the whisker's resonance out before taking X; use a bank without
//! the bins about it, or filter the samples first.
//!
//! Training, and the same for a PC: `feature_train` (feature `train`).

use crate::polynomial::{Polynomial, nearest};
use crate::spectrum::{Bank, BankState, Measure};

/// One of the five.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// f1, in units of the samples.
    Peak,
    /// f2, a second.
    Slope,
    /// f3, Hz.
    Centroid,
    /// f4, as |X|.
    CentroidMagnitude,
    /// f5, as |X|.
    TotalMagnitude,
}

impl Feature {
    /// All, in the order in which they stand in an array.
    pub const ALL: [Self; 5] = [
        Self::Peak,
        Self::Slope,
        Self::Centroid,
        Self::CentroidMagnitude,
        Self::TotalMagnitude,
    ];

    /// Its number of five.
    #[inline]
    pub fn of<T: Copy>(self, [f1, f2, f3, f4, f5]: &[T; 5]) -> T {
        match self {
            Self::Peak => *f1,
            Self::Slope => *f2,
            Self::Centroid => *f3,
            Self::CentroidMagnitude => *f4,
            Self::TotalMagnitude => *f5,
        }
    }
}

/// What the features are taken by; B bins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Features<const B: usize> {
    /// The sample of a free whisker.
    pub rest: f32,
    /// The deflection from which there is contact.
    pub onset: f32,
    /// Samples a second.
    pub rate_hz: f32,
    /// The resonators.
    pub bank: Bank<B>,
    /// Frequency of the first bin, Hz.
    pub first_hz: f32,
    /// From one bin to the next, Hz.
    pub step_hz: f32,
}

/// What changes as samples come in: 8 B + 20 bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeaturesState<const B: usize> {
    peak: f32,
    /// Samples so far.
    count: u32,
    /// The sample of contact and that of the peak, counted from one; contact
    /// is zero before there is any.
    contact: u32,
    peak_at: u32,
    bank: BankState<B>,
}

impl<const B: usize> Features<B> {
    /// The state before the first sample.
    pub const fn state(&self) -> FeaturesState<B> {
        FeaturesState {
            peak: f32::NEG_INFINITY,
            count: 0,
            contact: 0,
            peak_at: 0,
            bank: self.bank.state(),
        }
    }

    /// Takes a sample; the last of a block gives f1 to f5.
    #[inline]
    pub fn push(&self, state: &mut FeaturesState<B>, sample: f32) -> Option<[f32; 5]> {
        let deflection = sample - self.rest;
        state.count = state.count.saturating_add(1);
        if state.contact == 0 && deflection >= self.onset {
            state.contact = state.count;
        }
        if deflection > state.peak {
            state.peak = deflection;
            state.peak_at = state.count;
        }
        if self.bank.push(&mut state.bank, deflection) {
            Some(self.take(state))
        } else {
            None
        }
    }

    #[inline(never)]
    fn take(&self, state: &mut FeaturesState<B>) -> [f32; 5] {
        let bins = self.bank.read(&state.bank, Measure::Magnitude);
        let (mut at, mut most, mut total) = (0, 0.0_f32, 0.0_f32);
        for (bin, magnitude) in bins.into_iter().enumerate() {
            total += magnitude;
            if magnitude > most {
                (at, most) = (bin, magnitude);
            }
        }
        // Contact at the first sample: from just before it, as without contact.
        let before = state.contact.saturating_sub(1);
        let samples = state.peak_at.saturating_sub(before).max(1);
        let features = [
            state.peak,
            state.peak * self.rate_hz / samples as f32,
            self.first_hz + at as f32 * self.step_hz,
            most,
            total,
        ];
        *state = self.state();
        features
    }
}

/// A class and the real number that it is rounded from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The class, from zero.
    pub class: usize,
    /// The value of the polynomial.
    pub value: f32,
}

/// A polynomial of F chosen features that names one of some classes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeatureRule<'a, const F: usize> {
    /// The features chosen.
    pub chosen: [Feature; F],
    /// Of them.
    pub polynomial: Polynomial<'a, F>,
    /// How many classes there are.
    pub classes: usize,
}

impl<const F: usize> FeatureRule<'_, F> {
    /// What a block's features say.
    pub fn estimate(&self, features: &[f32; 5]) -> Estimate {
        let chosen = self.chosen.map(|feature| feature.of(features));
        let value = self.polynomial.value(&chosen);
        Estimate {
            class: nearest(value, self.classes),
            value,
        }
    }
}
