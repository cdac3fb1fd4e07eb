//! The page of how what is touched stands: `docs/measured/standing.md` and `standing.csv`,
//! generated: by how much estimates of tilt and depth are wrong, after how much contact, and where
//! use differs from training.
//!
//! Trainings have seeds from 7601 on, tests from 7651 on: nothing else has them, and nothing is
//! chosen by what comes of them.

use anyhow::{Context, Result};
use host_sim::recording::Stream;
use host_sim::replay::Replay;
use host_sim::training::{How, Tables, TrainedModel};
use scene::Rule;
use tactile::Pose;
use tactile::score::Statistics;

use super::{Change, Extent, SPREAD, SURFACES, Setting, THRESHOLD, TICK_HZ};
use crate::chart::{Mark, Panel, Series, linear};
use crate::decisions::figures::{cell as csv_cell, mean_of, number, plus_minus};
use crate::page::{Files, Page, row};

const TRAINED: u64 = 7601;
const TESTED: u64 = 7651;
/// Seconds of a training, and of one in short.
const TRAINED_S: [f64; 2] = [240.0, 120.0];
/// A block.
const BLOCK_MS: f64 = 20.0;
/// What is estimated, and what guessing the middle of the spread comes to, degrees: ±3° and ±2° of
/// even chance.
const TARGETS: [(&str, f64); 2] = [("tilt", 1.732), ("depth", 1.155)];

/// Errors of an estimate and what was stated of them, of the decisions of a training.
type Errors = [Vec<[f64; 2]>; 2];

struct Cell {
    /// Of each class.
    errors: Vec<Errors>,
    shown: usize,
    decided: usize,
}

fn conditions() -> Vec<Option<Change>> {
    use Change::{CrossTalk, Friction, ScaleX, ScaleY, Turned, Whisk, Zero};
    let [less, more] = [0.7, 1.3].map(Friction);
    let sensor = [ScaleY(0.85), ScaleX(0.85), Zero([200.0, -200.0])];
    let turned = [CrossTalk(0.03), Turned(2.0), Turned(5.0), Whisk(2.2)];
    let changes = [&[less, more], &sensor[..], &turned].concat();
    let changes = changes.into_iter().map(Some);
    [None].into_iter().chain(changes).collect()
}

fn record(change: Option<Change>, seconds: f64, seed: u64) -> Result<Vec<Stream>> {
    let setting = Setting {
        seconds: Some(seconds),
        ..Setting::of(SPREAD, change.as_slice())
    };
    setting.record(seed)
}

pub(crate) fn page(extent: &Extent) -> Result<Files> {
    let [trainings, _] = extent.trainings;
    let [test_s, _] = extent.test_s;
    let trained_s = TRAINED_S[usize::from(extent.is_quick)];
    let seeds: Vec<u64> = (TRAINED..).take(trainings).collect();
    let models = extent.cores.each("models", &seeds, |seed| {
        let recording = (seed.to_string(), record(None, trained_s, *seed)?);
        Ok(How::of(Tables::Joint).train(&[recording], TICK_HZ)?)
    })?;
    let mut conditions = conditions();
    conditions.truncate(extent.conditions.saturating_add(1));
    let jobs: Vec<usize> = (0..conditions.len() * trainings).collect();
    let cells = extent.cores.each("conditions", &jobs, |&job| {
        let (condition, training) = (job / trainings, job % trainings);
        let seed = TESTED + job as u64;
        cell(&models[training], conditions[condition], test_s, seed)
    })?;

    let header = "condition,class,training,decisions,tilt_rms,tilt_stated,depth_rms,depth_stated";
    let mut page = Page::with_table("standing", header);
    introduction(&mut page, extent, [trained_s, test_s]);
    by_contact(&mut page, &models)?;
    at_decisions(&mut page, &conditions, &cells, &seeds);
    Ok(page.into_files())
}

fn introduction(page: &mut Page, extent: &Extent, [trained_s, test_s]: [f64; 2]) {
    page.title_of_command("How what is touched stands");
    page.say(format_args!(
        "With `classifier.pose` a decision for a class is followed by an estimate of the tilt of what \
         is touched and of the depth of contact: how far the whisk would go beyond where the shaft \
         meets the surface. Each has its error, the root mean square in poses that training held \
         out. Scene `bench-textures`: each presentation has a tilt within ±3°, an obstacle within ±2° \
         and readings within ±5 %; {} trainings of {trained_s} s each, with seeds from {TRAINED} on; \
         tested on {test_s} s each with seeds from {TESTED} on, which nothing else has. Guessing the \
         middle of the spread would be wrong by {:.2}° of tilt and {:.2}° of depth. Figures are root \
         mean squares, degrees, as means over trainings ± their standard errors.",
        extent.trainings[0], TARGETS[0].1, TARGETS[1].1
    ));
    page.say(
        "Friction turns a deflection as a tilt does. So there are weights for each class, and of a \
         surface whose own friction varies, as the carpet's does from piece to piece, the tilt is \
         hardly known: its stated error says so.",
    );
    page.say_if_quick(extent.is_quick, "trainings, conditions and presentations");
}

