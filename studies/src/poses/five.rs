//! Trained in five poses: between them, and outside. And the scene `textures`, and the one whose
//! presentations differ in pose.

use anyhow::Result;
use host_sim::training::Expected;
use tactile::ModelBuf;

use super::{
    Asked, Change, Extent, Output, SPREAD, Setting, TEXTURES, THRESHOLD, Tally, Trained, WHISKER,
    as_felt, found, said,
};

const SEED: u64 = 8011;
const FRESH: u64 = 8301;
const CHANGED: u64 = 8311;
pub(super) const TILTS: [[Change; 1]; 5] = [
    [Change::Tilt(14.0)],
    [Change::Tilt(17.0)],
    [Change::Tilt(20.0)],
    [Change::Tilt(23.0)],
    [Change::Tilt(26.0)],
];

const MIDDLE: Asked = Asked::Known(90.0, Some(200.0));
const BETWEEN: Asked = Asked::Known(70.0, None);
const OUTSIDE: Asked = Asked::Honest(2.0);

/// Between the poses of training, in the middle one with another sensor, and outside.
fn conditions() -> [(&'static str, Asked, Vec<Change>); 3] {
    use Change::{CrossTalk, Obstacle, ScaleY, Tilt, Turned, Zero};
    let between = [15.5, 18.5, 21.5, 24.5].map(Tilt);
    let scales = [0.85, 1.15].map(ScaleY);
    let turned = [5.0, -5.0].map(Turned);
    let zeros = [100.0, -100.0].map(|zero| Zero([zero; 2]));
    let mixed = [0.03, -0.03].map(CrossTalk);
    let sensor = [scales, turned, zeros, mixed].concat();
    let tilts = [4.0, 10.0, 30.0, 35.0].map(Tilt);
    let obstacles = [96.0, 104.0, 107.0].map(Obstacle);
    [
        ("between", BETWEEN, between.to_vec()),
        ("another sensor", BETWEEN, sensor),
        ("outside", OUTSIDE, [&tilts[..], &obstacles].concat()),
    ]
}

pub(super) struct Five {
    pub(super) trained: Trained<'static>,
    pub(super) models: Vec<ModelBuf>,
}

impl Five {
    pub(super) fn new(extent: &Extent) -> Result<Self> {
        let poses = TILTS.each_ref().map(|tilt| Setting::of(WHISKER, tilt));
        let seeds = (SEED..).step_by(10);
        let test = Setting::of(WHISKER, &[]);
        let trained = Trained::record((extent, 1), (&poses, seeds), (test, FRESH))?;
        Ok(Self {
            models: trained.models(Expected::Bench, &as_felt)?,
            trained,
        })
    }

    pub(super) fn section(&self, output: &mut Output, extent: &Extent) -> Result<()> {
        output.page.heading(2, "Five poses trained");
        output.page.say(format_args!(
            "Recordings of 80 s at tilts 14, 17, 20, 23 and 26°, {} trainings: between them, at \
             20° with another sensor, and outside.",
            self.trained.seeds.len()
        ));
        let mut parts = conditions();
        for (.., changes) in &mut parts {
            changes.truncate(extent.conditions);
        }
        let changed: Vec<Change> = parts.iter().flat_map(|(.., of)| of).copied().collect();
        let kinds = [&self.models[..]];
        let mut found_of = self.trained.changed(&changed, &kinds, CHANGED)?.into_iter();
        let middle = self.trained.fresh(&self.models, THRESHOLD)?;
        let of = ["five poses", "tilt 20°", "several"];
        let mut rows = vec![output.row(of, &self.trained, &middle, MIDDLE)];
        let middle = Tally::sum(&middle);
        output.asked("five poses: in the middle one", MIDDLE, &middle);
        for (part, asked, changes) in &parts {
            let (mut of_part, mut missed) = (Vec::new(), Vec::new());
            for (change, tallies) in changes.iter().zip(found_of.by_ref()) {
                let (name, tallies) = (change.to_string(), &tallies[0]);
                let of = ["five poses", &name, "several"];
                rows.push(output.row(of, &self.trained, tallies, *asked));
                of_part.extend_from_slice(tallies);
                let of_cell = asked.missed(&Tally::sum(tallies));
                if !of_cell.is_empty() {
                    missed.push(format!("{name} ({})", of_cell.join(", ")));
                }
            }
            let missed: Vec<&str> = missed.iter().map(String::as_str).collect();
            output.goal(
                &format!("five poses: {part}, each of {}", changes.len()),
                &asked.text(),
                format!("together: {}", found(&Tally::sum(&of_part))),
                said(&missed),
            );
        }
        output.table("condition", "goal | ", rows);
        Ok(())
    }
}

/// Seconds of the training of what is spread.
const SPREAD_S: f64 = 240.0;

/// Measures both; the trainings of what is spread, and their models.
pub(super) fn scenes(
    output: &mut Output,
    extent: &Extent,
) -> Result<(Trained<'static>, Vec<ModelBuf>)> {
    output.page.heading(2, "Scenes");
    let [_, trainings] = extent.trainings;
    output.page.say(format_args!(
        "`textures`, trained on one recording as it is, and `bench-textures`, whose presentations \
         have poses of their own (tilt ±3°, obstacle ±2°, scale ±5 %), trained on {SPREAD_S} s \
         with their column `pose`; {trainings} trainings each."
    ));
    let setting = |file, seconds| Setting {
        seconds,
        ..Setting::of(file, &[])
    };
    let scenes = [
        (setting(TEXTURES, None), [8041, 8401], (97.0, Some(120.0))),
        (setting(SPREAD, Some(SPREAD_S)), [8051, 8411], (85.0, None)),
    ];
    let mut rows = Vec::new();
    let mut last = None;
    for (setting, [seed, fresh], (decided, ms)) in scenes {
        let asked = Asked::Known(decided, ms);
        let trained = Trained::record((extent, 1), (&[setting], seed..), (setting, fresh))?;
        let models = trained.models(Expected::Bench, &as_felt)?;
        let tallies = trained.fresh(&models, THRESHOLD)?;
        let (name, _) = setting.file;
        rows.push(output.row(["scenes", name, "bench"], &trained, &tallies, asked));
        output.asked(&format!("scene `{name}`"), asked, &Tally::sum(&tallies));
        last = Some((trained, models));
    }
    output.table("scene", "goal | ", rows);
    last.ok_or_else(|| anyhow::anyhow!("no scene"))
}
