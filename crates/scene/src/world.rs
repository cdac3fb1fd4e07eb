//! A module of one scene in the world of another.

use crate::sections::{Arm, PlantKind, Scene};

impl Scene {
    /// This module in the world of another scene: what its whiskers meet, for how long, and
    /// the seed of its randomness.
    ///
    /// # Errors
    /// What of the world does not fit the module.
    pub fn in_world(mut self, world: &Self) -> Result<Self, String> {
        let sides = |scene: &Self| scene.head.sides.count();
        if world.plant.obstacle.is_some() && sides(world) != sides(&self) {
            return Err(format!(
                "found a world for {} of whiskers, allowed: one for {}, as the module has",
                words(sides(world)),
                words(sides(&self))
            ));
        }
        if world.plant.kind != PlantKind::Ideal && self.whisking.is_none() {
            return Err(format!(
                "found a world with plant.kind = \"{}\", which needs an active whisker; the module \
                 has no [whisking]",
                world.plant.kind
            ));
        }
        self.plant = world.plant.clone();
        if let Some(motor) = &mut self.motor {
            motor.arm = motor.arm.or(Some(Arm::AtStart));
        }
        self.duration_s = world.duration_s;
        self.seed = world.seed;
        if self.ticks() == 0 {
            return Err(format!(
                "found a world of {} s, allowed: at least one tick, that is 1/{} s",
                self.duration_s, self.tick_hz
            ));
        }
        Ok(self)
    }
}

const fn words(sides: usize) -> &'static str {
    if sides == 1 { "one side" } else { "two sides" }
}
