//! The main job over many runs.

use anyhow::Result;
use host_sim::progress::Verbosity;

use super::extent::Extent;
use super::figures::{Table, mean_of, percent, plus_minus};
use super::ground::{Ground, record_all};
use crate::page::Page;

/// A scene with its shipped model: what `docs/textures.md` quotes.
pub(super) fn section(
    page: &mut Page,
    table: &mut Table,
    ground: &Ground,
    extent: &Extent,
    verbosity: Verbosity,
) -> Result<()> {
    let shipped = ground.shipped();
    let seeds: Vec<u64> = extent.main_job.clone().collect();
    let runs = record_all(&ground.scene, &seeds, verbosity)?;
    let figures = ground.score_on(&runs, &shipped.model, 0.99)?;
    table.add(
        ["main job", ground.name, "as shipped"],
        shipped.seed,
        &figures,
    );
    page.heading(2, "The main job");
    let (mean, error) = mean_of(&figures.hits);
    page.say(format_args!(
        "`cargo run -p host-sim` shows one run. Over {} runs with seeds {} to {} the \
         same model has a hit rate of {} %, in the worst run {:.1} %. A mean posterior of {:.2} % \
         was right in {}; {:.0} ms of contact to a decision; {} refused.",
        seeds.len(),
        extent.main_job.start,
        extent.main_job.end - 1,
        plus_minus((100.0 * mean, 100.0 * error), 2),
        figures.worst(),
        100.0 * figures.calibration.stated,
        percent(figures.calibration.found),
        figures.contact_ms,
        percent(figures.refused),
    ));
    Ok(())
}
