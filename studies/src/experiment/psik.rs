//! PSIK: eight sandpapers by the IMP of 33 vibrissae and a small network, with
//! more and more arcs; and two corridors told apart on the way through.

mod corridor;
mod why;

use classifiers::mlp::Network;
use classifiers::mlp::train::{Options, Trainer};
use rayon::prelude::*;
use tactile::score::Confusion;

use super::dataset::Dataset;
use super::page::{Section, confusion};
use super::paper::psik::{ARCS, FIG6_THREE_ARCS, TABLE_2, VIBRISSAE};
use super::picture::{Curve, FOLDER, linear, panel, percent};
use super::record::pad::{PAPERS, place};
use super::recording::{Recording, Recordings};
use super::request::Request;
use crate::accuracy::chart::{Mark, draw};
use crate::rigs::seed_of;
use host_sim::Error;

/// Names of the sandpapers, from coarse to fine.
const NAMES: [&str; PAPERS] = ["P40", "P50", "P60", "P80", "P100", "P120", "P150", "P180"];

fn refused(error: impl std::fmt::Display) -> Error {
    Error::Work(format!("PSIK: {error}"))
}

/// A row of the network's inputs, and its class.
type Row = (usize, Vec<f64>);

/// Penalties λ on weights that are tried; the paper names none. Learnt to the
/// end with hardly any, 1400 weights learn the scatter of a few hundred sweeps.
const PENALTIES: [f64; 3] = [1e-5, 1e-4, 1e-3];

/// One sweep of so many is held out to choose the penalty.
const HELD_OUT: usize = 5;

/// Learns a network with the penalty that does best on sweeps that are held out
/// of the learning ones, the smallest of equals; classes must come in order.
fn learn_choosing(rows: &[Row], seed: u64) -> Result<Network, Error> {
    let mut best = (0, Options::imp(seed).decay);
    let places = || rows.iter().enumerate();
    let kept = places().filter(|(n, _)| n % HELD_OUT != 0);
    let kept: Vec<Row> = kept.map(|(_, row)| row.clone()).collect();
    for penalty in PENALTIES {
        // A start is refused that never names some class: too large a penalty.
        let Ok(network) = learn(&kept, seed, penalty) else {
            continue;
        };
        let mut hits = 0;
        for (_, (class, row)) in places().filter(|(n, _)| n % HELD_OUT == 0) {
            hits += usize::from(network.classify(row).map_err(refused)? == *class);
        }
        if hits > best.0 {
            best = (hits, penalty);
        }
    }
    learn(rows, seed, best.1).or_else(|_| learn(rows, seed, PENALTIES[0]))
}

/// Learns a network with a penalty on its weights; classes must come in order.
fn learn(rows: &[Row], seed: u64, penalty: f64) -> Result<Network, Error> {
    let inputs = rows.first().map_or(0, |(_, row)| row.len());
    let mut options = Options::imp(seed);
    options.decay = penalty;
    options.hidden = inputs.max(1);
    // The paper sets no bar, and few vibrissae cannot tell every paper.
    options.reliable = 0.0;
    let mut trainer = Trainer::new(inputs, options).map_err(refused)?;
    for (class, row) in rows {
        trainer
            .add(&format!("class {class}"), row)
            .map_err(refused)?;
    }
    Ok(trainer.train().map_err(refused)?.network)
}

/// The sweeps, to learn from and to test with.
struct Sweeps {
    learning: Vec<Row>,
    testing: Vec<Row>,
}

impl Sweeps {
    fn new(request: &Request, all: &[&Recording]) -> Self {
        let mut sweeps = Self {
            learning: Vec::new(),
            testing: Vec::new(),
        };
        for (job, recording) in all.iter().enumerate() {
            let (paper, sweep) = place(request.scale, job);
            let row = (paper, recording.segment(0, 1));
            if sweep < request.scale.sweeps().0 {
                sweeps.learning.push(row);
            } else {
                sweeps.testing.push(row);
            }
        }
        sweeps
    }

    /// Learns and tests with the vibrissae from `from` up to `to`.
    fn score(&self, from: usize, to: usize, seed: u64) -> Result<Confusion, Error> {
        let cut = |rows: &[Row]| -> Vec<Row> {
            let some = |row: &Vec<f64>| row.get(from..to).unwrap_or(&[]).to_vec();
            rows.iter()
                .map(|(class, row)| (*class, some(row)))
                .collect()
        };
        let network = learn_choosing(&cut(&self.learning), seed)?;
        let mut score = Confusion::new(PAPERS);
        for (class, row) in cut(&self.testing) {
            let named = network.classify(&row).map_err(refused)?;
            score.add(class, Some(named)).map_err(refused)?;
        }
        Ok(score)
    }
}

/// Where each arc's vibrissae begin, and where the last ends.
fn borders() -> Vec<usize> {
    let mut borders = vec![0];
    for (count, _) in ARCS {
        borders.push(borders.last().copied().unwrap_or(0) + count);
    }
    borders
}

/// Hit rate of all trials, percent.
fn hit(score: &Confusion) -> f64 {
    100.0 * score.hit_rate().unwrap_or(0.0)
}

