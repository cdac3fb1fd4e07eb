//! Reads a TMAG5170 in the tick itself, by its driver: a blocking [`SpiDevice`] over the registers
//! of a side's SPI. In place of [`sensor`](super::sensor), which reads an MLX90333 by timer and
//! DMA and says why.
//!
//! - *frame*: 32 bits in one pulse of /CS, 3.6 or 4 us at the clock below; a tick has three, and
//!   twenty more where it sets the sensor up.
//!
//! Each wait for a byte has a bound ([`POLLS`]); where that passes the SPI is set up again, and the
//! driver's caller gets an error ([`SensorFault::Bus`](firmware::SensorFault::Bus)). What differs
//! between chips is in `spi_*.rs`.

use embedded_hal::spi::{Error, ErrorKind, ErrorType, Operation, SpiDevice};
use firmware::TiltSource;
use stm32_metapac::spi::vals::{Br, Cpha, Mstr};
use tmag5170::timing::{CLOCK_MAX_HZ, CS_HIGH_NS, CS_SETUP_NS};

use super::gpio::Pin;
use super::pin_config::{Mode, PinConfig};
use super::wiring::SensorPort;
use crate::here::{CLOCKS, reset_spi, spi};

/// A side's sensor.
pub(crate) type Source = TiltSource<Device>;

/// How a frame is paced: by the clock alone.
#[derive(Clone, Copy)]
pub(crate) struct FramePace {
    /// For the other sensor.
    pub(crate) slot: u16,
    /// For the other sensor.
    pub(crate) lag: u32,
}

/// By so many steps of the divider, of which each doubles the clock, it is faster than for an
/// MLX90333: 8 or 9 MHz. At half of that it takes a whole tick of 2 kHz to set two sensors up.
const FASTER: u8 = 5;

/// The clock.
const CLOCK_HZ: u32 = CLOCKS.spi_hz << FASTER;
const _: () = assert!(CLOCK_HZ <= CLOCK_MAX_HZ);

/// Looks at the SPI's flags for a byte of 1 us. One takes two cycles and more, so that this is
/// 14 us or more on every board, and 1 ms at most.
const POLLS: u32 = 1_000;

/// Rounds of `cortex_m::asm::delay`, of two cycles or more each, from /CS low to the clock and from
/// that to /CS high, and while it is high.
const SETUP_ROUNDS: u32 = rounds(CS_SETUP_NS);
const HIGH_ROUNDS: u32 = rounds(CS_HIGH_NS);

const fn rounds(ns: u32) -> u32 {
    (CLOCKS.core_hz / 1_000_000 * ns).div_ceil(2_000)
}

/// Sets everything up, once the sensors' clocks run.
pub(crate) fn start(port: &'static SensorPort, _: FramePace) -> Source {
    let pins = &port.pins;
    Pin::new_high(pins.select);
    set_up_spi(port);
    // Only now, so that the clock line never carries anything but the clock.
    let function = port.function;
    let output = PinConfig::new(Mode::AlternateOutput(function)).fast();
    Pin::new(pins.sck, output);
    Pin::new(pins.mosi, output);
    // A sensor that is not there reads as all ones.
    let input = PinConfig::new(Mode::AlternateInput(function)).pulled_up();
    Pin::new(pins.miso, input);
    TiltSource::of_module(Device { port })
}

/// Nothing here ends by an interrupt.
pub(crate) fn end_of_frame(_: &mut Source) {}

/// Mode 0, most significant bit first, bytes; /CS is ours, and no DMA. Also discards a frame that
/// broke off.
fn set_up_spi(port: &SensorPort) {
    reset_spi(port.spi);
    spi::set_up_bytes(port.spi);
    port.spi.cr2().modify(|w| w.set_rxdmaen(false));
    port.spi.cr1().write(|w| {
        w.set_mstr(Mstr::MASTER);
        w.set_ssm(true);
        w.set_ssi(true);
        w.set_cpha(Cpha::FIRST_EDGE);
        w.set_br(Br::from_bits(port.divider.to_bits() - FASTER));
        w.set_spe(true);
    });
}

/// An SPI with one sensor on it.
pub(crate) struct Device {
    port: &'static SensorPort,
}

/// The SPI has not sent what it was given.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stuck;

impl Error for Stuck {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

impl ErrorType for Device {
    type Error = Stuck;
}

impl Device {
    /// Waits until `is_so`, within a bound.
    #[inline]
    fn wait(is_so: impl Fn() -> bool) -> Result<(), Stuck> {
        if (0..POLLS).any(|_| is_so()) {
            Ok(())
        } else {
            Err(Stuck)
        }
    }

    /// Sends a byte and returns the one that came meanwhile.
    #[inline]
    fn byte(&self, sent: u8) -> Result<u8, Stuck> {
        let spi = self.port.spi;
        spi::send(spi, sent);
        Self::wait(|| spi.sr().read().rxne())?;
        Ok(spi::receive(spi))
    }

    /// What a transaction asks for, /CS low.
    #[inline]
    fn carry_out(&self, operation: &mut Operation<'_, u8>) -> Result<(), Stuck> {
        /// What is sent where nothing is given.
        const FILLER: u8 = 0;
        match operation {
            Operation::Read(read) => read
                .iter_mut()
                .try_for_each(|read| self.byte(FILLER).map(|byte| *read = byte)),
            Operation::Write(sent) => sent
                .iter()
                .try_for_each(|sent| self.byte(*sent).map(|_| ())),
            Operation::Transfer(read, sent) => {
                let longest = read.len().max(sent.len());
                let sent = sent.iter().copied().chain(core::iter::repeat(FILLER));
                let mut read = read.iter_mut();
                sent.take(longest).try_for_each(|sent| {
                    let byte = self.byte(sent)?;
                    if let Some(read) = read.next() {
                        *read = byte;
                    }
                    Ok(())
                })
            }
            Operation::TransferInPlace(bytes) => bytes
                .iter_mut()
                .try_for_each(|byte| self.byte(*byte).map(|read| *byte = read)),
            Operation::DelayNs(ns) => {
                // Whole microseconds, lest a product overflow.
                cortex_m::asm::delay(CLOCKS.core_hz / 1_000_000 * (*ns / 1_000 + 1));
                Ok(())
            }
        }
    }
}

impl SpiDevice for Device {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Stuck> {
        let port = self.port;
        spi::drain(port.spi);
        port.pins.select.low();
        cortex_m::asm::delay(SETUP_ROUNDS);
        let done = operations
            .iter_mut()
            .try_for_each(|operation| self.carry_out(operation))
            // The last byte is received half a clock before its end.
            .and_then(|()| Self::wait(|| !port.spi.sr().read().bsy()));
        cortex_m::asm::delay(SETUP_ROUNDS);
        port.pins.select.high();
        cortex_m::asm::delay(HIGH_ROUNDS);
        if done.is_err() {
            set_up_spi(port);
        }
        done
    }
}
