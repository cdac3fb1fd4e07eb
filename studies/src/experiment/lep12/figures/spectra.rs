//! Fig. 9 of LEP12: the power spectra of the whisker on each floor.

use crate::chart::{Mark, Series, linear, panel, top};
use crate::classifiers::spectrum::{Bins, Spectrum};
use crate::experiment::floors::CHANNELS;
use crate::experiment::lep12::groups::Group;
use crate::experiment::lep12::spectral::power;
use crate::page::{Page, figure};
use crate::paper::lep10::FLOORS;
use crate::paper::lep12::{FIG9_PEAK_HZ, SEGMENT_S};
use anyhow::Result;

/// Fig. 9: mean power spectra of anticlockwise motion.
pub(super) fn figure_9(page: &mut Page, group: &Group, rate_hz: f64) -> Result<()> {
    let block = (SEGMENT_S * rate_hz).round() as usize;
    let bins = Bins::between(block, rate_hz, 0.0, 120.0)?;
    let spectrum = Spectrum::new(bins);
    let mut panels = Vec::new();
    let mut peaks = Vec::new();
    for (channel, axis) in ["x", "y"].into_iter().enumerate() {
        let mut curves = Vec::new();
        for (floor, name) in FLOORS.iter().enumerate() {
            let mut sum = vec![0.0; bins.count];
            let mut count = 0.0;
            for stream in group.training.iter().filter(|stream| stream.floor == floor) {
                for segment in stream.samples.chunks_exact(block * CHANNELS) {
                    let power = power(&spectrum, segment, channel)?;
                    for (sum, power) in sum.iter_mut().zip(power) {
                        *sum += power;
                    }
                    count += 1.0;
                }
            }
            let points: Vec<(f64, f64)> = sum
                .iter()
                .enumerate()
                .map(|(bin, power)| (bins.frequency(bin, rate_hz), power / f64::max(count, 1.0)))
                .collect();
            let above = points.iter().filter(|(hz, _)| *hz >= 20.0);
            let peak = above
                .max_by(|a, b| a.1.total_cmp(&b.1))
                .map_or(0.0, |p| p.0);
            peaks.push(peak);
            curves.push(Series::curve(name, points));
        }
        let total: f64 = curves.iter().flat_map(|c| &c.points).map(|p| p.1).sum();
        for point in curves.iter_mut().flat_map(|curve| &mut curve.points) {
            point.1 *= 4.0 / total.max(f64::MIN_POSITIVE);
        }
        let x = linear("Hz", 0.0, 120.0);
        let y = linear("power / mean total", 0.0, top(&curves));
        panels.push(panel(axis, x, y, &curves, Mark::Nothing));
    }
    page.say(format_args!(
        "**Fig. 9**: mean power spectra over 400 ms, anticlockwise motion. The paper's peak at \
         {:.0} to {:.0} Hz; ours above 20 Hz, floor by floor: x {}, y {} Hz. That is no claim: \
         the stiffness of the follicle was chosen for a resonance at 35 Hz.",
        FIG9_PEAK_HZ.0,
        FIG9_PEAK_HZ.1,
        hertz(&peaks[..4]),
        hertz(&peaks[4..]),
    ));
    page.panels("lep12-fig9.svg", "Power spectra", &panels)
}

fn hertz(peaks: &[f64]) -> String {
    let text = peaks.iter().map(|hz| figure(*hz, 1).to_string());
    text.collect::<Vec<_>>().join(", ")
}
