//! Visits of the whisking head: strategies × textures × distances, and one
//! visit with strong and fast RCP that is looked at but not classified.

use super::whiskers;
use crate::Error;
use crate::experiment::paper::biotact::{DISTANCES_MM, STRATEGIES, TAU_Z_PERIODS, TEXTURES};
use crate::experiment::recording::Recording;
use crate::experiment::request::Request;
use crate::rigs::{CHANNELS, Visit};
use whisking::GateSettings;

/// Sensor channels, then θ' of the front whiskers in degrees and whether a
/// side touches (1) or not (0).
pub(crate) const COLUMNS: usize = CHANNELS + 4;

/// Strong and fast RCP (BIOTACT Fig. 8): σ_z and τ_z in whisk periods.
pub(crate) const STRONG: (f64, f64) = (2.0, 0.1);

/// How many visits there are: those of the strategies, then the strong ones,
/// one a distance, at the smooth surface.
pub(crate) fn jobs() -> usize {
    (STRATEGIES.len() * TEXTURES.len() + 1) * DISTANCES_MM.len()
}

/// The job of a visit; `strategy` is one more than the last for the strong ones.
pub(crate) fn number(strategy: usize, texture: usize, distance: usize) -> usize {
    let group = if strategy < STRATEGIES.len() {
        strategy * TEXTURES.len() + texture
    } else {
        STRATEGIES.len() * TEXTURES.len()
    };
    group * DISTANCES_MM.len() + distance
}

/// Records a visit.
pub(crate) fn record(request: &Request, job: usize, seed: u64) -> Result<Recording, Error> {
    let rig = &request.rigs.head;
    let (group, distance) = (job / DISTANCES_MM.len(), job % DISTANCES_MM.len());
    let (strategy, texture) = (group / TEXTURES.len(), group % TEXTURES.len());
    let (gain, periods, texture) = match STRATEGIES.get(strategy) {
        Some((_, gain)) => (*gain, TAU_Z_PERIODS, texture),
        None => (STRONG.0, STRONG.1, TEXTURES.len() - 1),
    };
    let surface = whiskers::abrasive(texture);
    let visit = Visit {
        distance_m: DISTANCES_MM[distance] / 1000.0,
        surface: &surface,
        rcp: (gain > 0.0).then_some(GateSettings {
            gain,
            tau_s: periods / rig.whisk_hz,
        }),
        whisks: request.scale.whisks(),
        seed,
    };
    let felt = rig.visit(
        &whiskers::head(),
        &whiskers::sensor(rig.full_scale_rad),
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
