//! How the head moves: whether a whisk has one peak or two, how long it
//! touches, and what RCP leaves of the deflection (BIOTACT Fig. 8).

use crate::experiment::record::head::{COLUMNS, EARLY_DEG, early, number};
use crate::experiment::recording::{Dataset, Recording, Recordings, of_set};
use crate::experiment::request::Request;
use crate::page::{Page, figure, row};
use crate::paper::biotact::{DISTANCES_MM, STRATEGIES, TEXTURES};
use crate::rigs::CHANNELS;

/// A rise and fall of θ' that makes a maximum a peak, degrees: θ' is smooth, and
/// an unmodulated whisk has no dip at all.
const PROMINENCE_DEG: f64 = 0.5;

/// Maxima of angles that are parted by dips of half a degree or more. What comes
/// before the first rise does not count: a recording may begin on the way down
/// from a peak that is not its own.
fn peaks(angles: impl Iterator<Item = f64>) -> usize {
    let (mut count, mut rising, mut extreme) = (0, false, f64::INFINITY);
    for angle in angles {
        extreme = if rising {
            extreme.max(angle)
        } else {
            extreme.min(angle)
        };
        if rising && angle <= extreme - PROMINENCE_DEG {
            (count, rising, extreme) = (count + 1, false, angle);
        } else if !rising && angle >= extreme + PROMINENCE_DEG {
            (rising, extreme) = (true, angle);
        }
    }
    count
}

/// Contacts, given whether there is one at each tick; shorter gaps than `least`
/// ticks part none.
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

/// One column of a visit from tick `from` to `to`.
pub(super) fn column(visit: &Recording, from: usize, to: usize, column: usize) -> Vec<f64> {
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
    let [
        mut peak_deg,
        mut touching,
        mut deflection,
        mut biphasic,
        mut touches,
    ] = [0.0; 5];
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
    [
        share * peak_deg,
        100.0 * share * touching,
        share * deflection,
        spread(visit, ticks, whisks),
        100.0 * share * biphasic,
        share * touches,
    ]
}

/// Root mean square, over the whisk, of the standard deviation between whisks
/// of x of the left front whisker.
fn spread(visit: &Recording, ticks: usize, whisks: usize) -> f64 {
    let x: Vec<Vec<f64>> = (0..whisks)
        .map(|whisk| column(visit, whisk * ticks, (whisk + 1) * ticks, 0))
        .collect();
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
    let classified = STRATEGIES
        .iter()
        .enumerate()
        .flat_map(|(strategy, (name, _))| {
            let places = DISTANCES_MM.iter().enumerate();
            places.map(move |(n, mm)| (*name, format!("{mm:.0} mm"), number(strategy, smooth, n)))
        });
    let names = STRATEGIES.iter().map(|strategy| strategy.0);
    let names = names.chain(["strong and fast RCP"]).enumerate();
    let met = names.map(|(n, name)| (name, format!("at {EARLY_DEG:.0} degrees"), early(n)));
    let mut rows = Vec::new();
    for (name, place, job) in classified.chain(met) {
        let found = movement(all[job], ticks)
            .into_iter()
            .zip([1, 0, 0, 0, 0, 1]);
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

#[cfg(test)]
mod tests {
    use super::peaks;

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
}
