//! PSIK: eight sandpapers by the IMP of 33 vibrissae and a small network, with
//! more and more arcs; and two corridors recognised on the way through.

mod corridor;
mod maze;
mod own;
mod sweeps;

use anyhow::{Context, Result};
use rayon::prelude::*;
use tactile::score::Confusion;

use super::ranges;
use super::record::pad::PAPERS;
use super::recording::{Dataset, Recordings, of_set};
use super::request::Request;
use crate::chart::{Mark, Series, linear, panel, percent};
use crate::page::{Page, confusion, figure, row};
use crate::paper::psik::{ARCS, FIG6_THREE_ARCS, TABLE_2, VIBRISSAE};
use crate::rigs::seed_of;
use sweeps::{NAMES, Sweeps, hit, hit_of_p40, mean_hit};

const CHANCE: f64 = 100.0 / PAPERS as f64;
/// What counts as the paper's 90 to 95 %.
const ENOUGH: f64 = FIG6_THREE_ARCS.0;

/// Where each arc's vibrissae begin, and where the last ends.
fn borders() -> Vec<usize> {
    let mut borders = vec![0];
    for (count, _) in ARCS {
        borders.push(borders.last().copied().unwrap_or(0) + count);
    }
    borders
}

pub(super) fn evaluate(page: &mut Page, request: &Request, recordings: &Recordings) -> Result<()> {
    let sweeps = Sweeps::new(request, &of_set(recordings, Dataset::Pad));
    let (training, testing) = request.extent.sweeps();
    page.heading(2, "PSIK: many vibrissae");
    page.say(format_args!(
        "A pad of {VIBRISSAE} vibrissae in eight arcs swept over eight sandpapers \
         (`studies/rigs/pad.toml`); the IMP of each, summed over the sweep, goes to a network of 33–33–8 \
         units, whose penalty on weights is chosen by a fifth of the training sweeps that is held \
         out. {training} sweeps of each paper to train on and {testing} to test with, where the \
         paper has 300 and 100; training is by L-BFGS, where it is by iRPROP there. The \
         paper's grits vary from P180 to P50, and it does not say which lie between; here {} from \
         coarse to fine, of which P40 is ours.",
        NAMES.join(", ")
    ));

    let borders = borders();
    let seed = |n: usize| seed_of(request.seed, &[33, n as u64]);
    let more = (1..=ARCS.len())
        .into_par_iter()
        .map(|arcs| sweeps.score(0, borders[arcs], seed(arcs)))
        .collect::<Result<Vec<Confusion>>>()?;
    let single = (0..5)
        .into_par_iter()
        .map(|arc| sweeps.score(borders[arc], borders[arc + 1], seed(100 + arc)))
        .collect::<Result<Vec<Confusion>>>()?;
    let all = more.last().context("no arcs")?;

    let mean = mean_hit(&TABLE_2);
    page.say(format_args!(
        "**Table 2**: all vibrissae; a row is the true paper, a column what was decided. Mean \
         {mean:.1} % in the paper, **{} %** here of its own grades, P50 to P180, and **{} %** of P40. \
         Rates below are of its own grades, among all eight.",
        figure(hit(all), 1),
        figure(hit_of_p40(all), 1)
    ));
    let paper = |truth: usize, named: usize| TABLE_2[truth][named];
    confusion(page, &NAMES, &paper, all);
    figures(page, &more, &single, &borders)?;
    claims(page, &more);
    // Codes of 8 bits, as wide as those of 14.
    let most = 127.0 * 64.0;
    ranges::say(page, (request, recordings), (Dataset::Vibrissa, 2), most);
    let name = "IMP and network 33–33–8";
    page.score(name, "eight sandpapers", hit(all), (CHANCE, Some(CHANCE)));
    corridor::section(page, request, recordings)?;
    own::of_one_vibrissa(page, request, recordings)
}

fn figures(
    page: &mut Page,
    more: &[Confusion],
    single: &[Confusion],
    borders: &[usize],
) -> Result<()> {
    let points = more.iter().zip(borders.iter().skip(1));
    let points = points.map(|(score, count)| (*count as f64, hit(score)));
    let curve = Series::curve("mean performance", points.collect());
    let x = linear(
        "vibrissae, from the longest arc on",
        0.0,
        VIBRISSAE as f64 + 1.0,
    );
    let panels = [panel("Fig. 6", x, percent("%"), &[curve], Mark::Dot)];
    page.say(format_args!(
        "**Fig. 6**: with more and more arcs, the longest first. In the paper {:.0} to {:.0} % \
         from three arcs (15 vibrissae) on.",
        FIG6_THREE_ARCS.0, FIG6_THREE_ARCS.1
    ));
    let what = "Performance over the number of vibrissae";
    page.panels("psik-fig6.svg", what, &panels)?;
    let header: Vec<String> = (1..=ARCS.len()).map(|n| n.to_string()).collect();
    let cells = more
        .iter()
        .map(|score| format!("**{}**", figure(hit(score), 1)));
    let line = row("hit rate, %", cells);
    page.table(&format!("arcs | {}", header.join(" | ")), [line]);

    page.say(
        "**Fig. 7**: each of the five longer arcs alone, percent of each paper. Here as there \
         arcs differ in which papers they tell.",
    );
    let rows: Vec<Vec<String>> = single
        .iter()
        .enumerate()
        .map(|(arc, score)| {
            let mut cells = vec![format!("{} ({:.0} mm)", arc + 1, ARCS[arc].1)];
            cells.extend((0..PAPERS).map(|class| {
                let rate = score.hit_rate_of(class).unwrap_or(0.0);
                format!("**{}**", figure(100.0 * rate, 0))
            }));
            cells.push(format!("**{}**", figure(hit(score), 1)));
            cells
        })
        .collect();
    let header = format!("arc | {} | mean", NAMES.join(" | "));
    page.table(&header, rows);
    Ok(())
}

fn claims(page: &mut Page, more: &[Confusion]) {
    let rates: Vec<f64> = more.iter().map(hit).collect();
    let [one, two, three, all] = [0, 1, 2, 7].map(|n| rates[n]);
    let text = |rate: f64| figure(rate, 1);
    page.claim(
        "PSIK: more arcs help",
        "quickly rising with the number of vibrissae",
        format_args!(
            "{} % with one arc, {} with two, {} with three, {} with all",
            text(one),
            text(two),
            text(three),
            text(all)
        ),
        ((two - one).min(three - two).min(all - one), "points"),
    )
    .rests_on(all, CHANCE);
    let least = rates.iter().skip(2).copied().fold(100.0, f64::min);
    page.claim(
        format_args!("PSIK: {ENOUGH:.0} % or more from three arcs on"),
        format_args!("{:.0} to {:.0} %", FIG6_THREE_ARCS.0, FIG6_THREE_ARCS.1),
        format_args!(
            "{} % with three, at least {} % from there on",
            text(three),
            text(least)
        ),
        (least - ENOUGH, "points"),
    )
    .rests_on(three, CHANCE);
}
