//! Trained in one pose: what comes of each condition by how much the training expects to differ,
//! and other thresholds.

use anyhow::Result;
use host_sim::training::Expected;
use tactile::ModelBuf;

use super::{
    Asked, Change, Extent, Five, Output, Setting, THRESHOLD, Tally, Trained, WHISKER, as_felt,
    cells, found, mean_within, missed, said,
};
use crate::decisions::figures::{mean_of, number, percent};
use crate::page::row;

const SEED: u64 = 8001;
const FRESH: u64 = 8101;
/// Below those of the other section.
const CHANGED: u64 = 8111;

const TRAINED: Asked = Asked::Known(80.0, Some(200.0));
/// In the worst cell and, to be aimed at, in each; in the mean of all.
const WORST: Asked = Asked::Honest(4.0);
const AIM: Asked = Asked::Honest(1.0);
const MEAN_SHORT: f64 = 1.0;

fn conditions() -> [Vec<Change>; 2] {
    use Change::{CrossTalk, Friction, NoRcp, Obstacle, ScaleX, ScaleY, Tilt, Turned, Whisk, Zero};
    let tilts = [18.0, 22.0, 15.0, 25.0, 10.0, 30.0, 0.0].map(Tilt);
    let obstacles = [95.0, 102.0, 105.0, 110.0].map(Obstacle);
    let scales = [ScaleY(0.85), ScaleY(1.15), ScaleX(0.85)];
    let zeros = [[1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0]];
    let zeros = zeros.map(|zero| Zero(zero.map(|sign| 200.0 * sign)));
    let (turned, mixed) = ([5.0, -5.0].map(Turned), [0.03, -0.03].map(CrossTalk));
    let surface = [0.7, 1.3].map(Friction);
    let place = [&tilts[..], &obstacles].concat();
    let pose = [&place[..], &scales, &zeros, &turned, &mixed, &surface].concat();
    let whisking = [1.5, 1.8, 2.2, 3.0].map(Whisk).into_iter().chain([NoRcp]);
    [pose, whisking.collect()]
}

/// The trainings, and their models by what `--expect` says.
pub(super) struct One {
    pub(super) trained: Trained<'static>,
    pub(super) bench: Vec<ModelBuf>,
    same: Vec<ModelBuf>,
    other: Vec<ModelBuf>,
}

impl One {
    pub(super) fn new(extent: &Extent) -> Result<Self> {
        let of = Setting::of(WHISKER, &[]);
        let trained = Trained::record((extent, 0), (&[of], SEED..), (of, FRESH))?;
        let models = |expect| trained.models(expect, &as_felt);
        Ok(Self {
            bench: models(Expected::Bench)?,
            same: models(Expected::Same)?,
            other: models(Expected::Other)?,
            trained,
        })
    }

    pub(super) fn section(&self, output: &mut Output, extent: &Extent) -> Result<()> {
        output.page.heading(2, "One pose trained");
        output.page.say(format_args!(
            "`whisker` as it is (tilt 20°, obstacle 100°, 2 Hz), one recording of 80 s for each of \
             {} trainings. The last four columns are of the same trainings with `--expect same`, \
             which has no second opinion, and `other`. *x × 0.85* and *cross-talk* are made of what was \
             recorded, about code 8192; *friction* is that of each texture times the factor, each \
             recorded by itself; all else is a key of the scene.",
            self.trained.seeds.len()
        ));
        let kinds = [&self.bench[..], &self.same, &self.other];
        let fresh = kinds.map(|models| self.trained.fresh(models, THRESHOLD));
        let mut all = vec![fresh.into_iter().collect::<Result<Vec<_>>>()?];
        let mut lists = conditions();
        for list in &mut lists {
            list.truncate(extent.conditions);
        }
        let changed = lists.concat();
        all.extend(self.trained.changed(&changed, &kinds, CHANGED)?);
        let mut names = vec!["as trained".to_owned()];
        names.extend(changed.iter().map(ToString::to_string));

        let mut rows = Vec::new();
        for (n, (name, cell)) in names.iter().zip(&all).enumerate() {
            let [bench, same, other] = [0, 1, 2].map(|kind| Tally::sum(&cell[kind]));
            let verdict = match n {
                0 => TRAINED.verdict(&bench),
                _ => WORST.verdict(&bench),
            };
            let beside = [same, other].map(|tally| [tally.right_share(), tally.decided_share()]);
            let beside = beside.into_iter().flatten().map(percent);
            let all = cells(&bench).into_iter().chain([verdict]).chain(beside);
            rows.push(row(name.as_str(), all));
            for (model, tallies) in ["bench", "same", "other"].iter().zip(cell) {
                output.keep(["one pose", name, model], &self.trained, tallies);
            }
        }
        let [trained, worst] = [TRAINED, WORST].map(Asked::text);
        let last = format!(
            "as trained: {trained}; else {worst} | `same`: right | decided | `other`: right | decided"
        );
        output.table("condition", &last, rows);
        let first = Tally::sum(&all[0][0]);
        output.asked("one pose: as trained", TRAINED, &first);
        let (pose, whisking) = all[1..].split_at(lists[0].len());
        let pose_names = &names[1..=lists[0].len()];
        Self::goals(output, "another pose or sensor", pose_names, pose);
        let whisking_names = &names[1 + lists[0].len()..];
        Self::goals(output, "another whisking", whisking_names, whisking);
        self.trainings(output, &names, &all);
        Ok(())
    }

