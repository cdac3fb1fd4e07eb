//! How the head moves: whether a whisk has one peak or two, how long it touches, and what RCP leaves of
//! the deflection (BIOTACT Fig. 8); and one whisker against smooth plastic and against abrasive, with
//! and without RCP: x over time, and its spectrum over time (Fig. 12).

use anyhow::Result;

use crate::chart::{Mark, Series, linear, panel};
use crate::classifiers::{Bins, Spectrum};
use crate::experiment::shades::{self, Spectrogram};
use crate::experiment::{Dataset, Recording, Recordings, Request, of_set};
use crate::moments::range;
use crate::page::{Page, figure, row};
use crate::paper::biotact::{DISTANCES_MM, STRATEGIES, TEXTURES};
use crate::rigs::CHANNELS;
use crate::rigs::head::{COLUMNS, EARLY_DEG, early, number};

/// A rise and fall of θ' that makes a maximum a peak, degrees: θ' is smooth, and
/// an unmodulated whisk has no dip at all.
const PROMINENCE_DEG: f64 = 0.5;

/// Maxima of angles that are parted by dips of half a degree or more. What comes before the first
/// rise does not count: a recording may begin on the way down from a peak that is not its own.
fn peaks(angles: impl Iterator<Item = f64>) -> usize {
    let (mut count, mut rising, mut extreme) = (0, false, f64::INFINITY);
    for angle in angles {
        let further = if rising { f64::max } else { f64::min };
        extreme = further(extreme, angle);
        if rising && angle <= extreme - PROMINENCE_DEG {
            (count, rising, extreme) = (count + 1, false, angle);
        } else if !rising && angle >= extreme + PROMINENCE_DEG {
            (rising, extreme) = (true, angle);
        }
    }
    count
}

/// Contacts, given whether there is one at each tick; shorter gaps than `least` ticks part none.
fn contacts(touching: &[f64], least: usize) -> usize {
    let (mut count, mut gap) = (0, usize::MAX);
    for touches in touching {
        if *touches > 0.5 {
            count += usize::from(gap >= least);
            gap = 0;
        } else {
            gap = gap.saturating_add(1);
        }
    }
    count
}

fn column(visit: &Recording, from: usize, to: usize, column: usize) -> Vec<f64> {
    let rows = visit.part(from, to).chunks_exact(COLUMNS);
    rows.filter_map(|row| row.get(column).map(|x| f64::from(*x)))
        .collect()
}

/// Of the whisks of one visit: their largest θ', degrees, and the share of time in which the left
/// side touches, percent; the largest deflection |x| and the spread of x between whisks at the same
/// time, codes; the share of whisks with two peaks or more, percent; contacts of the left side a
/// whisk, parted by 10 ms or more. Whisks begin retracted, so that no whisk's peaks are cut in two.
fn movement(visit: &Recording, ticks: usize) -> [f64; 6] {
    let whisks = (visit.len() / ticks.max(1)).max(1);
    let (mut peak_deg, mut touching, mut deflection) = (0.0, 0.0, 0.0);
    let (mut biphasic, mut touches) = (0.0, 0.0);
    for whisk in 0..whisks {
        let part = |n| column(visit, whisk * ticks, (whisk + 1) * ticks, n);
        let (angle, contact) = (part(CHANNELS), part(CHANNELS + 2));
        let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        biphasic += f64::from(u8::from(peaks(angle.iter().copied()) > 1));
        peak_deg += most(&angle);
        touches += contacts(&contact, ticks / 50) as f64;
        touching += contact.iter().sum::<f64>() / ticks as f64;
        let bent: Vec<f64> = part(0).iter().map(|x| x.abs()).collect();
        deflection += most(&bent);
    }
    let share = 1.0 / whisks as f64;
    let spread = spread(visit, ticks, whisks);
    let (touching, biphasic) = (100.0 * share * touching, 100.0 * share * biphasic);
    let (peak_deg, deflection) = (share * peak_deg, share * deflection);
    [
        peak_deg,
        touching,
        deflection,
        spread,
        biphasic,
        share * touches,
    ]
}

/// Root mean square, over the whisk, of the standard deviation between whisks
/// of x of the left front whisker.
fn spread(visit: &Recording, ticks: usize, whisks: usize) -> f64 {
    let x = (0..whisks).map(|whisk| column(visit, whisk * ticks, (whisk + 1) * ticks, 0));
    let x: Vec<Vec<f64>> = x.collect();
    let mut sum = 0.0;
    for tick in 0..ticks {
        let now = || x.iter().filter_map(|whisk| whisk.get(tick));
        let count = now().count().max(1) as f64;
        let mean = now().sum::<f64>() / count;
        sum += now().map(|x| (x - mean) * (x - mean)).sum::<f64>() / count;
    }
    (sum / ticks.max(1) as f64).sqrt()
}

