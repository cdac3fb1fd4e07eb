//! Outputs of a whisker: readings, contact, forces, energy.

use super::TouchingWhisker;
use super::body::Body;
use crate::vector::dot;

/// Points of a bent shaft, from the base to the tip.
const POINTS: usize = 13;

/// How a shaft is bent and where it touches, in axes that move with the base: x and y of the
/// sensor, and z along the straight shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bent {
    /// Length of the shaft, m.
    pub length_m: f64,
    /// Points at even arc lengths, the first the base and the last the tip, m.
    pub points_m: [[f64; 3]; POINTS],
    /// Where it touches, while it does, and where else at once.
    pub contacts: [Option<At>; 2],
}

/// A place of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct At {
    /// Arc length from the base, m.
    pub arc_m: f64,
    /// The point of the shaft, in the axes of [`Bent`], m.
    pub point_m: [f64; 3],
    /// Place on the plate, m: along the plate's first coordinate, and across it.
    pub plate_m: [f64; 2],
}

impl Bent {
    /// A straight shaft that touches nothing.
    pub fn straight(length_m: f64) -> Self {
        let step_m = length_m / (POINTS - 1) as f64;
        Self {
            length_m,
            points_m: core::array::from_fn(|n| [0.0, 0.0, step_m * n as f64]),
            contacts: [None; 2],
        }
    }
}

impl TouchingWhisker {
    /// The sensor's reading, x and y, each within ±1: rotation of the base over
    /// full scale, as last measured. A tip that is pushed towards +x reads
    /// positive.
    pub fn reading(&self) -> [f64; 2] {
        self.sensor.reading()
    }

    /// The same as signed 14-bit codes, ±8191.
    pub fn codes(&self) -> [i16; 2] {
        self.sensor.codes()
    }

    /// Whether the tip is pressed on the plate at the end of the step.
    pub fn contact(&self) -> bool {
        self.body.touch.is_contact()
    }

    /// How many parts the last step was cut into; none if the tip stayed clear
    /// of the plate.
    pub fn parts(&self) -> u32 {
        self.parts
    }

    /// Whether friction holds the tip where it is.
    pub fn sticking(&self) -> bool {
        self.contact() && self.body.touch.stuck
    }

    /// Normal and tangential force on the shaft, N; of two places that touch, the sums of sizes.
    pub fn force_n(&self) -> [f64; 2] {
        let [one, two] = [&self.body.touch, &self.body.other].map(|touch| {
            let normal = touch.normal_n;
            let square = dot(touch.force, touch.force) - normal * normal;
            [normal, square.max(0.0).sqrt()]
        });
        [one[0] + two[0], one[1] + two[1]]
    }

    /// By how much the ground was taken as lower than it is, m, where contact had no
    /// energy to press its spring: an error of the method, not of the energy.
    pub fn lowered_m(&self) -> f64 {
        self.body.touch.lowered_m
    }

    /// How the shaft is bent, for a picture of it.
    pub fn bent(&self) -> Bent {
        let shaft = &self.body.shaft;
        let curve = self.body.state.curve(shaft);
        let mut bent = Bent::straight(shaft.length_m);
        for point in bent.points_m.iter_mut().skip(1) {
            *point = curve.at(&shaft.grid.anywhere(point[2]));
        }
        bent.contacts = self.contacts_at();
        bent
    }

    /// Deflection of the tip in x and y, m.
    pub fn tip_m(&self) -> [f64; 2] {
        let shaft = &self.body.shaft;
        let [x, y, _] = self.body.state.curve(shaft).at(shaft.grid.tip());
        [x, y]
    }

    /// Where the shaft touches, while it does; of two places the one that touched first.
    pub fn contact_at(&self) -> Option<At> {
        let [first, _] = self.contacts_at();
        first
    }

    /// Where the shaft touches, while it does, and where else at once.
    pub fn contacts_at(&self) -> [Option<At>; 2] {
        let Body { shaft, state, .. } = &self.body;
        [&self.body.touch, &self.body.other].map(|touch| {
            let place = touch.place.filter(|_| touch.is_contact())?;
            let curve = self.body.curve.unwrap_or_else(|| state.curve(shaft));
            Some(At {
                arc_m: place.at_m,
                point_m: curve.at(&place),
                plate_m: [touch.foot[0], touch.foot[1]],
            })
        })
    }

    /// Rotation of the base in x and y, rad, unlimited and without noise.
    pub fn rotation_rad(&self) -> [f64; 2] {
        self.body.shaft.shapes.base(&self.body.state.x)
    }

    /// Kinetic and elastic energy of shaft, follicle and contact, J, in axes
    /// that move with the base.
    pub fn energy_j(&self) -> f64 {
        let springs_j = self.body.touch.spring_j + self.body.other.spring_j;
        self.body.state.energy_j(&self.body.shaft) + springs_j
    }
}
