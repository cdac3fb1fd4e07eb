//! What the rigs' textures are made of: the properties of [`physics::Surface`], each of which a
//! file `surfaces.toml` or a setting can change by the name of its surface.

use anyhow::Result;
use std::collections::BTreeMap;

use physics::{Grit, Material, Surface};
use serde::Deserialize;
use toml::{Table, Value};

use super::read::{Keys, OutOfRange, Rig, keys};

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

const ALL: [Material; 21] = [
    Material::RoughCarpet,
    Material::SmoothCarpet,
    Material::Tarmac,
    Material::Vinyl,
    Material::SmoothPlastic,
    Material::Aluminium,
    Material::Sandpaper(Grit::P40),
    Material::Sandpaper(Grit::P50),
    Material::Sandpaper(Grit::P60),
    Material::Sandpaper(Grit::P80),
    Material::Sandpaper(Grit::P100),
    Material::Sandpaper(Grit::P120),
    Material::Sandpaper(Grit::P150),
    Material::Sandpaper(Grit::P180),
    Material::Sandpaper(Grit::P240),
    Material::Sandpaper(Grit::P600),
    Material::Relief(30),
    Material::Relief(60),
    Material::Relief(100),
    Material::Relief(160),
    Material::Flat,
];

/// The name of a material's surface. That of a relief has its period in tenths of a millimetre.
fn name(material: Material) -> String {
    match material {
        Material::Flat => "flat".to_owned(),
        Material::SmoothPlastic => "smooth_plastic".to_owned(),
        Material::Aluminium => "aluminium".to_owned(),
        Material::Sandpaper(grit) => format!("{grit:?}").to_lowercase(),
        Material::RoughCarpet => "rough_carpet".to_owned(),
        Material::SmoothCarpet => "smooth_carpet".to_owned(),
        Material::Tarmac => "tarmac".to_owned(),
        Material::Vinyl => "vinyl".to_owned(),
        Material::Relief(tenths) => format!("relief_{tenths}"),
    }
}

impl Surfaces {
    /// The surface of a material, with what is said of it.
    pub(crate) fn of(&self, material: Material) -> Surface {
        let usual = Surface::of(material);
        let said = self.0.get(&name(material));
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

impl Rig for Surfaces {
    const FILE: &'static str = "surfaces.toml";

    fn defaults() -> String {
        let table = |material| {
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
            (name(material), Value::Table(Table::from_iter(keys)))
        };
        Table::from_iter(ALL.map(table)).to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::{ALL, Surfaces};
    use crate::rigs::{Setting, load};
    use physics::{Grit, Material, Surface};

    #[test]
    fn surfaces_are_those_of_the_physics_but_for_what_is_set() {
        let usual: Surfaces = load(None, &[]).unwrap();
        for material in ALL {
            assert_eq!(usual.of(material), Surface::of(material));
        }
        let setting: Setting = "surfaces.p80.grain_m=3e-4".parse().unwrap();
        let other: Surfaces = load(None, &[setting]).unwrap();
        let p80 = Material::Sandpaper(Grit::P80);
        let expected = Surface {
            grain_m: 3e-4,
            ..Surface::of(p80)
        };
        assert_eq!(other.of(p80), expected);
        assert_eq!(other.of(Material::Vinyl), Surface::of(Material::Vinyl));
    }
}