/// Evaluates the recordings.
pub(super) fn evaluate(request: &Request, recordings: &Recordings) -> Result<Section, Error> {
    let sweeps = Sweeps::new(request, &recordings.of(Dataset::Pad));
    let (learning, testing) = request.scale.sweeps();
    let mut section = Section::default();
    section.page.heading(2, "PSIK: many vibrissae");
    section.page.say(format_args!(
        "A pad of {VIBRISSAE} vibrissae in eight arcs swept over eight sandpapers \
         (`studies/rigs/pad.toml`); the IMP of each, summed over the sweep, goes to a network of 33–33–8 \
         units, whose penalty on weights is chosen by a fifth of the learning sweeps that is held \
         out. {learning} sweeps of each paper to learn from and {testing} to test with. The \
         paper names neither the eight grades nor their order; here {} from coarse to fine.",
        NAMES.join(", ")
    ));

    let borders = borders();
    let seed = |n: usize| seed_of(request.seed, &[33, n as u64]);
    let more: Result<Vec<Confusion>, Error> = (1..=ARCS.len())
        .into_par_iter()
        .map(|arcs| sweeps.score(0, borders[arcs], seed(arcs)))
        .collect();
    let more = more?;
    let single: Result<Vec<Confusion>, Error> = (0..5)
        .into_par_iter()
        .map(|arc| sweeps.score(borders[arc], borders[arc + 1], seed(100 + arc)))
        .collect();
    let single = single?;
    let all = more.last().ok_or_else(|| refused("no arcs"))?;

    let mean = TABLE_2
        .iter()
        .enumerate()
        .map(|(n, row)| row[n])
        .sum::<f64>()
        / 8.0;
    section.page.say(format_args!(
        "**Table 2**: all vibrissae; a row is the true paper, a column what was decided. Mean \
         {mean:.1} % in the paper, **{:.1} %** here.",
        hit(all)
    ));
    let names = NAMES.map(str::to_owned);
    confusion(
        &mut section.page,
        "true \\ decided",
        &names,
        &|row, column| Some(TABLE_2[row][column]),
        &|row, column| {
            let sum: u64 = (0..PAPERS).map(|k| all.count(row, k)).sum();
            100.0 * all.count(row, column) as f64 / sum.max(1) as f64
        },
    );
    figures(&mut section, &more, &single, &borders)?;
    let why = why::section(&mut section, request, &sweeps, &borders)?;
    claims(&mut section, &more, &why);
    section.score("IMP and network 33–33–8", "eight sandpapers", hit(all));
    corridor::section(&mut section, request, recordings)?;
    Ok(section)
}

fn figures(
    section: &mut Section,
    more: &[Confusion],
    single: &[Confusion],
    borders: &[usize],
) -> Result<(), Error> {
    let points = more.iter().zip(borders.iter().skip(1));
    let points = points.map(|(score, count)| (*count as f64, hit(score)));
    let curve = Curve::new("mean performance", points.collect());
    let x = linear(
        "vibrissae, from the longest arc on",
        0.0,
        VIBRISSAE as f64 + 1.0,
    );
    let panels = [panel("Fig. 6", x, percent("%"), &[curve], Mark::Dot)];
    section.page.say(format_args!(
        "**Fig. 6**: with more and more arcs, the longest first. In the paper {:.0} to {:.0} % \
         from three arcs (15 vibrissae) on.",
        FIG6_THREE_ARCS.0, FIG6_THREE_ARCS.1
    ));
    let what = "Performance over the number of vibrissae";
    section
        .page
        .picture_in(FOLDER, "psik-fig6.svg", what, draw(&panels)?);
    let header: Vec<String> = (1..=ARCS.len()).map(|n| n.to_string()).collect();
    let row = more.iter().map(|score| format!("**{:.1}**", hit(score)));
    let mut cells = vec!["hit rate, %".to_owned()];
    cells.extend(row);
    section
        .page
        .table(&format!("arcs | {}", header.join(" | ")), [cells]);

    section.page.say(
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
                format!("**{:.0}**", 100.0 * rate)
            }));
            cells.push(format!("**{:.1}**", hit(score)));
            cells
        })
        .collect();
    let header = format!("arc | {} | mean", NAMES.join(" | "));
    section.page.table(&header, rows);
    Ok(())
}

fn claims(section: &mut Section, more: &[Confusion], why: &str) {
    let rates: Vec<f64> = more.iter().map(hit).collect();
    let at = |arcs: usize| rates.get(arcs - 1).copied().unwrap_or(0.0);
    section.claim(
        "PSIK: more arcs help",
        "quickly rising with the number of vibrissae",
        format_args!(
            "{:.1} % with one arc, {:.1} with two, {:.1} with three, {:.1} with all",
            at(1),
            at(2),
            at(3),
            at(8)
        ),
        at(2) > at(1) && at(3) > at(2) && at(8) > at(1),
        why,
    );
    section.claim(
        "PSIK: 90 % or more from three arcs on",
        format_args!("{:.0} to {:.0} %", FIG6_THREE_ARCS.0, FIG6_THREE_ARCS.1),
        format_args!(
            "{:.1} % with three, at least {:.1} % from there on",
            at(3),
            rates.iter().skip(2).copied().fold(100.0, f64::min)
        ),
        rates.iter().skip(2).all(|rate| *rate >= 90.0),
        why,
    );
}
