//! Figs. 4 to 9 of LEP12.

use anyhow::Result;
use tactile::{SequentialRule, Threshold};

use super::{BLOCK, Curves, Group, Point, ROTATING, power};
use crate::chart::{Axis, Mark, Panel, Series, linear, panel, percent, top};
use crate::classifiers::{Bayes, Bins, Recogniser, Spectrum};
use crate::experiment::floors::{CHANNELS, hit_curves};
use crate::page::{Page, figure};
use crate::paper::lep10::FLOORS;
use crate::paper::lep12::{FIG7, FIG8_THRESHOLDS, FIG9_PEAK_HZ, SEGMENT_S};

/// How much of a stretch Fig. 7 shows, s; what takes longer is shown as that.
const SHOWN_S: f64 = 0.2;
/// Volts a sensor code.
const VOLTS: f64 = 5.0 / 16_384.0;

pub(super) fn all(
    page: &mut Page,
    groups: &[Group],
    curves: &[Curves],
    rate_hz: f64,
) -> Result<()> {
    distributions(page, groups)?;
    hit_rates(page, groups, curves)?;
    example(page, &groups[ROTATING], rate_hz)?;
    decision_times(page, &groups[ROTATING], rate_hz)?;
    spectra(page, &groups[0], rate_hz)
}

/// Fig. 4: how often each voltage occurs, per floor, channel and motion.
fn distributions(page: &mut Page, groups: &[Group]) -> Result<()> {
    let mut panels = Vec::new();
    for group in groups {
        let model = group.model.view();
        for (channel, axis) in ["x", "y"].into_iter().enumerate() {
            let Some(q) = model.quantiser(channel) else {
                continue;
            };
            let bins = model.bins(channel).unwrap_or(1);
            let unit = libm::exp2(-f64::from(q.exponent));
            let volts = |bin: usize| {
                let share = (bin as f64 + 0.5) / bins as f64;
                let code = f64::from(q.low) + share * (f64::from(q.high) - f64::from(q.low));
                (q.origin + code * unit) * VOLTS + 2.5
            };
            let curve = |(class, floor): (usize, &&str)| {
                let p = |bin| {
                    let log2 = model.log2_likelihood(channel, bin, class).unwrap_or(-20.0);
                    100.0 * libm::exp2(f64::from(log2))
                };
                Series::curve(floor, (0..bins).map(|bin| (volts(bin), p(bin))).collect())
            };
            let curves: Vec<Series> = FLOORS.iter().enumerate().map(curve).collect();
            let x = linear("V", volts(0), volts(bins.saturating_sub(1)));
            let y = linear("% a bin", 0.0, top(&curves));
            let title = format!("{}: {axis}", group.name);
            panels.push(panel(&title, x, y, &curves, Mark::Nothing));
        }
    }
    page.say("**Fig. 4**: how often each voltage occurs (bins of 10 mV, smoothed).");
    page.panels("lep12-fig4.svg", "Sampling distributions", &panels)
}

/// Figs. 5 and 6: hit rates against time and threshold.
fn hit_rates(page: &mut Page, groups: &[Group], curves: &[Curves]) -> Result<()> {
    let lines = |points: &[Point], x: &dyn Fn(&Point) -> f64| {
        hit_curves(points.iter().map(|p| (x(p), &p.tally)), "mean")
    };
    let (mut fixed, mut sequential) = (Vec::new(), Vec::new());
    for (group, both) in groups.iter().zip(curves) {
        let time = |points: &[Point]| Axis::decades("s", points.iter().map(|p| p.time_s));
        let window = lines(&both.window, &|p| p.time_s);
        let x = time(&both.window);
        fixed.push(panel(group.name, x, percent("%"), &window, Mark::Dot));
        let doubt = |p: &Point| 1.0 - p.parameter;
        let by_threshold = lines(&both.sequential, &doubt);
        let x = Axis::decades("1 − threshold", both.sequential.iter().map(doubt));
        let title = format!("{}: threshold", group.name);
        sequential.push(panel(&title, x, percent("%"), &by_threshold, Mark::Dot));
        let by_time = lines(&both.sequential, &|p| p.time_s);
        let title = format!("{}: mean decision time", group.name);
        let x = time(&both.sequential);
        sequential.push(panel(&title, x, percent("%"), &by_time, Mark::Dot));
    }
    page.say("**Fig. 5**: maximum likelihood, hit rate against the window.");
    page.panels("lep12-fig5.svg", "Hit rate against window", &fixed)?;
    page.say(
        "**Fig. 6**: sequential Bayes, hit rate against the threshold (left, as what is missing \
         to one) and against the mean decision time at that threshold (right).",
    );
    let what = "Hit rate against threshold and time";
    page.panels("lep12-fig6.svg", what, &sequential)
}

