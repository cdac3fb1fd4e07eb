//! The main job over many runs.

use anyhow::{Context, Result};
use host_sim::commands::main_job;
use host_sim::progress::Verbosity;
use host_sim::training::{How, Tables};

use super::{Extent, percent, plus_minus, record_all, score_on};
use crate::page::{Page, verdict};

/// The main job's scene with the model that it trains: what `docs/textures.md` quotes.
pub(super) fn section(page: &mut Page, extent: &Extent) -> Result<()> {
    let scene = main_job::scene()?;
    let streams = main_job::record(&scene, Verbosity::Quiet)?;
    let how = How::of(Tables::Joint).like(&scene);
    let trained = how.train(&[(scene.name.clone(), streams)], scene.tick_hz)?;
    let joint = trained.joint.as_ref();
    let opinion = joint.and_then(|joint| joint.opinion.as_ref());
    let poses = opinion.context("the main job has no second opinion")?.poses;
    let seeds: Vec<u64> = extent.main_job.clone().collect();
    let runs = record_all(&scene, &seeds, extent)?;
    let figures = score_on(&runs, &trained.model, 0.99, scene.tick_hz)?;
    let of = ["main job", &scene.name, "as shipped"];
    figures.keep(page, of, scene.seed + 1);
    page.heading(2, "The main job");
    let calibration = &figures.all.calibration;
    let (stated, found) = (calibration.stated, calibration.found.share);
    let decided = 100.0 * (1.0 - figures.all.undecided.share);
    page.say(format_args!(
        "`cargo run -p host-sim` shows one run of `scenes/bench-textures.toml`, in which each \
         presentation has a pose of its own; it trains on {poses} poses. Over {} runs with seeds \
         {} to {} the same model has a hit rate of {} %, in the worst run {:.1} %. A mean \
         posterior of {:.2} % was right in {} (goals: at least 98.5 %, {}, and a point apart, {}); \
         {:.0} ms of contact to a decision; in {decided:.1} % of presentations a class is named \
         (goal: 85 %, {}).",
        seeds.len(),
        extent.main_job.start,
        extent.main_job.end - 1,
        plus_minus(figures.hits(), 2),
        figures.worst(),
        100.0 * stated,
        percent(calibration.found),
        verdict(found >= 0.985),
        verdict((stated - found).abs() <= 0.01),
        figures.contact_ms,
        verdict(decided >= 85.0),
    ));
    Ok(())
}