pub(super) fn section(page: &mut Page, request: &Request, recordings: &Recordings) {
    let all = of_set(recordings, Dataset::Head);
    let ticks = request.rigs.head.whisk_ticks();
    let smooth = TEXTURES.len() - 1;
    let mut visits = Vec::new();
    for (strategy, (name, _)) in STRATEGIES.iter().enumerate() {
        for (n, mm) in DISTANCES_MM.iter().enumerate() {
            visits.push((*name, format!("{mm:.0} mm"), number(strategy, smooth, n)));
        }
    }
    let names = STRATEGIES.iter().map(|strategy| strategy.0);
    for (n, name) in names.chain(["strong and fast RCP"]).enumerate() {
        visits.push((name, format!("at {EARLY_DEG:.0} degrees"), early(n)));
    }
    let mut rows = Vec::new();
    for (name, place, job) in visits {
        let found = movement(all[job], ticks).into_iter();
        let found = found.zip([1, 0, 0, 0, 0, 1]);
        let cells = found.map(|(value, digits)| figure(value, digits).to_string());
        rows.push(row(name, [place].into_iter().chain(cells)));
    }
    page.say(
        "**How the head moves** (smooth surface; left front whisker: mean of the largest θ' of a \
         whisk, share of time in contact, largest |x| in sensor codes, spread of x between whisks, share of whisks with two \
         peaks of θ' with a dip of half a degree or more between them, contacts a whisk). Strong and fast is σ_z = 2 and \
         τ_z = T_W/10 (Fig. 8); at 100 degrees is where the front whisker meets the \
         obstacle of that figure. The paper shows two contacts a whisk in its simulation only.",
    );
    page.table(
        "whisking | surface | peak, degrees | contact, % | deflection, codes | spread, codes | biphasic, % | contacts",
        rows,
    );
}

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

pub(super) fn histories(page: &mut Page, request: &Request, recordings: &Recordings) -> Result<()> {
    let all = of_set(recordings, Dataset::Head);
    let ticks = request.rigs.head.whisk_ticks();
    let rate_hz = request.rigs.head.tick_hz;
    let mut panels = Vec::new();
    let mut spectrograms = Vec::new();
    for texture in SHOWN {
        let mut curves = Vec::new();
        for (strategy, (name, _)) in STRATEGIES.iter().enumerate() {
            let visit = all[number(strategy, texture, DISTANCE)];
            let x = column(visit, ticks, 2 * ticks, 0);
            spectrograms.push(Spectrogram {
                title: format!("{}, {name}", TEXTURES[texture].0),
                time_s: ticks as f64 / rate_hz,
                highest_hz: HIGHEST_HZ,
                power: reassigned(&x, rate_hz)?,
            });
            let points = x.iter().enumerate().map(|(n, x)| (n as f64 / rate_hz, *x));
            curves.push(Series::curve(name, points.collect()));
        }
        let points = curves.iter().flat_map(|curve| &curve.points);
        let (low, high) = range(points.map(|point| point.1).chain([0.0]));
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
        "**Fig. 12**, reassigned spectrograms of the same whisks, 0 to {HIGHEST_HZ:.0} Hz over the \
         whisk: power under a Gaussian window of {:.0} ms, at the time and frequency that it comes \
         from, black the most of all, white {:.0} dB less.",
        1000.0 * WINDOW_S,
        shades::RANGE_DB
    ));
    let svg = shades::spectrograms(&spectrograms, STRATEGIES.len())?;
    let what = "Spectrograms of one whisk with and without RCP";
    page.picture("biotact-fig12-spectrograms.svg", what, svg);
    Ok(())
}

