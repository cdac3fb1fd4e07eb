//! Which whisker, sensor and surface of the physics each rig has.

use anyhow::{Context, Result};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::paper::psik::ARCS;
use crate::rigs::{Layout, Surfaces, Vibrissa, seed_of};
use physics::{Biotact, Grit, Material, Modes, SensorSettings, Shaft, Surface, TouchingWhisker};

/// A sensor with a rig's gains of x and y.
pub(crate) fn sensor(full_scale_rad: [f64; 2]) -> SensorSettings {
    SensorSettings {
        full_scale_rad,
        ..SensorSettings::default()
    }
}

/// A shaft whose follicle is so many times as stiff.
pub(crate) fn held(mut shaft: Shaft, follicle: f64) -> Shaft {
    shaft.follicle.rotation_n_m_rad *= follicle;
    shaft
}

/// The whiskers of a side of the head, the front one first.
pub(crate) fn head(follicle: f64) -> [Shaft; 3] {
    Biotact::ALL.map(|length| held(Shaft::biotact(length), follicle))
}

/// A floor by its place in LEP10's tables.
pub(crate) fn floor(surfaces: &Surfaces, floor: usize) -> Surface {
    surfaces.of(match floor {
        0 => Material::RoughCarpet,
        1 => Material::SmoothCarpet,
        2 => Material::Tarmac,
        _ => Material::Vinyl,
    })
}

/// A texture of the head's experiment by its place in the paper's list.
pub(crate) fn abrasive(surfaces: &Surfaces, texture: usize) -> Surface {
    surfaces.of(match texture {
        0 => Material::Sandpaper(Grit::P240),
        1 => Material::Sandpaper(Grit::P600),
        _ => Material::SmoothPlastic,
    })
}

/// A texture at the table by its place in the paper's list.
pub(crate) fn table_texture(surfaces: &Surfaces, texture: usize) -> Surface {
    surfaces.of(match texture {
        0 => Material::Sandpaper(Grit::P80),
        1 => Material::Sandpaper(Grit::P180),
        2 => Material::Sandpaper(Grit::P600),
        _ => Material::Aluminium,
    })
}

/// Grades of the eight sandpapers of PSIK Table 2, from coarse to fine. The
/// paper says "from P180 to P50" and eight of them; FEPA has seven grades in
/// that range, so P40 is added.
const GRADES: [Grit; 8] = [
    Grit::P40,
    Grit::P50,
    Grit::P60,
    Grit::P80,
    Grit::P100,
    Grit::P120,
    Grit::P150,
    Grit::P180,
];

pub(crate) fn sandpaper(surfaces: &Surfaces, number: usize) -> Surface {
    let grade = GRADES.get(number).copied().unwrap_or(Grit::P180);
    surfaces.of(Material::Sandpaper(grade))
}

type Arcs = Arc<Vec<(Shaft, Modes)>>;

/// Those of each diameter of the tips and share of the follicle's stiffness that was asked for, by
/// their bits: solving modes takes milliseconds, and there are a hundred thousand vibrissae to make.
static ARC_SHAFTS: Mutex<BTreeMap<[u64; 2], Arcs>> = Mutex::new(BTreeMap::new());

const MODES: usize = 3;

fn arcs(tip_diameter_m: f64, follicle: f64) -> Arcs {
    let of = |arc| {
        let mut shaft = held(Shaft::psikharpax(arc), follicle);
        shaft.tip_diameter_m = tip_diameter_m.min(shaft.hub_diameter_m);
        shaft.modes(MODES).map(|modes| (shaft, modes))
    };
    // What another thread had to leave behind is whole: maps are only added to.
    let mut known = ARC_SHAFTS.lock().unwrap_or_else(PoisonError::into_inner);
    let new = || Arc::new((1..=ARCS.len()).filter_map(|arc| of(arc).ok()).collect());
    let asked = [tip_diameter_m, follicle].map(f64::to_bits);
    let found = known.entry(asked).or_insert_with(new);
    Arc::clone(found)
}

/// A vibrissa of an arc, from 0, of all `shafts`. The sensor of the longest has the gain that is
/// given; the same push aside turns shorter ones the more, and their sensors have the less.
fn vibrissa(shafts: &Arcs, arc: usize, full_scale_rad: f64, seed: u64) -> Result<TouchingWhisker> {
    let (shaft, modes) = shafts.get(arc).context("no such arc")?;
    let longest = shafts
        .first()
        .map_or(shaft.length_m, |(shaft, _)| shaft.length_m);
    let sensor = SensorSettings {
        // Sampled at 1157 Hz by a converter of its own: nothing is held.
        refresh_s: 0.0,
        ..sensor([full_scale_rad * longest / shaft.length_m; 2])
    };
    TouchingWhisker::with_modes(shaft, modes, &sensor, seed).map_err(anyhow::Error::new)
}

/// The vibrissae of a pad, arc by arc, each with a seed of its own.
pub(crate) fn pad(
    layout: &Layout,
    (full_scale_rad, follicle): (f64, f64),
    seed: u64,
) -> Result<Vec<(Vibrissa, TouchingWhisker)>> {
    let shafts = arcs(layout.tip_diameter_m, follicle);
    let vibrissae = layout.vibrissae().into_iter().enumerate();
    let make = |(n, of): (usize, Vibrissa)| {
        let seed = seed_of(seed, &[1, n as u64]);
        let whisker = vibrissa(&shafts, of.arc, full_scale_rad, seed)?;
        Ok((of, whisker))
    };
    vibrissae.map(make).collect()
}

/// The four walls of relief plexiglass, by number: their periods differ.
pub(crate) fn wall(surfaces: &Surfaces, number: usize) -> Surface {
    /// Periods, tenths of a millimetre (chosen; PSIK Fig. 8 has no extent).
    const PERIODS: [u16; 4] = [30, 60, 100, 160];
    let period = PERIODS.get(number).copied().unwrap_or(30);
    surfaces.of(Material::Relief(period))
}
