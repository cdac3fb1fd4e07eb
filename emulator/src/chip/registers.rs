//! The registers of all peripherals by address: reads, writes, clock gates and
//! peripheral resets.

use super::dma::Dma;
use super::gpio::Role;
use super::rcc::Bus;
use super::spi::Spi;
use super::{Chip, Fault};

/// What lies at an address.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Unit {
    Tim(usize),
    Watchdog,
    Spi1,
    Gpio(usize),
    Rcc,
    Flash,
    Dma2,
    Debug,
}

/// A unit, its base address, and its gate in RCC where it has one.
type Entry = (Unit, u32, Option<(Bus, u32)>);

const MAP: [Entry; 14] = [
    (Unit::Tim(0), 0x4000_0000, Some((Bus::Apb1, 0))),
    (Unit::Tim(1), 0x4000_0400, Some((Bus::Apb1, 1))),
    (Unit::Tim(2), 0x4000_0C00, Some((Bus::Apb1, 3))),
    (Unit::Watchdog, 0x4000_3000, None),
    (Unit::Tim(3), 0x4001_0000, Some((Bus::Apb2, 0))),
    (Unit::Tim(4), 0x4001_0400, Some((Bus::Apb2, 1))),
    (Unit::Spi1, 0x4001_3000, Some((Bus::Apb2, 12))),
    (Unit::Gpio(0), 0x4002_0000, Some((Bus::Ahb1, 0))),
    (Unit::Gpio(1), 0x4002_0400, Some((Bus::Ahb1, 1))),
    (Unit::Gpio(2), 0x4002_0800, Some((Bus::Ahb1, 2))),
    (Unit::Rcc, 0x4002_3800, None),
    (Unit::Flash, 0x4002_3C00, None),
    (Unit::Dma2, 0x4002_6400, Some((Bus::Ahb1, 22))),
    (Unit::Debug, 0xE004_2000, None),
];

impl Chip {
    /// The unit at an address, whether it has its clock, and the offset in it.
    fn find(&self, address: u32) -> Option<(Unit, bool, u32)> {
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
                Unit::Spi1 => self.spi.read(offset),
                Unit::Gpio(n) => self.gpio[n].read(offset),
                Unit::Rcc => self.rcc.read(offset),
                Unit::Flash => self.flash.read(offset),
                Unit::Dma2 => self.dma.read(offset),
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
        let half = matches!(unit, Unit::Tim(_) | Unit::Spi1 | Unit::Watchdog);
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
            Unit::Spi1 => self.spi.write(offset, value, now, self.clocks.apb2),
            Unit::Gpio(n) => self.gpio[n].write(offset, value),
            Unit::Rcc => self.rcc.write(offset, value),
            Unit::Flash => self.flash.write(offset, value),
            Unit::Dma2 => self.dma.write(offset, value),
            Unit::Debug => self.debug.write(offset, value),
        };
        if !known {
            return Err(unmodelled);
        }
        match unit {
            Unit::Rcc => {
                self.clocks = self.rcc.clocks()?;
                self.reset_peripherals();
                self.select_sensor();
            }
            Unit::Gpio(1) => self.select_sensor(),
            _ => {}
        }
        Ok(())
    }

    /// Brings the level of PB6 to the sensor's /SS.
    fn select_sensor(&mut self) {
        let low = self.gpio[1].role(6) == Role::Output(false);
        self.lines.select(low);
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
                Unit::Spi1 => self.spi = Spi::default(),
                Unit::Gpio(n) => self.gpio[n].reset(),
                Unit::Dma2 => self.dma = Dma::default(),
                Unit::Watchdog | Unit::Rcc | Unit::Flash | Unit::Debug => {}
            }
        }
    }
}
