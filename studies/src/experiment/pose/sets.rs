//! The contacts, to train on and to test with.

use anyhow::Result;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

use crate::experiment::record::table::{Contact, contacts};
use crate::experiment::recording::{Dataset, Recordings, of_set};
use crate::experiment::request::Request;
use crate::rigs::{Chance, seed_of};

pub(super) type Signal = (Contact, Vec<f64>);

/// Half of the contacts to train on, the other half to test with: each set
/// has every pose once.
pub(super) struct Sets {
    pub(super) training: Vec<Signal>,
    pub(super) testing: Vec<Signal>,
    /// Both channels of each contact as it was, of either set.
    pub(super) pairs: [Vec<(Contact, Vec<[f64; 2]>)>; 2],
    pub(super) rate_hz: f64,
    /// Of the notch at the whisker's resonance, 0: none.
    pub(super) notch_quality: f64,
}

impl Sets {
    pub(super) fn new(request: &Request, recordings: &Recordings) -> Result<Self> {
        let all = of_set(recordings, Dataset::Table);
        let contacts = contacts(request.extent);
        let poses = contacts.len() / 2;
        let mut chance = Chance::new(seed_of(request.seed, &[20]));
        let table = &request.rigs.table;
        let mut sets = Self {
            training: Vec::new(),
            testing: Vec::new(),
            pairs: [Vec::new(), Vec::new()],
            rate_hz: table.tick_hz,
            notch_quality: table.notch_quality,
        };
        for pose in 0..poses {
            let first = chance.among(2);
            for time in [first, 1 - first] {
                let job = time * poses + pose;
                let (Some(contact), Some(recording)) = (contacts.get(job), all.get(job)) else {
                    continue;
                };
                let samples = recording.segment(0, recording.len());
                let pairs = samples.as_chunks().0.to_vec();
                sets.pairs[usize::from(time != first)].push((*contact, pairs));
                let x: Vec<f64> = samples.iter().step_by(2).copied().collect();
                let x = without_below(&x, table.high_pass_hz, table.tick_hz);
                let x = low_passed(x, table.low_pass_hz, table.tick_hz)?;
                if time == first {
                    sets.training.push((*contact, x));
                } else {
                    sets.testing.push((*contact, x));
                }
            }
        }
        Ok(sets)
    }
}

/// A signal without what is above `hz`, where that is above zero: bins of its transform beyond are
/// set to zero, so that nothing is delayed.
fn low_passed(x: Vec<f64>, hz: f64, rate_hz: f64) -> Result<Vec<f64>> {
    if hz <= 0.0 {
        return Ok(x);
    }
    let mut planner = RealFftPlanner::new();
    let (there, back) = (
        planner.plan_fft_forward(x.len()),
        planner.plan_fft_inverse(x.len()),
    );
    let (mut input, mut bins) = (x, there.make_output_vec());
    there.process(&mut input, &mut bins)?;
    let count = input.len() as f64;
    for (k, bin) in bins.iter_mut().enumerate() {
        if k as f64 * rate_hz / count > hz {
            *bin = Complex::default();
        }
    }
    back.process(&mut bins, &mut input)?;
    Ok(input.into_iter().map(|x| x / count).collect())
}

/// A signal without its harmonics below `hz`, as POSE sets X to zero below 6 Hz (eq. 5).
fn without_below(x: &[f64], hz: f64, rate_hz: f64) -> Vec<f64> {
    let mut left = x.to_vec();
    let count = x.len() as f64;
    let mut harmonic = 0.0;
    while harmonic * rate_hz / count < hz {
        let angle = core::f64::consts::TAU * harmonic / count;
        let wave = |n: usize| libm::sincos(angle * n as f64);
        let mut sums = [0.0; 2];
        for (n, x) in x.iter().enumerate() {
            let (sine, cosine) = wave(n);
            sums[0] += x * sine;
            sums[1] += x * cosine;
        }
        let share = if harmonic > 0.0 { 2.0 } else { 1.0 } / count;
        for (n, left) in left.iter_mut().enumerate() {
            let (sine, cosine) = wave(n);
            *left -= share * (sums[0] * sine + sums[1] * cosine);
        }
        harmonic += 1.0;
    }
    left
}

#[cfg(test)]
mod tests {
    use super::{low_passed, without_below};

    #[test]
    fn what_is_below_goes_and_the_rest_stays() {
        let wave =
            |hz: f64| move |n: i32| libm::sin(core::f64::consts::TAU * hz * f64::from(n) / 1e3);
        let (slow, fast) = (wave(5.0), wave(6.0));
        let both: Vec<f64> = (0..1000).map(|n| 3.0 + slow(n) + fast(n)).collect();
        let left = without_below(&both, 6.0, 1e3);
        let error = (0..1000).map(|n| (left[n as usize] - fast(n)).abs());
        assert!(error.fold(0.0, f64::max) < 1e-9);
        let left = low_passed(both.clone(), 5.5, 1e3).unwrap();
        let error = (0..1000).map(|n| (left[n as usize] - 3.0 - slow(n)).abs());
        assert!(error.fold(0.0, f64::max) < 1e-9);
        assert_eq!(low_passed(both.clone(), 0.0, 1e3).unwrap(), both);
        assert_eq!(without_below(&both, 0.0, 1e3), both);
    }
}
