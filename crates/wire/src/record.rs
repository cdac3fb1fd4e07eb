//! A record: one whisker in one tick.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use zerocopy::{FromBytes, Immutable, IntoBytes};

use crate::flags::Flags;

/// One whisker in one tick: as it is sent 20 bytes, all numbers little-endian.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, FromBytes, IntoBytes, Immutable)]
#[repr(C)]
pub struct TickRecord {
    /// Ticks since the module started, this one included.
    pub sequence: u32,
    /// Deflection along the direction of whisking: the sensor's word, see [`codes`](Self::codes).
    pub x: u16,
    /// Deflection across it, alike.
    pub y: u16,
    /// Where the whisker should be: protraction, Q13.
    pub setpoint: i16,
    /// Where it is by its encoder: protraction, Q13.
    pub measured: i16,
    /// What drives the motor, of the supply: Q15.
    pub duty: i16,
    /// Gate z of its side (BIOTACT eq. 10), Q13.
    pub z: i16,
    /// Contact π of the whisker (BIOTACT eq. 9), 0 to 1: Q13.
    pub contact: i16,
    /// What is so.
    pub flags: Flags,
}

impl TickRecord {
    /// x and y as codes of 14 bits, 0 to 16383, at rest 8192: the two lowest bits of a word are
    /// no measurement.
    pub const fn codes(&self) -> [u16; 2] {
        [self.x >> 2, self.y >> 2]
    }
}

/// The bytes of a record; both sides of a link are little-endian.
type Bytes = [u8; size_of::<TickRecord>()];

impl Serialize for TickRecord {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let bytes: Bytes = zerocopy::transmute!(*self);
        bytes.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for TickRecord {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let bytes = Bytes::deserialize(deserializer)?;
        Ok(zerocopy::transmute!(bytes))
    }
}

/// Q24 as Q13, rounded downwards, limited to what fits: −4 to 3.9999.
#[inline]
pub fn q13(q24: i32) -> i16 {
    // As a comparison with ends: an ARM core has one instruction for it.
    (q24 >> 11).clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16
}

/// The number that Q13 stands for.
pub fn unit(q13: i16) -> f32 {
    f32::from(q13) / 8192.0
}

/// The angle of a protraction in Q13, degrees: θ' = 100 θ + 50 (BIOTACT section III).
pub fn degrees(q13: i16) -> f32 {
    100.0 * unit(q13) + 50.0
}

#[cfg(test)]
mod tests {
    use super::{degrees, q13, unit};

    #[test]
    fn numbers_keep_their_value_and_their_sign() {
        for (value, found) in [(0.25, 0.25), (-0.25, -0.25), (3.5, 3.5), (-4.0, -4.0)] {
            assert_eq!(unit(q13((value * 16_777_216.0) as i32)), found);
        }
        assert_eq!(q13(i32::MAX), i16::MAX);
        assert_eq!(q13(i32::MIN), i16::MIN);
        assert_eq!(degrees(q13(1 << 22)), 75.0);
    }
}
