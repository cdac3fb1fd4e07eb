//! Starts the motion of an active scene: motors, encoders and pattern generator.

use firmware::{Active, Servo};
use whisking::motor::MotorDriver;
use whisking::{Real, Start, State};

use super::encoder::Encoder;
use super::pwm;
use super::wiring::Side;
use crate::here::clock_motors;

/// Motion at its start, every whisker being at rest now; `motor` starts that of a side, and
/// `seed` is that of the noise.
pub(crate) fn start<R: Real, M: MotorDriver, const S: usize>(
    sides: [&Side; S],
    motor: impl Fn(&Side) -> M,
    start: &Start<R, S, 1>,
    seed: u64,
) -> Active<R, M, Encoder, S, 1> {
    clock_motors();
    pwm::start();
    let servos = sides.map(|side| [Servo::new(motor(side), Encoder::start(&side.encoder))]);
    Active::new(State::new(start, seed), servos)
}
