//! Each figure of the two scenes beside its goal; and stated against found, as a picture and a table.

use anyhow::Result;
use tactile::ModelBuf;
use tactile::score::{CalibrationBin, Interval};
use tactile::train::joint::JointModel;

use super::{Extent, Figures, Goal, Ground, mean_of, number, percent, plus_minus};
use crate::chart::{Axis, Mark, Panel, Series};
use crate::page::{Page, row};

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

fn above(figures: &Figures) -> f64 {
    figures.hits.iter().filter(|hits| **hits > 0.94).count() as f64
}

fn below(figures: &Figures) -> f64 {
    figures.hits.iter().filter(|hits| **hits < 0.9).count() as f64
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
                let (apart, stated) = (f.overstated().abs(), 100.0 * f.all.calibration.stated);
                let found = percent(f.all.calibration.found);
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
            |f| f.all.calibration.found.count as f64,
            |f| f.all.calibration.found.count.to_string(),
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
            |f| 100.0 * f.all.undecided.share,
            |f| percent(f.all.undecided),
            1,
        ),
        line(
            "refused of known textures",
            Goal::AtMost(6.0),
            |f| 100.0 * f.all.refused.share,
            |f| percent(f.all.refused),
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
        let mean = plus_minus(mean_of(values), decimals);
        let of_others = worst.map_or_else(String::new, |x| format!("{mean}; {x:.decimals$}"));
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

/// The least that is stated, the least that is found, and the most: shares of errors.
const STATED: f64 = 1e-5;
const FOUND: f64 = 1e-4;
const HIGH: f64 = 0.1;

pub(super) fn calibration(page: &mut Page, grounds: &[Ground]) -> Result<()> {
    page.heading(2, "Stated against found");
    page.say(
        "Decisions of all trainings by their posterior, at three thresholds. The picture shows \
         the share of errors: stated 99 % is 1e-2. On the grey line a posterior is what it says; \
         below it decisions are right more often than they say, above it less often. Bars are \
         95 % intervals; where none was wrong only the bar is drawn, from the bottom.",
    );
    let panels: Vec<Panel> = grounds
        .iter()
        .map(|ground| stated_and_found(ground.name, &ground.trained))
        .collect();
    page.panels("calibration.svg", "stated against found", &panels)?;
    let (at, (threshold, _)) = (0, THRESHOLDS[0]);
    for ground in grounds {
        let rows = pooled(&ground.trained, at).into_iter().map(|bin| {
            let setting = format!("{} to {}", bin.low, bin.high);
            let cells = [
                format!("{:.2}", 100.0 * bin.stated),
                percent(bin.found),
                bin.found.count.to_string(),
            ];
            row(setting, cells)
        });
        let rows: Vec<_> = rows.collect();
        page.say(format_args!("{}, threshold {threshold}:", ground.name));
        page.table("posterior | stated | found | decisions", rows);
    }
    Ok(())
}

fn pooled(trained: &[Trained], at: usize) -> Vec<CalibrationBin> {
    let mut pooled: Vec<CalibrationBin> = Vec::new();
    let bins = trained
        .iter()
        .flat_map(|one| &one.at[at].all.calibration.bins);
    for bin in bins {
        match pooled.iter_mut().find(|other| other.low == bin.low) {
            Some(other) => *other = both(other, bin),
            None => pooled.push(*bin),
        }
    }
    pooled.sort_by(|a, b| a.low.total_cmp(&b.low));
    pooled
}

fn both(a: &CalibrationBin, b: &CalibrationBin) -> CalibrationBin {
    let count = a.found.count + b.found.count;
    let sum = |figure: fn(&CalibrationBin) -> f64| {
        figure(a) * a.found.count as f64 + figure(b) * b.found.count as f64
    };
    CalibrationBin {
        stated: sum(|bin| bin.stated) / count as f64,
        found: Interval::of(sum(|bin| bin.found.share).round() as usize, count),
        ..*a
    }
}

fn stated_and_found(name: &str, trained: &[Trained]) -> Panel {
    let axis = |name, low| Axis::decades(name, [low, HIGH].into_iter());
    let inside = |x: f64| x.clamp(FOUND, HIGH);
    let mut series = vec![Series::new(
        "as stated",
        0,
        Mark::Nothing,
        vec![(FOUND, FOUND), (HIGH, HIGH)],
    )];
    let marks = [Mark::Dot, Mark::Ring, Mark::Cross];
    for (at, ((threshold, _), mark)) in THRESHOLDS.iter().zip(marks).enumerate() {
        let bins = pooled(trained, at);
        let place = |bin: &CalibrationBin| (1.0 - bin.stated).clamp(STATED, HIGH);
        let wrong = bins.iter().filter(|bin| bin.found.share < 1.0);
        let points = wrong.map(|bin| (place(bin), inside(1.0 - bin.found.share)));
        let name = format!("threshold {threshold}");
        series.push(Series {
            joined: false,
            ..Series::new(&name, at + 1, mark, points.collect())
        });
        for bin in &bins {
            let bar = [bin.found.high, bin.found.low].map(|x| (place(bin), inside(1.0 - x)));
            series.push(Series::new("", at + 1, Mark::Nothing, bar.to_vec()));
        }
    }
    let x = axis("share of errors stated", STATED);
    Panel::new(name, x, axis("share of errors found", FOUND), series)
}