/// Power by times and frequencies of a signal without its mean, reassigned (BIOTACT Fig. 12:
/// `tfrrgab`; Flandrin, Auger and Chassande-Mottin 2003).
///
/// With the Gaussian w(t) = exp(−t²/2σ²), F = ∫ x(t) w(t − t₀) exp(−iω(t − t₀)) dt and G the same
/// with (t − t₀) w, |F|² moves from t₀ to t₀ + Re(G F*)/|F|², and, as w' = −t w/σ², from ω to
/// ω + Im(G F*)/(σ² |F|²).
fn reassigned(x: &[f64], rate_hz: f64) -> Result<Vec<Vec<f64>>> {
    let sigma = WINDOW_S * rate_hz;
    // Four standard deviations either way.
    let reach = (4.0 * sigma).ceil() as usize;
    let block = 2 * reach + 1;
    // Four times as fine as what is shown, in time and in frequency.
    let fine = 4 * FREQUENCIES;
    let points = (rate_hz * fine as f64 / HIGHEST_HZ).round() as usize;
    let bins = Bins {
        points: points.max(block),
        first: 0,
        count: fine,
    };
    let spectrum = Spectrum::new(bins);
    let mean = x.iter().sum::<f64>() / x.len().max(1) as f64;
    let mut all = vec![vec![0.0; FREQUENCIES]; TIMES];
    let step = (x.len() / (4 * TIMES)).max(1);
    for middle in (step / 2..x.len()).step_by(step) {
        let away = |n: usize| n as f64 - reach as f64;
        let windowed = |n: usize| {
            let at = (middle + n).checked_sub(reach).and_then(|at| x.get(at));
            at.map_or(0.0, |x| {
                (x - mean) * libm::exp(-0.5 * (away(n) / sigma).powi(2))
            })
        };
        let here = spectrum.complex((0..block).map(windowed))?;
        let lever = spectrum.complex((0..block).map(|n| away(n) * windowed(n)))?;
        for (bin, (here, lever)) in here.iter().zip(&lever).enumerate() {
            let power = here.norm_sqr();
            // No power moves nowhere: such a place is no number, and is in no cell.
            let moved = lever * here.conj() / power;
            let time = (middle as f64 + moved.re) / x.len() as f64;
            let turn = moved.im / (sigma * sigma) / core::f64::consts::TAU;
            let hz = bins.frequency(bin, rate_hz) + turn * rate_hz;
            let place = |share: f64, count: usize| {
                let is_inside = (0.0..1.0).contains(&share);
                is_inside.then_some((share * count as f64) as usize)
            };
            let (time, hz) = (place(time, TIMES), place(hz / HIGHEST_HZ, FREQUENCIES));
            let row = time.and_then(|time| all.get_mut(time));
            if let Some(cell) = row.zip(hz).and_then(|(row, hz)| row.get_mut(hz)) {
                *cell += power;
            }
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::{FREQUENCIES, HIGHEST_HZ, TIMES, peaks, reassigned};

    #[test]
    fn peaks_are_counted_by_the_dips_between_them() {
        let wave = |depth: f64| {
            (0..1000).map(move |n| {
                let t = f64::from(n) / 1000.0 * core::f64::consts::TAU;
                100.0 - 30.0 * t.cos() - depth * (2.0 * t).cos()
            })
        };
        assert_eq!(peaks(wave(0.0)), 1);
        // Maxima at cos t = −30/(4 depth), the dip at t = π between them is
        // (4 depth − 30)²/(8 depth): 0.24 degrees for 8.5, 3.4 for 12.
        assert_eq!(peaks(wave(8.5)), 1);
        assert_eq!(peaks(wave(12.0)), 2);
    }

    /// The frequency of most power at a time, Hz, and the share of that time's power in its cell.
    fn peak(power: &[Vec<f64>], time: usize) -> (f64, f64) {
        let row = &power[time];
        let most = row.iter().copied().fold(0.0, f64::max);
        let bin = row.iter().position(|x| *x == most).unwrap();
        let hz = (bin as f64 + 0.5) * HIGHEST_HZ / FREQUENCIES as f64;
        (hz, most / row.iter().sum::<f64>())
    }

    #[test]
    fn power_is_where_tones_and_chirps_and_clicks_are() {
        let signal = |of: fn(f64) -> f64| -> Vec<f64> {
            (0..1000).map(|n| of(f64::from(n) / 2000.0)).collect()
        };
        let tone = signal(|t| libm::sin(core::f64::consts::TAU * 121.0 * t));
        let power = reassigned(&tone, 2000.0).unwrap();
        assert_eq!(power.len(), TIMES);
        let (hz, share) = peak(&power, TIMES / 2);
        // All of a line is in one cell; under the window alone it is 20 Hz wide, three cells.
        assert!((hz - 121.0).abs() < 4.0 && share > 0.99, "{hz} {share}");
        // A chirp of 50 Hz + 300 Hz/s t is there as well, to a cell of 7.8 Hz.
        let chirp = signal(|t| libm::sin(core::f64::consts::TAU * (50.0 + 150.0 * t) * t));
        let power = reassigned(&chirp, 2000.0).unwrap();
        for time in [10, 20, 30] {
            let at = (time as f64 + 0.5) / TIMES as f64 * 0.5;
            let (hz, _) = peak(&power, time);
            assert!((hz - 50.0 - 300.0 * at).abs() < 5.0, "{hz} at {at}");
        }
        // A click is in its time's row: at a third, row 13 of 40.
        let click: Vec<f64> = (0..1000).map(|n| f64::from(u8::from(n == 333))).collect();
        let power = reassigned(&click, 2000.0).unwrap();
        let sums: Vec<f64> = power.iter().map(|row| row.iter().sum()).collect();
        assert!(sums[13] > 0.99 * sums.iter().sum::<f64>(), "{sums:?}");
    }
}
