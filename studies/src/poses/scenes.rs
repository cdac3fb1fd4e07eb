//! The scene `textures`, and the one whose presentations differ in pose.

use anyhow::Result;
use host_sim::training::Expected;
use tactile::ModelBuf;

use super::Extent;
use super::asked::Asked;
use super::condition::{SPREAD, Setting, TEXTURES};
use super::output::{COLUMNS, Output};
use super::tally::Tally;
use super::trained::{THRESHOLD, Trained, as_felt};

/// Seconds of the training of what is spread.
const SPREAD_S: f64 = 240.0;

/// Measures both; the trainings of what is spread, and their models.
pub(super) fn section(
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
        (
            setting(TEXTURES, None),
            [7041, 7401],
            Asked::Known {
                decided: 97.0,
                ms: Some(120.0),
            },
        ),
        (
            setting(SPREAD, Some(SPREAD_S)),
            [7051, 7411],
            Asked::Known {
                decided: 85.0,
                ms: None,
            },
        ),
    ];
    let mut rows = Vec::new();
    let mut last = None;
    for (setting, [seed, fresh], asked) in scenes {
        let trained = Trained::record((extent, 1), (&[setting], seed..), (setting, fresh))?;
        let models = trained.models(Expected::Bench, &as_felt)?;
        let tallies = trained.fresh(&models, THRESHOLD)?;
        let name = setting.file.name;
        rows.push(output.row(["scenes", name, "bench"], &trained, &tallies, asked));
        output.asked(&format!("scene `{name}`"), asked, &Tally::sum(&tallies));
        last = Some((trained, models));
    }
    output
        .page
        .table(&format!("scene | {COLUMNS} | goal | "), rows);
    last.ok_or_else(|| anyhow::anyhow!("no scene"))
}
