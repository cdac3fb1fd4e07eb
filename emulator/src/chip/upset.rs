//! What may befall the registers, from outside of the program.

use super::Chip;
use super::map::Unit;

/// Offsets within a unit that hold settings or counts.
const OFFSETS: u32 = 0x80;

impl Chip {
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
