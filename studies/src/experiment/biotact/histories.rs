//! One whisk against smooth plastic and against abrasive, with and without RCP:
//! x over time, and its spectrum over time (BIOTACT Fig. 12).

use crate::classifiers::spectrum::{Bins, Measure, Spectrum};
use anyhow::Result;

use super::movement::column;
use crate::chart::{Mark, Series, linear, panel};
use crate::experiment::record::head::number;
use crate::experiment::recording::{Dataset, Recording, Recordings, of_set};
use crate::experiment::request::Request;
use crate::experiment::spectrogram::{self, Spectrogram};
use crate::page::Page;
use crate::paper::biotact::{STRATEGIES, TEXTURES};

/// The distance of the figure: the middle one.
const DISTANCE: usize = 1;
/// The textures of the figure: smooth plastic and P240.
const SHOWN: [usize; 2] = [TEXTURES.len() - 1, 0];

/// Standard deviation of the Gaussian window of a spectrum, s.
const WINDOW_S: f64 = 0.008;
const TIMES: usize = 40;
const FREQUENCIES: usize = 32;
/// Highest frequency, Hz.
const HIGHEST_HZ: f64 = 250.0;

fn whisk(all: &[&Recording], ticks: usize, strategy: usize, texture: usize) -> Option<Vec<f64>> {
    let visit = all.get(number(strategy, texture, DISTANCE))?;
    Some(column(visit, ticks, 2 * ticks, 0))
}

pub(super) fn section(page: &mut Page, request: &Request, recordings: &Recordings) -> Result<()> {
    let all = of_set(recordings, Dataset::Head);
    let ticks = request.rigs.head.whisk_ticks();
    let rate_hz = request.rigs.head.tick_hz;
    let mut panels = Vec::new();
    let mut spectrograms = Vec::new();
    for texture in SHOWN {
        let mut curves = Vec::new();
        for (strategy, (name, _)) in STRATEGIES.iter().enumerate() {
            let Some(x) = whisk(&all, ticks, strategy, texture) else {
                continue;
            };
            spectrograms.push(Spectrogram {
                title: format!("{}, {name}", TEXTURES[texture].0),
                time_s: ticks as f64 / rate_hz,
                highest_hz: HIGHEST_HZ,
                power: gabor(&x, rate_hz)?,
            });
            let points = x.iter().enumerate().map(|(n, x)| (n as f64 / rate_hz, *x));
            curves.push(Series::curve(name, points.collect()));
        }
        let ends = curves.iter().flat_map(|curve| &curve.points);
        let (low, high) = ends.fold((0.0_f64, 0.0_f64), |(low, high), point| {
            (low.min(point.1), high.max(point.1))
        });
        let x = linear("s", 0.0, ticks as f64 / rate_hz);
        let y = linear("sensor codes", low, high);
        panels.push(panel(TEXTURES[texture].0, x, y, &curves, Mark::Nothing));
    }
    page.say(
        "**Fig. 12**, time histories: x of the left 80 mm whisker over one whisk at 10 mm. RCP \
         cuts the deflection short; textures differ less than strategies, as in the paper.",
    );
    let what = "One whisk with and without RCP";
    page.panels("biotact-fig12.svg", what, &panels)?;
    page.say(format_args!(
        "**Fig. 12**, spectrograms of the same whisks, 0 to {HIGHEST_HZ:.0} Hz over the whisk: power \
         under a Gaussian window of {:.0} ms, black the most of all, white {:.0} dB less (the paper \
         reassigns it to where it comes from, which sharpens lines and moves none).",
        1000.0 * WINDOW_S,
        spectrogram::RANGE_DB
    ));
    let svg = spectrogram::draw(&spectrograms, STRATEGIES.len())?;
    let what = "Spectrograms of one whisk with and without RCP";
    page.picture("biotact-fig12-spectrograms.svg", what, svg);
    Ok(())
}

/// Power by times and frequencies of a signal without its mean: |∫ x(t) w(t − t₀)
/// exp(−iωt) dt|² with a Gaussian w.
fn gabor(x: &[f64], rate_hz: f64) -> Result<Vec<Vec<f64>>> {
    // Four standard deviations either way.
    let reach = (4.0 * WINDOW_S * rate_hz).ceil() as usize;
    let block = 2 * reach + 1;
    let points = (rate_hz * FREQUENCIES as f64 / HIGHEST_HZ).round() as usize;
    let bins = Bins {
        points: points.max(block),
        first: 0,
        count: FREQUENCIES,
    };
    let spectrum = Spectrum::new(bins);
    let mean = x.iter().sum::<f64>() / x.len().max(1) as f64;
    let mut all = Vec::with_capacity(TIMES);
    for time in 0..TIMES {
        let middle = (2 * time + 1) * x.len() / (2 * TIMES);
        let block = (0..block).map(|n| {
            let at = (middle + n).checked_sub(reach).and_then(|at| x.get(at));
            let away = (n as f64 - reach as f64) / (WINDOW_S * rate_hz);
            at.map_or(0.0, |x| (x - mean) * libm::exp(-0.5 * away * away))
        });
        all.push(spectrum.of(block, Measure::Power)?);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::{FREQUENCIES, HIGHEST_HZ, TIMES, gabor};

    #[test]
    fn a_tone_in_the_second_half_is_where_it_is() {
        let rate_hz = 2000.0;
        let tone = |n: usize| {
            let phase = core::f64::consts::TAU * 125.0 * n as f64 / rate_hz;
            if n < 500 { 0.0 } else { libm::sin(phase) }
        };
        let x: Vec<f64> = (0..1000).map(tone).collect();
        let power = gabor(&x, rate_hz).unwrap();
        assert_eq!(power.len(), TIMES);
        let bin = (125.0 / HIGHEST_HZ * FREQUENCIES as f64) as usize;
        let late = &power[TIMES * 3 / 4];
        let most = late.iter().copied().fold(0.0, f64::max);
        assert_eq!(late[bin], most);
        // (Σ w/2)² = (σ √(2π)/2)² with σ = 16 samples.
        let expected = 16.0_f64.powi(2) * core::f64::consts::TAU / 4.0;
        assert!((most / expected - 1.0).abs() < 0.01, "{most} {expected}");
        assert!(power[TIMES / 4][bin] < 1e-6 * most);
    }
}
