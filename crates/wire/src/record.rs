//! A record: one whisker in one tick.

use crate::flags::Flags;

/// One whisker in one tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
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
    /// Flags.
    pub flags: Flags,
}

impl TickRecord {
    /// As it is sent.
    #[inline]
    pub const fn words(&self) -> [u32; 5] {
        [
            self.sequence,
            word(self.x, self.y),
            word(self.setpoint.cast_unsigned(), self.measured.cast_unsigned()),
            word(self.duty.cast_unsigned(), self.z.cast_unsigned()),
            word(self.contact.cast_unsigned(), self.flags.bits()),
        ]
    }

    /// As it was sent.
    pub const fn from_words(words: [u32; 5]) -> Self {
        let [x, y] = halves(words[1]);
        let [setpoint, measured] = halves(words[2]);
        let [duty, z] = halves(words[3]);
        let [contact, flags] = halves(words[4]);
        Self {
            sequence: words[0],
            x,
            y,
            setpoint: setpoint.cast_signed(),
            measured: measured.cast_signed(),
            duty: duty.cast_signed(),
            z: z.cast_signed(),
            contact: contact.cast_signed(),
            flags: Flags::from_bits(flags),
        }
    }

    /// x and y as codes of 14 bits, 0 to 16383, at rest 8192: the two lowest bits of a word are
    /// no measurement.
    pub const fn codes(&self) -> [u16; 2] {
        [self.x >> 2, self.y >> 2]
    }
}

const fn halves(word: u32) -> [u16; 2] {
    [word as u16, (word >> 16) as u16]
}

const fn word(low: u16, high: u16) -> u32 {
    low as u32 | (high as u32) << 16
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
    use super::{TickRecord, degrees, q13, unit};

    #[test]
    fn a_record_lies_where_the_page_says() {
        let words = [
            0x0403_0201,
            0x0807_0605,
            0x0C0B_0A09,
            0x100F_0E0D,
            0x1413_1211,
        ];
        let record = TickRecord::from_words(words);
        assert_eq!(record.words(), words);
        assert_eq!([record.x, record.y], [0x0605, 0x0807]);
        assert_eq!([record.setpoint, record.measured], [0x0A09, 0x0C0B]);
        assert_eq!([record.duty, record.z], [0x0E0D, 0x100F]);
        assert_eq!(record.contact, 0x1211);
        assert_eq!(record.flags.bits(), 0x1413);
    }

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
