//! The page of decisions: `docs/measured/decisions.md`, its table and its pictures, generated.
//!
//! Each section is a module that measures and appends its text, tables and pictures; the figures of
//! each model stand in `decisions.csv`, too: the mean posterior that is *stated*, and the share of right
//! decisions that is *found*. All of it is the same, byte for byte, in every run and on any number of
//! cores.

mod air;
pub(crate) mod figures;
mod goals;
mod ground;
mod main_job;
pub(crate) mod placebo;
mod run_time;
mod terrain;

use std::ops::Range;
use std::path::Path;

use anyhow::Result;

use crate::accuracy::schemes::Counts;
use crate::cores::Cores;
use crate::page::{Files, Page};
pub(crate) use figures::percent;
use figures::{Figures, Goal, known_refused, mean_of, number, over, plus_minus};
use goals::{Trained, measure};
use ground::{Ground, LONGEST_S, record_all, score_on};
pub(crate) use placebo::permuted;

/// How much is measured. Training seeds are none of those scored.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Extent {
    pub(crate) is_quick: bool,
    pub(crate) cores: Cores,
    /// Seeds of the runs that are trained on; the first is that of the shipped models.
    pub(crate) trainings: Vec<u64>,
    pub(crate) scored: Range<u64>,
    pub(crate) main_job: Range<u64>,
    /// How long a free whisker is moved, s.
    pub(crate) air_s: f64,
    /// How many drives are held out; the rest only serve to train.
    pub(crate) drives: usize,
    pub(crate) values: usize,
}

impl Extent {
    pub(crate) fn new(is_quick: bool, cores: Cores) -> Self {
        let others = if is_quick { 41..41 } else { 41..50 };
        let most = if is_quick { 2 } else { usize::MAX };
        Self {
            is_quick,
            cores,
            trainings: [3].into_iter().chain(others).collect(),
            scored: 600..if is_quick { 602 } else { 620 },
            main_job: 600..if is_quick { 603 } else { 700 },
            air_s: if is_quick { 10.0 } else { 600.0 },
            drives: most,
            values: most,
        }
    }
}

/// `docs` is where `instructions.csv` is read, `terrain` where `terrain-train.csv` and
/// `terrain-test.csv` are.
pub(crate) fn page(docs: &Path, terrain: &Path, extent: &Extent) -> Result<Files> {
    let counts = Counts::read(&docs.join("instructions.csv"))?;
    let mut page = Page::with_table("decisions", figures::HEADER);
    introduction(&mut page, extent);

    let grounds = Ground::all(extent)?;
    goals::section(&mut page, &grounds);
    main_job::section(&mut page, extent)?;
    placebo::unknown(&mut page, &grounds, extent)?;
    air::section(&mut page, &grounds, extent)?;
    placebo::section(&mut page, &grounds, extent)?;
    terrain::section(&mut page, terrain, extent)?;
    goals::calibration(&mut page, &grounds)?;
    run_time::section(&mut page, &grounds, &counts, extent)?;
    Ok(page.into_files())
}

fn introduction(page: &mut Page, extent: &Extent) {
    page.title_of_command("Decisions");
    page.say(
        "What the classifier's decisions are worth, each figure beside its goal. All are \
         measured with the code behind `host-sim train`, `score` and `evaluate`, whose \
         classifier is the one that a board runs.",
    );
    let Extent {
        trainings, scored, ..
    } = extent;
    let others: Vec<String> = trainings.iter().map(u64::to_string).collect();
    page.say(format_args!(
        "Each model is trained on one run of its scene, with seed {} (the first is the model \
         that is shipped), and scored on {} others, with seeds {} to {}, by the sequential rule \
         at threshold 0.99 unless said otherwise. ± is the standard error over the runs, or \
         over the trainings where it stands behind their mean. Brackets hold 95 % intervals by \
         Wilson; decisions of one run are not independent, so that the truth is somewhat wider. \
         Shares are in percent. The figures of each model are in [decisions.csv](decisions.csv).",
        others.join(", "),
        scored.end - scored.start,
        scored.start,
        scored.end - 1,
    ));
    page.say(
        "Elsewhere: [cost.md](cost.md) has the instructions of a sample and of a tick beside their \
         goals, [the detector's source](../../crates/tactile/src/touch.rs) how soon a touch is \
         reported.",
    );
    page.say_if_quick(extent.is_quick, "runs, trainings and settings");
}
