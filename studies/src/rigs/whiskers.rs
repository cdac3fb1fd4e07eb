//! Which whisker, sensor and surface of the physics each rig has, and what surfaces are made of: the
//! properties of [`physics::Surface`], each of which a file `surfaces.toml` or a setting can change by
//! the name of its surface.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::Result;
use physics::{Grit, Material, Modes, SensorSettings, Shaft, Surface, TouchingWhisker};
use serde::Deserialize;
use toml::{Table, Value};

use super::{Keys, Layout, OutOfRange, Vibrissa, keys, seed_of};
use crate::paper::psik::ARCS;

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

/// The surfaces of each rig by their names: the floors of LEP10's tables, the textures of the head's
/// experiment, and those at the table, as the papers list them.
pub(crate) const FLOORS: [&str; 4] = ["rough_carpet", "smooth_carpet", "tarmac", "vinyl"];
pub(crate) const ABRASIVES: [&str; 3] = ["p240", "p600", "smooth_plastic"];
pub(crate) const TABLE: [&str; 4] = ["p80", "p180", "p600", "aluminium"];

/// The eight sandpapers of PSIK Table 2, from coarse to fine. The paper says "from P180 to P50" and
/// eight of them; FEPA has seven grades in that range, so P40 is added.
pub(crate) const SANDPAPERS: [&str; 8] =
    ["p40", "p50", "p60", "p80", "p100", "p120", "p150", "p180"];

/// The four walls of relief plexiglass; their periods differ (chosen; PSIK Fig. 8 has no extent).
pub(crate) const WALLS: [&str; 4] = ["relief_30", "relief_60", "relief_100", "relief_160"];

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
        let whisker = TouchingWhisker::with_modes(shaft, modes, &sensor, seed)?;
        Ok((of, whisker))
    };
    let vibrissae = layout.vibrissae().into_iter();
    vibrissae.enumerate().map(make).collect()
}

keys! {
    /// A surface; see [`Surface`] for each key and [`Surface::of`] for sources and choices.
    Properties, rig:
    height_m: f64 => 0.0..=0.01,
    grain_m: f64 => 1e-6..=0.1,
    stiffness_n_m: f64 => 1.0..=1e9,
    damping: f64 => 0.0..=10.0,
    friction: f64 => 0.0..=10.0,
    hold: f64 => rig.friction..=10.0,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(transparent)]
pub(crate) struct Surfaces(BTreeMap<String, Properties>);

/// The names of materials' surfaces. That of a relief has its period in tenths of a millimetre.
const ALL: [(&str, Material); 21] = [
    ("rough_carpet", Material::RoughCarpet),
    ("smooth_carpet", Material::SmoothCarpet),
    ("tarmac", Material::Tarmac),
    ("vinyl", Material::Vinyl),
    ("smooth_plastic", Material::SmoothPlastic),
    ("aluminium", Material::Aluminium),
    ("p40", Material::Sandpaper(Grit::P40)),
    ("p50", Material::Sandpaper(Grit::P50)),
    ("p60", Material::Sandpaper(Grit::P60)),
    ("p80", Material::Sandpaper(Grit::P80)),
    ("p100", Material::Sandpaper(Grit::P100)),
    ("p120", Material::Sandpaper(Grit::P120)),
    ("p150", Material::Sandpaper(Grit::P150)),
    ("p180", Material::Sandpaper(Grit::P180)),
    ("p240", Material::Sandpaper(Grit::P240)),
    ("p600", Material::Sandpaper(Grit::P600)),
    ("relief_30", Material::Relief(30)),
    ("relief_60", Material::Relief(60)),
    ("relief_100", Material::Relief(100)),
    ("relief_160", Material::Relief(160)),
    ("flat", Material::Flat),
];

impl Surfaces {
    /// A surface by its name in [`ALL`], with what is said of it.
    pub(crate) fn of(&self, name: &str) -> Surface {
        let material = ALL.iter().find(|(other, _)| *other == name);
        let (_, material) = material.expect("rigs name surfaces that there are");
        let said = &self.0[name];
        Surface {
            height_m: said.height_m,
            grain_m: said.grain_m,
            stiffness_n_m: said.stiffness_n_m,
            damping: said.damping,
            friction: said.friction,
            hold: said.hold,
            seed: Surface::of(*material).seed,
        }
    }
}

impl Keys for Surfaces {
    fn check(&self) -> Result<(), OutOfRange> {
        self.0.values().try_for_each(Keys::check)
    }
}

pub(super) fn defaults() -> Table {
    let table = |(name, material): (&str, Material)| {
        let surface = Surface::of(material);
        let properties = [
            ("height_m", surface.height_m),
            ("grain_m", surface.grain_m),
            ("stiffness_n_m", surface.stiffness_n_m),
            ("damping", surface.damping),
            ("friction", surface.friction),
            ("hold", surface.hold),
        ];
        let keys = properties.map(|(key, value)| (key.to_owned(), Value::Float(value)));
        (name.to_owned(), Value::Table(Table::from_iter(keys)))
    };
    Table::from_iter(ALL.map(table))
}
