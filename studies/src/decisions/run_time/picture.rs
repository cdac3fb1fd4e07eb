//! The picture: errors, calibration and time against each setting.

use super::settings::{FIGURES, Setting, Tried};
use crate::chart::{Mark, Panel, Series, linear};
use crate::decisions::ground::Ground;

/// A line of panels a setting, a column a figure.
pub(super) fn panels(grounds: &[Ground], tried: &[Tried<'_>]) -> Vec<Panel> {
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
                x: linear(setting.name(), 0.0, f64::from(most)),
                y: linear("", 0.0, 1.1 * top),
                series,
            });
        }
    }
    panels
}
