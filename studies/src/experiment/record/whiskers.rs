//! Which whisker, sensor and surface of the physics each rig has.

use anyhow::Result;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::paper::psik::ARCS;
use crate::rigs::{Layout, Vibrissa, seed_of};
use physics::{Biotact, Grit, Material, Modes, SensorSettings, Shaft, TouchingWhisker};

pub(crate) fn sensor(full_scale_rad: [f64; 2]) -> SensorSettings {
    SensorSettings {
        full_scale_rad,
        ..SensorSettings::default()
    }
}

pub(crate) fn held(mut shaft: Shaft, follicle: f64) -> Shaft {
    shaft.follicle.rotation_n_m_rad *= follicle;
    shaft
}

/// The whiskers of a side of the head, the front one first.
pub(crate) fn head(follicle: f64) -> [Shaft; 3] {
    Biotact::ALL.map(|length| held(Shaft::biotact(length), follicle))
}

/// The floors of LEP10's tables.
pub(crate) const FLOORS: [Material; 4] = [
    Material::RoughCarpet,
    Material::SmoothCarpet,
    Material::Tarmac,
    Material::Vinyl,
];

/// The textures of the head's experiment, and those at the table, as the papers list them.
pub(crate) const ABRASIVES: [Material; 3] = [
    Material::Sandpaper(Grit::P240),
    Material::Sandpaper(Grit::P600),
    Material::SmoothPlastic,
];
pub(crate) const TABLE: [Material; 4] = [
    Material::Sandpaper(Grit::P80),
    Material::Sandpaper(Grit::P180),
    Material::Sandpaper(Grit::P600),
    Material::Aluminium,
];

/// The eight sandpapers of PSIK Table 2, from coarse to fine. The
/// paper says "from P180 to P50" and eight of them; FEPA has seven grades in
/// that range, so P40 is added.
pub(crate) const SANDPAPERS: [Material; 8] = [
    Material::Sandpaper(Grit::P40),
    Material::Sandpaper(Grit::P50),
    Material::Sandpaper(Grit::P60),
    Material::Sandpaper(Grit::P80),
    Material::Sandpaper(Grit::P100),
    Material::Sandpaper(Grit::P120),
    Material::Sandpaper(Grit::P150),
    Material::Sandpaper(Grit::P180),
];

/// The four walls of relief plexiglass; their periods differ (chosen; PSIK Fig. 8 has no extent).
pub(crate) const WALLS: [Material; 4] = [
    Material::Relief(30),
    Material::Relief(60),
    Material::Relief(100),
    Material::Relief(160),
];

type Arcs = Arc<Vec<(Shaft, Modes)>>;

/// Those of each diameter of the tips and share of the follicle's stiffness that was asked for, by
/// their bits: solving modes takes milliseconds, and there are a hundred thousand vibrissae to make.
static ARC_SHAFTS: Mutex<BTreeMap<[u64; 2], Arcs>> = Mutex::new(BTreeMap::new());

const MODES: usize = 3;

fn arcs(tip_diameter_m: f64, follicle: f64) -> Result<Arcs> {
    let of = |arc| {
        let mut shaft = held(Shaft::psikharpax(arc), follicle);
        shaft.tip_diameter_m = tip_diameter_m.min(shaft.hub_diameter_m);
        anyhow::Ok((shaft, shaft.modes(MODES)?))
    };
    // What another thread had to leave behind is whole: maps are only added to.
    let mut known = ARC_SHAFTS.lock().unwrap_or_else(PoisonError::into_inner);
    let asked = [tip_diameter_m, follicle].map(f64::to_bits);
    if let Some(found) = known.get(&asked) {
        return Ok(Arc::clone(found));
    }
    let made: Arcs = Arc::new((1..=ARCS.len()).map(of).collect::<Result<_>>()?);
    known.insert(asked, Arc::clone(&made));
    Ok(made)
}

/// The vibrissae of a pad. The sensor of the longest has the gain that is given; the same push
/// aside turns shorter ones the more, and their sensors have the less.
pub(crate) fn pad(
    layout: &Layout,
    (full_scale_rad, follicle): (f64, f64),
    seed: u64,
) -> Result<Vec<(Vibrissa, TouchingWhisker)>> {
    let shafts = arcs(layout.tip_diameter_m, follicle)?;
    let longest = shafts[0].0.length_m;
    let make = |(n, of): (usize, Vibrissa)| {
        let (shaft, modes) = &shafts[of.arc];
        let sensor = SensorSettings {
            // Sampled at 1157 Hz by a converter of its own: nothing is held.
            refresh_s: 0.0,
            ..sensor([full_scale_rad * longest / shaft.length_m; 2])
        };
        let seed = seed_of(seed, &[1, n as u64]);
        Ok((
            of,
            TouchingWhisker::with_modes(shaft, modes, &sensor, seed)?,
        ))
    };
    layout
        .vibrissae()
        .into_iter()
        .enumerate()
        .map(make)
        .collect()
}
