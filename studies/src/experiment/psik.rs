//! PSIK: eight sandpapers by the IMP of 33 vibrissae and a small network, with
//! more and more arcs; and two corridors recognised on the way through.

mod corridor;
mod maze;

use std::ops::Range;

use anyhow::{Context, Result};
use rayon::prelude::*;
use tactile::score::Confusion;

use super::{Dataset, Recording, Recordings, Request, of_set, product, ranges};
use crate::chart::{Mark, Series, linear, panel, percent};
use crate::classifiers::network::{self, Network, Options, Row};
use crate::page::{Page, bold, confusion, figure};
use crate::paper::psik::{ARCS, CORRIDORS, FIG6_THREE_ARCS, RATE_HZ, TABLE_2, VIBRISSAE};
use crate::rigs::corridor::{COLUMNS, FELT, place as in_corridor};
use crate::rigs::pad::{PAPERS, place as on_paper};
use crate::rigs::seed_of;

const CHANCE: f64 = 100.0 / PAPERS as f64;
/// What counts as the paper's 90 to 95 %.
const ENOUGH: f64 = FIG6_THREE_ARCS.0;

/// Where each arc's vibrissae begin, and where the last ends.
fn borders() -> Vec<usize> {
    let all = (0..=ARCS.len()).map(|arcs| &ARCS[..arcs]);
    all.map(|arcs| arcs.iter().map(|(count, _)| count).sum())
        .collect()
}

