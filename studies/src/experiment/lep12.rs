//! LEP12: sequential Bayes against maximum likelihood over fixed windows, the
//! template of the power spectrum and a neural network on it.

mod figures;
mod groups;
mod pairs;
mod spectral;

use super::{Floors, Recordings, Request, Stream, product};
use crate::page::{Page, beside, figure, row};
use crate::paper::lep10::FLOORS;
use crate::paper::lep12::{KNEE_S, MOTIONS, SEQUENTIAL_GAIN, TABLES, TIME_S};
use anyhow::{Context, Result};
use groups::{BLOCK, Curves, Group, Point, interpolate};
use spectral::power;

/// The group of both rotations.
const ROTATING: usize = 2;

const CHANCE: f64 = 100.0 / FLOORS.len() as f64;

pub(super) fn evaluate(page: &mut Page, request: &Request, recordings: &Recordings) -> Result<()> {
    // As many trials of natural motion as of each rotation.
    let floors = Floors::new(request, recordings, request.extent.trials);
    let rate_hz = floors.rate_hz;
    let groups = Group::all(&floors)?;
    page.heading(2, "LEP12: sequential Bayes");
    page.say(
        "The recordings of LEP10. Evidence is the mean log-likelihood of blocks of 20 samples; \
         the sequential rule decides where a posterior passes its threshold, the window after a \
         fixed time. The spectral methods take segments of 400 ms. Where the paper's template takes \
         the whole spectrum, ours ends at 120 Hz, as the network's does; the network learns by \
         L-BFGS, where the paper has scaled conjugate gradients. Each cell: the paper's percentage / \
         **ours**, as in the paper and drawn again.",
    );

    let mut curves = Vec::new();
    let mut rows: [Vec<[f64; 5]>; 4] = Default::default();
    let mut times = Vec::new();
    for group in &groups {
        let both = Curves::of(group, rate_hz)?;
        let window = group.window(floors.samples(TIME_S) as u32, rate_hz)?;
        let nearest = both.nearest().context("no threshold")?;
        times.push((nearest.parameter, nearest.time_s));
        rows[0].push(with_mean(window.tally.hits()));
        rows[1].push(with_mean(nearest.tally.hits()));
        rows[2].push(with_mean(spectral::template(group, rate_hz)?));
        rows[3].push(with_mean(spectral::network(group, rate_hz, request.seed)?));
        curves.push(both);
    }
    tables(page, &rows, &times);
    figures::all(page, &groups, &curves, rate_hz)?;
    claims(page, &rows, &curves);
    pairs::section(page, &groups[ROTATING], rate_hz)?;
    product(page, &groups, rate_hz)?;
    let names = [
        "maximum likelihood, window of 200 ms",
        "sequential Bayes, 200 ms on average",
        "template of the power spectrum, 400 ms",
        "network on the power spectrum, 400 ms",
    ];
    for (name, rows) in names.into_iter().zip(&rows) {
        let mean = rows[ROTATING][4];
        page.score(name, "four floors, rotating", mean, (CHANCE, Some(CHANCE)));
    }
    Ok(())
}

fn product(page: &mut Page, groups: &[Group], rate_hz: f64) -> Result<()> {
    let streams = |streams: &[Stream]| -> Result<Vec<_>> {
        let all = streams.iter().enumerate();
        let one = |(n, stream): (usize, &Stream)| {
            let pairs = stream.samples.as_chunks().0.to_vec();
            product::stream(FLOORS[stream.floor], n, pairs, None)
        };
        all.map(one).collect()
    };
    let task = |group: &Group| {
        let name = format!("four floors, {}", group.name);
        Ok((name, streams(&group.training)?, streams(&group.validation)?))
    };
    let tasks = groups.iter().map(task).collect::<Result<_>>()?;
    product::section(page, rate_hz, tasks)
}