/// Fig. 7: posteriors of one stretch of rough carpet.
fn example(page: &mut Page, group: &Group, rate_hz: f64) -> Result<()> {
    let model = group.model.view();
    let never = Threshold::new(1.0 - 1e-12)?;
    let Some(stream) = group.validation.first() else {
        return Ok(());
    };
    let mut bayes = Bayes::<SequentialRule>::new(model, never)?;
    let mut curves = FLOORS.map(|floor| Series::curve(floor, Vec::new()));
    let mut passed = FIG7.map(|_| None);
    let shown = (SHOWN_S * rate_hz).round() as usize;
    let samples = stream.samples.chunks_exact(CHANNELS).take(shown);
    for (n, sample) in samples.enumerate() {
        bayes.push(sample);
        if (n + 1) % BLOCK as usize != 0 {
            continue;
        }
        let time_s = (n + 1) as f64 / rate_hz;
        let posteriors = bayes.posteriors();
        let most = posteriors.to_f64().fold(0.0, f64::max);
        for (found, (threshold, _)) in passed.iter_mut().zip(FIG7) {
            if most > threshold && found.is_none() {
                *found = Some(time_s);
            }
        }
        for (curve, p) in curves.iter_mut().zip(posteriors.to_f64()) {
            curve.points.push((time_s, p));
        }
    }
    let said = FIG7.iter().zip(passed).map(|((threshold, paper), ours)| {
        let ours = figure(1000.0 * ours.unwrap_or(SHOWN_S), 0);
        format!("{threshold}: {:.0} ms / **{ours} ms**", 1000.0 * paper)
    });
    let said: Vec<String> = said.collect();
    page.say(format_args!(
        "**Fig. 7**: posteriors at the beginning of a stretch of rough carpet. Thresholds passed \
         at (paper / ours): {}.",
        said.join("; ")
    ));
    let x = linear("s", 0.0, SHOWN_S);
    let y = linear("posterior", 0.0, 1.0);
    let panels = [panel("posterior probabilities", x, y, &curves, Mark::Dot)];
    page.panels("lep12-fig7.svg", "Posteriors", &panels)
}

/// Fig. 8: how decision times spread, per floor.
fn decision_times(page: &mut Page, group: &Group, rate_hz: f64) -> Result<()> {
    /// Width of a bar, s, and how many there are.
    const BAR_S: f64 = 0.02;
    const BARS: usize = 40;
    let model = group.model.view();
    let mut curves = FLOORS.map(|_| Vec::new());
    let mut means = Vec::new();
    for theta in FIG8_THRESHOLDS {
        let threshold = Threshold::new(theta)?;
        let mut cells = vec![format!("{theta}")];
        for (floor, curves) in curves.iter_mut().enumerate() {
            let mut counts = [0_u32; BARS];
            let (mut sum, mut count) = (0.0, 0_u32);
            let streams = group.validation.iter();
            for stream in streams.filter(|stream| stream.floor == floor) {
                let mut bayes = Bayes::<SequentialRule>::new(model, threshold)?;
                for outcome in bayes.outcomes(&stream.samples, CHANNELS) {
                    let time_s = f64::from(outcome.samples) / rate_hz;
                    let bar = ((time_s / BAR_S) as usize).min(BARS - 1);
                    counts[bar] += 1;
                    sum += time_s;
                    count += 1;
                }
            }
            let share = |n: u32| 100.0 * f64::from(n) / f64::from(count.max(1));
            let points = counts.iter().enumerate();
            let points = points.map(|(bar, n)| ((bar as f64 + 0.5) * BAR_S, share(*n)));
            let name = format!("threshold {theta}");
            curves.push(Series::curve(&name, points.collect()));
            let mean_s = sum / f64::from(count.max(1));
            cells.push(figure(1000.0 * mean_s, 0).to_string());
        }
        means.push(cells);
    }
    let panels = FLOORS.iter().zip(&curves).map(|(floor, curves)| {
        let x = linear("decision time, s", 0.0, BAR_S * BARS as f64);
        let y = linear("% of decisions", 0.0, top(curves));
        panel(floor, x, y, curves, Mark::Nothing)
    });
    let panels: Vec<Panel> = panels.collect();
    page.say(
        "**Fig. 8**: decision times, rotating motion (the last bar holds all longer ones); mean \
         times in ms below.",
    );
    page.panels("lep12-fig8.svg", "Decision times", &panels)?;
    page.table(&format!("threshold | {}", FLOORS.join(" | ")), means);
    Ok(())
}

/// Fig. 9: mean power spectra of anticlockwise motion.
fn spectra(page: &mut Page, group: &Group, rate_hz: f64) -> Result<()> {
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
            let mean = |power: f64| power / f64::max(count, 1.0);
            let points = sum.into_iter().enumerate();
            let points = points.map(|(bin, power)| (bins.frequency(bin, rate_hz), mean(power)));
            let points: Vec<(f64, f64)> = points.collect();
            let above = points.iter().filter(|(hz, _)| *hz >= 20.0);
            let peak = above.max_by(|a, b| a.1.total_cmp(&b.1));
            peaks.push(peak.map_or(0.0, |peak| peak.0));
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
