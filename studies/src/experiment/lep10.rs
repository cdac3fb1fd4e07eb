//! LEP10: naive Bayes over fixed windows, on x, y and both; artificial motion
//! (turning on the spot) against natural motion (autonomous).

use super::{Dataset, Floors, Recordings, Request, Stream, Tally, hit_curves, ranges, train};
use crate::chart::{Series, over_windows};
use crate::page::{Page, bold, confusion, figure};
use crate::paper::lep10::{FIG4_KNEE_S, FIG4_LONG, FLOORS, TABLES, WINDOW_S};
use crate::rigs::RobotMotion;
use anyhow::Result;
use tactile::ModelBuf;

/// Windows of Fig. 4, samples: 0.5 ms to 1 s.
const WINDOWS: [u32; 11] = [1, 2, 5, 10, 20, 50, 100, 200, 400, 1000, 2000];
/// Channels of Tables I to III.
const CHANNELS: [(&str, &[usize]); 3] = [("x", &[0]), ("y", &[1]), ("x and y", &[0, 1])];
const SPOT: [RobotMotion; 2] = [RobotMotion::Anticlockwise, RobotMotion::Clockwise];
const NATURAL: [RobotMotion; 1] = [RobotMotion::Autonomous];

const CHANCE: f64 = 100.0 / FLOORS.len() as f64;
/// Vinyl, which falls the most in the paper.
const VINYL: usize = 3;

pub(super) fn evaluate(page: &mut Page, request: &Request, recordings: &Recordings) -> Result<()> {
    let floors = Floors::new(request, recordings, 2 * request.extent.trials);
    page.heading(2, "LEP10: naive Bayes over fixed windows");
    page.say(
        "A passive whisker dragged over four floors by a small robot (`studies/rigs/floor.toml`). \
         Likelihoods in bins of 10 mV, smoothed over 100 mV, from the first half of each trial \
         (four of each rotation, eight of natural motion); the second half is cut into windows. In the tables a row is the true floor, a column \
         what was decided, and a cell holds the paper's percentage and **ours**, as in the paper and drawn again.",
    );

    let window = floors.samples(WINDOW_S) as u32;
    let [training, validation] = floors.halves(&SPOT);
    let [natural, natural_validation] = floors.halves(&NATURAL);
    let mut hits = [[0.0; 4]; 5];
    let mut means = [0.0; 5];
    let models = CHANNELS.map(|(_, picked)| train(&training, picked, 1));
    let models: Vec<ModelBuf> = models.into_iter().collect::<Result<_>>()?;
    let both: &[usize] = &[0, 1];
    let of_natural = train(&natural, both, 1)?;
    for (n, table) in TABLES.iter().enumerate() {
        let (model, picked, streams) = match n {
            0..3 => (&models[n], CHANNELS[n].1, &validation),
            3 => (&models[2], both, &natural_validation),
            _ => (&of_natural, both, &natural_validation),
        };
        let tally = Tally::of_windows(streams, picked, model, window)?;
        hits[n] = tally.hits();
        means[n] = tally.mean_hit();
        page.say(format_args!(
            "**Table {}**, {}, 0.5 s: mean hit rate {:.0} % in the paper, **{} %** here.",
            table.number,
            table.what,
            table.mean,
            figure(means[n], 1)
        ));
        // The paper's columns are the true floors.
        let paper = |truth: usize, named: usize| table.percent[named][truth];
        confusion(page, &FLOORS, &paper, &tally.confusion);
    }

    let knee = figure_4(&floors, &models, &validation, page)?;
    for ((name, _), mean) in CHANNELS.into_iter().zip(means) {
        let name = format!("naive Bayes, window of 0.5 s, {name}");
        page.score(name, "four floors", mean, (CHANCE, Some(CHANCE)));
    }
    claims(page, &means, &hits, knee);
    let of = (request, recordings);
    ranges::say(page, of, (Dataset::Floor, 2), 8191.0);
    Ok(())
}

