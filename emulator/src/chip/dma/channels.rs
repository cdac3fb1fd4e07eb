//! A DMA controller whose channels move single bytes on request (STM32F1 and STM32G0;
//! RM0008, chapter 13; RM0444, chapter 10): not from memory to memory.

use super::{Dma, Move};
use crate::chip::fields::{Field, field, whole};

const ISR: u32 = 0x00;
const IFCR: u32 = 0x04;
const CHANNELS: u32 = 0x08;
const CHANNEL_SIZE: u32 = 0x14;

/// Of a channel, from where it begins.
const CCR: u32 = 0x00;
const CNDTR: u32 = 0x04;
const CPAR: u32 = 0x08;
const CMAR: u32 = 0x0C;

const EN: u32 = 1 << 0;
const TCIE: u32 = 1 << 1;
const TEIE: u32 = 1 << 3;
const DIR_FROM_MEMORY: u32 = 1 << 4;
const CIRC: u32 = 1 << 5;
const MINC: u32 = 1 << 7;
/// And the priority: the rest is not modelled.
const MODELLED: u32 = EN | TCIE | TEIE | DIR_FROM_MEMORY | CIRC | MINC | 3 << 12;

/// Flags of a channel, which has four bits in ISR.
const GIF: u32 = 1 << 0;
const TCIF: u32 = 1 << 1;
const HTIF: u32 = 1 << 2;
const ALL: u32 = 15;

pub(super) const FIELDS: [Field; 15] = [
    field("ISR", ISR, "GIF1", GIF),
    field("ISR", ISR, "TCIF1", TCIF),
    field("ISR", ISR, "HTIF1", HTIF),
    field("ISR", ISR, "TCIF2", TCIF << 4),
    field("IFCR", IFCR, "CTCIF1", TCIF),
    field("CCR1", CHANNELS + CCR, "EN", EN),
    field("CCR1", CHANNELS + CCR, "TCIE", TCIE),
    field("CCR1", CHANNELS + CCR, "TEIE", TEIE),
    field("CCR1", CHANNELS + CCR, "DIR", DIR_FROM_MEMORY),
    field("CCR1", CHANNELS + CCR, "CIRC", CIRC),
    field("CCR1", CHANNELS + CCR, "MINC", MINC),
    whole("CNDTR1", CHANNELS + CNDTR),
    whole("CPAR1", CHANNELS + CPAR),
    whole("CMAR1", CHANNELS + CMAR),
    field("CCR2", CHANNELS + CHANNEL_SIZE, "EN", EN),
];

#[derive(Debug, Clone, Copy, Default)]
struct Channel {
    ccr: u32,
    cndtr: u32,
    cpar: u32,
    cmar: u32,
    /// Bytes to move and bytes moved since it was enabled.
    length: u32,
    done: u32,
}

#[derive(Debug, Clone, Default)]
pub(super) struct Channels {
    channels: [Channel; 7],
    isr: u32,
}

impl Dma for Channels {
    fn stop(&mut self, channel: usize) {
        if let Some(channel) = self.channels.get_mut(channel) {
            channel.ccr &= !EN;
        }
    }

    fn request(&mut self, channel: usize, _: u32) -> Option<Move> {
        let c = self.channels.get_mut(channel)?;
        if c.ccr & EN == 0 || c.cndtr == 0 {
            return None;
        }
        let memory = c
            .cmar
            .wrapping_add(if c.ccr & MINC != 0 { c.done } else { 0 });
        let moved = Move {
            peripheral: c.cpar,
            memory,
            to_memory: c.ccr & DIR_FROM_MEMORY == 0,
        };
        c.done += 1;
        c.cndtr -= 1;
        let mut flags = 0;
        if 2 * c.done == c.length {
            flags |= GIF | HTIF;
        }
        if c.cndtr == 0 {
            // It stays enabled, and starts again or moves nothing more.
            flags |= GIF | TCIF;
            if c.ccr & CIRC != 0 {
                c.cndtr = c.length;
                c.done = 0;
            }
        }
        self.isr |= flags << (4 * channel);
        Some(moved)
    }

    fn interrupts(&self, channel: usize) -> bool {
        let flags = self.isr >> (4 * channel);
        flags & TCIF != 0 && self.channels[channel].ccr & TCIE != 0
    }

    fn read(&self, offset: u32) -> Option<u32> {
        Some(match offset {
            ISR => self.isr,
            IFCR => 0,
            _ => {
                let c = self.channels.get(channel(offset)?)?;
                match (offset - CHANNELS) % CHANNEL_SIZE {
                    CCR => c.ccr,
                    CNDTR => c.cndtr,
                    CPAR => c.cpar,
                    CMAR => c.cmar,
                    _ => return None,
                }
            }
        })
    }

    fn write(&mut self, offset: u32, value: u32) -> bool {
        if offset == IFCR {
            for channel in 0..self.channels.len() {
                let flags = (value >> (4 * channel)) & ALL;
                // The flag of them all clears them all.
                let flags = if flags & GIF != 0 { ALL } else { flags };
                self.isr &= !(flags << (4 * channel));
            }
            return true;
        }
        let Some(c) = channel(offset).and_then(|n| self.channels.get_mut(n)) else {
            return false;
        };
        let enabled = c.ccr & EN != 0;
        match (offset - CHANNELS) % CHANNEL_SIZE {
            CCR if value & !MODELLED != 0 => return false,
            CCR => {
                if value & EN != 0 && !enabled {
                    c.length = c.cndtr;
                    c.done = 0;
                }
                c.ccr = value;
            }
            // The others are locked while the channel is enabled.
            CNDTR | CPAR | CMAR if enabled => {}
            CNDTR => c.cndtr = value & 0xFFFF,
            CPAR => c.cpar = value,
            CMAR => c.cmar = value,
            _ => return false,
        }
        true
    }
}

fn channel(offset: u32) -> Option<usize> {
    Some((offset.checked_sub(CHANNELS)? / CHANNEL_SIZE) as usize)
}
