//! DMAMUX: which request a channel of the DMA listens to (STM32G0; RM0444, chapter 11).
//! Synchronisation and generators are not modelled.

use super::fields::{Field, field};

const CHANNELS: u32 = 7;
const DMAREQ_ID: u32 = 0x3F;

pub(super) const FIELDS: [Field; 2] = [
    field("C0CR", 0, "DMAREQ_ID", DMAREQ_ID),
    field("C1CR", 4, "DMAREQ_ID", DMAREQ_ID),
];

#[derive(Debug, Clone, Default)]
pub(super) struct Mux {
    ccr: [u32; CHANNELS as usize],
}

impl Mux {
    /// Channels count from 0.
    pub(super) fn request(&self, channel: usize) -> Option<u32> {
        self.ccr.get(channel).copied()
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        self.request(offset as usize / 4)
    }

    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        let known = offset < 4 * CHANNELS && value & !DMAREQ_ID == 0;
        if known {
            self.ccr[offset as usize / 4] = value;
        }
        known
    }
}
