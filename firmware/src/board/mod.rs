//! What every board has in common: drivers over the registers that the chip
//! families share, and the program.
//!
//! A board has a file of its own beside this one, which is `crate::here`. It
//! names three things: its clocks; the peripherals and pins of each side, a
//! table by the types of [`wiring`]; and which of the drivers that exist in
//! several versions (`gpio_*`, `spi_*`, `dma_*`, `power_*` and more) fit its chip. What a PC knows
//! of it too is in `firmware::boards`. See docs/boards.md for how to add a board.
//!
//! A program takes any scene: that is data, which a start finds in flash ([`scene`]). What an
//! image is built without, by cargo features (`firmware::Part`), is not linked, and a scene that
//! needs it is refused.
//!
//! Register-level throughout: for time, safety and size, and because that is
//! what the families share. All `unsafe` of the firmware is in here.
#![allow(
    dead_code,
    reason = "an image or a board names some of the types and drivers; the others are not linked"
)]
#![allow(
    clippy::unused_self,
    reason = "the right to write a register is a value without size"
)]

pub(crate) mod about;
pub(crate) mod blocking_spi;
#[cfg(not(feature = "bus"))]
#[path = "bus/off.rs"]
pub(crate) mod bus;
#[cfg(feature = "bus")]
#[path = "bus/on.rs"]
pub(crate) mod bus;
pub(crate) mod counters;
pub(crate) mod encoder;
pub(crate) mod faults;
pub(crate) mod flash_lock;
pub(crate) mod gpio;
pub(crate) mod hardware;
pub(crate) mod integrity;
#[cfg(feature = "deploy")]
pub(crate) mod loading;
pub(crate) mod log;
pub(crate) mod logger;
mod memory;
pub(crate) mod motors;
pub(crate) mod outputs;
pub(crate) mod pace;
pub(crate) mod perception;
pub(crate) mod pin_config;
#[macro_use]
pub mod program;
pub(crate) mod pwm;
pub(crate) mod reset;
pub(crate) mod retained;
pub(crate) mod rtt;
pub(crate) mod scene;
// Which of them a scene needs it is asked for by `Part::is_built`: a program has one.
#[cfg(all(feature = "mlx90333", feature = "tmag5170"))]
compile_error!("a board's program reads one sensor: mlx90333 or tmag5170");
#[cfg(feature = "mlx90333")]
pub(crate) mod sensor;
#[cfg(not(feature = "mlx90333"))]
#[path = "tilt.rs"]
pub(crate) mod sensor;
#[cfg(not(feature = "serial"))]
#[path = "serial/off.rs"]
pub(crate) mod serial;
#[cfg(feature = "serial")]
#[path = "serial/on.rs"]
pub(crate) mod serial;
pub(crate) mod signal_pins;
pub(crate) mod sleep;
pub(crate) mod slots;
pub(crate) mod supply;
pub(crate) mod systick;
#[cfg(not(feature = "rtt"))]
#[path = "telemetry/off.rs"]
pub(crate) mod telemetry;
#[cfg(feature = "rtt")]
#[path = "telemetry/on.rs"]
pub(crate) mod telemetry;
pub(crate) mod tick_timer;
pub(crate) mod types;
pub(crate) mod user_button;
pub(crate) mod watchdog;
pub(crate) mod wiring;
