//! Error against run time: what bits, bins, blocks and time of training are worth.

use anyhow::Result;
use host_sim::training;
use tactile::ModelBuf;
use tactile::train::Expect;
use tactile::train::joint::{JointModel, Options};

use super::{Extent, Figures, Ground, LONGEST_S, Trained, known_refused, number, over};
use crate::accuracy::schemes::{Counts, TARGETS, cell};
use crate::chart::{Mark, Panel, Series, draw_in, linear};
use crate::moments::range;
use crate::page::{Page, row};

pub(super) fn section(
    page: &mut Page,
    grounds: &[Ground],
    counts: &Counts,
    extent: &Extent,
) -> Result<()> {
    let mut jobs = Vec::new();
    for setting in &SETTINGS {
        for &value in setting.values.iter().take(extent.values) {
            jobs.extend(grounds.iter().map(|ground| (setting, value, ground)));
        }
    }
    let tried = extent
        .cores
        .each("settings", &jobs, |&(setting, value, ground)| {
            let (mut figures, mut bytes) = (Vec::new(), 0);
            for one in &ground.trained {
                if let Some(model) = (setting.model)(value, ground, one)? {
                    bytes = model.as_bytes().len();
                    figures.push((one.seed, ground.score(&model, 0.99)?));
                }
            }
            Ok(Tried {
                setting,
                value,
                ground,
                figures,
                bytes,
            })
        })?;
    for tried in &tried {
        let setting = format!("{} {}", tried.value, tried.setting.name);
        for (seed, figures) in &tried.figures {
            figures.keep(page, ["run time", tried.ground.name, &setting], *seed);
        }
    }

    page.heading(2, "Error against run time");
    page.say(
        "One setting at a time, all else by default; means of all trainings with bars of a \
         standard error. Fewer bits and bins are less flash, longer blocks fewer instructions a \
         sample, a shorter training less of a user's patience. The goals are those of hit rate, \
         calibration, time, undecided and refused on both scenes, kept by the mean of the \
         trainings with a standard error to spare. Instructions are counted with the default \
         block; of shorter ones they are at most what is shown.",
    );
    let picture = draw_in(FIGURES.len(), &panels(grounds, &tried))?;
    page.picture(
        "run-time.svg",
        "errors, calibration and time against bits, bins, block and training",
        picture,
    );
    for setting in &SETTINGS {
        of_setting(page, setting, grounds, &tried, counts);
    }
    Ok(())
}