pub(super) fn evaluate(page: &mut Page, request: &Request, recordings: &Recordings) -> Result<()> {
    let rows = sweeps(request, &of_set(recordings, Dataset::Pad));
    let (training, testing) = request.extent.sweeps;
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
    let more = |arcs: usize| score(&rows, 0..borders[arcs], seed(arcs));
    let single = |arc: usize| score(&rows, borders[arc]..borders[arc + 1], seed(100 + arc));
    let more = (1..=ARCS.len()).into_par_iter().map(more);
    let more = more.collect::<Result<Vec<Confusion>>>()?;
    let single = (0..5).into_par_iter().map(single);
    let single = single.collect::<Result<Vec<Confusion>>>()?;
    let all = more.last().context("no arcs")?;

    let mean = mean_hit(&TABLE_2);
    page.say(format_args!(
        "**Table 2**: all vibrissae; a row is the true paper, a column what was decided. Mean \
         {mean:.1} % in the paper, **{} %** here of its own grades, P50 to P180, and **{} %** of P40. \
         Rates below are of its own grades, among all eight.",
        figure(hit(all), 1),
        figure(hit_of(all, 0), 1)
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
    of_one_vibrissa(page, request, recordings)
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
    let most = VIBRISSAE as f64 + 1.0;
    let x = linear("vibrissae, from the longest arc on", 0.0, most);
    let panels = [panel("Fig. 6", x, percent("%"), &[curve], Mark::Dot)];
    page.say(format_args!(
        "**Fig. 6**: with more and more arcs, the longest first. In the paper {:.0} to {:.0} % \
         from three arcs (15 vibrissae) on.",
        FIG6_THREE_ARCS.0, FIG6_THREE_ARCS.1
    ));
    let what = "Performance over the number of vibrissae";
    page.panels("psik-fig6.svg", what, &panels)?;
    let header: Vec<String> = (1..=ARCS.len()).map(|n| n.to_string()).collect();
    let line = bold(
        "hit rate, %",
        more.iter().map(|score| figure(hit(score), 1)),
    );
    page.table(&format!("arcs | {}", header.join(" | ")), [line]);

    page.say(
        "**Fig. 7**: each of the five longer arcs alone, percent of each paper. Here as there \
         arcs differ in which papers they tell.",
    );
    let line = |(arc, (score, (_, mm))): (usize, (&Confusion, (usize, f64)))| {
        let rates = (0..PAPERS).map(|class| figure(hit_of(score, class), 0));
        let mean = figure(hit(score), 1);
        bold(format!("{} ({mm:.0} mm)", arc + 1), rates.chain([mean]))
    };
    let header = format!("arc | {} | mean", NAMES.join(" | "));
    page.table(&header, single.iter().zip(ARCS).enumerate().map(line));
    Ok(())
}

fn claims(page: &mut Page, more: &[Confusion]) {
    let rates: Vec<f64> = more.iter().map(hit).collect();
    let least = rates.iter().skip(2).copied().fold(100.0, f64::min);
    let [one, two, three, all] = [0, 1, 2, 7].map(|n| rates[n]);
    let [a, b, c, d, e] = [one, two, three, all, least].map(|rate| figure(rate, 1));
    let (low, high) = FIG6_THREE_ARCS;
    page.claim(
        "PSIK: more arcs help",
        "quickly rising with the number of vibrissae",
        format_args!("{a} % with one arc, {b} with two, {c} with three, {d} with all"),
        ((two - one).min(three - two).min(all - one), "points"),
    )
    .rests_on(all, CHANCE);
    page.claim(
        format_args!("PSIK: {ENOUGH:.0} % or more from three arcs on"),
        format_args!("{low:.0} to {high:.0} %"),
        format_args!("{c} % with three, at least {e} % from there on"),
        (least - ENOUGH, "points"),
    )
    .rests_on(three, CHANCE);
}

fn pairs(samples: &[f32]) -> impl Iterator<Item = [f64; 2]> + '_ {
    let (pairs, _) = samples.as_chunks();
    pairs.iter().map(|pair: &[f32; 2]| pair.map(f64::from))
}

/// The product's own rule on papers and corridors, by one vibrissa: the middle one of the longest
/// arc, of the left pad in corridors.
fn of_one_vibrissa(page: &mut Page, request: &Request, recordings: &Recordings) -> Result<()> {
    let (mut taught, mut asked) = (Vec::new(), Vec::new());
    for (job, sweep) in of_set(recordings, Dataset::Vibrissa).iter().enumerate() {
        let (paper, number) = on_paper(request.extent, job);
        let samples = pairs(&sweep.values).collect();
        // At both ends of a sweep it is in the air.
        let stream = product::stream(NAMES[paper], job, samples, Some(RATE_HZ))?;
        let is_taught = number < request.extent.sweeps.0;
        if is_taught { &mut taught } else { &mut asked }.push(stream);
    }
    let name = "eight sandpapers by one vibrissa".to_owned();
    let papers = (name, taught, asked);

    let (training, tested, _) = request.extent.runs;
    let (mut taught, mut asked) = (Vec::new(), Vec::new());
    for (job, run) in of_set(recordings, Dataset::Corridor).iter().enumerate() {
        let (case, number) = in_corridor(request.extent, job);
        let windows = run.part(0, run.len()).chunks_exact(COLUMNS);
        let samples = windows.flat_map(|window| pairs(&window[FELT..])).collect();
        let stream = product::stream(CORRIDORS[case], job, samples, None)?;
        if number < training - tested.min(training) {
            taught.push(stream);
        } else if number >= training {
            asked.push(stream);
        }
    }
    let name = "two corridors, both ways, by one vibrissa".to_owned();
    product::section(page, RATE_HZ, vec![papers, (name, taught, asked)])
}

/// Names of the sandpapers, from coarse to fine.
const NAMES: [&str; PAPERS] = ["P40", "P50", "P60", "P80", "P100", "P120", "P150", "P180"];

/// Penalties λ on weights that are tried; the paper names none. Trained to the
/// end with hardly any, 1400 weights fit the scatter of a few hundred sweeps.
const PENALTIES: [f64; 3] = [1e-5, 1e-4, 1e-3];

/// One sweep of so many is held out to choose the penalty.
const HELD_OUT: usize = 5;

/// The penalty is the best on sweeps held out of the training ones, the smallest of equals.
fn train_choosing(rows: &[Row], seed: u64) -> Result<Network> {
    let mut best = (0, Options::imp(seed).decay);
    let places = || rows.iter().enumerate();
    let kept = places().filter(|(n, _)| n % HELD_OUT != 0);
    let kept: Vec<Row> = kept.map(|(_, row)| row.clone()).collect();
    for penalty in PENALTIES {
        let network = train(&kept, seed, penalty)?;
        let mut hits = 0;
        for (_, (class, row)) in places().filter(|(n, _)| n % HELD_OUT == 0) {
            hits += usize::from(network.classify(row)? == *class);
        }
        if hits > best.0 {
            best = (hits, penalty);
        }
    }
    train(rows, seed, best.1)
}

fn train(rows: &[Row], seed: u64, penalty: f64) -> Result<Network> {
    let inputs = rows.first().map_or(0, |(_, row)| row.len());
    let options = Options {
        decay: penalty,
        hidden: inputs,
        ..Options::imp(seed)
    };
    network::train(rows, &options)
}

/// Rows to train on, and to test with.
fn sweeps(request: &Request, all: &[&Recording]) -> [Vec<Row>; 2] {
    let mut sweeps = [Vec::new(), Vec::new()];
    for (job, recording) in all.iter().enumerate() {
        let (paper, sweep) = on_paper(request.extent, job);
        let is_tested = sweep >= request.extent.sweeps.0;
        sweeps[usize::from(is_tested)].push((paper, recording.segment(0, 1)));
    }
    sweeps
}

/// Trains and tests with some of the vibrissae.
fn score(sweeps: &[Vec<Row>; 2], some: Range<usize>, seed: u64) -> Result<Confusion> {
    let [training, testing] = sweeps.each_ref().map(|rows| -> Vec<Row> {
        let some = |(class, row): &Row| (*class, row[some.clone()].to_vec());
        rows.iter().map(some).collect()
    });
    let network = train_choosing(&training, seed)?;
    let mut score = Confusion::new(PAPERS);
    for (class, row) in testing {
        score.add(class, Some(network.classify(&row)?))?;
    }
    Ok(score)
}

/// Hit rate of the paper's own grades, P50 to P180, percent, among all eight: P40 is ours.
fn hit(score: &Confusion) -> f64 {
    let own = (1..PAPERS).map(|class| score.hit_rate_of(class).unwrap_or(0.0));
    100.0 * own.sum::<f64>() / (PAPERS - 1) as f64
}

fn hit_of(score: &Confusion, class: usize) -> f64 {
    100.0 * score.hit_rate_of(class).unwrap_or(0.0)
}

fn mean_hit<const N: usize>(table: &[[f64; N]; N]) -> f64 {
    let hits = table.iter().enumerate().map(|(n, row)| row[n]);
    hits.sum::<f64>() / N as f64
}
