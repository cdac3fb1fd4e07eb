//! What befalls supply, clocks and registers from outside, and what the chip makes of it by itself.

use super::model::Unit;
use super::{Chip, Fault, ResetCause};

/// Bits of the wait states in the flash interface's first register.
const LATENCY: u32 = 15;
/// Offsets within a unit that hold settings or counts.
const OFFSETS: u32 = 0x80;

impl Chip {
    /// Returns what holds the chip in reset.
    pub(crate) fn set_supply(&mut self, supply_mv: u32) -> Result<Option<ResetCause>, Fault> {
        self.power.supply_mv = supply_mv;
        let held = self.power.holds_in_reset();
        if held.is_none() {
            self.compare_supply();
            self.follow_clocks()?;
        }
        Ok(held)
    }

    pub(super) fn compare_supply(&mut self) {
        if self.power.compare() {
            self.exti.rise();
        }
    }

    /// Has the option bytes set to the highest brown-out level; whether there is any.
    pub(crate) fn set_brown_out(&mut self) -> bool {
        self.power.set_brown_out()
    }

    /// Returns whether the chip runs by the clock from outside.
    pub(crate) fn stop_clock(&mut self, stopped: bool) -> Result<bool, Fault> {
        let had = self.rcc.stop_outside(stopped);
        self.follow_clocks()?;
        Ok(had)
    }

    pub(crate) fn let_go(&mut self) {
        self.debug.reset();
    }

    /// Whether a debugger that halts the core stops timers, the motors' among them, and the
    /// watchdog.
    pub(crate) fn stops_with_the_core(&self) -> bool {
        self.debug.values().iter().any(|bits| *bits != 0)
    }

    pub(crate) fn has_nmi(&self) -> bool {
        self.rcc.has_failed
    }

    /// Takes the clocks that the registers make, where the flash keeps up with them.
    pub(super) fn follow_clocks(&mut self) -> Result<(), Fault> {
        let clocks = self.rcc.clocks()?;
        let wait_states = self.flash.read(0, self.now).unwrap_or(0) & LATENCY;
        let supply_mv = self.power.supply_mv;
        let mut steps = self.model.flash_hz.iter();
        let step = steps.find(|(from_mv, _)| supply_mv >= *from_mv);
        let (_, hz) = step.ok_or(Fault::Clock("the supply is below the chip's range"))?;
        // A tick of the picosecond clock more than the period is rounded by.
        if clocks.core * hz * u64::from(wait_states + 1) < 999_900_000_000 {
            return Err(Fault::Clock(
                "the flash has too few wait states for this clock and supply",
            ));
        }
        self.clocks = clocks;
        Ok(())
    }

    /// Inverts a bit of a register that is not zero: which one, `detail` says. Returns its
    /// name, or nothing where no such bit is modelled.
    pub(crate) fn flip(&mut self, detail: u64) -> Option<String> {
        let mut found = Vec::new();
        for &(unit, base, _) in self.model.map {
            // Reading the data register of an SPI takes a byte away; the watchdog has keys.
            if matches!(unit, Unit::Spi(_) | Unit::Watchdog | Unit::Debug) {
                continue;
            }
            for offset in (0..OFFSETS).step_by(4) {
                let address = base + offset;
                let value = self.read(address, u32::MAX).unwrap_or(0);
                found.extend((value != 0).then_some((address, value)));
            }
        }
        let count = found.len();
        for n in 0..count {
            let place = (detail as usize).wrapping_add(n) % count;
            let (address, value) = *found.get(place)?;
            let bit = (detail >> 32) % 32;
            if self.write(address, value ^ (1 << bit), u32::MAX).is_ok() {
                return Some(format!("{address:#010x} bit {bit}"));
            }
        }
        None
    }

    /// Disables the DMA stream that receives the left sensor's bytes.
    pub(crate) fn stop_dma(&mut self) {
        let side = &self.model.wiring.sides[0];
        if let Some(dma) = self.dmas.get_mut(side.dma) {
            dma.stop(side.rx.stream);
        }
    }
}
