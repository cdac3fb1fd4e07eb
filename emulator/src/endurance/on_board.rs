//! Hours of a scene on an emulated board, beside the PC.

use std::path::Path;
use std::time::Instant;

use host_sim::Error;
use host_sim::loaded::Loaded;

use super::row::ShardRow;
use crate::compare::{Circumstances, compare};

/// Every counter starts just below its wrap, and on the PC at zero. Every tick and every decision
/// must be the same, no tick may be missed, and every counter must wrap.
pub(super) fn on_board(
    path: &Path,
    program: &Path,
    subject: &str,
    hours: f64,
) -> Result<ShardRow, Error> {
    let begun = Instant::now();
    let scene = Loaded::new(path)?.scene;
    let circumstances = Circumstances {
        wraps: true,
        duration_s: Some(3_600.0 * hours),
        ..Circumstances::default()
    };
    let agreed = compare(path, program, circumstances)?;
    if agreed.missed > 0 {
        let fault = format!("{}: {} ticks missed", path.display(), agreed.missed);
        return Err(Error::Work(fault));
    }
    Ok(ShardRow {
        subject: subject.to_owned(),
        scene: scene.name,
        seed: scene.seed,
        hours,
        ticks: agreed.ticks,
        decisions: agreed.decisions,
        touches: agreed.touches,
        wrapped: agreed.wrapped as u64,
        took_s: begun.elapsed().as_secs_f64(),
        ..ShardRow::default()
    })
}
