//! The shaft of an elastic whisker: a paper's, or one of the scene's own numbers.

use std::ops::RangeInclusive;

use crate::choice::choice;
use crate::key::Condition::{self, Is};
use crate::key::{Key, number};
use crate::keys::keys;

choice! {
    /// Whose whisker it is.
    pub enum ShaftName {
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

/// A shaft of the scene's own numbers.
const OWN: &[Condition] = &[Is("shaft", ShaftName::Own.name())];

const fn own(ends: RangeInclusive<f64>) -> Key<f64> {
    number(ends)
        .required_if(OWN, "that of `shaft`")
        .only_if(OWN)
}

keys! {
    /// Numbers of a straight round shaft whose diameter goes linearly from hub
    /// to tip, on a hinge spring.
    #[derive(Copy)]
    pub struct ShaftNumbers {
        /// Length of the shaft.
        length_m: f64 = own(1e-3..=1.0).unit("m"),

        /// Diameter at the base; at most a fifth of the length.
        hub_diameter_m: f64 = own(1e-5..=0.2).unit("m"),

        /// Diameter at the tip; at most a fifth of the length.
        tip_diameter_m: f64 = own(1e-6..=0.2).unit("m"),

        /// Young's modulus of the material.
        youngs_pa: f64 = own(1e5..=1e12).unit("Pa"),

        /// Density of the material.
        density_kg_m3: f64 = own(10.0..=3e4).unit("kg/m³"),

        /// Damping ratio of every mode.
        damping_ratio: f64 = own(1e-4..=0.99),

        /// Rotational stiffness of the follicle, which holds the base.
        follicle_n_m_rad: f64 = own(1e-9..=1e6).unit("N m/rad"),
    }
}
