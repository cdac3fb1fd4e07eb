//! The pose of each presentation, where a scene has a spread of them, and how surfaces stand in it.

use core::f64::consts::TAU;

use physics::Noise;
use scene::{PoseSpread, Scene};
use whisking::muscle::PEAK_GAIN;
use whisking::{DEGREES_PER_UNIT, REST_DEG};

use crate::plant::SurfacePose;

/// Sets the numbers that poses are drawn from apart from all others of the same seed.
const STREAM: u64 = 0x706F_7365_7320_3334;

#[derive(Debug, Clone)]
pub(super) struct Poses {
    /// None: all presentations have the scene's own.
    spread: Option<PoseSpread>,
    random: Noise,
    next: SurfacePose,
    taken: u64,
    present: SurfacePose,
    /// Of each whisker the tilt of its surface and how far its whisk goes beyond it, both of the
    /// scene's own pose, degrees; none where nobody asks.
    own: Vec<[f64; 2]>,
}

impl Poses {
    pub(super) fn new(scene: &Scene) -> Self {
        let mut poses = Self {
            spread: scene.plant.spread.filter(PoseSpread::is_there),
            random: Noise::new(0),
            next: SurfacePose::OF_SCENE,
            taken: 0,
            present: SurfacePose::OF_SCENE,
            own: own(scene),
        };
        poses.restart(scene.seed);
        poses
    }

    pub(super) fn restart(&mut self, seed: u64) {
        self.random = Noise::new(seed ^ STREAM);
        self.taken = 0;
        self.present = SurfacePose::OF_SCENE;
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
        self.present = pose;
        self.draw();
        Some(pose)
    }

    /// How what stands before each whisker does: its tilt, and how far the whisk goes beyond where
    /// the shaft meets it, degrees.
    pub(super) fn stands(&self) -> Vec<[f64; 2]> {
        let [more, less] = [self.present.tilt_deg, self.present.obstacle_deg];
        let own = self.own.iter();
        let stands = own.map(|[tilt, depth]| [tilt + more, depth - less].map(rounded));
        stands.collect()
    }

    /// Which one was taken last, from 0; none where there is none.
    pub(super) const fn number(&self) -> Option<u64> {
        self.taken.checked_sub(1)
    }
}

/// To a ten-thousandth: of more digits nothing is learnt.
fn rounded(degrees: f64) -> f64 {
    (1e4 * degrees).round() / 1e4
}

/// Of a scene that asks for poses or spreads them, and has whiskers that meet surfaces.
fn own(scene: &Scene) -> Vec<[f64; 2]> {
    let asks = scene.classifier.as_ref().is_some_and(|of| of.pose)
        || scene.plant.spread.is_some_and(|spread| spread.is_there());
    let (true, Some(facing), Some(obstacles), Some(whisking)) = (
        asks,
        &scene.plant.facing,
        &scene.plant.obstacle,
        &scene.whisking,
    ) else {
        return Vec::new();
    };
    let whiskers = 0..scene.head.sides.count() * scene.head.whiskers_per_side;
    let own = |n: usize| {
        let gain = whisking.gain.get(n).or(whisking.gain.first())?;
        let side = n / scene.head.whiskers_per_side;
        let obstacle = obstacles.obstacle_deg.get(side)?;
        Some([facing.tilt_deg, farthest_deg(*gain) - obstacle])
    };
    whiskers.filter_map(own).collect()
}

/// The farthest θ′ of a whisk that meets nothing, without noise and RCP, degrees: BIOTACT eqs. 6 to 8 on
/// the limit cycle, the whisks after the first being alike to a thousandth of a degree.
fn farthest_deg(gain: f64) -> f64 {
    /// Of a whisk, whose frequency does not matter: ω_n T = 10.
    const STEPS: u32 = 4000;
    let step = 10.0 / f64::from(STEPS);
    let (mut theta, mut speed, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
    for n in 0..4 * STEPS {
        let psi = (TAU * f64::from(n) / f64::from(STEPS)).cos();
        let drive = f64::midpoint((2.0 * psi).tanh(), 1.0);
        let force = PEAK_GAIN * gain * drive * (-theta * theta).exp();
        speed += step * (force - theta - 4.0 * speed);
        theta += step * speed;
        most = most.max(theta);
    }
    REST_DEG + DEGREES_PER_UNIT * most
}

#[cfg(test)]
mod tests;