/// The figure; mean hit rates of both channels together at one sample, at the
/// knee and at the longest window.
fn figure_4(
    floors: &Floors<'_>,
    models: &[ModelBuf],
    validation: &[Stream],
    page: &mut Page,
) -> Result<[f64; 3]> {
    let mut panels = Vec::new();
    let mut means: Vec<Series> = Vec::new();
    for ((name, picked), model) in CHANNELS.iter().zip(models) {
        let mut points = Vec::new();
        for window in WINDOWS {
            let tally = Tally::of_windows(validation, picked, model, window)?;
            points.push((f64::from(window) / floors.rate_hz, tally));
        }
        let [curves @ .., mean] = hit_curves(points.iter().map(|(x, tally)| (*x, tally)), name);
        let title = format!("{name}: hit rate of each floor, %");
        panels.push(over_windows(&title, &curves));
        means.push(mean);
    }
    let at = |seconds: f64| {
        let points = means.last().map_or(&[][..], |curve| &curve.points);
        let found = points.iter().find(|(x, _)| *x >= seconds - 1e-9);
        found.or(points.last()).map_or(0.0, |(_, hit)| *hit)
    };
    let knee = [at(0.0), at(FIG4_KNEE_S), at(f64::INFINITY)];
    let header = "mean hit rate, % | 0.5 ms | 10 ms | 100 ms | 0.5 s | 1 s";
    let line = |curve: &Series| {
        let shown = [0, 4, 7, 9, 10].map(|n| figure(curve.points[n].1, 0));
        bold(&*curve.name, shown)
    };
    let rows: Vec<Vec<String>> = means.iter().map(line).collect();
    let mean = over_windows("mean hit rate, %", &means);
    page.say(format_args!(
        "**Fig. 4**: hit rate against the window. In the paper x alone and y alone reach about \
         {:.0} % and both together {:.0} % from 0.5 s on.",
        FIG4_LONG[0], FIG4_LONG[2]
    ));
    let what = "Hit rate against window";
    page.panels("lep10-fig4.svg", what, &panels)?;
    page.panels("lep10-fig4-means.svg", what, &[mean])?;
    page.table(header, rows);
    Ok(knee)
}

fn claims(page: &mut Page, means: &[f64; 5], hits: &[[f64; 4]; 5], knee: [f64; 3]) {
    let [x, y, both, transfer, _] = *means;
    let [of_x, of_y, of_both, of_transfer, of_natural] = means.map(|mean| figure(mean, 1));
    page.claim(
        "LEP10: x and y together beat either alone (0.5 s)",
        "79, 82: 92 %",
        format_args!("{of_x}, {of_y}: {of_both} %"),
        (both - x.max(y), "points"),
    )
    .rests_on(both, CHANCE);
    let share = 100.0 * (knee[1] - knee[0]) / (knee[2] - knee[0]);
    let [first, middle, last] = knee.map(|hit| figure(hit, 1));
    let of_gain = figure(share, 0);
    page.claim(
        "LEP10: most of the gain comes within 100 ms",
        "substantial up to 100 ms, modest after",
        format_args!(
            "{first} % at one sample, {middle} % at 100 ms, {last} % at 1 s: {of_gain} % of the gain"
        ),
        (share - 50.0, "points over half of the gain"),
    )
    .rests_on(knee[2], CHANCE);
    let [_, _, artificial, by_artificial, _] = hits;
    let falls: [f64; 4] = core::array::from_fn(|k| artificial[k] - by_artificial[k]);
    let others = falls.iter().take(VINYL).copied().fold(f64::MIN, f64::max);
    let [from, to] = [artificial, by_artificial].map(|hits| figure(hits[VINYL], 0));
    page.claim(
        "LEP10: the hit rate falls from artificial training to natural validation, that of \
         vinyl the most",
        "92 to 68 %, vinyl 98 to 20; natural training 81 %",
        format_args!(
            "{of_both} to {of_transfer} %, vinyl {from} to {to}; natural training {of_natural} %"
        ),
        ((both - transfer).min(falls[VINYL] - others), "points"),
    )
    .rests_on(both, CHANCE);
}