/// A line of panels a setting, a column a figure.
fn panels(grounds: &[Ground], tried: &[Tried<'_>]) -> Vec<Panel> {
    let mut panels = Vec::new();
    for setting in &SETTINGS {
        let is_of_setting = |tried: &&Tried<'_>| tried.setting.name == setting.name;
        let of_setting: Vec<&Tried<'_>> = tried.iter().filter(is_of_setting).collect();
        let most = setting.values.iter().copied().max().unwrap_or(1);
        for (name, figure) in FIGURES {
            let ends = of_setting.iter().map(|tried| tried.mean(figure));
            let ends = ends.map(|(mean, error)| mean + error);
            let top = ends.filter(|x| !x.is_nan()).fold(0.0, f64::max);
            let mut series = Vec::new();
            for (n, ground) in grounds.iter().enumerate() {
                let known = of_setting.iter().filter(|tried| !tried.figures.is_empty());
                let of_ground = known.filter(|tried| tried.ground.name == ground.name);
                let point = |tried: &&Tried<'_>| (f64::from(tried.value), tried.mean(figure));
                let points: Vec<_> = of_ground.map(point).collect();
                let means = points.iter().map(|&(x, (mean, _))| (x, mean)).collect();
                series.push(Series::new(ground.name, n + 1, Mark::Dot, means));
                series.extend(points.iter().map(|&(x, (mean, error))| {
                    let bar = vec![(x, mean - error), (x, mean + error)];
                    Series::new("", n + 1, Mark::Nothing, bar)
                }));
            }
            let x = linear(setting.name, 0.0, f64::from(most));
            panels.push(Panel::new(name, x, linear("", 0.0, 1.1 * top), series));
        }
    }
    panels
}

fn of_setting(
    page: &mut Page,
    setting: &Setting,
    grounds: &[Ground],
    tried: &[Tried<'_>],
    counts: &Counts,
) {
    let values = || {
        let values = setting.values.iter().copied();
        let of = |value| move |t: &&Tried| t.setting.name == setting.name && t.value == value;
        values.map(move |value| (value, tried.iter().filter(of(value)).collect::<Vec<_>>()))
    };
    let measured = || values().filter(|(_, of_value)| !of_value.is_empty());
    let rows = measured().map(|(value, of_value)| {
        let figures = of_value.iter().flat_map(|tried| {
            let [errors, apart, ms] = FIGURES.map(|(_, figure)| tried.mean(figure).0);
            let refused = tried.mean(known_refused).0;
            [
                number(100.0 - errors, 2),
                number(apart, 2),
                number(ms, 0),
                number(refused, 1),
            ]
        });
        let bytes = of_value.iter().map(|tried| tried.bytes).max().unwrap_or(0);
        let last = (setting.cost)(counts, value, bytes);
        row(value.to_string(), figures.chain([last]))
    });
    let rows: Vec<_> = rows.collect();
    let of_scene = |ground: &Ground| format!("{}: hit rate | apart | ms | refused", ground.name);
    let scenes = grounds.iter().map(of_scene).collect::<Vec<_>>().join(" | ");
    page.table(
        &format!("{} | {scenes} | {}", setting.name, setting.last),
        rows,
    );

    let keeps = |(_, of_value): &(u32, Vec<&Tried>)| {
        let enough = |tried: &&Tried| tried.is_enough();
        of_value.len() == grounds.len() && of_value.iter().all(enough)
    };
    let of_value = |found: Option<(u32, Vec<&Tried>)>| {
        found.map_or_else(|| "none".to_owned(), |(value, _)| value.to_string())
    };
    let ms = |(_, of_value): &(u32, Vec<&Tried>)| -> f64 {
        let times = of_value.iter();
        times.map(|tried| tried.mean(|f| f.contact_ms).0).sum()
    };
    let cheapest = of_value(measured().find(keeps));
    let kept = measured().filter(keeps);
    let quickest = kept.min_by(|a, b| ms(a).total_cmp(&ms(b)));
    let defaults = grounds.iter().map(|ground| (setting.default)(ground));
    let mut defaults: Vec<String> = defaults.map(|value| value.to_string()).collect();
    defaults.dedup();
    let quickest = if setting.is_for_time {
        format!(", {} the quickest to decide", of_value(quickest))
    } else {
        String::new()
    };
    page.say(format_args!(
        "**{}**: {} by default, {}. Of those that keep the goals {cheapest} is the \
         cheapest{quickest}.",
        setting.name,
        defaults.join(" and "),
        setting.reason,
    ));
}

/// Of a sample, the end of a block shared among its samples. Mean and worst were counted
/// with the default block: the worst holds the whole end, the mean a sample's share of it. Most
/// ends cost less than the worst: for shorter blocks this is a bound.
fn instructions(counts: &Counts, block: u32) -> String {
    const KERNEL: &str = "joint classifier push K=4";
    let counted = f64::from(Options::default().block);
    let of = |target| {
        let (mean, worst) = counts.mean_and_worst([KERNEL, "integer", target])?;
        let end = (worst - mean) / (1.0 - 1.0 / counted);
        Some(worst - end + end / f64::from(block))
    };
    TARGETS.map(|(_, target)| cell(of(target))).join("; ")
}

struct Setting {
    name: &'static str,
    /// The values tried, the cheapest first.
    values: &'static [u32],
    default: fn(&Ground) -> u32,
    /// Of a training; none where it is refused.
    model: fn(u32, &Ground, &Trained) -> Result<Option<ModelBuf>>,
    /// The last column, and what it says of a value and of the bytes of its model.
    last: &'static str,
    cost: fn(&Counts, u32, usize) -> String,
    /// By what the default is chosen, and whether by how soon decisions fall beside what it costs.
    reason: &'static str,
    is_for_time: bool,
}

static SETTINGS: [Setting; 4] = [
    Setting {
        name: "bits of an entry",
        values: &[6, 8, 10, 12, 16],
        default: |_| 16,
        model: |bits, _, trained| Ok(Some(coarser(&trained.joint, bits).model()?)),
        last: "model",
        // The format has 16 bits; fewer are what a table would take.
        cost: |_, bits, bytes| kib(bytes * bits as usize / 16),
        reason: "a half-word is read in one instruction and needs no scale of its own; fewer bits \
                 would only save flash",
        is_for_time: false,
    },
    Setting {
        name: "bins an axis",
        values: &[8, 16, 24, 32, 64],
        default: |ground| ground.shipped().joint.options.bins as u32,
        model: |bins, ground, trained| {
            let bins = bins as usize;
            let options = trained.joint.options.clone();
            let options = Options { bins, ..options };
            of_options(options, ground.scene.duration_s, ground, trained).map(Some)
        },
        last: "model",
        cost: |_, _, bytes| kib(bytes),
        reason: "finer ones are quicker, but tell fewer of the unknown textures of the elastic whisker \
                 ([decisions.md](../decisions.md#28-bins-and-block-by-many-trainings))",
        is_for_time: true,
    },
    Setting {
        name: "samples of a block",
        values: &[80, 40, 20, 10, 5],
        default: |ground| ground.shipped().joint.options.block,
        model: |block, ground, trained| {
            let options = trained.joint.options.clone();
            let options = Options { block, ..options };
            of_options(options, ground.scene.duration_s, ground, trained).map(Some)
        },
        last: "instructions a sample, M4F; M0+",
        cost: |counts, block, _| instructions(counts, block),
        reason: "meant to be the quickest to decide that keeps the goals",
        is_for_time: true,
    },
    Setting {
        name: "s of training",
        values: &[10, 20, 40, LONGEST_S as u32],
        default: |ground| ground.scene.duration_s.round() as u32,
        // Too short a training is refused.
        model: |seconds, ground, trained| {
            let options = trained.joint.options.clone();
            Ok(of_options(options, seconds.into(), ground, trained).ok())
        },
        last: "model",
        cost: |_, _, bytes| kib(bytes),
        reason: "the scene's own length, in which each texture comes several times",
        is_for_time: false,
    },
];

/// Trained again on the first seconds of its run.
fn of_options(
    mut options: Options,
    seconds: f64,
    ground: &Ground,
    trained: &Trained,
) -> Result<ModelBuf> {
    options.expect = Expect::Same;
    let recording = ground.recording(trained.seed, seconds);
    let recordings = [(ground.scene.name.clone(), recording)];
    Ok(training::joint(&recordings, &options)?.model()?)
}

fn kib(bytes: usize) -> String {
    format!("{:.1} KiB", bytes as f64 / 1024.0)
}

/// A model whose entries have only so many bits: between the least and the largest of
/// each table are 2^bits − 1 equal steps.
fn coarser(joint: &JointModel, bits: u32) -> JointModel {
    let mut joint = joint.clone();
    if bits >= u16::BITS {
        return joint;
    }
    for table in &mut joint.tables {
        let (low, high) = range(table.log2_p.iter().copied());
        let step = (high - low) / f64::from((1_u32 << bits) - 1);
        if step > 0.0 {
            for log2_p in &mut table.log2_p {
                *log2_p = low + step * ((*log2_p - low) / step).round();
            }
        }
    }
    joint
}

/// What a setting's value gave, by training.
struct Tried<'g> {
    setting: &'static Setting,
    value: u32,
    ground: &'g Ground,
    figures: Vec<(u64, Figures)>,
    bytes: usize,
}

impl Tried<'_> {
    fn mean(&self, figure: fn(&Figures) -> f64) -> (f64, f64) {
        let figures = self.figures.iter().map(|(_, figures)| figures);
        over(figures, figure)
    }

    /// Whether the mean over the trainings keeps the goals with a standard error to spare.
    fn is_enough(&self) -> bool {
        let goals = self.ground.goals;
        let keeps = |(figure, most): (Figure, f64)| {
            let (mean, error) = self.mean(figure);
            mean + error <= most
        };
        let most = [1.5, 1.0, goals.contact_ms];
        let drawn = FIGURES.map(|(_, figure)| figure).into_iter().zip(most);
        let others: [(Figure, f64); 2] = [(undecided, goals.undecided), (known_refused, 6.0)];
        drawn.chain(others).all(keeps)
    }
}

fn undecided(figures: &Figures) -> f64 {
    100.0 * figures.all.undecided.share
}

type Figure = fn(&Figures) -> f64;

type Drawn = (&'static str, Figure);

const FIGURES: [Drawn; 3] = [
    ("errors, %", |f| 100.0 - f.hits().0),
    ("stated and found apart, points", |f| f.overstated().abs()),
    ("contact to a decision, ms", |f| f.contact_ms),
];
