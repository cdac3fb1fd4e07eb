//! Error against run time: what bits, bins, blocks and time of training are worth.

use host_sim::Error;
use host_sim::progress::Verbosity;
use tactile::ModelBuf;
use tactile::train::joint::{JointModel, Options};

use super::extent::Extent;
use super::figures::{Figures, Key, Table, number, over};
use super::goals::Trained;
use super::ground::{Ground, LONGEST_S};
use crate::accuracy::counts::{Counts, Target};
use crate::chart::{Mark, Panel, Series, draw_in, linear};
use crate::cores::each;
use crate::page::{Page, row};
use crate::refused::refused;

/// What is varied, all else by default.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Setting {
    /// Bits of an entry of a table, between the least and the largest of it.
    Bits,
    /// Bins an axis.
    Bins,
    /// Samples of a block.
    Block,
    /// Seconds of the run that is trained on.
    Training,
}

impl Setting {
    const ALL: [Self; 4] = [Self::Bits, Self::Bins, Self::Block, Self::Training];

    const fn name(self) -> &'static str {
        match self {
            Self::Bits => "bits of an entry",
            Self::Bins => "bins an axis",
            Self::Block => "samples of a block",
            Self::Training => "s of training",
        }
    }

    /// The values tried, the cheapest first.
    const fn values(self) -> &'static [u32] {
        match self {
            Self::Bits => &[6, 8, 10, 12, 16],
            Self::Bins => &[8, 16, 32, 64],
            Self::Block => &[80, 40, 20, 10, 5],
            Self::Training => &[10, 20, 40, LONGEST_S as u32],
        }
    }

    /// The product's.
    fn default(self, ground: &Ground, options: &Options) -> u32 {
        match self {
            Self::Bits => 16,
            Self::Bins => options.bins as u32,
            Self::Block => options.block,
            Self::Training => ground.scene.duration_s.round() as u32,
        }
    }

    /// A training with it.
    fn model(self, value: u32, ground: &Ground, trained: &Trained) -> Result<ModelBuf, Error> {
        let options = trained.joint.options.clone();
        let seconds = match self {
            Self::Training => f64::from(value),
            _ => ground.scene.duration_s,
        };
        let joint = match self {
            Self::Bits => coarser(&trained.joint, value),
            Self::Bins | Self::Block | Self::Training => {
                let options = match self {
                    Self::Bins => Options {
                        bins: value as usize,
                        ..options
                    },
                    Self::Block => Options {
                        block: value,
                        ..options
                    },
                    _ => options,
                };
                ground.train_by(ground.recording(trained.seed, seconds), &options)?
            }
        };
        joint.model().map_err(refused)
    }
}

