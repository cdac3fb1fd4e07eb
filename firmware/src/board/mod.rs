//! What every board has in common: drivers over the registers that the chip
//! families share, and the program.
//!
//! A board has a file of its own beside this one, which is `crate::here`. It
//! names three things: its clocks; the peripherals and pins of each side, a
//! table by the types of [`wiring`]; and which of the drivers that exist in
//! several versions (`gpio_*`, `spi_*`, `dma_*`, `power_*` and more) fit its chip. The scene's types
//! and settings come from the build script into [`scene`]; nothing else depends
//! on the scene but the `cfg`s `right_side`, by which a board gives that side its
//! clocks and its interrupt, and `telemetry` and `serial`. See docs/boards.md for how to add a board.
//!
//! Register-level throughout: for time, safety and size, and because that is
//! what the families share. All `unsafe` of the firmware is in here.
#![allow(
    dead_code,
    reason = "a scene or a board names some of the types and drivers; the others are not linked"
)]
#![allow(
    clippy::unused_self,
    reason = "the right to write a register is a value without size"
)]

pub(crate) mod counters;
pub(crate) mod encoder;
pub(crate) mod faults;
pub(crate) mod flash_lock;
pub(crate) mod gpio;
pub(crate) mod inner;
pub(crate) mod integrity;
pub(crate) mod loading;
pub(crate) mod log;
pub(crate) mod logger;
pub(crate) mod model_place;
pub(crate) mod motion;
pub(crate) mod motors;
pub(crate) mod outputs;
pub(crate) mod pin_config;
#[macro_use]
pub mod program;
pub(crate) mod pwm;
pub(crate) mod reset;
pub(crate) mod retained;
pub(crate) mod rtt;
pub(crate) mod scene;
pub(crate) mod sensor;
#[cfg(not(serial))]
#[path = "serial/off.rs"]
pub(crate) mod serial;
#[cfg(serial)]
#[path = "serial/on.rs"]
pub(crate) mod serial;
pub(crate) mod signal_pins;
pub(crate) mod supply;
pub(crate) mod systick;
#[cfg(not(telemetry))]
#[path = "telemetry/off.rs"]
pub(crate) mod telemetry;
#[cfg(telemetry)]
#[path = "telemetry/on.rs"]
pub(crate) mod telemetry;
pub(crate) mod tick_timer;
pub(crate) mod timing;
pub(crate) mod user_button;
pub(crate) mod watchdog;
pub(crate) mod wiring;

use timing::Clocks;

/// The clocks of this board as the scene's sensors need them.
pub(crate) const CLOCKS: Clocks = if scene::SENSORS_ARE_SLOW {
    crate::here::CLOCKS.halved()
} else {
    crate::here::CLOCKS
};
