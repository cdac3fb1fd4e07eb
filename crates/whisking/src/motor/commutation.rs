//! Block commutation: which two of three phases to drive for a Hall code.
//!
//! Conventions, electrical degrees, forward being protraction:
//!
//! - phase k (1, 2, 3) has its axis at 0°, 120°, 240°; current into it makes a
//!   field along that axis, current out of it the opposite;
//! - Hall sensor k is high while the rotor's magnet is within 90° of axis k,
//!   so a forward rotor shows the codes 1, 3, 2, 6, 4, 5 (bit 0 is sensor 1).
//!
//! Sector s then covers 60 s° ± 30°, and driving the field at 60 s° + 90° leads the rotor by 60° to
//! 120° throughout: torque within sin 60° = 87 % of its peak, in the direction of the duty. Reverse
//! drive exchanges the two phases, which turns the field by 180° and so lags by as much.
//!
//! A motor's own lettering of windings and sensors may differ; its wiring must
//! be brought to this convention (the 1307BH's has not been verified).

/// One of the three motor phases, whose axis is at 0°, 120° or 240°.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Phase {
    One,
    Two,
    Three,
}

impl Phase {
    pub(super) const ALL: [Self; 3] = [Self::One, Self::Two, Self::Three];

    /// Its part of three.
    #[inline]
    pub(super) const fn of<T>(self, parts: &mut [T; 3]) -> &mut T {
        let [one, two, three] = parts;
        match self {
            Self::One => one,
            Self::Two => two,
            Self::Three => three,
        }
    }
}

/// What a phase does in a step.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Enable low: neither switch conducts.
    Float,
    /// Enabled, input carries the PWM.
    High,
    /// Enabled, input low: tied to ground.
    Low,
}

/// The driven pair of phases: current flows into `high` and out of `low`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pair {
    /// The phase with the PWM.
    pub(super) high: Phase,
    /// The phase tied to ground; not the same as `high`.
    pub(super) low: Phase,
}

impl Pair {
    const fn new(high: Phase, low: Phase) -> Self {
        Self { high, low }
    }

    #[inline]
    pub(super) fn role(self, phase: Phase) -> Role {
        if phase == self.high {
            Role::High
        } else if phase == self.low {
            Role::Low
        } else {
            Role::Float
        }
    }
}

/// The pairs for forward torque, by sector, in the order a forward rotor passes them.
const FORWARD: [Pair; 6] = [
    Pair::new(Phase::Two, Phase::Three), // rotor 0°, field 90°
    Pair::new(Phase::Two, Phase::One),   // rotor 60°, field 150°
    Pair::new(Phase::Three, Phase::One), // rotor 120°, field 210°
    Pair::new(Phase::Three, Phase::Two), // rotor 180°, field 270°
    Pair::new(Phase::One, Phase::Two),   // rotor 240°, field 330°
    Pair::new(Phase::One, Phase::Three), // rotor 300°, field 30°
];

/// A sixth of an electrical turn, 0 to 5; sector s is centred on 60 s°.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sector(u8);

impl Sector {
    /// The sector of a Hall code; none for the impossible 0 and 7 (and for anything above).
    #[inline]
    pub(super) const fn from_hall(code: u8) -> Option<Self> {
        match code {
            0b001 => Some(Self(0)),
            0b011 => Some(Self(1)),
            0b010 => Some(Self(2)),
            0b110 => Some(Self(3)),
            0b100 => Some(Self(4)),
            0b101 => Some(Self(5)),
            _ => None,
        }
    }

    /// Sectors forward from `earlier` to this one, 0 to 5.
    #[inline]
    pub(super) const fn ahead_of(self, earlier: Self) -> u8 {
        // Both are below 6: the sum is 1 to 11.
        (self.0 + 6 - earlier.0) % 6
    }

    /// The pair to drive for torque in the given direction.
    #[inline]
    pub(super) const fn pair(self, forward: bool) -> Pair {
        // The remainder changes nothing; it shows that the index is in range.
        let Pair { high, low } = FORWARD[self.0 as usize % 6];
        if forward {
            Pair { high, low }
        } else {
            Pair::new(low, high)
        }
    }
}
