//! The page of poses: `docs/measured/poses.md` and `poses.csv`, generated: what decisions are
//! worth where use differs from training.
//!
//! A *condition* is what a scene differs by from the pose of training, a *cell* what comes of it over
//! all trainings; [`introduction`] has the other words.
//!
//! Trainings have seeds from 8001 on and 8501 on, tests from 8101 on: nothing else has them, and
//! nothing is chosen by what comes of them.

mod bound;
mod condition;
mod five;
mod one;
mod output;
mod placebo;
pub(crate) mod standing;
mod tally;
mod trained;

use anyhow::Result;
use host_sim::training::Expected;
use tactile::ModelBuf;

use crate::cores::Cores;
use crate::page::{Files, Page};
use bound::Case;
use condition::{Change, SPREAD, SURFACES, Setting, TEXTURES, WHISKER};
use five::{Five, TILTS};
use one::One;
use output::{Output, cells, found};
use tally::{Asked, REASONS, Tally, mean_within, missed, said};
use trained::{Relabel, THRESHOLD, TICK_HZ, Trained, as_felt, judge, model};

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extent {
    pub(crate) is_quick: bool,
    pub(crate) cores: Cores,
    /// Trainings in one pose, and all others.
    pub(crate) trainings: [usize; 2],
    /// Seconds that are tested of each training, likewise.
    pub(crate) test_s: [f64; 2],
    /// The most conditions of a table.
    pub(crate) conditions: usize,
    /// The most surfaces that have two names, or are left out.
    pub(crate) surfaces: usize,
}

impl Extent {
    pub(crate) const fn new(is_quick: bool, cores: Cores) -> Self {
        Self {
            is_quick,
            cores,
            trainings: if is_quick { [2, 1] } else { [5, 3] },
            test_s: if is_quick { [20.0; 2] } else { [240.0, 340.0] },
            conditions: if is_quick { 3 } else { usize::MAX },
            surfaces: if is_quick { 1 } else { usize::MAX },
        }
    }
}

pub(crate) fn page(extent: &Extent) -> Result<Files> {
    let mut output = Output::new();
    let one = One::new(extent)?;
    one.section(&mut output, extent)?;
    let five = Five::new(extent)?;
    five.section(&mut output, extent)?;
    let (spread, spread_models) = five::scenes(&mut output, extent)?;
    let all = [
        ("one pose", Expected::Bench, &one.trained),
        ("one pose, `same`", Expected::Same, &one.trained),
        ("five poses", Expected::Bench, &five.trained),
        ("`bench-textures`", Expected::Bench, &spread),
    ];
    placebo::section(&mut output, &all[..3], extent)?;
    placebo::unknown(&mut output, &all, extent)?;
    one.thresholds(&mut output, &five)?;
    let cases = cases((&one, &five), (&spread, &spread_models));
    let cases = cases.get(..extent.conditions).unwrap_or(&cases);
    bound::section(&mut output, cases, extent)?;

    let Output {
        page: measured,
        goals,
    } = output;
    let mut page = Page::new("poses");
    introduction(&mut page, extent);
    page.heading(2, "Goals");
    page.table("condition | goal | found | ", goals);
    page.text.push_str(&measured.text);
    page.csv = measured.csv;
    Ok(page.into_files())
}

/// Where a goal of what is decided or right was missed at some time, and the poses of training.
fn cases<'c>(
    (one, five): (&'c One, &'c Five),
    spread: (&'c Trained<'static>, &'c [ModelBuf]),
) -> [Case<'c>; 9] {
    use Change::{CrossTalk, Friction, Obstacle, Turned};
    let [slippery, rough] = [0.7, 1.3].map(|by| Some(Friction(by)));
    let [near, far] = [96.0, 104.0].map(|to| Some(Obstacle(to)));
    let mixed = Some(CrossTalk(0.03));
    let one = (&one.trained, &one.bench[..]);
    let five = (&five.trained, &five.models[..]);
    let all = [
        ("one pose, as trained", one, None, 80.0),
        ("one pose, friction × 0.7", one, slippery, 5.0),
        ("one pose, friction × 1.3", one, rough, 5.0),
        ("five poses, tilt 20°", five, None, 90.0),
        ("five poses, turned +5°", five, Some(Turned(5.0)), 70.0),
        ("five poses, cross-talk +3 %", five, mixed, 70.0),
        ("five poses, obstacle 96°", five, near, 5.0),
        ("five poses, obstacle 104°", five, far, 5.0),
        ("`bench-textures`", spread, None, 85.0),
    ];
    all.map(|(name, (trained, models), change, asked)| Case {
        name,
        trained,
        models,
        change,
        asked,
    })
}

fn introduction(page: &mut Page, extent: &Extent) {
    page.title_of_command("Poses");
    page.say(
        "What decisions are worth where the pose, the sensor or the whisking is not that of the \
         training, each figure beside its goal. All are measured with the code behind `host-sim \
         record`, `train` and `evaluate`, whose classifier is the one that a board runs, by the \
         sequential rule at threshold 0.99 unless said otherwise.",
    );
    page.say(
        "*Right* is the share of named decisions that are right, *stated* their mean posterior, \
         *decided* the share of presentations in which a class is named; *short by* is stated \
         less right, in points; shares are in percent. Brackets hold 95 % intervals by Wilson, \
         for which a presentation is one observation; means over trainings have Student's. \
         Errors cluster by training, so that the truth is somewhat wider. A goal is missed where \
         the interval excludes it. *Silent* says why decisions named no class: what was felt is \
         unlike all classes, touched in a way that was not trained, or between two classes. Each \
         training has its own presentations, with seeds from 8101 on; trainings have seeds from \
         8001 on and 8501 on; nothing else has them, and nothing was chosen by them. The figures \
         of each training are in [poses.csv](poses.csv).",
    );
    page.say_if_quick(extent.is_quick, "trainings, conditions and presentations");
}
