//! Trained in five poses: between them, and outside.

use anyhow::Result;
use host_sim::progress::Verbosity;
use host_sim::training::Expected;
use tactile::ModelBuf;

use super::asked::{Asked, said};
use super::condition::{Change, Setting, WHISKER};
use super::extent::Extent;
use super::output::{COLUMNS, Output, cells, found};
use super::tally::Tally;
use super::trained::{THRESHOLD, Trained, as_felt};
use crate::page::row;

const SEED: u64 = 7011;
const FRESH: u64 = 7301;
const CHANGED: u64 = 7311;
pub(super) const TILTS: [[Change; 1]; 5] = [
    [Change::Tilt(14.0)],
    [Change::Tilt(17.0)],
    [Change::Tilt(20.0)],
    [Change::Tilt(23.0)],
    [Change::Tilt(26.0)],
];

const MIDDLE: Asked = Asked::Known {
    decided: 90.0,
    ms: Some(200.0),
};
const BETWEEN: Asked = Asked::Known {
    decided: 70.0,
    ms: None,
};
const OUTSIDE: Asked = Asked::Honest { short: 2.0 };

/// Between the poses of training, in the middle one with another sensor, and outside.
fn conditions() -> [Vec<Change>; 3] {
    use Change::{CrossTalk, Obstacle, ScaleY, Tilt, Turned, Zero};
    let sensor = vec![
        ScaleY(0.85),
        ScaleY(1.15),
        Turned(5.0),
        Turned(-5.0),
        Zero([100.0, 100.0]),
        Zero([-100.0, -100.0]),
        CrossTalk(0.03),
        CrossTalk(-0.03),
    ];
    let tilts = [4.0, 10.0, 30.0, 35.0].map(Tilt);
    let obstacles = [96.0, 104.0, 107.0].map(Obstacle);
    [
        [15.5, 18.5, 21.5, 24.5].map(Tilt).to_vec(),
        sensor,
        tilts.into_iter().chain(obstacles).collect(),
    ]
}

pub(super) struct Five {
    pub(super) trained: Trained<'static>,
    pub(super) models: Vec<ModelBuf>,
}

impl Five {
    pub(super) fn new(extent: &Extent, verbosity: Verbosity) -> Result<Self> {
        let [_, trainings] = extent.trainings;
        let [_, test_s] = extent.test_s;
        let test = (Setting::of(WHISKER, &[]), test_s);
        let poses = TILTS.each_ref().map(|tilt| Setting::of(WHISKER, tilt));
        let seeds = (SEED..).step_by(10).take(trainings);
        let trained = Trained::record(&poses, seeds, test, FRESH, verbosity)?;
        Ok(Self {
            models: trained.models(Expected::Bench, &as_felt, verbosity)?,
            trained,
        })
    }

    pub(super) fn section(
        &self,
        output: &mut Output,
        extent: &Extent,
        verbosity: Verbosity,
    ) -> Result<()> {
        output.page.heading(2, "Five poses trained");
        output.page.say(format_args!(
            "Recordings of 80 s at tilts 14, 17, 20, 23 and 26°, {} trainings: between them, at \
             20° with another sensor, and outside.",
            self.trained.seeds.len()
        ));
        let mut lists = conditions();
        for list in &mut lists {
            list.truncate(extent.conditions);
        }
        let changed = lists.concat();
        let kinds = [&self.models[..]];
        let found_of = self.trained.changed(&changed, &kinds, CHANGED, verbosity)?;
        let mut all: Vec<(String, Asked, Vec<Tally>)> = vec![(
            "tilt 20°".to_owned(),
            MIDDLE,
            self.trained.fresh(&self.models, THRESHOLD)?,
        )];
        let inside = lists[0].len() + lists[1].len();
        for (n, (change, mut of_kinds)) in changed.iter().zip(found_of).enumerate() {
            let asked = if n < inside { BETWEEN } else { OUTSIDE };
            all.push((change.to_string(), asked, of_kinds.swap_remove(0)));
        }
        let mut rows = Vec::new();
        for (name, asked, tallies) in &all {
            let tally = Tally::sum(tallies);
            let goal = [asked.text(), asked.verdict(&tally)];
            rows.push(row(name.as_str(), cells(&tally).into_iter().chain(goal)));
            output.keep(
                ["five poses", name, "several"],
                &self.trained.seeds,
                tallies,
            );
        }
        output
            .page
            .table(&format!("condition | {COLUMNS} | goal | "), rows);
        let middle = Tally::sum(&all[0].2);
        output.goal(
            "five poses: in the middle one",
            &MIDDLE.text(),
            found(&middle),
            MIDDLE.verdict(&middle),
        );
        let parts = [
            ("between", 1..1 + lists[0].len()),
            ("another sensor", 1 + lists[0].len()..1 + inside),
            ("outside", 1 + inside..all.len()),
        ];
        for (name, part) in parts {
            let part = &all[part];
            let sum = Tally::sum(part.iter().flat_map(|(_, _, tallies)| tallies));
            let mut missed = Vec::new();
            for (name, asked, tallies) in part {
                let of_cell = asked.missed(&Tally::sum(tallies));
                if !of_cell.is_empty() {
                    missed.push(format!("{name} ({})", of_cell.join(", ")));
                }
            }
            let missed: Vec<&str> = missed.iter().map(String::as_str).collect();
            output.goal(
                &format!("five poses: {name}, each of {}", part.len()),
                &part
                    .first()
                    .map_or_else(String::new, |(_, asked, _)| asked.text()),
                format!("together: {}", found(&sum)),
                said(&missed),
            );
        }
        Ok(())
    }
}