fn by_contact(page: &mut Page, models: &[TrainedModel]) -> Result<()> {
    page.heading(2, "Error against contact time");
    page.say(
        "Of touches in poses that were held out in training, if the class is known. A decision falls \
         after 100 to 180 ms of a touch.",
    );
    let errors: Vec<&Vec<Vec<[f64; 2]>>> = models
        .iter()
        .filter_map(|model| Some(&model.joint.as_ref()?.opinion.as_ref()?.pose_errors))
        .collect();
    let first = errors.first().context("no poses were learnt")?;
    let names: Vec<&str> = models[0].model.names().collect();
    let stages = first.first().map_or(0, Vec::len);
    let of = |class: usize, stage: usize, target: usize| {
        let at = move |of: &&Vec<Vec<[f64; 2]>>| of[class][stage][target];
        errors.iter().map(at)
    };
    let mut panels = Vec::new();
    let mut header = vec!["contact, ms".to_owned()];
    let mut rows: Vec<Vec<String>> = (1..=stages)
        .map(|stage| vec![number(BLOCK_MS * stage as f64, 0)])
        .collect();
    for (target, (name, guess)) in TARGETS.iter().enumerate() {
        let marks = [Mark::Dot, Mark::Ring, Mark::Cross, Mark::Nothing];
        let mut series = Vec::new();
        for (n, class) in names.iter().enumerate() {
            header.push(format!("{name}: {class}"));
            let mut points = Vec::new();
            for (stage, row) in rows.iter_mut().enumerate() {
                let mean = mean_of(of(n, stage, target));
                row.push(plus_minus(mean, 2));
                points.push((BLOCK_MS * (stage + 1) as f64, mean.0));
            }
            series.push(Series::new(class, n, marks[n % marks.len()], points));
        }
        let title = format!("error of {name}, degrees");
        let x = linear("contact, ms", 0.0, BLOCK_MS * stages as f64);
        let y = linear("degrees", 0.0, *guess * 1.1);
        panels.push(Panel::new(&title, x, y, series));
    }
    page.table(&header.join(" | "), rows);
    page.panels(
        "errors.svg",
        "Error of tilt and of depth against contact time, a curve a texture",
        &panels,
    )
}

/// Decisions of a model on fresh presentations.
fn cell(trained: &TrainedModel, change: Option<Change>, test_s: f64, seed: u64) -> Result<Cell> {
    let streams = record(change, test_s, seed)?;
    let threshold = THRESHOLD;
    let mut replay = Replay::new(trained.model.clone(), Rule::Sequential { threshold })?;
    let mut cell = Cell {
        errors: SURFACES.iter().map(|_| Errors::default()).collect(),
        shown: streams.len(),
        decided: 0,
    };
    for stream in &streams {
        let decided = replay.stream(stream)?;
        let truth = stream.stands.context("a presentation without its pose")?;
        cell.decided += usize::from(decided.iter().any(|d| d.pose.is_some()));
        for decided in decided {
            let is_named = |(name, _): &(&str, _)| *name == decided.decision;
            let class = SURFACES.iter().position(is_named);
            let (Some(class), Some(Pose { tilt, depth })) = (class, decided.pose) else {
                continue;
            };
            let estimates = cell.errors[class].iter_mut().zip([tilt, depth]);
            for ((of, estimate), truth) in estimates.zip(truth) {
                of.push([estimate.value() - truth, estimate.error()]);
            }
        }
    }
    Ok(cell)
}

fn root(errors: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|n| Statistics::of(errors.iter().map(|of| of[n])).map_or(f64::NAN, |s| s.rms))
}

fn at_decisions(page: &mut Page, conditions: &[Option<Change>], cells: &[Cell], seeds: &[u64]) {
    page.heading(2, "At decisions, where use differs from training");
    page.say(
        "Of named decisions on fresh presentations: found, and in brackets stated. *Within two* is the \
         share of estimates that lie within two stated errors; decided is the share of presentations \
         with a named class, percent. A sensor that is turned about the shaft turns every \
         deflection, which is what a tilt does: nothing that a whisker feels can set them apart, and \
         what is decided then is estimated wrongly by as much. So do another scale and another friction, \
         in part. The stated error is for the sensor and the surfaces of the training: it knows of such \
         changes only what differed between recordings.",
    );
    for (target, (what, _)) in TARGETS.iter().enumerate() {
        let mut rows = Vec::new();
        for (change, cells) in conditions.iter().zip(cells.chunks(seeds.len())) {
            let name = change.map_or_else(|| "as trained".to_owned(), |change| change.to_string());
            let sum = |of: fn(&Cell) -> usize| cells.iter().map(of).sum::<usize>() as f64;
            let decided = 100.0 * sum(|cell| cell.decided) / sum(|cell| cell.shown);
            let mut row_cells = vec![number(decided, 0)];
            for (class, (texture, _)) in SURFACES.iter().enumerate() {
                let of = |n: usize| {
                    let errors = cells.iter().map(|cell| &cell.errors[class][target]);
                    mean_of(errors.map(|errors| root(errors)[n]))
                };
                let [found, (stated, _)] = [0, 1].map(of);
                row_cells.push(format!("{} ({})", plus_minus(found, 2), number(stated, 2)));
                if target > 0 {
                    continue;
                }
                for (seed, cell) in seeds.iter().zip(cells) {
                    let roots = cell.errors[class].iter().flat_map(|of| root(of));
                    let count = cell.errors[class][0].len();
                    let mut figures = vec![seed.to_string(), count.to_string()];
                    figures.extend(roots.map(|root| csv_cell(root, 4)));
                    page.keep(&[&name.replace(',', ";"), texture], &figures);
                }
            }
            let errors = cells.iter().flat_map(|cell| &cell.errors);
            let all: Vec<&[f64; 2]> = errors.flat_map(|of| &of[target]).collect();
            let within = all.iter().filter(|of| of[0].abs() <= 2.0 * of[1]).count();
            row_cells.push(number(100.0 * within as f64 / all.len() as f64, 0));
            rows.push(row(name, row_cells));
        }
        let textures = SURFACES.map(|(name, _)| name).join(" | ");
        page.table(&format!("{what} | decided | {textures} | within two"), rows);
    }
}
