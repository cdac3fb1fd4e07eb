//! The corridors of PSIK section 3.3: a network on the IMP of both pads votes
//! at every step; the most votes decide where to turn at the end.

use anyhow::Result;
use tactile::score::Confusion;

use super::{PENALTIES, maze, mean_hit, train};
use crate::classifiers::network::{Row, largest};
use crate::experiment::{Dataset, Recording, Recordings, Request, of_set};
use crate::page::{Page, confusion, figure};
use crate::paper::psik::{CORRIDORS, TABLE_3};
use crate::rigs::corridor::{COLUMNS, place};
use crate::rigs::{INPUTS, seed_of};

const CHANCE: f64 = 100.0 / CORRIDORS.len() as f64;
/// What counts as telling them, percent (chosen).
const ENOUGH: f64 = 75.0;

fn steps(run: &Recording) -> Vec<Vec<f64>> {
    let rows = run.part(0, run.len()).chunks_exact(COLUMNS);
    rows.map(|row| row.iter().take(INPUTS).map(|x| f64::from(*x)).collect())
        .collect()
}

pub(super) fn section(page: &mut Page, request: &Request, recordings: &Recordings) -> Result<()> {
    let runs = of_set(recordings, Dataset::Corridor);
    let (training, tested, deciding) = request.extent.runs;
    let taught = training.saturating_sub(tested);
    let mut rows: Vec<Row> = Vec::new();
    for (job, run) in runs.iter().enumerate() {
        let (case, number) = place(request.extent, job);
        if number < taught {
            rows.extend(steps(run).into_iter().map(|row| (case, row)));
        }
    }
    let network = train(&rows, seed_of(request.seed, &[66]), PENALTIES[0])?;

    let (mut by_run, mut by_step) = (Confusion::new(4), Confusion::new(4));
    let (mut off, mut squares, mut count) = (0.0_f64, 0.0, 0.0_f64);
    let mut finished = 0;
    for (job, run) in runs.iter().enumerate() {
        let (case, number) = place(request.extent, job);
        let mut votes = [0_u32; 4];
        for row in steps(run) {
            let named = network.classify(&row)?;
            votes[named] += 1;
            if (taught..training).contains(&number) {
                by_step.add(case, Some(named))?;
            }
        }
        if number < training {
            continue;
        }
        by_run.add(case, Some(largest(&votes)))?;
        finished += 1;
        for row in run.part(0, run.len()).chunks_exact(COLUMNS) {
            let aside = f64::from(row[INPUTS]);
            off = off.max(aside.abs());
            squares += aside * aside;
            count += 1.0;
        }
    }
    let hit = 100.0 * by_run.hit_rate().unwrap_or(0.0);
    let paper = mean_hit(&TABLE_3);
    page.say(format_args!(
        "**Corridors** (`studies/rigs/corridor.toml`): the robot keeps to the middle by D = (1/N) Σ (1 − \
         V_i) L_i of either side and V_y = (D_left − D_right) · 0.01. {taught} runs of each \
         corridor and direction to train on, {tested} to test with (**{} %** of single \
         steps right), {deciding} to decide in. Over these {finished} runs the neck is off the \
         middle by **{} mm** in root mean square and {} mm at most; the corridor leaves 50.",
        figure(100.0 * by_step.hit_rate().unwrap_or(0.0), 0),
        figure(1000.0 * (squares / count.max(1.0)).sqrt(), 1),
        figure(1000.0 * off, 0),
    ));
    page.say(format_args!(
        "**Table 3**: a row is the true corridor and direction, a column what was decided. Mean \
         {paper:.0} % in the paper, **{} %** here.",
        figure(hit, 0)
    ));
    let printed = |truth: usize, named: usize| TABLE_3[truth][named];
    confusion(page, &CORRIDORS, &printed, &by_run);
    page.claim(
        format_args!(
            "PSIK: the robot tells two corridors and their directions apart on its way, \
                 steering by touch ({ENOUGH:.0} % or more)"
        ),
        format_args!("{paper:.0} %"),
        format_args!("{} %", figure(hit, 1)),
        (hit - ENOUGH, "points"),
    )
    .rests_on(hit, CHANCE);
    page.score(
        "IMP and network 66–66–4, votes",
        "two corridors, both ways",
        hit,
        (CHANCE, Some(CHANCE)),
    );
    if request.is_whole {
        page.is_alone = true;
        maze::section(page, request, &network)?;
        page.is_alone = false;
    }
    Ok(())
}
