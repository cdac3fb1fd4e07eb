//! The instantaneous mean power (IMP) of a whisker pad (PSIK section 3.1).
//!
//! # Glossary
//!
//! - **deflection**: r = √(x² + y²) of a vibrissa, whichever way it bends.
//! - **peak**: where the deflection stops rising and falls: its derivative changes sign from plus
//!   to minus. Peak amplitude A is the deflection there.
//! - **peak period** T: from one peak to the next, samples.
//! - **IMP**: the mean of A/T over the peaks of a window; for a pure vibration it is amplitude
//!   times frequency.
//!
//! | deflection | IMP |
//! |---|---|
//! | x = A sin(2πft), y = 0: r = A \|sin\| | 2 A f: r has two peaks a turn |
//! | r = c + A sin(2πft), c ≥ A | (c + A) f |
//! | constant, or rising only | 0: no peaks |
//!
//! The amplitude is that of the deflection itself, as the paper has it, so a steady deflection
//! counts: a steadily bent whisker has a larger IMP at the same vibration.
//!
//! Integers throughout. Peaks are found by comparing squares, which is exact; the one square root
//! and the one division are taken at a peak. A/T is in units of 2⁻¹⁶ code a sample, at most 2⁻¹⁵
//! of itself and two units low.

use crate::paper::psik::VIBRISSAE;

/// √(x² + y²) of a square of at most 2³¹, in units of 2⁻¹⁶, rounded down: at most 2⁻¹⁵ of itself
/// low. Shifted up by an even number of places first, so that the integer root has 16 bits.
fn root(square: u32) -> u32 {
    // 16 for nought alone, whose root is nought however shifted.
    let places = (square.leading_zeros() / 2).min(15);
    (square << (2 * places)).isqrt() << (16 - places)
}

/// The peaks of one vibrissa so far.
#[derive(Default)]
struct Peaks {
    /// The square of the deflection at the last sample.
    last: u32,
    is_rising: bool,
    /// Samples since the largest of this rise, and since the last peak.
    age: u32,
    since: u32,
    /// Whether there was a peak: the first has no period.
    any: bool,
    /// Of A/T, in units of 2⁻¹⁶ code a sample.
    sum: u64,
    count: u32,
}

impl Peaks {
    /// As if falling from above all squares: what the first sample begins with is no peak.
    fn new() -> Self {
        Self {
            last: u32::MAX,
            ..Self::default()
        }
    }

    fn push(&mut self, codes: [i16; 2]) {
        let [x, y] = codes.map(|code| u32::from(code.unsigned_abs()));
        let square = x * x + y * y;
        self.since += 1;
        self.age += 1;
        if square > self.last {
            (self.is_rising, self.age) = (true, 0);
        } else if square < self.last && self.is_rising {
            if self.any {
                self.sum += u64::from(root(self.last) / (self.since - self.age));
                self.count += 1;
            }
            (self.is_rising, self.any, self.since) = (false, true, self.age);
        }
        self.last = square;
    }

    /// The mean of A/T over the peaks since the last call; nought if there were none. A peak
    /// counts where it is noticed, and its period may begin before.
    fn take(&mut self) -> u32 {
        // Each term is below 2³¹, and so is their mean.
        let mean = self.sum.checked_div(u64::from(self.count)).unwrap_or(0) as u32;
        (self.sum, self.count) = (0, 0);
        mean
    }
}

pub(crate) struct Imp {
    window: u32,
    vibrissae: [Peaks; VIBRISSAE],
    open: u32,
}

impl Imp {
    pub(crate) fn new(window: u32) -> Self {
        Self {
            window,
            vibrissae: std::array::from_fn(|_| Peaks::new()),
            open: 0,
        }
    }

    /// Takes a sample of all vibrissae, x and y in codes. With the last of a window comes the IMP
    /// of each over that window, in units of 2⁻¹⁶ code a sample.
    pub(crate) fn push(&mut self, codes: &[[i16; 2]; VIBRISSAE]) -> Option<[u32; VIBRISSAE]> {
        for (peaks, codes) in self.vibrissae.iter_mut().zip(codes) {
            peaks.push(*codes);
        }
        self.open += 1;
        if self.open < self.window {
            return None;
        }
        self.finish()
    }

