//! The serial port's two wires: bytes between USART2, memory and the other end.

use std::collections::VecDeque;

use super::model::Unit;
use super::usart::BITS;
use super::wiring::{PORTS_BUS, SERIAL, SERIAL_DMA};
use super::{Chip, Fault, Ps};
use crate::memory::Memories;

const SECOND: Ps = 1_000_000_000_000;

/// By how many thousandths the chip's bits may differ from those of the other end: what the
/// board's build allows, and what the picosecond clock rounds.
const OFF_PERMILLE: Ps = 16;

/// Whoever is at the other end: the ST-LINK, with a baud of its own.
#[derive(Debug, Clone, Default)]
pub(super) struct SerialLine {
    /// A bit at the other end; none: nothing is there.
    pub(super) bit: Option<Ps>,
    pub(super) sending: VecDeque<u8>,
    /// When the first of that has gone.
    pub(super) ends: Ps,
    pub(super) heard: Vec<u8>,
}

impl SerialLine {
    pub(super) fn next(&self) -> Option<Ps> {
        (!self.sending.is_empty()).then_some(self.ends)
    }
}

impl Chip {
    /// The other end has this baud; none: nothing is there.
    pub(crate) fn attach_serial(&mut self, baud: Option<u32>) {
        self.serial.bit = baud.map(|baud| SECOND / Ps::from(baud));
    }

    pub(crate) fn serial_write(&mut self, bytes: &[u8]) {
        let Some(bit) = self.serial.bit else {
            return;
        };
        if self.serial.sending.is_empty() {
            self.serial.ends = self.now + BITS * bit;
        }
        self.serial.sending.extend(bytes);
    }

    pub(crate) fn serial_waiting(&self) -> usize {
        self.serial.sending.len()
    }

    pub(crate) fn serial_read(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.serial.heard)
    }

    pub(super) fn serial_clock(&self) -> Ps {
        self.clocks.bus(PORTS_BUS)
    }

    fn agrees(&self, bit: Ps) -> Result<(), Fault> {
        let found = self.usart.bit(self.serial_clock());
        if found.abs_diff(bit) * 1_000 <= OFF_PERMILLE * bit {
            return Ok(());
        }
        Err(Fault::Misused {
            peripheral: "USART2",
            what: "its bits are not as long as those of the other end",
        })
    }

    pub(super) fn carry_serial(&mut self) -> Result<(), Fault> {
        let now = self.now;
        let wires = &self.model.wiring;
        let clock = self.serial_clock();
        if let Some(byte) = self.usart.sent(now, clock)
            && self.drives(&SERIAL[..1], wires.serial_function)
            && let Some(bit) = self.serial.bit
        {
            self.agrees(bit)?;
            self.serial.heard.push(byte);
        }
        if self.serial.next().is_none_or(|ends| ends > now) {
            return Ok(());
        }
        let (Some(byte), Some(bit)) = (self.serial.sending.pop_front(), self.serial.bit) else {
            return Ok(());
        };
        self.serial.ends += BITS * bit;
        let is_clocked = self.is_clocked(Unit::Usart);
        if is_clocked && self.usart.listens() && self.hears(&SERIAL[1..], wires.serial_function) {
            self.agrees(bit)?;
            self.usart.receive(byte);
        }
        Ok(())
    }

    /// Moves bytes between memory and the USART; whether it has moved one.
    pub(super) fn serve_serial(&mut self, memories: &Memories) -> Result<bool, Fault> {
        let wires = &self.model.wiring;
        let fetched = self.usart.requests_fetch();
        let fetched = fetched.then(|| self.moves(SERIAL_DMA, wires.serial_rx));
        let moved = fetched.flatten().or_else(|| {
            let brought = self.usart.requests_byte();
            brought.then(|| self.moves(SERIAL_DMA, wires.serial_tx))?
        });
        let Some(moved) = moved else {
            return Ok(false);
        };
        self.move_byte(SERIAL_DMA, moved, memories)?;
        Ok(true)
    }
}
