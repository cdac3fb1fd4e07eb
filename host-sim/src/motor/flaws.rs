//! What can be wrong with an encoder that still counts.

use rand_core::Rng;
use rand_xoshiro::Xoshiro256PlusPlus;

/// Flaws of an encoder, from the moment on at which they are set: its count does not jump then.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EncoderFlaws {
    /// It counts so many times what it should.
    pub scale: f64,
    /// Share of the counts of protraction that it loses, 0 to 1; it keeps those of retraction, so
    /// the whisker creeps towards protraction.
    pub slip: f64,
    /// Its count is off by so much at most, drawn in each tick.
    pub jitter: u16,
}

impl EncoderFlaws {
    /// None.
    pub const NONE: Self = Self {
        scale: 1.0,
        slip: 0.0,
        jitter: 0,
    };

    pub(super) fn seen(self, turned: f64) -> f64 {
        let seen = self.scale * turned;
        if turned > 0.0 {
            seen * (1.0 - self.slip)
        } else {
            seen
        }
    }
}

/// The next count by which it is off, within `most` either way.
pub(super) fn jitter(random: &mut Xoshiro256PlusPlus, most: u16) -> i32 {
    let values = 2 * u64::from(most) + 1;
    (random.next_u64() % values) as i32 - i32::from(most)
}

#[cfg(test)]
mod tests {
    use firmware::AngleInput;

    use super::EncoderFlaws;
    use crate::motor::{MotorSettings, SimMotor, Wire};

    /// Counts of a whisker that is turned there and back by 50 degrees, at either end.
    fn counts(flaws: EncoderFlaws) -> [i32; 2] {
        let (mut motor, mut pins) = SimMotor::brushed(MotorSettings::DEFAULT).unwrap();
        motor.set_encoder(flaws);
        [100.0, 50.0].map(|angle_deg| {
            motor.turn_to_deg(angle_deg);
            pins.encoder.counts()
        })
    }

    #[test]
    fn counts_are_lost_one_way_scaled_and_turned() {
        // 11 turns of 512 counts a whisker turn.
        let none = EncoderFlaws::NONE;
        assert_eq!(counts(none), [782, 0]);
        assert_eq!(counts(EncoderFlaws { slip: 0.5, ..none }), [391, -391]);
        let scale = -2.0;
        assert_eq!(counts(EncoderFlaws { scale, ..none }), [-1564, 0]);
    }

    #[test]
    fn a_stuck_encoder_jitters_about_its_count() {
        let (mut motor, mut pins) = SimMotor::brushed(MotorSettings::DEFAULT).unwrap();
        motor.cut(Wire::Encoder);
        let none = EncoderFlaws::NONE;
        motor.set_encoder(EncoderFlaws { jitter: 3, ..none });
        motor.set_load_nm(1e-3);
        let mut seen = std::collections::BTreeSet::new();
        for _ in 0..200 {
            motor.advance(5e-4);
            seen.insert(pins.encoder.counts());
        }
        assert!(seen.iter().copied().eq(-3..=3), "{seen:?}");
        assert!(motor.angle_deg() > 60.0);
    }
}
