//! What the rigs' textures are made of: the properties of [`physics::Surface`], each of which a
//! file `surfaces.toml` or a setting can change by the name of its surface.

use anyhow::Result;
use std::collections::BTreeMap;

use physics::{Grit, Material, Surface};
use serde::Deserialize;
use toml::{Table, Value};

use super::read::{Keys, OutOfRange, keys};

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
    /// The surface of a material, with what is said of it.
    pub(crate) fn of(&self, material: Material) -> Surface {
        let usual = Surface::of(material);
        let name = ALL.iter().find(|(_, other)| *other == material);
        let said = name.and_then(|(name, _)| self.0.get(*name));
        said.map_or(usual, |said| Surface {
            height_m: said.height_m,
            grain_m: said.grain_m,
            stiffness_n_m: said.stiffness_n_m,
            damping: said.damping,
            friction: said.friction,
            hold: said.hold,
            seed: usual.seed,
        })
    }
}

impl Keys for Surfaces {
    fn check(&self) -> Result<(), OutOfRange> {
        self.0.values().try_for_each(Keys::check)
    }
}

/// What the physics has.
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
