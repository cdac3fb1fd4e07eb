//! The contacts, to train on and to test with, and how their signals are filtered: behind a notch at
//! the whisker's resonance POSE takes its features of texture (section II-C: "IIR notch filtered to
//! remove the resonant frequency").

use core::f64::consts::TAU;

use anyhow::{Context, Result};
use physics::Shaft;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

use crate::experiment::{Dataset, Recordings, Request, of_set};
use crate::rigs::{Chance, Contact, contacts, seed_of};

pub(super) type Signal = (Contact, Vec<f64>);

/// Half of the contacts to train on, the other half to test with: each set has every pose once.
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
        let (mut signals, mut both) = ([Vec::new(), Vec::new()], [Vec::new(), Vec::new()]);
        for pose in 0..poses {
            let first = chance.among(2);
            for time in [first, 1 - first] {
                let job = time * poses + pose;
                let (contact, recording) = (&contacts[job], all[job]);
                let samples = recording.segment(0, recording.len());
                let set = usize::from(time != first);
                both[set].push((*contact, samples.as_chunks().0.to_vec()));
                let x: Vec<f64> = samples.iter().step_by(2).copied().collect();
                let band = [table.high_pass_hz, table.low_pass_hz];
                signals[set].push((*contact, passed(x, band, table.tick_hz)?));
            }
        }
        let [training, testing] = signals;
        Ok(Self {
            training,
            testing,
            pairs: both,
            rate_hz: table.tick_hz,
            notch_quality: table.notch_quality,
        })
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

/// The lowest natural frequency of the table's whisker in free air, Hz.
pub(super) fn resonance_hz() -> Result<f64> {
    let modes = Shaft::xy_table().modes(1)?;
    let first = modes.modes.first().context("no mode")?;
    Ok(first.omega_rad_s / TAU)
}

/// A signal behind a notch at `hz`, `hz` / `quality` wide (at −3 dB), as if it had always rested
/// at its first value; the signal itself for a quality of 0:
/// H(z) = (1 − 2 c z⁻¹ + z⁻²)/(1 + a − 2 c z⁻¹ + (1 − a) z⁻²) with c = cos ω and
/// a = sin ω/(2 quality), the bilinear transform of the analogue notch.
pub(super) fn notched(x: &[f64], hz: f64, quality: f64, rate_hz: f64) -> Vec<f64> {
    if quality <= 0.0 {
        return x.to_vec();
    }
    let (sine, cosine) = libm::sincos(TAU * hz / rate_hz);
    let a = sine / (2.0 * quality);
    let rest = x.first().copied().unwrap_or(0.0);
    let (mut inputs, mut outputs) = ([rest; 2], [rest; 2]);
    let step = |&x: &f64| {
        let zeros = x - 2.0 * cosine * inputs[0] + inputs[1];
        let poles = 2.0 * cosine * outputs[0] - (1.0 - a) * outputs[1];
        let y = (zeros + poles) / (1.0 + a);
        inputs = [x, inputs[0]];
        outputs = [y, outputs[0]];
        y
    };
    x.iter().map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::{TAU, notched, passed};

    #[test]
    fn what_is_below_or_above_goes_and_the_rest_stays() {
        let wave = |hz: f64| move |n: i32| libm::sin(TAU * hz * f64::from(n) / 1e3);
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

    #[test]
    fn a_tone_at_the_notch_goes_and_others_and_the_mean_stay() {
        let rate_hz = 4000.0;
        let amplitude = |hz: f64| {
            let tone = |n: i32| 5.0 + libm::sin(TAU * hz * f64::from(n) / rate_hz);
            let x: Vec<f64> = (0..16_000).map(tone).collect();
            let y = notched(&x, 30.0, 5.0, rate_hz);
            let late = y.iter().skip(8_000).map(|y| y - 5.0);
            late.fold(0.0_f64, |most, y| most.max(y.abs()))
        };
        assert!(amplitude(30.0) < 1e-3, "{}", amplitude(30.0));
        // Half the power at the edges of its width, geometrically about its middle.
        let edge = 30.0 * (1.0 + 0.25 / 25.0_f64).sqrt() + 3.0;
        assert!((amplitude(edge) - 0.5_f64.sqrt()).abs() < 0.01);
        assert!((amplitude(200.0) - 1.0).abs() < 0.01);
        assert_eq!(notched(&[1.0, 2.0], 30.0, 0.0, rate_hz), [1.0, 2.0]);
    }
}
