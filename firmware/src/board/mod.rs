//! What every board has in common: drivers over the registers that the chip
//! families share, and the program.
//!
//! Three things are a board's own, in a file of its name beside this one, which
//! is `crate::here`: its clocks, its pins and timers as constants, and which of
//! the drivers that exist in several versions (`gpio_*`, `spi_*`, `dma_*`) its
//! chip has. What a scene has of its own comes from the build script into
//! [`scene`]. Nothing else chooses: no feature or `cfg` of a scene is asked
//! anywhere. See docs/boards.md for how to add a board.
//!
//! Register-level throughout: for time, safety and size, and because that is
//! what the families share. All `unsafe` of the firmware is in here.
#![allow(
    dead_code,
    reason = "a scene or a board names some of the types and drivers; the others are not linked"
)]
#![allow(
    clippy::unused_self,
    reason = "who may write a register holds the value without size that stands for it"
)]

pub(crate) mod counter;
pub(crate) mod encoder;
pub(crate) mod faults;
pub(crate) mod gpio;
pub(crate) mod log;
pub(crate) mod motion;
pub(crate) mod motors;
pub(crate) mod outputs;
pub(crate) mod pin_config;
#[macro_use]
pub mod program;
pub(crate) mod pwm;
pub(crate) mod reset;
pub(crate) mod scene;
pub(crate) mod sensor;
pub(crate) mod timing;
pub(crate) mod touch;
pub(crate) mod watchdog;
pub(crate) mod wiring;
