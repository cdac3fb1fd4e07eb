//! The NUCLEO-F446RE: drivers and constants that only this board needs.
//!
//! Register-level where time, safety or size ask for it; pins by the HAL. All
//! `unsafe` of the firmware is in here.

pub(crate) mod clock;
pub mod counter;
#[cfg(not(motor = "none"))]
pub mod encoder;
pub(crate) mod faults;
pub(crate) mod log;
#[cfg(not(motor = "none"))]
pub(crate) mod motor;
pub(crate) mod outputs;
#[cfg(not(motor = "none"))]
pub mod pwm;
pub(crate) mod scene;
pub mod sensor;
#[cfg_attr(
    motor = "none",
    allow(dead_code, reason = "without a motor some of it is not needed")
)]
pub(crate) mod timing;
pub(crate) mod touch;
pub(crate) mod watchdog;
