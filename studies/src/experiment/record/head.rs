//! Visits of the whisking head: strategies × textures × distances, and
//! early ones, where the surface is nearer and RCP can also be strong and fast:
//! they are looked at but not classified.

use super::whiskers;
use crate::experiment::recording::{Dataset, Recording};
use crate::experiment::request::Request;
use crate::paper::biotact::{
    DISTANCES_MM, OBSTACLES_DEG, STRATEGIES, STRONG, TAU_Z_PERIODS, TEXTURES, WHISKERS,
};
use crate::rigs::{CHANNELS, Visit};
use anyhow::Result;
use whisking::GateSettings;

/// Sensor channels, then θ' of the front whiskers in degrees and whether a
/// side touches (1) or not (0).
pub(crate) const COLUMNS: usize = CHANNELS + 4;

/// Where the front whisker meets the smooth surface in the early visits,
/// degrees: the obstacle of BIOTACT Fig. 8.
pub(crate) const EARLY_DEG: f64 = OBSTACLES_DEG[0];

/// The texture and distance of all in a placebo: P600 at 10 mm.
const PLACEBO: (usize, usize) = (1, 1);

const CLASSIFIED: usize = STRATEGIES.len() * TEXTURES.len() * DISTANCES_MM.len();

/// How many visits there are: those of the strategies, then the early ones, one
/// a strategy and one with strong and fast RCP.
pub(crate) fn jobs() -> usize {
    CLASSIFIED + STRATEGIES.len() + 1
}

/// The job of an early visit; `strategy` is one more than the last for strong
/// and fast RCP.
pub(crate) fn early(strategy: usize) -> usize {
    CLASSIFIED + strategy
}

pub(crate) fn number(strategy: usize, texture: usize, distance: usize) -> usize {
    (strategy * TEXTURES.len() + texture) * DISTANCES_MM.len() + distance
}

pub(crate) fn record(request: &Request, job: usize, seed: u64) -> Result<Recording> {
    let rig = &request.rigs.head;
    let (strategy, texture, distance_m) = if let Some(strategy) = job.checked_sub(CLASSIFIED) {
        let front = WHISKERS[0].0 / 1000.0;
        let reach = -front * libm::cos(EARLY_DEG.to_radians());
        (strategy, TEXTURES.len() - 1, reach - rig.base_back_m[0])
    } else {
        let (group, distance) = (job / DISTANCES_MM.len(), job % DISTANCES_MM.len());
        let (strategy, texture) = (group / TEXTURES.len(), group % TEXTURES.len());
        let distance_m = DISTANCES_MM[request.place(distance, PLACEBO.1)] / 1000.0;
        (strategy, texture, distance_m)
    };
    let (gain, periods) = match STRATEGIES.get(strategy) {
        Some((_, gain)) => (*gain, TAU_Z_PERIODS),
        None => STRONG,
    };
    let surface = request.surface(&whiskers::ABRASIVES, texture, PLACEBO.0);
    let visit = Visit {
        distance_m,
        // The arm goes along its axis: one spot of a texture for all distances and strategies.
        spot_m: request.spot_m(Dataset::Head, texture, seed),
        surface: &surface,
        rcp: (gain > 0.0).then_some(GateSettings {
            gain,
            tau_s: periods / rig.whisk_hz,
        }),
        whisks: request.extent.whisks(),
        seed,
    };
    let felt = rig.visit(
        &whiskers::head(rig.follicle),
        &whiskers::sensor([rig.full_scale_rad; 2]),
        &visit,
    )?;
    let mut values = Vec::with_capacity(felt.angle_deg.len() * COLUMNS);
    let states = felt.angle_deg.iter().zip(&felt.touching);
    for (codes, (angles, touching)) in felt.codes.chunks_exact(CHANNELS).zip(states) {
        values.extend(codes.iter().map(|code| f32::from(*code)));
        values.extend(angles.iter().map(|angle| *angle as f32));
        values.extend(touching.iter().map(|touches| f32::from(u8::from(*touches))));
    }
    Ok(Recording::new(COLUMNS, values))
}
