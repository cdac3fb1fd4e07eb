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

/// How a figure of a model is written: with so many decimals, or as a share with its interval.
#[derive(Clone, Copy)]
enum Text {
    Number(fn(&Figures) -> f64, usize),
    Share(fn(&Figures) -> Interval),
    /// A mean with its error.
    Mean(fn(&Figures) -> (f64, f64)),
    /// How far stated and found lie apart.
    Apart,
}

impl Text {
    fn value(self, figures: &Figures) -> f64 {
        match self {
            Self::Number(of, _) => of(figures),
            Self::Share(of) => 100.0 * of(figures).share,
            Self::Mean(of) => of(figures).0,
            Self::Apart => figures.overstated().abs(),
        }
    }

    fn of(self, figures: &Figures) -> String {
        match self {
            Self::Number(of, decimals) => number(of(figures), decimals),
            Self::Share(of) => percent(of(figures)),
            Self::Mean(of) => plus_minus(of(figures), 2),
            Self::Apart => {
                let calibration = &figures.all.calibration;
                let (apart, stated) = (self.value(figures), 100.0 * calibration.stated);
                let found = percent(calibration.found);
                format!("{apart:.2}: stated {stated:.2}, found {found}")
            }
        }
    }
}

/// A line: what is measured of a model at which of [`THRESHOLDS`], its goal, and decimals of the
/// other trainings' mean.
struct Line(String, Goal, Text, usize, usize);

fn runs(figures: &Figures, is_meant: fn(f64) -> bool) -> f64 {
    figures.hits.iter().filter(|hits| is_meant(**hits)).count() as f64
}

fn lines(ground: &Ground) -> Vec<Line> {
    use Goal::{AtLeast, AtMost};
    use Text::{Apart, Mean, Number, Share};
    let goals = ground.goals;
    // Of single runs no goal is set but on the first scene.
    let of_runs = |goal| match goal {
        _ if goals.of_runs => goal,
        AtLeast(_) => AtLeast(f64::NEG_INFINITY),
        AtMost(_) => AtMost(f64::INFINITY),
    };
    let count = ground.runs.len();
    let least = (0.95 * count as f64).floor();
    let names = [
        "hit rate, mean over runs".to_owned(),
        "hit rate of the worst run".to_owned(),
        format!("runs above 94 %, of {count}"),
        format!("runs below 90 %, of {count}"),
    ];
    let above = Number(|f| runs(f, |hits| hits > 0.94), 0);
    let below = Number(|f| runs(f, |hits| hits < 0.9), 0);
    let asked = [
        (AtLeast(98.5), Mean(Figures::hits), 2),
        (of_runs(AtLeast(90.0)), Number(Figures::worst, 1), 1),
        (of_runs(AtLeast(least)), above, 1),
        (of_runs(AtMost(0.0)), below, 1),
    ];
    let others = [
        "decisions these are of, at 0.99",
        "time of contact to a decision, ms",
        "the same by the clock, from the first sample that counted, ms",
        "presentations without a decision",
        "refused of known textures",
    ];
    let count = Number(|f| f.all.calibration.found.count as f64, 0);
    let of_others = [
        (AtLeast(2000.0), count, 0),
        (AtMost(goals.contact_ms), Number(|f| f.contact_ms, 0), 0),
        (AtMost(f64::INFINITY), Number(|f| f.wall_ms, 0), 0),
        (AtMost(goals.undecided), Share(|f| f.all.undecided), 1),
        (AtMost(6.0), Share(|f| f.all.refused), 1),
    ];
    let usual = |(name, (goal, text, decimals))| Line(name, goal, text, USUAL, decimals);
    let apart = THRESHOLDS.into_iter().enumerate();
    let apart = apart.map(|(at, (threshold, apart))| {
        let name = format!("stated and found at {threshold}, points apart");
        Line(name, AtMost(apart), Apart, at, 2)
    });
    let first = names.into_iter().zip(asked).map(usual);
    let others = others.map(str::to_owned).into_iter().zip(of_others);
    first.chain(apart).chain(others.map(usual)).collect()
}

impl Line {
    fn row(&self, trained: &[Trained]) -> Vec<String> {
        let Self(name, goal, text, at, decimals) = self;
        let value = |trained: &Trained| text.value(&trained.at[*at]);
        let Some((shipped, others)) = trained.split_first() else {
            return Vec::new();
        };
        let values: Vec<f64> = others.iter().map(value).collect();
        let worst = values.iter().copied().reduce(|a, b| goal.worse(a, b));
        let mean = plus_minus(mean_of(values), *decimals);
        let of_others = worst.map_or_else(String::new, |x| {
            format!("{mean}; {x:.decimals$}", decimals = *decimals)
        });
        let met = trained.iter().filter(|one| goal.met(value(one)));
        let of_all = if goal.is_asked() {
            format!("{} of {}", met.count(), trained.len())
        } else {
            String::new()
        };
        vec![
            name.clone(),
            goal.text(),
            text.of(&shipped.at[*at]),
            goal.verdict(value(shipped)).to_owned(),
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
    let panel = |ground: &Ground| stated_and_found(ground.name, &ground.trained);
    let panels: Vec<Panel> = grounds.iter().map(panel).collect();
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
    let calibrations = trained.iter().map(|one| &one.at[at].all.calibration);
    for bin in calibrations.flat_map(|of| &of.bins) {
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
