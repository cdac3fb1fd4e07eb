//! Which pin does what: the same on every board. The peripherals behind the
//! pins are in the board's own file.

use stm32_metapac::gpio::Gpio;

use super::gpio::Pin;

/// Clock of the sensor's SPI.
pub(crate) type SensorSck = Pin<'A', 5>;
/// Data from the sensor; joined to [`SensorMosi`] outside, one open-drain line.
pub(crate) type SensorMiso = Pin<'A', 6>;
/// Data to the sensor.
pub(crate) type SensorMosi = Pin<'A', 7>;
/// /SS of the sensor.
pub(crate) type SensorSelect = Pin<'B', 6>;

/// Channel A of the encoder.
pub(crate) type EncoderA = Pin<'A', 0>;
/// Channel B of the encoder.
pub(crate) type EncoderB = Pin<'A', 1>;

/// PWM of the H-bridge, and of the first of three half-bridges.
pub(crate) type Pwm1 = Pin<'A', 8>;
/// PWM of the second half-bridge.
pub(crate) type Pwm2 = Pin<'A', 9>;
/// PWM of the third half-bridge.
pub(crate) type Pwm3 = Pin<'A', 10>;
/// Direction of the H-bridge.
pub(crate) type Direction = Pin<'B', 5>;
/// Enable inputs of the three half-bridges.
pub(crate) type Enables = (Pin<'C', 10>, Pin<'C', 11>, Pin<'C', 12>);
/// Hall sensors of the brushless motor.
pub(crate) type Halls = (Pin<'A', 15>, Pin<'B', 3>, Pin<'B', 10>);

/// Every output that can drive a motor: the PWM and the enables.
pub(crate) const MOTOR_OUTPUTS: [(Gpio, usize); 6] = [
    Pwm1::PORT_AND_NUMBER,
    Pwm2::PORT_AND_NUMBER,
    Pwm3::PORT_AND_NUMBER,
    Pin::<'C', 10>::PORT_AND_NUMBER,
    Pin::<'C', 11>::PORT_AND_NUMBER,
    Pin::<'C', 12>::PORT_AND_NUMBER,
];
