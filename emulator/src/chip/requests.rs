//! The DMA's requests: which peripheral asks for a byte, and who moves it.

use super::dma::Move;
use super::model::Unit;
use super::wiring::{Request, Side};
use super::{Chip, Fault};
use crate::memory::Memories;

/// The peripherals on APB1, which are all that the peripheral port of a DMA1 with streams
/// reaches (AN4031, section 2.1: it is not connected to the bus matrix).
const APB1: std::ops::Range<u32> = 0x4000_0000..0x4000_8000;

/// An access of a byte, as the low bits of the data registers are reached.
const BYTE: u32 = 0xFF;

impl Chip {
    pub(super) fn serve_requests(&mut self, memories: &Memories) -> Result<(), Fault> {
        for (n, side) in self.model.wiring.sides.iter().enumerate() {
            while let Some(moved) = self.requested(n, side) {
                if moved.to_memory {
                    self.lines[n].put(moved.memory);
                }
                self.move_byte(side.dma, moved, memories)?;
            }
        }
        while self.serve_serial(memories)? {}
        Ok(())
    }

    /// The next move that a request of a side's SPI or byte timer brings.
    fn requested(&mut self, n: usize, side: &Side) -> Option<Move> {
        let Side { rx, tx, .. } = side;
        if self.spis[n].requests()
            && let Some(moved) = self.moves(side.dma, *rx)
        {
            return Some(moved);
        }
        if !self.timers[side.byte_timer].requests(side.byte_signal) {
            return None;
        }
        let moved = self.moves(side.dma, *tx)?;
        self.timers[side.byte_timer].serve(side.byte_signal);
        Some(moved)
    }

    /// What a request moves, if the stream or channel that it is wired to listens to it.
    pub(super) fn moves(&mut self, dma: usize, of: Request) -> Option<Move> {
        let has_mux = self.has(Unit::Requests);
        if has_mux && self.mux.request(of.stream) != Some(of.channel) {
            return None;
        }
        self.dmas[dma].request(of.stream, of.channel)
    }

    pub(super) fn move_byte(
        &mut self,
        dma: usize,
        moved: Move,
        memories: &Memories,
    ) -> Result<(), Fault> {
        let misused = |what| Fault::Misused {
            peripheral: if dma == 0 { "DMA1" } else { "DMA2" },
            what,
        };
        let has_streams = !self.model.dmas[dma].has_channels;
        if has_streams && dma == 0 && !APB1.contains(&moved.peripheral) {
            return Err(misused("its peripheral port reaches APB1 alone"));
        }
        let no_memory = || misused("there is no memory at the address of a stream");
        if moved.to_memory {
            let byte = self.read(moved.peripheral, BYTE)? as u8;
            let put = memories.write(moved.memory, &[byte]);
            put.map_err(|_| no_memory())
        } else {
            let byte = memories.get(moved.memory).ok_or_else(no_memory)?;
            self.write(moved.peripheral, byte.into(), BYTE)
        }
    }
}
