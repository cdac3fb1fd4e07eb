//! The registers of all peripherals by address: reads, writes, clock gates and peripheral resets.

use super::model::Unit;
use super::mux::Mux;
use super::remap::Remap;
use super::{Chip, Fault};

impl Chip {
    /// The unit at an address, whether it has its clock, and the offset in it.
    pub(super) fn find(&self, address: u32) -> Option<(Unit, bool, u32)> {
        let mut map = self.model.map.iter();
        let found = map.find(|(_, base, _)| (*base..base + 0x400).contains(&address));
        let &(unit, base, gate) = found?;
        let clocked = gate.is_none_or(|(bus, bit)| self.rcc.is_clocked(bus, bit));
        Some((unit, clocked, address - base))
    }

    pub(super) fn is_clocked(&self, unit: Unit) -> bool {
        let mut map = self.model.map.iter();
        let found = map.find(|(found, ..)| *found == unit);
        found.is_some_and(|(_, base, _)| self.find(*base).is_some_and(|(_, clocked, _)| clocked))
    }

    pub(super) fn has(&self, unit: Unit) -> bool {
        self.model.map.iter().any(|(found, ..)| *found == unit)
    }

    /// Reads the bits of `mask` of a register, at the time in [`Chip::now`].
    pub(crate) fn read(&mut self, address: u32, mask: u32) -> Result<u32, Fault> {
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
                Unit::Spi(n) => self.spis[n].read(offset, bytes_of(mask)),
                Unit::Gpio(n) => self.gpio[n].read(offset),
                Unit::Rcc => self.rcc.read(offset),
                Unit::Flash => self
                    .power
                    .options(offset)
                    .or_else(|| self.flash.read(offset, now)),
                Unit::Power => self.power.read(offset),
                Unit::Lines => self.exti.read(offset),
                Unit::Usart => self.usart.read(offset),
                Unit::Can => self.can.read(offset),
                Unit::Dma(n) => self.dmas[n].read(offset),
                Unit::Requests => self.mux.read(offset),
                Unit::Remap => Remap::read(offset),
                Unit::System => self.system.read(offset),
                Unit::Debug => self.debug.read(offset),
            }
        });
        let (write, pc) = (false, 0);
        found.ok_or(Fault::Unmodelled { address, write, pc })
    }

    pub(crate) fn write(&mut self, address: u32, value: u32, mask: u32) -> Result<(), Fault> {
        let now = self.now;
        let (write, pc) = (true, 0);
        let unmodelled = Fault::Unmodelled { address, write, pc };
        let Some((unit, clocked, offset)) = self.find(address) else {
            return Err(unmodelled);
        };
        if !clocked {
            return Ok(());
        }
        // Timers and watchdog have registers of 16 bits: a half-word is all. An SPI takes
        // any access for what it is, a USART no more of it than its register has.
        let half = matches!(unit, Unit::Tim(_) | Unit::Watchdog) && mask == 0xFFFF;
        let whole = mask == u32::MAX || half || matches!(unit, Unit::Spi(_) | Unit::Usart);
        let value = if whole {
            value
        } else {
            self.read(address, u32::MAX)? & !mask | value & mask
        };
        // What the clocks cannot be set to leaves them as they are.
        let is_of_clocks = matches!(unit, Unit::Rcc | Unit::Flash);
        let before = is_of_clocks.then(|| (self.rcc.clone(), self.flash.clone()));
        let known = match unit {
            Unit::Tim(n) => {
                let clock = self.timer_clock(n);
                self.timers[n].write(offset, value, now, clock)
            }
            Unit::Watchdog => self.watchdog.write(offset, value, now),
            Unit::Spi(n) => {
                let clock = self.spi_clock(n);
                let bytes = bytes_of(mask);
                self.spis[n].write(offset, value, bytes, now, clock)
            }
            Unit::Gpio(n) => self.gpio[n].write(offset, value),
            Unit::Rcc => self.rcc.write(offset, value),
            Unit::Flash => self.flash.write(offset, value, now),
            Unit::Power => self.power.write(offset, value),
            Unit::Lines => self.exti.write(offset, value),
            Unit::Usart => {
                let clock = self.serial_clock();
                self.usart.write(offset, value, now, clock)
            }
            Unit::Can => self.can.write(offset, value, now),
            Unit::Dma(n) => self.dmas[n].write(offset, value),
            Unit::Requests => self.mux.write(offset, value),
            Unit::Remap => self.remap.write(offset, value),
            Unit::System => self.system.write(offset, value),
            Unit::Debug => self.debug.write(offset, value),
        };
        if !known {
            return Err(unmodelled);
        }
        if let Some((rcc, flash)) = before
            && let Err(fault) = self.follow_clocks()
        {
            (self.rcc, self.flash) = (rcc, flash);
            return Err(fault);
        }
        match unit {
            Unit::Rcc => {
                self.reset_peripherals();
                self.select_sensors();
            }
            Unit::Power => self.compare_supply(),
            Unit::Gpio(_) => self.select_sensors(),
            _ => {}
        }
        Ok(())
    }

    fn reset_peripherals(&mut self) {
        for &(unit, _, gate) in self.model.map {
            if gate.is_some_and(|(bus, bit)| self.rcc.is_in_reset(bus, bit)) {
                self.reset_unit(unit);
            }
        }
    }

    /// A peripheral as after power-up, but for what outlives a reset. RCC is apart: it keeps why.
    pub(super) fn reset_unit(&mut self, unit: Unit) {
        match unit {
            Unit::Tim(n) => self.timers[n].reset(),
            Unit::Watchdog => self.watchdog.reset(),
            Unit::Spi(n) => self.spis[n].reset(),
            Unit::Gpio(n) => self.gpio[n].reset(),
            Unit::Rcc => {}
            Unit::Flash => self.flash.reset(),
            Unit::Dma(n) => self.dmas[n].reset(),
            Unit::Requests => self.mux = Mux::default(),
            Unit::Remap => self.remap = Remap::default(),
            Unit::System => self.system.reset(),
            Unit::Debug => self.debug.reset(),
            Unit::Power => self.power.reset(),
            Unit::Lines => self.exti.reset(),
            Unit::Usart => self.usart.reset(),
            Unit::Can => self.can.reset(),
        }
    }
}

const fn bytes_of(mask: u32) -> u32 {
    mask.count_ones() / 8
}
