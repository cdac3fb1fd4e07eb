//! Where the two kinds of DMA controllers have their registers and bits. Streams: STM32F4;
//! RM0390, chapter 9; direct mode, no double buffer, no bursts. Channels: STM32F1 and STM32G0;
//! RM0008, chapter 13; RM0444, chapter 10; not from memory to memory.

use super::{CR, EN, MAR, NDTR, PAR};
use crate::chip::fields::{Field, field, whole};

#[derive(Debug)]
pub(in crate::chip) struct Layout {
    pub(in crate::chip) fields: &'static [Field],
    /// Channels, whose requests are wired, or selected by a DMAMUX.
    pub(in crate::chip) has_channels: bool,
    /// Registers of flags, each with one that clears them; then come the streams.
    pub(super) flag_registers: u32,
    pub(super) size: u32,
    /// Where the flags of each stream of a register begin.
    pub(super) flags_at: &'static [u32],
    /// The flags of a stream, and which of them is of them all.
    pub(super) flags: u32,
    pub(super) of_all: u32,
    pub(super) tcif: u32,
    /// Set with the half and with the last byte.
    pub(super) half: u32,
    pub(super) complete: u32,
    pub(super) tcie: u32,
    pub(super) from_memory: u32,
    pub(super) circ: u32,
    pub(super) minc: u32,
    /// What selects the request.
    pub(super) select: u32,
    /// In CR; the rest is not modelled.
    pub(super) modelled: u32,
    /// What is off after the last byte: a channel stays enabled, and moves nothing more.
    pub(super) ends: u32,
}

pub(in crate::chip) static STREAMS: Layout = {
    const LISR: u32 = 0x00;
    const LIFCR: u32 = 0x08;
    const HIFCR: u32 = 0x0C;
    const FIRST: u32 = 0x10;
    const SIZE: u32 = 0x18;
    const TCIE: u32 = 1 << 4;
    const DIR_FROM_MEMORY: u32 = 1 << 6;
    const CIRC: u32 = 1 << 8;
    const MINC: u32 = 1 << 10;
    const PL: u32 = 3 << 16;
    const CHSEL: u32 = 7 << 25;
    const TCIF: u32 = 1 << 5;
    const FLAGS_AT: [u32; 4] = [0, 6, 16, 22];
    Layout {
        fields: &[
            field("LISR", LISR, "TCIF0", TCIF << FLAGS_AT[0]),
            field("LISR", LISR, "TCIF1", TCIF << FLAGS_AT[1]),
            field("LISR", LISR, "TCIF3", TCIF << FLAGS_AT[3]),
            field("LIFCR", LIFCR, "CTCIF0", TCIF << FLAGS_AT[0]),
            field("HIFCR", HIFCR, "CTCIF4", TCIF << FLAGS_AT[0]),
            field("S0CR", FIRST + CR, "EN", EN),
            field("S0CR", FIRST + CR, "TCIE", TCIE),
            field("S0CR", FIRST + CR, "DIR", DIR_FROM_MEMORY),
            field("S0CR", FIRST + CR, "CIRC", CIRC),
            field("S0CR", FIRST + CR, "MINC", MINC),
            field("S0CR", FIRST + CR, "PL", PL),
            field("S0CR", FIRST + CR, "CHSEL", CHSEL),
            whole("S0NDTR", FIRST + NDTR),
            whole("S0PAR", FIRST + PAR),
            whole("S0M0AR", FIRST + MAR),
            field("S3CR", FIRST + 3 * SIZE, "EN", EN),
        ],
        has_channels: false,
        flag_registers: 2,
        size: SIZE,
        flags_at: &FLAGS_AT,
        flags: 0x3F,
        of_all: 0,
        tcif: TCIF,
        half: 0,
        complete: TCIF,
        tcie: TCIE,
        from_memory: DIR_FROM_MEMORY,
        circ: CIRC,
        minc: MINC,
        select: CHSEL,
        // DMEIE, TEIE, TCIE, DIR to memory or from it, CIRC, MINC, priority and channel.
        modelled: EN | 0b10110 | DIR_FROM_MEMORY | CIRC | MINC | PL | CHSEL,
        ends: EN,
    }
};

pub(in crate::chip) static CHANNELS: Layout = {
    const ISR: u32 = 0x00;
    const IFCR: u32 = 0x04;
    const FIRST: u32 = 0x08;
    const SIZE: u32 = 0x14;
    const TCIE: u32 = 1 << 1;
    const TEIE: u32 = 1 << 3;
    const DIR_FROM_MEMORY: u32 = 1 << 4;
    const CIRC: u32 = 1 << 5;
    const MINC: u32 = 1 << 7;
    const GIF: u32 = 1 << 0;
    const TCIF: u32 = 1 << 1;
    const HTIF: u32 = 1 << 2;
    Layout {
        fields: &[
            field("ISR", ISR, "GIF1", GIF),
            field("ISR", ISR, "TCIF1", TCIF),
            field("ISR", ISR, "HTIF1", HTIF),
            field("ISR", ISR, "TCIF2", TCIF << 4),
            field("IFCR", IFCR, "CTCIF1", TCIF),
            field("CCR1", FIRST + CR, "EN", EN),
            field("CCR1", FIRST + CR, "TCIE", TCIE),
            field("CCR1", FIRST + CR, "TEIE", TEIE),
            field("CCR1", FIRST + CR, "DIR", DIR_FROM_MEMORY),
            field("CCR1", FIRST + CR, "CIRC", CIRC),
            field("CCR1", FIRST + CR, "MINC", MINC),
            whole("CNDTR1", FIRST + NDTR),
            whole("CPAR1", FIRST + PAR),
            whole("CMAR1", FIRST + MAR),
            field("CCR2", FIRST + SIZE, "EN", EN),
        ],
        has_channels: true,
        flag_registers: 1,
        size: SIZE,
        flags_at: &[0, 4, 8, 12, 16, 20, 24],
        flags: 15,
        of_all: GIF,
        tcif: TCIF,
        half: GIF | HTIF,
        complete: GIF | TCIF,
        tcie: TCIE,
        from_memory: DIR_FROM_MEMORY,
        circ: CIRC,
        minc: MINC,
        select: 0,
        // And the priority.
        modelled: EN | TCIE | TEIE | DIR_FROM_MEMORY | CIRC | MINC | 3 << 12,
        ends: 0,
    }
};