    /// The mean and the worst of some cells.
    fn goals(output: &mut Output, what: &str, names: &[String], all: &[Vec<Vec<Tally>>]) {
        let trainings = all.first().map_or(0, |cell| cell[0].len());
        let of_cells = |kind: usize, training: usize| {
            mean_of(all.iter().map(|cell| cell[kind][training].short())).0
        };
        let mean = |kind| mean_within((0..trainings).map(|training| of_cells(kind, training)));
        let shown = |[low, mean, high]: [f64; 3]| format!("{mean:.1} ({low:.1} to {high:.1})");
        let [bench, same, other] = [0, 1, 2].map(mean);
        let is_missed = bench[0] > MEAN_SHORT;
        let [bench, same, other] = [bench, same, other].map(shown);
        output.goal(
            &format!("one pose: {what}, mean of cells"),
            &format!("right ≥ stated − {MEAN_SHORT}"),
            format!("short by {bench} points; with `same` {same}, with `other` {other}"),
            said(&missed([("right", is_missed)])),
        );
        let sums: Vec<Tally> = all.iter().map(|cell| Tally::sum(&cell[0])).collect();
        let missing = |asked: Asked| {
            let missing = names.iter().zip(&sums);
            let missing = missing.filter(|(_, tally)| !asked.missed(tally).is_empty());
            missing.map(|(name, _)| name.as_str()).collect::<Vec<_>>()
        };
        let [worst, aim] = [WORST, AIM].map(missing);
        let named = names.iter().zip(&sums);
        let loud = named.filter(|(_, tally)| tally.decided > 0);
        let least = loud.max_by(|a, b| a.1.short().total_cmp(&b.1.short()));
        let least = least.map_or_else(String::new, |(name, tally)| {
            format!("{name}: {}; ", found(tally))
        });
        let all = sums.len();
        let [kept, aimed] = [&worst, &aim].map(|missing| all - missing.len());
        output.goal(
            &format!("one pose: {what}, worst cell"),
            &WORST.text(),
            format!("{least}{kept} of {all} cells keep it, {aimed} the aim of − 1"),
            said(&worst),
        );
    }

    fn trainings(&self, output: &mut Output, names: &[String], all: &[Vec<Vec<Tally>>]) {
        output.page.say(
            "Errors cluster by training. Of each training the pose it was trained in, the mean \
             over all conditions of what right lies below stated (points), and the condition in \
             which that is most, of those in which at least 20 presentations were decided:",
        );
        let rows = self.trained.seeds.iter().enumerate().map(|(n, seed)| {
            let own = all[0][0][n];
            let (mean, _) = mean_of(all.iter().skip(1).map(|cell| cell[0][n].short()));
            let loud = names.iter().zip(all).map(|(name, cell)| (name, cell[0][n]));
            let loud = loud.filter(|(_, tally)| tally.decided >= 20);
            let worst = loud.max_by(|a, b| a.1.short().total_cmp(&b.1.short()));
            let worst = worst.map(|(name, tally)| {
                let decided = percent(tally.decided_share());
                format!("{name}: {:.1}, decided {decided}", tally.short())
            });
            let cells = [
                percent(own.right_share()),
                percent(own.decided_share()),
                number(mean, 2),
                worst.unwrap_or("–".to_owned()),
            ];
            row(seed.to_string(), cells)
        });
        output.page.table(
            "training | right as trained | decided | short by, mean | worst",
            rows,
        );
    }

    /// Other thresholds, with models of five poses beside them.
    pub(super) fn thresholds(&self, output: &mut Output, five: &Five) -> Result<()> {
        output.page.heading(2, "Thresholds");
        output.page.say(
            "What more silence would give: right and decided in the pose of training, of five \
             poses in the middle one.",
        );
        let mut rows = Vec::new();
        for threshold in [0.8, 0.9, 0.95, 0.99, 0.999] {
            let mut shown = Vec::new();
            for (model, trained, models) in [
                ("bench", &self.trained, &self.bench),
                ("same", &self.trained, &self.same),
                ("five poses", &five.trained, &five.models),
            ] {
                let tallies = trained.fresh(models, threshold)?;
                let setting = format!("threshold {threshold}");
                output.keep(["thresholds", &setting, model], trained, &tallies);
                let tally = Tally::sum(&tallies);
                shown.extend([tally.right_share(), tally.decided_share()].map(percent));
            }
            rows.push(row(threshold.to_string(), shown));
        }
        output.page.table(
            "threshold | one pose: right | decided | `same`: right | decided | five poses: right | \
             decided",
            rows,
        );
        Ok(())
    }
}
