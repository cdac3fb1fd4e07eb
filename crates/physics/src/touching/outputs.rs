//! Outputs of a whisker: readings, contact, forces, energy.

use super::TouchingWhisker;
use crate::vector::dot;

/// How a shaft is bent. With no moment at its end it is in each plane about the cubic that has
/// these three.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bent {
    /// Length of the shaft, m.
    pub length_m: f64,
    /// Deflection of the tip in x and y, m.
    pub tip_m: [f64; 2],
    /// Rotation of the base in x and y, rad.
    pub base_rad: [f64; 2],
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

    /// Normal and tangential force on the tip, N.
    pub fn force_n(&self) -> [f64; 2] {
        let normal = self.body.touch.normal_n;
        let square = dot(self.body.touch.force, self.body.touch.force) - normal * normal;
        [normal, square.max(0.0).sqrt()]
    }

    /// By how much the ground was taken as lower than it is, m, where contact had no
    /// energy to press its spring: an error of the method, not of the energy.
    pub fn lowered_m(&self) -> f64 {
        self.body.touch.lowered_m
    }

    /// How the shaft is bent, for a picture of it.
    pub fn bent(&self) -> Bent {
        Bent {
            length_m: self.body.shaft.length_m,
            tip_m: self.tip_m(),
            base_rad: self.rotation_rad(),
        }
    }

    /// Deflection of the tip in x and y, m.
    pub fn tip_m(&self) -> [f64; 2] {
        let shaft = &self.body.shaft;
        let [x, y, _] = self.body.state.curve(shaft).at(shaft.grid.tip());
        [x, y]
    }

    /// Where the shaft touches, m from the base, while it does.
    pub fn contact_m(&self) -> Option<f64> {
        let place = self.body.touch.place.filter(|_| self.contact());
        place.map(|place| place.at_m)
    }

    /// Rotation of the base in x and y, rad, unlimited and without noise.
    pub fn rotation_rad(&self) -> [f64; 2] {
        self.body.shaft.shapes.base(&self.body.state.x)
    }

    /// Kinetic and elastic energy of shaft, follicle and contact, J, in axes
    /// that move with the base.
    pub fn energy_j(&self) -> f64 {
        self.body.state.energy_j(&self.body.shaft) + self.body.touch.spring_j
    }
}