/// A model whose entries have only so many bits: between the least and the largest of
/// each table are 2^bits − 1 equal steps.
fn coarser(joint: &JointModel, bits: u32) -> JointModel {
    let mut joint = joint.clone();
    if bits >= u16::BITS {
        return joint;
    }
    for table in &mut joint.tables {
        let (low, high) = crate::moments::range(table.log2_p.iter().copied());
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
struct Tried {
    setting: Setting,
    value: u32,
    ground: usize,
    /// Of the trainings that this was enough for.
    figures: Vec<(u64, Figures)>,
    /// Bytes of the first model.
    bytes: usize,
}

impl Tried {
    fn mean(&self, figure: fn(&Figures) -> f64) -> (f64, f64) {
        let figures = self.figures.iter().map(|(_, figures)| figures);
        over(figures, figure)
    }

    /// Whether the mean over the trainings keeps the goals with a standard error to spare.
    fn is_enough(&self, ground: &Ground) -> bool {
        let most = [1.5, 1.0, ground.goals.contact_ms];
        let keeps = |((_, figure), most): (Drawn, f64)| {
            let (mean, error) = self.mean(figure);
            mean + error <= most
        };
        FIGURES.into_iter().zip(most).all(keeps)
    }
}

/// A figure and its name.
type Drawn = (&'static str, fn(&Figures) -> f64);

/// What is drawn of each.
const FIGURES: [Drawn; 3] = [
    ("errors, %", |f| 100.0 - f.hit_rate()),
    ("stated and found apart, points", |f| f.overstated().abs()),
    ("contact to a decision, ms", |f| f.contact_ms),
];

/// All settings on both scenes.
pub(super) fn section(
    page: &mut Page,
    table: &mut Table,
    grounds: &[Ground],
    trained: &[Vec<Trained>],
    counts: &Counts,
    extent: &Extent,
    verbosity: Verbosity,
) -> Result<(), Error> {
    let mut jobs = Vec::new();
    for setting in Setting::ALL {
        for &value in setting.values().iter().take(extent.values) {
            jobs.extend((0..grounds.len()).map(|ground| (setting, value, ground)));
        }
    }
    let tried = each(verbosity, "settings", &jobs, |&(setting, value, n)| {
        let (ground, trained) = (&grounds[n], &trained[n]);
        let (mut figures, mut bytes) = (Vec::new(), 0);
        for one in trained {
            // Too short a training is refused: it then has no figure.
            let Ok(model) = setting.model(value, ground, one) else {
                continue;
            };
            bytes = model.as_bytes().len();
            figures.push((one.seed, ground.score(&model, 0.99)?));
        }
        Ok(Tried {
            setting,
            value,
            ground: n,
            figures,
            bytes,
        })
    })?;
    for tried in &tried {
        let setting = format!("{} {}", tried.value, tried.setting.name());
        for (seed, figures) in &tried.figures {
            let key = Key {
                part: "run time",
                scene: grounds[tried.ground].name,
                setting: &setting,
                seed: *seed,
            };
            table.add(key, figures);
        }
    }

    page.heading(2, "Error against run time");
    page.say(
        "One setting at a time, all else by default; means of all trainings with bars of a \
         standard error. Fewer bits and bins are less flash, longer blocks fewer instructions a \
         sample, a shorter training less of a user's patience. The goals are those of hit rate, \
         calibration and time on both scenes, kept by the mean of the trainings with a standard \
         error to spare.",
    );
    let picture = draw_in(3, &panels(grounds, &tried))?;
    page.picture(
        "run-time.svg",
        "errors, calibration and time against bits, bins, block and training",
        picture,
    );
    for setting in Setting::ALL {
        of_setting(page, setting, grounds, trained, &tried, counts);
    }
    Ok(())
}

/// Table and conclusion of a setting.
fn of_setting(
    page: &mut Page,
    setting: Setting,
    grounds: &[Ground],
    trained: &[Vec<Trained>],
    tried: &[Tried],
    counts: &Counts,
) {
    let values = || {
        let values = setting.values().iter().copied();
        let of = move |value| move |t: &&Tried| t.setting == setting && t.value == value;
        values.map(move |value| (value, tried.iter().filter(of(value)).collect::<Vec<_>>()))
    };
    let measured = || values().filter(|(_, of_value)| !of_value.is_empty());
    let rows = measured().map(|(value, of_value)| {
        let figures = of_value.iter().flat_map(|tried| {
            let [errors, apart, ms] = FIGURES.map(|(_, figure)| tried.mean(figure).0);
            [number(100.0 - errors, 2), number(apart, 2), number(ms, 0)]
        });
        let bytes = of_value.iter().map(|tried| tried.bytes).max().unwrap_or(0);
        // The format has 16 bits; fewer are what a table would take.
        let bytes = match setting {
            Setting::Bits => bytes * value as usize / 16,
            _ => bytes,
        };
        let last = match setting {
            Setting::Block => instructions(counts, value),
            _ => format!("{:.1} KiB", bytes as f64 / 1024.0),
        };
        row(value.to_string(), figures.chain([last]))
    });
    let rows: Vec<_> = rows.collect();
    let of_scenes = grounds.iter().map(|ground| {
        let name = ground.name;
        format!("{name}: hit rate | apart | ms")
    });
    let last = match setting {
        Setting::Block => "instructions a sample, M4F; M0+",
        _ => "model",
    };
    let header: Vec<String> = of_scenes.collect();
    page.table(
        &format!("{} | {} | {last}", setting.name(), header.join(" | ")),
        rows,
    );

    let keeps = |(_, of_value): &(u32, Vec<&Tried>)| {
        let enough = |tried: &&Tried| tried.is_enough(&grounds[tried.ground]);
        of_value.len() == grounds.len() && of_value.iter().all(enough)
    };
    let of_value = |found: Option<(u32, Vec<&Tried>)>| {
        found.map_or_else(|| "none".to_owned(), |(value, _)| value.to_string())
    };
    let ms = |(_, of_value): &(u32, Vec<&Tried>)| -> f64 {
        of_value
            .iter()
            .map(|tried| tried.mean(|f| f.contact_ms).0)
            .sum()
    };
    let cheapest = of_value(measured().find(keeps));
    let quickest = measured()
        .filter(keeps)
        .min_by(|a, b| ms(a).total_cmp(&ms(b)));
    let mut defaults: Vec<String> = grounds
        .iter()
        .zip(trained)
        .filter_map(|(ground, trained)| {
            let options = &trained.first()?.joint.options;
            Some(setting.default(ground, options).to_string())
        })
        .collect();
    defaults.dedup();
    // Bits and training are chosen by what they cost.
    let quickest = match setting {
        Setting::Bits | Setting::Training => String::new(),
        Setting::Bins | Setting::Block => {
            format!(", {} the quickest to decide", of_value(quickest))
        }
    };
    page.say(format_args!(
        "**{}**: {} by default, {}. Of those that keep the goals {cheapest} is the \
         cheapest{quickest}.",
        setting.name(),
        defaults.join(" and "),
        reason(setting),
    ));
}

/// By what the default is chosen.
const fn reason(setting: Setting) -> &'static str {
    match setting {
        Setting::Bits => {
            "a half-word is read in one instruction and needs no scale of its own; fewer bits \
             would only save flash"
        }
        Setting::Bins | Setting::Block => "meant to be the quickest to decide that keeps the goals",
        Setting::Training => "the scene's own length, in which each texture comes several times",
    }
}

/// Of a sample, the end of a block shared among its samples. Mean and worst were counted
/// with blocks of 20: the worst holds the whole end, the mean a twentieth of it.
fn instructions(counts: &Counts, block: u32) -> String {
    const KERNEL: &str = "joint classifier push K=4";
    const COUNTED: f64 = 20.0;
    let of = |target| {
        let (mean, worst) = counts.mean_and_worst(KERNEL, "integer", target)?;
        let end = (worst - mean) / (1.0 - 1.0 / COUNTED);
        Some(worst - end + end / f64::from(block))
    };
    let cell = |target| of(target).map_or_else(|| "not counted".to_owned(), |n| format!("{n:.0}"));
    Target::ALL.map(cell).join("; ")
}

/// A line of panels a setting, a column a figure.
fn panels(grounds: &[Ground], tried: &[Tried]) -> Vec<Panel> {
    let mut panels = Vec::new();
    for setting in Setting::ALL {
        for (name, figure) in FIGURES {
            let of_setting = || tried.iter().filter(move |tried| tried.setting == setting);
            let highest = of_setting().map(|tried| {
                let (mean, error) = tried.mean(figure);
                mean + error
            });
            let top = highest.filter(|x| !x.is_nan()).fold(0.0, f64::max);
            let most = setting.values().iter().copied().max().unwrap_or(1);
            let mut series = Vec::new();
            for (n, ground) in grounds.iter().enumerate() {
                let of_ground = || of_setting().filter(move |tried| tried.ground == n);
                let known = of_ground().filter(|tried| !tried.figures.is_empty());
                let points: Vec<_> = known
                    .map(|tried| (f64::from(tried.value), tried.mean(figure)))
                    .collect();
                let means = points.iter().map(|&(x, (mean, _))| (x, mean)).collect();
                series.push(Series::new(ground.name, n + 1, Mark::Dot, means));
                series.extend(points.iter().map(|&(x, (mean, error))| {
                    let bar = vec![(x, mean - error), (x, mean + error)];
                    Series::new("", n + 1, Mark::Nothing, bar)
                }));
            }
            panels.push(Panel {
                title: name.to_owned(),
                x: linear(setting.name(), 0.0, f64::from(most)),
                y: linear("", 0.0, 1.1 * top),
                series,
            });
        }
    }
    panels
}

#[cfg(test)]
mod tests {
    use super::{Counts, instructions};

    #[test]
    fn the_end_of_a_block_is_shared_among_its_samples() {
        // 100 a sample and 200 for the end.
        let table = b"kernel,format,target,mean,worst\n\
            joint classifier push K=4,integer,cortex-m4f,110,300\n";
        let counts = Counts::parse(table);
        assert_eq!(instructions(&counts, 20), "110; not counted");
        assert_eq!(instructions(&counts, 5), "140; not counted");
    }
}
