//! Error against run time: what bits, bins, blocks and time of training are worth.

mod settings;

use anyhow::Result;
use tactile::train::joint::Options;

use super::Extent;
use super::figures::number;
use super::ground::Ground;
use crate::accuracy::counts::{Counts, TARGETS};
use crate::chart::{Mark, Panel, Series, draw_in, linear};
use crate::page::{Page, row};
use settings::{FIGURES, SETTINGS, Setting, Tried};

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
                let Some(model) = (setting.model)(value, ground, one)? else {
                    continue;
                };
                bytes = model.as_bytes().len();
                figures.push((one.seed, ground.score(&model, 0.99)?));
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
        for (name, figure) in FIGURES {
            let of_setting = || {
                tried
                    .iter()
                    .filter(move |tried| tried.setting.name == setting.name)
            };
            let highest = of_setting().map(|tried| {
                let (mean, error) = tried.mean(figure);
                mean + error
            });
            let top = highest.filter(|x| !x.is_nan()).fold(0.0, f64::max);
            let most = setting.values.iter().copied().max().unwrap_or(1);
            let mut series = Vec::new();
            for (n, ground) in grounds.iter().enumerate() {
                let of_ground = || of_setting().filter(|tried| tried.ground.name == ground.name);
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
                x: linear(setting.name, 0.0, f64::from(most)),
                y: linear("", 0.0, 1.1 * top),
                series,
            });
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
            let refused = tried.mean(settings::known_refused).0;
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
    let of_scenes = grounds.iter().map(|ground| {
        let name = ground.name;
        format!("{name}: hit rate | apart | ms | refused")
    });
    let header: Vec<String> = of_scenes.collect();
    page.table(
        &format!(
            "{} | {} | {}",
            setting.name,
            header.join(" | "),
            setting.last
        ),
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
        .map(|ground| (setting.default)(ground).to_string())
        .collect();
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
        let (mean, worst) = counts.mean_and_worst(KERNEL, "integer", target)?;
        let end = (worst - mean) / (1.0 - 1.0 / counted);
        Some(worst - end + end / f64::from(block))
    };
    let cell = |target| of(target).map_or_else(|| "not counted".to_owned(), |n| format!("{n:.0}"));
    TARGETS.map(cell).join("; ")
}
