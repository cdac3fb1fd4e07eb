//! Starts the motion of an active scene: motor, encoder and pattern generator.

use firmware::{Active, Servo};
use whisking::motor::MotorDriver;
use whisking::{Real, Start, State};

use super::encoder::Encoder;
use crate::here::clock_motor;

/// Motion at its start, the whisker being at rest now; `seed` is that of the noise.
pub(crate) fn start<R: Real, M: MotorDriver>(
    motor: impl FnOnce() -> M,
    start: &Start<R, 1, 1>,
    seed: u64,
) -> Active<R, M, Encoder, 1, 1> {
    clock_motor();
    let encoder = Encoder::start();
    Active::new(State::new(start, seed), [[Servo::new(motor(), encoder)]])
}
