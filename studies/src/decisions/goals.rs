//! Each figure of the two scenes beside its goal.

use anyhow::Result;
use tactile::ModelBuf;
use tactile::train::joint::JointModel;

use super::Extent;
use super::figures::{Figures, Goal, mean_of, number, percent, plus_minus};
use super::ground::Ground;
use crate::page::Page;

/// Thresholds, with how many points stated and found may lie apart.
pub(super) const THRESHOLDS: [(f64, f64); 3] = [(0.95, 1.5), (0.99, 1.0), (0.999, 1.5)];
const USUAL: usize = 1;

/// A model with the default settings, and its figures at each of [`THRESHOLDS`].
pub(super) struct Trained {
    pub(super) seed: u64,
    pub(super) joint: JointModel,
    pub(super) model: ModelBuf,
    pub(super) at: Vec<Figures>,
}

impl Trained {
    pub(super) fn usual(&self) -> &Figures {
        &self.at[USUAL]
    }
}

pub(super) fn measure(ground: &Ground, extent: &Extent) -> Result<Vec<Trained>> {
    let seeds: Vec<u64> = ground.seeds().collect();
    extent.cores.each("trainings", &seeds, |&seed| {
        let joint = ground.train(ground.recording(seed, ground.scene.duration_s))?;
        let model = joint.model()?;
        let at = THRESHOLDS.map(|(threshold, _)| ground.score(&model, threshold));
        Ok(Trained {
            seed,
            at: at.into_iter().collect::<Result<_, _>>()?,
            joint,
            model,
        })
    })
}

/// A line: what is measured of a model, and how that is written.
struct Line {
    name: String,
    goal: Goal,
    value: fn(&Figures) -> f64,
    text: fn(&Figures) -> String,
    /// At which of [`THRESHOLDS`], and decimals of the other trainings' mean.
    at: usize,
    decimals: usize,
}

fn runs(figures: &Figures, count: fn(f64) -> bool) -> f64 {
    figures.hits.iter().filter(|hits| count(**hits)).count() as f64
}

fn above(figures: &Figures) -> f64 {
    runs(figures, |hits| hits > 0.94)
}

fn below(figures: &Figures) -> f64 {
    runs(figures, |hits| hits < 0.9)
}

fn lines(ground: &Ground) -> Vec<Line> {
    let goals = ground.goals;
    // Of single runs no goal is set but on the first scene.
    let of_runs = |goal| match goal {
        _ if goals.of_runs => goal,
        Goal::AtLeast(_) => Goal::AtLeast(f64::NEG_INFINITY),
        Goal::AtMost(_) => Goal::AtMost(f64::INFINITY),
    };
    let count = ground.runs.len();
    let line = |name: &str, goal, value, text, decimals| Line {
        name: name.to_owned(),
        goal,
        value,
        text,
        at: USUAL,
        decimals,
    };
    let mut lines = vec![
        line(
            "hit rate, mean over runs",
            Goal::AtLeast(98.5),
            Figures::hit_rate,
            |f| {
                let (mean, error) = mean_of(f.hits.iter().copied());
                plus_minus((100.0 * mean, 100.0 * error), 2)
            },
            2,
        ),
        line(
            "hit rate of the worst run",
            of_runs(Goal::AtLeast(90.0)),
            Figures::worst,
            |f| number(f.worst(), 1),
            1,
        ),
        line(
            &format!("runs above 94 %, of {count}"),
            of_runs(Goal::AtLeast((0.95 * count as f64).floor())),
            above,
            |f| number(above(f), 0),
            1,
        ),
        line(
            &format!("runs below 90 %, of {count}"),
            of_runs(Goal::AtMost(0.0)),
            below,
            |f| number(below(f), 0),
            1,
        ),
    ];
    for (at, (threshold, apart)) in THRESHOLDS.into_iter().enumerate() {
        lines.push(Line {
            name: format!("stated and found at {threshold}, points apart"),
            goal: Goal::AtMost(apart),
            value: |f| f.overstated().abs(),
            text: |f| {
                let (apart, stated) = (f.overstated().abs(), 100.0 * f.calibration.stated);
                let found = percent(f.calibration.found);
                format!("{apart:.2}: stated {stated:.2}, found {found}")
            },
            at,
            decimals: 2,
        });
    }
    lines.extend([
        line(
            "decisions these are of, at 0.99",
            Goal::AtLeast(2000.0),
            |f| f.calibration.found.count as f64,
            |f| f.calibration.found.count.to_string(),
            0,
        ),
        line(
            "time of contact to a decision, ms",
            Goal::AtMost(goals.contact_ms),
            |f| f.contact_ms,
            |f| number(f.contact_ms, 0),
            0,
        ),
        line(
            "the same by the clock, from the first sample that counted, ms",
            Goal::AtMost(f64::INFINITY),
            |f| f.wall_ms,
            |f| number(f.wall_ms, 0),
            0,
        ),
        line(
            "presentations without a decision",
            Goal::AtMost(goals.undecided),
            |f| 100.0 * f.undecided.share,
            |f| percent(f.undecided),
            1,
        ),
        line(
            "refused of known textures",
            Goal::AtMost(6.0),
            |f| 100.0 * f.refused.share,
            |f| percent(f.refused),
            1,
        ),
    ]);
    lines
}

impl Line {
    /// Name, goal, the shipped model and whether that keeps it, the others.
    fn row(&self, trained: &[Trained]) -> Vec<String> {
        let value = |trained: &Trained| (self.value)(&trained.at[self.at]);
        let Some((shipped, others)) = trained.split_first() else {
            return Vec::new();
        };
        let values: Vec<f64> = others.iter().map(value).collect();
        let worst = values.iter().copied().reduce(|a, b| self.goal.worse(a, b));
        let decimals = self.decimals;
        let of_others = worst.map_or_else(String::new, |worst| {
            format!(
                "{}; {worst:.decimals$}",
                plus_minus(mean_of(values.iter().copied()), decimals)
            )
        });
        let met = trained.iter().filter(|one| self.goal.met(value(one)));
        let of_all = if self.goal.is_asked() {
            format!("{} of {}", met.count(), trained.len())
        } else {
            String::new()
        };
        vec![
            self.name.clone(),
            self.goal.text(),
            (self.text)(&shipped.at[self.at]),
            self.goal.verdict(value(shipped)).to_owned(),
            of_others,
            of_all,
        ]
    }
}

pub(super) fn section(page: &mut Page, grounds: &[Ground]) {
    page.heading(2, "Goals");
    page.say(
        "A hit rate is the mean over classes of the share of right decisions among those for a \
         class; \"unknown\" is counted as refused. The goals are for one training run: the \
         verdict is on the shipped model, and the last columns say what other runs would have \
         given (mean ± standard error; the worst).",
    );
    for ground in grounds {
        page.heading(3, &format!("`scenes/{}.toml`", ground.name));
        let rows = lines(ground)
            .into_iter()
            .map(|line| line.row(&ground.trained));
        page.table(
            "figure | goal | shipped | | other trainings; the worst | trainings that keep it",
            rows,
        );
        for one in &ground.trained {
            for ((threshold, _), figures) in THRESHOLDS.iter().zip(&one.at) {
                let setting = format!("threshold {threshold}");
                figures.keep(page, ["goals", ground.name, &setting], one.seed);
            }
        }
    }
}
