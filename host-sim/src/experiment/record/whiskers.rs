//! Which whisker, sensor and surface of the physics each rig has.

use crate::experiment::paper::biotact;
use crate::physics::{Follicle, Grit, Material, SensorSettings, Shaft, Surface};

/// Acrylonitrile butadiene styrene: Young's modulus, Pa, and density, kg/m³
/// (handbook values).
const ABS: (f64, f64) = (2.3e9, 1050.0);
/// Nanocure RC25, a resin filled with ceramic: the same (chosen; with these and
/// the follicle below, the frequencies are near those of BIOTACT section II-C).
const NANOCURE: (f64, f64) = (3.6e9, 1600.0);

fn shaft(length_m: f64, [hub, tip]: [f64; 2], (youngs_pa, density_kg_m3): (f64, f64)) -> Shaft {
    Shaft {
        length_m,
        hub_diameter_m: hub,
        tip_diameter_m: tip,
        youngs_pa,
        density_kg_m3,
        damping: 0.05,
        follicle: Follicle {
            rotation_n_m_rad: 0.3,
            axial_n_m: 1e4,
        },
    }
}

/// The robot's whisker: ABS, 200 mm long, 2 mm thick.
pub(crate) fn floor_robot() -> Shaft {
    shaft(0.2, [2e-3, 2e-3], ABS)
}

/// Its sensor.
pub(crate) fn floor_sensor() -> SensorSettings {
    SensorSettings::default()
}

/// A floor by its place in LEP10's tables.
pub(crate) fn floor(floor: usize) -> Surface {
    Surface::of(match floor {
        0 => Material::RoughCarpet,
        1 => Material::SmoothCarpet,
        2 => Material::Tarmac,
        _ => Material::Vinyl,
    })
}

/// The whiskers of a side of the head, the front one first.
pub(crate) fn head() -> [Shaft; 3] {
    biotact::WHISKERS.map(|(length_mm, _)| shaft(length_mm / 1000.0, [2e-3, 0.25e-3], NANOCURE))
}

/// Their sensors.
pub(crate) fn head_sensor() -> SensorSettings {
    SensorSettings::default()
}

/// A texture of the head's experiment by its place in the paper's list.
pub(crate) fn abrasive(texture: usize) -> Surface {
    Surface::of(match texture {
        0 => Material::Sandpaper(Grit::P240),
        1 => Material::Sandpaper(Grit::P600),
        _ => Material::SmoothPlastic,
    })
}

/// The whisker at the table.
pub(crate) fn table_whisker() -> Shaft {
    shaft(0.185, [2e-3, 0.25e-3], ABS)
}

/// Its sensor.
pub(crate) fn table_sensor() -> SensorSettings {
    SensorSettings::default()
}

/// A texture at the table by its place in the paper's list.
pub(crate) fn table_texture(texture: usize) -> Surface {
    Surface::of(match texture {
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

/// A sandpaper by its place.
pub(crate) fn sandpaper(number: usize) -> Surface {
    let grade = GRADES.get(number).copied().unwrap_or(Grit::P180);
    Surface::of(Material::Sandpaper(grade))
}

/// A vibrissa of a length, m.
pub(crate) fn vibrissa(length_m: f64) -> Shaft {
    shaft(length_m, [2e-3, 0.5e-3], ABS)
}

/// Its sensor, which is read with 8 bits.
pub(crate) fn vibrissa_sensor() -> SensorSettings {
    SensorSettings {
        refresh_s: 0.0,
        ..SensorSettings::default()
    }
}

/// The four walls of relief plexiglass, by number: their periods differ.
pub(crate) fn wall(number: usize) -> Surface {
    /// Periods, tenths of a millimetre (chosen; PSIK Fig. 8 has no scale).
    const PERIODS: [u16; 4] = [30, 60, 100, 160];
    let period = PERIODS.get(number).copied().unwrap_or(30);
    Surface::of(Material::Relief(period))
}
