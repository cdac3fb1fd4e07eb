//! The shaft of an elastic whisker: a paper's, or one of its own numbers.

use crate::choice::choice;

choice! {
    /// Whose whisker it is.
    ShaftName {
        /// BIOTACT's front whisker: 80 mm, 86 Hz.
        BiotactFront = "biotact-front",
        /// BIOTACT's middle whisker: 112 mm, 50 Hz.
        BiotactMiddle = "biotact-middle",
        /// BIOTACT's rear whisker: 158 mm, 21 Hz.
        BiotactRear = "biotact-rear",
        /// The floor robot's: 200 mm, uniform (LEP10, LEP12).
        FloorRobot = "floor-robot",
        /// The XY table's: 200 mm, tapered.
        XyTable = "xy-table",
        /// None of these: the scene has its numbers.
        Own = "own",
    }
}

/// A shaft; all whiskers of a head have the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaft {
    /// Whose it is.
    pub name: ShaftName,
    /// Its numbers; there exactly when `name` is [`ShaftName::Own`].
    pub own: Option<ShaftNumbers>,
}

/// Numbers of a straight round shaft whose diameter goes linearly from hub to
/// tip, on a hinge spring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShaftNumbers {
    /// Length, 1e-3 to 1 m.
    pub length_m: f64,
    /// Diameter at the base, 1e-5 m to a fifth of the length.
    pub hub_diameter_m: f64,
    /// Diameter at the tip, 1e-6 m to a fifth of the length.
    pub tip_diameter_m: f64,
    /// Young's modulus, 1e5 to 1e12 Pa.
    pub youngs_pa: f64,
    /// Density, 10 to 3e4 kg/m³.
    pub density_kg_m3: f64,
    /// Damping ratio of every mode, 1e-4 to 0.99.
    pub damping_ratio: f64,
    /// Rotational stiffness of the follicle, 1e-9 to 1e6 N m/rad.
    pub follicle_n_m_rad: f64,
}
