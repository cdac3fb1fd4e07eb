//! The DMA's requests: which peripheral asks for a byte, and who moves it.

use super::dma::Move;
use super::wiring::{SIDES, Side};
use super::{Chip, Fault, Memory};

/// The peripherals on APB1, which are all that the peripheral port of DMA1 reaches
/// (AN4031, section 2.1: it is not connected to the bus matrix).
const APB1: std::ops::Range<u32> = 0x4000_0000..0x4000_8000;

impl Chip {
    /// Moves bytes for every request that a stream listens to.
    pub(super) fn serve_requests(&mut self, memory: &dyn Memory) -> Result<(), Fault> {
        for (n, side) in SIDES.iter().enumerate() {
            while let Some(moved) = self.requested(n, side) {
                self.move_byte(side.dma, moved, memory)?;
            }
        }
        Ok(())
    }

    /// The next move that a request of a side's SPI or byte timer brings.
    fn requested(&mut self, n: usize, side: &Side) -> Option<Move> {
        let Side { rx, tx, .. } = side;
        if self.spis[n].requests()
            && let Some(moved) = self.dmas[side.dma].request(rx.stream, rx.channel)
        {
            return Some(moved);
        }
        let timer = &mut self.timers[side.byte_timer];
        if !timer.request {
            return None;
        }
        let moved = self.dmas[side.dma].request(tx.stream, tx.channel)?;
        timer.request = false;
        Some(moved)
    }

    fn move_byte(&mut self, dma: usize, moved: Move, memory: &dyn Memory) -> Result<(), Fault> {
        let misused = |what| Fault::Misused {
            peripheral: if dma == 0 { "DMA1" } else { "DMA2" },
            what,
        };
        if dma == 0 && !APB1.contains(&moved.peripheral) {
            return Err(misused("its peripheral port reaches APB1 alone"));
        }
        let no_memory = || misused("there is no memory at the address of a stream");
        if moved.to_memory {
            let byte = self.read(moved.peripheral)? as u8;
            memory.put(moved.memory, byte).ok_or_else(no_memory)
        } else {
            let byte = memory.get(moved.memory).ok_or_else(no_memory)?;
            self.write(moved.peripheral, byte.into(), u32::MAX)
        }
    }
}
