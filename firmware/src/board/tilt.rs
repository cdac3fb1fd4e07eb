//! Reads a TMAG5170 in the tick itself, by its driver over [`blocking_spi`](super::blocking_spi).
//! In place of [`sensor`](super::sensor), which reads an MLX90333 by timer and DMA and says why.
//!
//! - *frame*: 32 bits in one pulse of /CS, 3.6 or 4 us at the clock below; a tick has three, and
//!   twenty more where it sets the sensor up.
//!
//! A frame that does not end is [`SensorFault::Bus`](firmware::SensorFault::Bus).

use firmware::TiltSource;
use stm32_metapac::spi::vals::Cpha;
use tmag5170::timing::{CLOCK_MAX_HZ, CS_HIGH_NS, CS_SETUP_NS};

use super::blocking_spi::{Device, Wires, rounds};
use super::gpio::Pin;
use super::pin_config::{Mode, PinConfig};
use super::wiring::SensorPort;
use crate::here::CLOCKS;

pub(crate) type Source = TiltSource<Device>;

/// How a frame is paced: by the clock alone.
#[derive(Clone, Copy)]
pub(crate) struct FramePace {
    /// For the other sensor.
    pub(crate) slot: u16,
    /// For the other sensor.
    pub(crate) lag: u32,
}

/// Of SPI mode 0, at 8 or 9 MHz: at half of it, to set two sensors up takes a whole tick of 2 kHz.
const WIRES: Wires = Wires {
    phase: Cpha::FIRST_EDGE,
    faster: 5,
    lead_rounds: rounds(CS_SETUP_NS),
    lag_rounds: rounds(CS_SETUP_NS),
    high_rounds: rounds(CS_HIGH_NS),
    // For a byte of 1 us: 14 us or more on every board, and 1 ms at most.
    polls: 1_000,
};
const _: () = assert!(CLOCKS.spi_hz << WIRES.faster <= CLOCK_MAX_HZ);

/// Once the sensors' clocks run.
pub(crate) fn start(port: &'static SensorPort, _: FramePace) -> Source {
    let pins = &port.pins;
    Pin::new_high(pins.select);
    let device = Device::start(port, &WIRES);
    // Only now, so that the clock line never carries anything but the clock.
    let function = port.function;
    let output = PinConfig::new(Mode::AlternateOutput(function)).fast();
    Pin::new(pins.sck, output);
    Pin::new(pins.mosi, output);
    // A sensor that is not there reads as all ones.
    let input = PinConfig::new(Mode::AlternateInput(function)).pulled_up();
    Pin::new(pins.miso, input);
    TiltSource::of_module(device)
}

/// Nothing here ends by an interrupt.
pub(crate) fn end_of_frame(_: &mut Source) {}
