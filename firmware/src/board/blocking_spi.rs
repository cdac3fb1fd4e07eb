//! A sensor's SPI as a blocking [`SpiDevice`], over the registers: a TMAG5170 is read by it in each
//! tick (`tilt.rs`), an MLX90333 before the first one (`sensor.rs`).
//!
//! Each wait for a byte has a bound ([`Wires::polls`]); where that passes the SPI is set up again,
//! and the driver's caller gets an error. What differs between chips is in `spi_*.rs`.

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{Error, ErrorKind, ErrorType, Operation, SpiDevice};
use stm32_metapac::spi::vals::{Br, Cpha, Mstr};

use super::pace;
use super::wiring::SensorPort;
use crate::here::{CLOCKS, reset_spi, spi};

/// Rounds are those of `cortex_m::asm::delay`.
pub(crate) struct Wires {
    /// Whether data is taken at the first edge of the clock, which is low at rest, or the second.
    pub(crate) phase: Cpha,
    /// Steps of the divider, each of which doubles the clock, beyond an MLX90333's.
    pub(crate) faster: u8,
    /// From /SS low to the clock.
    pub(crate) lead_rounds: u32,
    /// From the clock to /SS high.
    pub(crate) lag_rounds: u32,
    pub(crate) high_rounds: u32,
    /// Looks at the SPI's flags for a byte. One takes two cycles and more.
    pub(crate) polls: u32,
}

/// Rounds of so many nanoseconds at the core's highest clock, of two cycles or more each.
pub(crate) const fn rounds(ns: u32) -> u32 {
    (CLOCKS.core_hz / 1_000_000 * ns).div_ceil(2_000)
}

/// Also discards a frame that broke off in the middle of a byte.
#[inline(never)]
pub(crate) fn set_up(port: &SensorPort, wires: &Wires, has_dma: bool) {
    reset_spi(port.spi);
    spi::set_up_bytes(port.spi);
    port.spi.cr2().modify(|w| w.set_rxdmaen(has_dma));
    port.spi.cr1().write(|w| {
        w.set_mstr(Mstr::MASTER);
        w.set_ssm(true);
        w.set_ssi(true);
        w.set_cpha(wires.phase);
        w.set_br(Br::from_bits(port.divider.to_bits() - wires.faster));
        w.set_spe(true);
    });
}

pub(crate) struct Device {
    port: &'static SensorPort,
    wires: &'static Wires,
}

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
    pub(crate) fn start(port: &'static SensorPort, wires: &'static Wires) -> Self {
        set_up(port, wires, false);
        Self { port, wires }
    }

    #[inline]
    fn wait(&self, is_so: impl Fn() -> bool) -> Result<(), Stuck> {
        if (0..self.wires.polls).any(|_| is_so()) {
            Ok(())
        } else {
            Err(Stuck)
        }
    }

    #[inline]
    fn byte(&self, sent: u8) -> Result<u8, Stuck> {
        let spi = self.port.spi;
        spi::send(spi, sent);
        self.wait(|| spi.sr().read().rxne())?;
        Ok(spi::receive(spi))
    }

    /// As many bytes as the longer of the two has. No driver of these sensors asks for it.
    #[cold]
    #[inline(never)]
    fn transfer(&self, read: &mut [u8], sent: &[u8]) -> Result<(), Stuck> {
        const FILLER: u8 = 0;
        (0..read.len().max(sent.len())).try_for_each(|n| {
            let byte = self.byte(sent.get(n).copied().unwrap_or(FILLER))?;
            if let Some(read) = read.get_mut(n) {
                *read = byte;
            }
            Ok(())
        })
    }

    #[inline]
    fn carry_out(&self, operation: &mut Operation<'_, u8>) -> Result<(), Stuck> {
        match operation {
            Operation::Read(read) => self.transfer(read, &[]),
            Operation::Write(sent) => self.transfer(&mut [], sent),
            Operation::Transfer(read, sent) => self.transfer(read, sent),
            Operation::TransferInPlace(bytes) => bytes
                .iter_mut()
                .try_for_each(|byte| self.byte(*byte).map(|read| *byte = read)),
            Operation::DelayNs(ns) => {
                Wait.delay_ns(*ns);
                Ok(())
            }
        }
    }
}

impl SpiDevice for Device {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Stuck> {
        let Self { port, wires } = *self;
        spi::drain(port.spi);
        port.pins.select.low();
        cortex_m::asm::delay(wires.lead_rounds);
        let done = operations
            .iter_mut()
            .try_for_each(|operation| self.carry_out(operation))
            // The last byte is received half a clock before its end.
            .and_then(|()| self.wait(|| !port.spi.sr().read().bsy()));
        cortex_m::asm::delay(wires.lag_rounds);
        port.pins.select.high();
        cortex_m::asm::delay(wires.high_rounds);
        if done.is_err() {
            set_up(port, wires, false);
        }
        done
    }
}

pub(crate) struct Wait;

impl DelayNs for Wait {
    fn delay_ns(&mut self, ns: u32) {
        /// Cycles that a round takes at least, on every core of these boards.
        const ROUND: u32 = 3;
        // Whole microseconds, lest a product overflow.
        let us = ns / 1_000 + 1;
        cortex_m::asm::delay(pace::clocks().core_hz / 1_000_000 * us / ROUND);
    }
}
