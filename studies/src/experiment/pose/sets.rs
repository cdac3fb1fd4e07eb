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
                let (contact, recording) = (&contacts[job], all[job]);
                let samples = recording.segment(0, recording.len());
                let pairs = samples.as_chunks().0.to_vec();
                sets.pairs[usize::from(time != first)].push((*contact, pairs));
                let x: Vec<f64> = samples.iter().step_by(2).copied().collect();
                let band = [table.high_pass_hz, table.low_pass_hz];
                let x = passed(x, band, table.tick_hz)?;
                let is_taught = time == first;
                if is_taught {
                    &mut sets.training
                } else {
                    &mut sets.testing
                }
                .push((*contact, x));
            }
        }
        Ok(sets)
    }
}

/// A signal without its harmonics below the first frequency, as POSE sets X to zero below 6 Hz
/// (eq. 5), and without what is above the second, where that is above zero: bins of its transform
/// are set to zero, so that nothing is delayed.
fn passed(x: Vec<f64>, [low_hz, high_hz]: [f64; 2], rate_hz: f64) -> Result<Vec<f64>> {
    if low_hz <= 0.0 && high_hz <= 0.0 {
        return Ok(x);
    }
    let mut planner = RealFftPlanner::new();
    let there = planner.plan_fft_forward(x.len());
    let back = planner.plan_fft_inverse(x.len());
    let (mut input, mut bins) = (x, there.make_output_vec());
    there.process(&mut input, &mut bins)?;
    let count = input.len() as f64;
    for (k, bin) in bins.iter_mut().enumerate() {
        let hz = k as f64 * rate_hz / count;
        if hz < low_hz || high_hz > 0.0 && hz > high_hz {
            *bin = Complex::default();
        }
    }
    back.process(&mut bins, &mut input)?;
    Ok(input.into_iter().map(|x| x / count).collect())
}

#[cfg(test)]
mod tests {
    use super::passed;

    #[test]
    fn what_is_below_or_above_goes_and_the_rest_stays() {
        let wave =
            |hz: f64| move |n: i32| libm::sin(core::f64::consts::TAU * hz * f64::from(n) / 1e3);
        let (slow, fast) = (wave(5.0), wave(6.0));
        let both: Vec<f64> = (0..1000).map(|n| 3.0 + slow(n) + fast(n)).collect();
        let errors = |band: [f64; 2], expected: &dyn Fn(i32) -> f64| {
            let left = passed(both.clone(), band, 1e3).unwrap();
            let errors = (0..1000).map(|n| (left[n as usize] - expected(n)).abs());
            errors.fold(0.0, f64::max)
        };
        assert!(errors([6.0, 0.0], &fast) < 1e-9);
        assert!(errors([0.0, 5.5], &|n| 3.0 + slow(n)) < 1e-9);
        assert_eq!(passed(both.clone(), [0.0; 2], 1e3).unwrap(), both);
    }
}
