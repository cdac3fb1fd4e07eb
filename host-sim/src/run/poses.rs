//! The pose of each presentation, where a scene has a spread of them.

use physics::Noise;
use scene::{PoseSpread, Scene};

use crate::plant::SurfacePose;

/// Sets the numbers that poses are drawn from apart from all others of the same seed.
const STREAM: u64 = 0x706F_7365_7320_3334;

/// Draws poses.
#[derive(Debug, Clone)]
pub(super) struct Poses {
    /// None: all presentations have the scene's own.
    spread: Option<PoseSpread>,
    random: Noise,
    /// That of the next presentation.
    next: SurfacePose,
    taken: u64,
}

impl Poses {
    /// Those of a scene.
    pub(super) fn new(scene: &Scene) -> Self {
        let mut poses = Self {
            spread: scene.plant.spread.filter(PoseSpread::is_there),
            random: Noise::new(0),
            next: SurfacePose::OF_SCENE,
            taken: 0,
        };
        poses.restart(scene.seed);
        poses
    }

    /// Starts again with this seed.
    pub(super) fn restart(&mut self, seed: u64) {
        self.random = Noise::new(seed ^ STREAM);
        self.taken = 0;
        self.draw();
    }

    fn draw(&mut self) {
        let Some(spread) = self.spread else {
            return;
        };
        let mut within = |spread: f64| spread * (2.0 * self.random.uniform() - 1.0);
        self.next = SurfacePose {
            tilt_deg: within(spread.tilt_spread_deg),
            obstacle_deg: within(spread.obstacle_spread_deg),
            gain: 1.0 + within(spread.gain_spread),
        };
    }

    /// That of the next presentation; none where poses do not differ.
    pub(super) fn next(&self) -> Option<SurfacePose> {
        self.spread.map(|_| self.next)
    }

    /// The same, for the presentation that begins now; none where poses do not differ.
    pub(super) fn take(&mut self) -> Option<SurfacePose> {
        let pose = self.next()?;
        self.taken += 1;
        self.draw();
        Some(pose)
    }

    /// Which one was taken last, from 0; none where there is none.
    pub(super) const fn number(&self) -> Option<u64> {
        self.taken.checked_sub(1)
    }
}

#[cfg(test)]
mod tests;
