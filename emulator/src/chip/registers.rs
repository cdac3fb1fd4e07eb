//! The registers of all peripherals by address: reads, writes, clock gates and
//! peripheral resets.

use super::dma::Dma;
use super::rcc::Bus;
use super::spi::Spi;
use super::timers::{TIM1, TIM2, TIM3, TIM5, TIM6, TIM7, TIM8};
use super::{Chip, Fault};

/// What lies at an address.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unit {
    Tim(usize),
    Watchdog,
    Spi(usize),
    Gpio(usize),
    Rcc,
    Flash,
    Dma(usize),
    Debug,
}

/// A unit, its base address, and its gate in RCC where it has one.
pub(super) type Entry = (Unit, u32, Option<(Bus, u32)>);

pub(super) const MAP: [Entry; 18] = [
    (Unit::Tim(TIM2), 0x4000_0000, Some((Bus::Apb1, 0))),
    (Unit::Tim(TIM3), 0x4000_0400, Some((Bus::Apb1, 1))),
    (Unit::Tim(TIM5), 0x4000_0C00, Some((Bus::Apb1, 3))),
    (Unit::Tim(TIM6), 0x4000_1000, Some((Bus::Apb1, 4))),
    (Unit::Tim(TIM7), 0x4000_1400, Some((Bus::Apb1, 5))),
    (Unit::Watchdog, 0x4000_3000, None),
    (Unit::Spi(1), 0x4000_3800, Some((Bus::Apb1, 14))),
    (Unit::Tim(TIM1), 0x4001_0000, Some((Bus::Apb2, 0))),
    (Unit::Tim(TIM8), 0x4001_0400, Some((Bus::Apb2, 1))),
    (Unit::Spi(0), 0x4001_3000, Some((Bus::Apb2, 12))),
    (Unit::Gpio(0), 0x4002_0000, Some((Bus::Ahb1, 0))),
    (Unit::Gpio(1), 0x4002_0400, Some((Bus::Ahb1, 1))),
    (Unit::Gpio(2), 0x4002_0800, Some((Bus::Ahb1, 2))),
    (Unit::Rcc, 0x4002_3800, None),
    (Unit::Flash, 0x4002_3C00, None),
    (Unit::Dma(0), 0x4002_6000, Some((Bus::Ahb1, 21))),
    (Unit::Dma(1), 0x4002_6400, Some((Bus::Ahb1, 22))),
    (Unit::Debug, 0xE004_2000, None),
];

impl Chip {
    /// The unit at an address, whether it has its clock, and the offset in it.
    pub(super) fn find(&self, address: u32) -> Option<(Unit, bool, u32)> {
        let (unit, base, gate) = MAP
            .into_iter()
            .find(|(_, base, _)| (*base..base + 0x400).contains(&address))?;
        let clocked = gate.is_none_or(|(bus, bit)| self.rcc.is_clocked(bus, bit));
        Some((unit, clocked, address - base))
    }

    /// Reads a register, at the time in [`Chip::now`].
    ///
    /// # Errors
    /// [`Fault::Unmodelled`], without the place in the program.
    pub(crate) fn read(&mut self, address: u32) -> Result<u32, Fault> {
        let now = self.now;
        let found = self.find(address).and_then(|(unit, clocked, offset)| {
            if !clocked {
                return Some(0);
            }
            match unit {
                Unit::Tim(n) => {
                    let clock = self.timer_clock(n);
                    self.timers[n].read(offset, now, clock)
                }
                Unit::Watchdog => self.watchdog.read(offset, now),
                Unit::Spi(n) => self.spis[n].read(offset),
                Unit::Gpio(n) => self.gpio[n].read(offset),
                Unit::Rcc => self.rcc.read(offset),
                Unit::Flash => self.flash.read(offset),
                Unit::Dma(n) => self.dmas[n].read(offset),
                Unit::Debug => self.debug.read(offset),
            }
        });
        found.ok_or(Fault::Unmodelled {
            address,
            write: false,
            pc: 0,
        })
    }

    /// Writes the bits of `mask` into a register, at the time in [`Chip::now`].
    ///
    /// # Errors
    /// [`Fault::Unmodelled`], without the place in the program; what a wrong
    /// clock tree brings.
    pub(crate) fn write(&mut self, address: u32, value: u32, mask: u32) -> Result<(), Fault> {
        let now = self.now;
        let unmodelled = Fault::Unmodelled {
            address,
            write: true,
            pc: 0,
        };
        let Some((unit, clocked, offset)) = self.find(address) else {
            return Err(unmodelled);
        };
        if !clocked {
            return Ok(());
        }
        // Timers, SPI and watchdog have registers of 16 bits: a half-word is all.
        let half = matches!(unit, Unit::Tim(_) | Unit::Spi(_) | Unit::Watchdog);
        let value = if mask == u32::MAX || (half && mask == 0xFFFF) {
            value
        } else {
            self.read(address)? & !mask | value & mask
        };
        let known = match unit {
            Unit::Tim(n) => {
                let clock = self.timer_clock(n);
                self.timers[n].write(offset, value, now, clock)
            }
            Unit::Watchdog => self.watchdog.write(offset, value, now),
            Unit::Spi(n) => {
                let clock = self.spi_clock(n);
                self.spis[n].write(offset, value, now, clock)
            }
            Unit::Gpio(n) => self.gpio[n].write(offset, value),
            Unit::Rcc => self.rcc.write(offset, value),
            Unit::Flash => self.flash.write(offset, value),
            Unit::Dma(n) => self.dmas[n].write(offset, value),
            Unit::Debug => self.debug.write(offset, value),
        };
        if !known {
            return Err(unmodelled);
        }
        match unit {
            Unit::Rcc => {
                self.clocks = self.rcc.clocks()?;
                self.reset_peripherals();
                self.select_sensors();
            }
            Unit::Gpio(_) => self.select_sensors(),
            _ => {}
        }
        Ok(())
    }

    /// Resets what RCC's reset registers name.
    fn reset_peripherals(&mut self) {
        if !self.rcc.has_pulsed() {
            return;
        }
        for (unit, _, gate) in MAP {
            let Some((bus, bit)) = gate else { continue };
            if !self.rcc.take_reset(bus, bit) {
                continue;
            }
            match unit {
                Unit::Tim(n) => self.timers[n].reset(),
                Unit::Spi(n) => self.spis[n] = Spi::default(),
                Unit::Gpio(n) => self.gpio[n].reset(),
                Unit::Dma(n) => self.dmas[n] = Dma::default(),
                Unit::Watchdog | Unit::Rcc | Unit::Flash | Unit::Debug => {}
            }
        }
    }
}