    pub(crate) fn finish(&mut self) -> Option<[u32; VIBRISSAE]> {
        let is_open = std::mem::take(&mut self.open) > 0;
        is_open.then(|| self.vibrissae.each_mut().map(Peaks::take))
    }
}

#[cfg(test)]
mod tests {
    use super::{Imp, Peaks, VIBRISSAE, root};
    use proptest::prelude::*;

    /// The IMP of a signal in codes a sample, and the peaks that it is the mean of.
    fn imp_of(codes: impl Iterator<Item = [i16; 2]>) -> (f64, u32) {
        let mut peaks = Peaks::new();
        codes.for_each(|codes| peaks.push(codes));
        let count = peaks.count;
        (f64::from(peaks.take()) / 65536.0, count)
    }

    #[test]
    fn windows_share_peaks_out_and_lose_none() {
        // Peaks every 20 samples, of 10, 20, 30, … codes.
        let codes = |n: i32| {
            let top = 10 * (n / 20 + 1);
            [(top - (n % 20 - 10).abs() * top / 10) as i16, 0]
        };
        let mut imp = Imp::new(100);
        let mut windows: Vec<_> = (0..260)
            .filter_map(|n| imp.push(&[codes(n); VIBRISSAE]))
            .collect();
        windows.extend(imp.finish());
        assert!(imp.finish().is_none());
        // The peaks at 10, 30, …, 90 of 10 to 50: the first has no period.
        let means = [35.0, 80.0, 120.0].map(|mean| mean / 20.0);
        assert_eq!(windows.len(), means.len());
        for (window, mean) in windows.iter().zip(means) {
            assert!((f64::from(window[32]) / 65536.0 - mean).abs() < 4e-4);
        }
    }

    /// The definition, in double precision and with all deflections in hand.
    fn defined(codes: &[[i16; 2]]) -> (f64, u32) {
        // Of an exact square, so that deflections that are equal stay equal.
        let r = |[x, y]: [i16; 2]| (f64::from(x).powi(2) + f64::from(y).powi(2)).sqrt();
        let r: Vec<f64> = codes.iter().map(|codes| r(*codes)).collect();
        let mut tops: Vec<usize> = Vec::new();
        let mut rising = None;
        for n in 1..r.len() {
            if r[n] > r[n - 1] {
                rising = Some(n);
            } else if r[n] < r[n - 1] {
                tops.extend(rising.take());
            }
        }
        let rates = tops.windows(2).map(|t| r[t[1]] / (t[1] - t[0]) as f64);
        let count = tops.len().saturating_sub(1) as u32;
        (rates.sum::<f64>() / f64::from(count.max(1)), count)
    }

    proptest! {
        #[test]
        fn integers_are_within_their_bound_of_the_definition(
            steps in prop::collection::vec((-90_i16..90, -90_i16..90), 3..400),
        ) {
            let mut at = [0_i16; 2];
            let codes: Vec<[i16; 2]> = steps.iter().map(|(x, y)| {
                at = [at[0] / 2 + x, at[1] / 3 + y];
                at
            }).collect();
            let (exact, count) = defined(&codes);
            let (found, peaks) = imp_of(codes.into_iter());
            prop_assert_eq!(peaks, count);
            let least = exact * (1.0 - 1.0 / 32768.0) - 2.0 / 65536.0;
            prop_assert!(found <= exact && found >= least, "{} {}", found, exact);
        }

        #[test]
        fn roots_are_within_their_bound_and_never_high(square in 0_u32..=1 << 31) {
            let (exact, found) = (f64::from(square).sqrt(), f64::from(root(square)) / 65536.0);
            prop_assert!(found <= exact && found >= exact * (1.0 - 1.0 / 32768.0));
        }
    }
}
