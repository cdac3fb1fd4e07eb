//! Flags of a tick.

use core::ops::BitOr;

/// A set of things that are so, one bit each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Flags(u16);

impl Flags {
    /// None.
    pub const NONE: Self = Self(0);
    /// The whisker is one of the right side.
    pub const RIGHT: Self = Self(1);
    /// A new frame of the sensor came; otherwise the last good one is held.
    pub const FRESH: Self = Self(1 << 1);
    /// The readings count; otherwise the whisker has a fault, x and y are at rest.
    pub const VALID: Self = Self(1 << 2);
    /// Motors may be driven.
    pub const ARMED: Self = Self(1 << 3);
    /// The motor follows the setpoint.
    pub const RUNNING: Self = Self(1 << 4);
    /// The motor is being homed.
    pub const HOMING: Self = Self(1 << 5);
    /// The motor rests after a fault, or was given up.
    pub const RESTING: Self = Self(1 << 6);
    /// The whisker touches something.
    pub const TOUCHING: Self = Self(1 << 7);
    /// A decision fell in this tick.
    pub const DECIDED: Self = Self(1 << 8);
    /// A fault was reported in this tick.
    pub const FAULT: Self = Self(1 << 9);
    /// Records were lost before this one, for want of room.
    pub const LOST: Self = Self(1 << 10);
    /// The zero of a sensor was moved in this tick.
    pub const ZEROED: Self = Self(1 << 11);

    /// The flags of these bits.
    pub const fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// Their bits.
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// Whether all of `other` are among these.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// These if `so`, otherwise none.
    #[inline]
    pub const fn when(self, so: bool) -> Self {
        if so { self } else { Self::NONE }
    }

    /// These without those of `other`.
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }
}

impl BitOr for Flags {
    type Output = Self;

    #[inline]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}
