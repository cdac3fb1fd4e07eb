//! A DMA controller whose streams move single bytes on request (STM32F4; RM0390,
//! chapter 9): direct mode, no double buffer, no bursts.

use super::{Dma, Move};
use crate::chip::fields::{Field, field, whole};

const LISR: u32 = 0x00;
const HISR: u32 = 0x04;
const LIFCR: u32 = 0x08;
const HIFCR: u32 = 0x0C;
const STREAMS: u32 = 0x10;
const STREAM_SIZE: u32 = 0x18;

/// Of a stream, from where it begins.
const CR: u32 = 0x00;
const NDTR: u32 = 0x04;
const PAR: u32 = 0x08;
const M0AR: u32 = 0x0C;

const EN: u32 = 1 << 0;
const TCIE: u32 = 1 << 4;
const DIR_FROM_MEMORY: u32 = 1 << 6;
const CIRC: u32 = 1 << 8;
const MINC: u32 = 1 << 10;
const PL: u32 = 3 << 16;
const CHSEL: u32 = 7 << 25;
/// DMEIE, TEIE, TCIE, DIR to memory or from it, CIRC, MINC, priority and channel: the rest is not
/// modelled.
const MODELLED: u32 = EN | 0b10110 | DIR_FROM_MEMORY | CIRC | MINC | PL | CHSEL;

/// The flags of a stream in LISR or HISR begin at these bits; TCIF is the sixth.
const FLAGS_AT: [u32; 4] = [0, 6, 16, 22];
const TCIF: u32 = 1 << 5;

pub(super) const FIELDS: [Field; 16] = [
    field("LISR", LISR, "TCIF0", TCIF << FLAGS_AT[0]),
    field("LISR", LISR, "TCIF1", TCIF << FLAGS_AT[1]),
    field("LISR", LISR, "TCIF3", TCIF << FLAGS_AT[3]),
    field("LIFCR", LIFCR, "CTCIF0", TCIF << FLAGS_AT[0]),
    field("HIFCR", HIFCR, "CTCIF4", TCIF << FLAGS_AT[0]),
    field("S0CR", STREAMS + CR, "EN", EN),
    field("S0CR", STREAMS + CR, "TCIE", TCIE),
    field("S0CR", STREAMS + CR, "DIR", DIR_FROM_MEMORY),
    field("S0CR", STREAMS + CR, "CIRC", CIRC),
    field("S0CR", STREAMS + CR, "MINC", MINC),
    field("S0CR", STREAMS + CR, "PL", PL),
    field("S0CR", STREAMS + CR, "CHSEL", CHSEL),
    whole("S0NDTR", STREAMS + NDTR),
    whole("S0PAR", STREAMS + PAR),
    whole("S0M0AR", STREAMS + M0AR),
    field("S3CR", STREAMS + 3 * STREAM_SIZE, "EN", EN),
];

#[derive(Debug, Clone, Copy, Default)]
struct Stream {
    cr: u32,
    ndtr: u32,
    par: u32,
    m0ar: u32,
    /// Bytes asked for when it was enabled.
    length: u32,
}

#[derive(Debug, Clone, Default)]
pub(super) struct Streams {
    streams: [Stream; 8],
    /// Flags of each stream, as if it were the first.
    flags: [u32; 8],
}

impl Dma for Streams {
    fn stop(&mut self, stream: usize) {
        if let Some(stream) = self.streams.get_mut(stream) {
            stream.cr &= !EN;
        }
    }

    fn request(&mut self, stream: usize, channel: u32) -> Option<Move> {
        let s = self.streams.get_mut(stream)?;
        if s.cr & EN == 0 || (s.cr & CHSEL) >> CHSEL.trailing_zeros() != channel {
            return None;
        }
        let done = s.length - s.ndtr;
        let memory = s.m0ar.wrapping_add(if s.cr & MINC != 0 { done } else { 0 });
        s.ndtr -= 1;
        if s.ndtr == 0 {
            if s.cr & CIRC != 0 {
                s.ndtr = s.length;
            } else {
                s.cr &= !EN;
            }
            self.flags[stream] |= TCIF;
        }
        Some(Move {
            peripheral: s.par,
            memory,
            to_memory: s.cr & DIR_FROM_MEMORY == 0,
        })
    }

    fn interrupts(&self, stream: usize) -> bool {
        self.flags[stream] & TCIF != 0 && self.streams[stream].cr & TCIE != 0
    }

    fn read(&self, offset: u32) -> Option<u32> {
        Some(match offset {
            LISR => self.gather(0),
            HISR => self.gather(4),
            LIFCR | HIFCR => 0,
            _ => {
                let s = self.streams.get(stream(offset)?)?;
                match (offset - STREAMS) % STREAM_SIZE {
                    CR => s.cr,
                    NDTR => s.ndtr,
                    PAR => s.par,
                    M0AR => s.m0ar,
                    _ => return None,
                }
            }
        })
    }

    fn write(&mut self, offset: u32, value: u32) -> bool {
        match offset {
            LIFCR => self.clear(0, value),
            HIFCR => self.clear(4, value),
            _ => {
                let Some(s) = stream(offset).and_then(|n| self.streams.get_mut(n)) else {
                    return false;
                };
                let register = (offset - STREAMS) % STREAM_SIZE;
                let enabled = s.cr & EN != 0;
                match register {
                    CR if value & !MODELLED != 0 => return false,
                    CR => {
                        if value & EN != 0 && !enabled {
                            s.length = s.ndtr;
                        }
                        // Without bytes to move it does not start.
                        let idle = value & EN != 0 && s.ndtr == 0;
                        s.cr = if idle { value & !EN } else { value };
                    }
                    // The others are locked while the stream is enabled.
                    NDTR | PAR | M0AR if enabled => {}
                    NDTR => s.ndtr = value & 0xFFFF,
                    PAR => s.par = value,
                    M0AR => s.m0ar = value,
                    _ => return false,
                }
            }
        }
        true
    }
}

impl Streams {
    fn gather(&self, first: usize) -> u32 {
        let flags = self.flags[first..first + 4].iter().zip(FLAGS_AT);
        flags.fold(0, |all, (flags, at)| all | flags << at)
    }

    fn clear(&mut self, first: usize, value: u32) {
        for (flags, at) in self.flags[first..first + 4].iter_mut().zip(FLAGS_AT) {
            *flags &= !((value >> at) & 0x3F);
        }
    }
}

fn stream(offset: u32) -> Option<usize> {
    Some((offset.checked_sub(STREAMS)? / STREAM_SIZE) as usize)
}
