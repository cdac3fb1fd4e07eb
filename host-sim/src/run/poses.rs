//! The pose of each presentation, where a scene has a spread of them.

use physics::Noise;
use scene::{PoseSpread, Scene};

use crate::plant::SurfacePose;

/// How far before a plate a whisker is out of its way, degrees: in the air a shaft lags, or
/// swings ahead, by less.
const CLEARANCE_DEG: f64 = 5.0;

/// Sets the numbers that poses are drawn from apart from all others of the same seed.
const STREAM: u64 = 0x706F_7365_7320_3334;

/// Draws poses.
#[derive(Debug, Clone)]
pub(super) struct Poses {
    /// None: all presentations have the scene's own.
    spread: Option<PoseSpread>,
    /// Of each whisker, the angle up to which it is out of the way of the scene's own plate.
    clear_deg: Vec<f64>,
    random: Noise,
    /// That of the next presentation.
    next: SurfacePose,
    taken: u64,
}

impl Poses {
    /// Those of a scene.
    pub(super) fn new(scene: &Scene) -> Self {
        let obstacles = scene.plant.obstacle.iter().flat_map(|of| &of.obstacle_deg);
        let each = scene.head.whiskers_per_side;
        let clear_deg =
            obstacles.flat_map(|obstacle| core::iter::repeat_n(obstacle - CLEARANCE_DEG, each));
        let mut poses = Self {
            spread: scene.plant.spread.filter(PoseSpread::is_there),
            clear_deg: clear_deg.collect(),
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

    /// That of the presentation which begins; none where poses do not differ.
    pub(super) fn take(&mut self) -> Option<SurfacePose> {
        self.spread?;
        let pose = self.next;
        self.taken += 1;
        self.draw();
        Some(pose)
    }

    /// Which one was taken last, from 0; none where there is none.
    pub(super) const fn number(&self) -> Option<u64> {
        self.taken.checked_sub(1)
    }

    /// Whether any whisker, at these angles, may be in the way of the next pose's plate.
    pub(super) fn are_near(&self, angles_deg: &[f64]) -> bool {
        let mut whiskers = angles_deg.iter().zip(&self.clear_deg);
        self.spread.is_some()
            && whiskers.any(|(angle, clear)| *angle > clear + self.next.obstacle_deg)
    }
}

#[cfg(test)]
mod tests;
