//! Play of a gear: the whisker lags behind its motor by up to so much, and is free between.

use super::rotor::Rotor;

/// Where the whisker is within its play. Angles, speeds and inertias are those at the rotor.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Play {
    /// Play either side of the middle, rad; 0: none.
    pub(super) half: f64,
    /// The whisker's angle less the rotor's, rad, and its speed, rad/s.
    pub(super) lag: f64,
    pub(super) speed: f64,
}

/// What a tick without play comes to: the push on both, and what each weighs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coupled {
    /// Outer torque on the whisker, N·m.
    pub(super) load_nm: f64,
    pub(super) whisker_kg_m2: f64,
    pub(super) both_kg_m2: f64,
}

impl Play {
    /// A gear with so much in all, rad, its whisker in the middle.
    pub(super) fn new(play: f64) -> Self {
        let (half, none) = (play / 2.0, Self::default());
        Self { half, ..none }
    }

    /// Whether the whisker goes with the rotor, which `together` would move on to: it is pushed,
    /// and not left behind.
    pub(super) fn is_pushed(&self, of: Coupled, before: Rotor, together: Rotor, dt: f64) -> bool {
        let force = of.whisker_kg_m2 * (together.speed - before.speed) / dt - of.load_nm;
        (self.lag <= -self.half && force > 0.0) || (self.lag >= self.half && force < 0.0)
    }

    /// The rotor has moved without the whisker, which meets it where the play ends; neither
    /// rebounds.
    pub(super) fn coast(&mut self, of: Coupled, before: Rotor, rotor: &mut Rotor, dt: f64) {
        let moved = rotor.angle - before.angle;
        self.speed += of.load_nm / of.whisker_kg_m2 * dt;
        self.lag += self.speed * dt - moved;
        if self.lag.abs() >= self.half {
            self.lag = self.half.copysign(self.lag);
            let share = of.whisker_kg_m2 / of.both_kg_m2;
            rotor.speed += share * (self.speed - rotor.speed);
            self.speed = rotor.speed;
        }
    }
}
