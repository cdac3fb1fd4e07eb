//! What a classifier makes of angle, speed and texture.

use anyhow::Result;
use tactile::score::{Confusion, Statistics};

use crate::experiment::record::table::{Contact, speeds};
use crate::paper::pose::{ANGLES_DEG, SPEEDS_MM_S, TEXTURES};

/// What a classifier makes of the test set: a matrix a property.
#[derive(Debug, Clone)]
pub(super) struct Scores(pub(super) [Confusion; 3]);

impl Scores {
    pub(super) fn new() -> Self {
        Self([ANGLES_DEG.len(), SPEEDS_MM_S.2, TEXTURES.len()].map(Confusion::new))
    }

    /// Counts a contact: its classes of angle, speed and texture, and those named.
    pub(super) fn add(&mut self, truth: &Contact, named: [usize; 3]) -> Result<()> {
        let truth = [truth.angle, truth.speed, truth.texture];
        for ((score, truth), named) in self.0.iter_mut().zip(truth).zip(named) {
            score.add(truth, Some(named))?;
        }
        Ok(())
    }

    /// κ of each property.
    pub(super) fn kappa(&self) -> [f64; 3] {
        self.0.each_ref().map(|score| score.kappa().unwrap_or(0.0))
    }

    /// Hit rate of each property, percent.
    pub(super) fn hit(&self) -> [f64; 3] {
        self.0
            .each_ref()
            .map(|score| 100.0 * score.hit_rate().unwrap_or(0.0))
    }

    /// Errors of each property in its unit.
    pub(super) fn errors(&self) -> [Option<Statistics>; 3] {
        let textures: Vec<f64> = (0..TEXTURES.len()).map(|n| n as f64).collect();
        [
            self.0[0].errors(&ANGLES_DEG),
            self.0[1].errors(&speeds()),
            self.0[2].errors(&textures),
        ]
    }
}