fn with_mean(hits: [f64; 4]) -> [f64; 5] {
    let [a, b, c, d] = hits;
    [a, b, c, d, (a + b + c + d) / 4.0]
}

fn tables(page: &mut Page, rows: &[Vec<[f64; 5]>; 4], times: &[(f64, f64)]) {
    let header = format!("motion | {} | mean", FLOORS.join(" | "));
    for (table, ours) in TABLES.iter().zip(rows) {
        page.say(format_args!("**Table {}**: {}.", table.number, table.what));
        let line = |(motion, ours): (usize, &[f64; 5])| {
            let mean = beside(table.mean[motion], ours[4]);
            let floors = (0..4).map(|k| beside(table.percent[motion][k], ours[k]));
            row(MOTIONS[motion], floors.chain([mean]))
        };
        page.table(&header, ours.iter().enumerate().map(line));
        if table.number == 2 {
            let said = |(motion, (threshold, time)): (&&str, &(f64, f64))| {
                let time = figure(1000.0 * time, 0);
                format!("{motion} {time} ms at {}", figure(*threshold, 4))
            };
            let said: Vec<String> = MOTIONS.iter().zip(times).map(said).collect();
            let said = said.join("; ");
            page.say(format_args!(
                "Mean decision times nearest to 200 ms, and their thresholds: {said}."
            ));
        }
        if table.number == 3 {
            page.say(
                "The paper prints a mean of 48 % for rotating motion; its own floors give 59.5 %.",
            );
        }
    }
}

fn claims(page: &mut Page, rows: &[Vec<[f64; 5]>; 4], curves: &[Curves]) {
    // A placebo may decide nothing, and then hits nothing: it has no rate.
    let decided = |hit: f64| if hit > 0.0 { hit } else { f64::NAN };
    for (m, motion) in MOTIONS.iter().enumerate() {
        let ours = rows.each_ref().map(|table| table[m][4]);
        let [window, sequential, template, network] = ours;
        let [a, b, c, d] = ours.map(|rate| figure(rate, 1));
        let printed = [0, 1, 2, 3].map(|n| TABLES[n].mean[m]);
        let time_s = curves[m].nearest().map_or(TIME_S, |point| point.time_s);
        let fixed = interpolate(&curves[m].window, time_s);
        let gain = sequential - fixed;
        let [of_fixed, of_gain] = [fixed, gain].map(|rate| figure(rate, 1));
        let (least, _) = SEQUENTIAL_GAIN;
        page.claim(
            format_args!(
                "LEP12, {motion}: sequential beats the window by {least:.0} points or more at \
                 equal mean time"
            ),
            format_args!("{:+.0} points", printed[1] - printed[0]),
            format_args!("{b} against {of_fixed} %: {of_gain:+} points"),
            (gain - least, "points over those"),
        )
        .rests_on(decided(sequential), CHANCE);
        let [w, x, y, z] = printed;
        page.claim(
            format_args!("LEP12, {motion}: both beat the spectral template and the network"),
            format_args!("{w:.0} and {x:.0} against {y:.0} and {z:.0} %"),
            format_args!("{a} and {b} against {c} and {d} %"),
            (window.min(sequential) - template.max(network), "points"),
        )
        .rests_on(window, CHANCE);
    }
    let at = |time: f64| interpolate(&curves[ROTATING].sequential, time);
    let (first, knee, last) = (at(0.0), at(KNEE_S), at(1.0));
    let share = 100.0 * (knee - first) / (last - first);
    let [a, b, c] = [first, knee, last].map(|rate| figure(rate, 1));
    let of_gain = figure(share, 0);
    page.claim(
        "LEP12, rotating: most of the gain of the sequential rule comes within 100 ms",
        "dramatic up to 100 ms, slow after",
        format_args!(
            "{a} % at the shortest, {b} % at 100 ms, {c} % at the longest: {of_gain} % of the gain"
        ),
        (share - 50.0, "points over half of the gain"),
    )
    .rests_on(decided(last), CHANCE);
}
