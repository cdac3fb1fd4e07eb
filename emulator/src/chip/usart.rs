//! A USART with eight bits, no parity and one stop bit, each bit sampled sixteen times, both
//! ways by DMA (RM0390, chapter 25; RM0008, chapter 27; RM0444, chapter 33). Interrupts, other
//! formats, other clocks than the bus's and what comes while no program listens are not modelled.

use super::Ps;
use super::fields::{Field, field, whole};

const TE: u32 = 1 << 3;
const RE: u32 = 1 << 2;
const DMAR: u32 = 1 << 6;
const DMAT: u32 = 1 << 7;
const OVRDIS: u32 = 1 << 12;

const ORE: u32 = 1 << 3;
const RXNE: u32 = 1 << 5;
const TC: u32 = 1 << 6;
const TXE: u32 = 1 << 7;

/// Start, eight bits and stop.
pub(super) const BITS: Ps = 10;

#[derive(Debug)]
pub(super) struct Layout {
    status: u32,
    status_name: &'static str,
    received: u32,
    sent: u32,
    brr: u32,
    cr1: u32,
    cr2: u32,
    cr3: u32,
    /// The bit that switches it on, and those of CR3 that are modelled.
    ue: u32,
    cr3_modelled: u32,
}

/// One data register (STM32F1, STM32F4).
pub(super) static ONE: Layout = Layout {
    status: 0x00,
    status_name: "SR",
    received: 0x04,
    sent: 0x04,
    brr: 0x08,
    cr1: 0x0C,
    cr2: 0x10,
    cr3: 0x14,
    ue: 1 << 13,
    cr3_modelled: DMAR | DMAT,
};

/// One each way (STM32G0).
pub(super) static TWO: Layout = Layout {
    status: 0x1C,
    status_name: "ISR",
    received: 0x24,
    sent: 0x28,
    brr: 0x0C,
    cr1: 0x00,
    cr2: 0x04,
    cr3: 0x08,
    ue: 1 << 0,
    cr3_modelled: DMAR | DMAT | OVRDIS,
};

pub(super) fn fields(at: &Layout) -> Vec<Field> {
    let mut fields = vec![
        whole("BRR", at.brr),
        field("CR1", at.cr1, "UE", at.ue),
        field("CR1", at.cr1, "TE", TE),
        field("CR1", at.cr1, "RE", RE),
        field("CR3", at.cr3, "DMAR", DMAR),
        field("CR3", at.cr3, "DMAT", DMAT),
    ];
    let flags = [("ORE", ORE), ("RXNE", RXNE), ("TC", TC), ("TXE", TXE)];
    fields.extend(flags.map(|(name, bit)| field(at.status_name, at.status, name, bit)));
    if at.has_one_data_register() {
        fields.push(whole("DR", at.sent));
    } else {
        fields.extend([
            whole("RDR", at.received),
            whole("TDR", at.sent),
            field("CR3", at.cr3, "OVRDIS", OVRDIS),
        ]);
    }
    fields
}

impl Layout {
    const fn has_one_data_register(&self) -> bool {
        self.sent == self.received
    }
}

#[derive(Debug, Clone)]
pub(super) struct Usart {
    layout: &'static Layout,
    cr1: u32,
    cr3: u32,
    brr: u32,
    /// The byte on its way, and when it has gone.
    shift: Option<(u8, Ps)>,
    waiting: Option<u8>,
    received: Option<u8>,
    last: u8,
    overrun: bool,
}

impl Usart {
    pub(super) const fn new(layout: &'static Layout) -> Self {
        Self {
            layout,
            cr1: 0,
            cr3: 0,
            brr: 0,
            shift: None,
            waiting: None,
            received: None,
            last: 0,
            overrun: false,
        }
    }

    pub(super) const fn reset(&mut self) {
        *self = Self::new(self.layout);
    }

    const fn does(&self, what: u32) -> bool {
        let ue = self.layout.ue;
        self.cr1 & (ue | what) == ue | what
    }

    pub(super) fn bit(&self, bus: Ps) -> Ps {
        bus * Ps::from(self.brr)
    }

    pub(super) const fn listens(&self) -> bool {
        self.does(RE)
    }

    pub(super) const fn receive(&mut self, byte: u8) {
        if self.received.is_some() {
            self.overrun = self.cr3 & OVRDIS == 0;
            if self.overrun {
                return;
            }
        }
        self.received = Some(byte);
    }

    pub(super) fn sends_until(&self) -> Option<Ps> {
        self.shift.map(|(_, ends)| ends)
    }

    pub(super) fn sent(&mut self, now: Ps, bus: Ps) -> Option<u8> {
        let (gone, _) = self.shift.take_if(|(_, ends)| *ends <= now)?;
        self.begin(now, bus);
        Some(gone)
    }

    fn begin(&mut self, now: Ps, bus: Ps) {
        if self.shift.is_none()
            && self.does(TE)
            && let Some(byte) = self.waiting.take()
        {
            self.shift = Some((byte, now + BITS * self.bit(bus)));
        }
    }

    pub(super) const fn requests_fetch(&self) -> bool {
        self.received.is_some() && self.cr3 & DMAR != 0
    }

    pub(super) const fn requests_byte(&self) -> bool {
        self.waiting.is_none() && self.cr3 & DMAT != 0 && self.does(TE)
    }

    pub(super) fn read(&mut self, offset: u32) -> Option<u32> {
        let at = self.layout;
        let flag = |on: bool, bit: u32| if on { bit } else { 0 };
        Some(match offset {
            _ if offset == at.status => {
                flag(self.overrun, ORE)
                    | flag(self.received.is_some(), RXNE)
                    | flag(self.shift.is_none() && self.waiting.is_none(), TC)
                    | flag(self.waiting.is_none(), TXE)
            }
            _ if offset == at.received => {
                self.last = self.received.take().unwrap_or(self.last);
                self.overrun &= !at.has_one_data_register();
                self.last.into()
            }
            _ if offset == at.brr => self.brr,
            _ if offset == at.cr1 => self.cr1,
            _ if offset == at.cr2 => 0,
            _ if offset == at.cr3 => self.cr3,
            _ => return None,
        })
    }

    pub(super) fn write(&mut self, offset: u32, value: u32, now: Ps, bus: Ps) -> bool {
        let at = self.layout;
        match offset {
            _ if offset == at.sent => {
                self.waiting = Some(value as u8);
                self.begin(now, bus);
            }
            // Below 16 there is no bit to be sampled so often.
            _ if offset == at.brr && (16..=0xFFFF).contains(&value) => self.brr = value,
            _ if offset == at.cr1 && value & !(at.ue | TE | RE) == 0 => {
                let is_set_up = value & at.ue == 0 || self.brr >= 16;
                self.cr1 = value;
                return is_set_up;
            }
            _ if offset == at.cr2 => return value == 0,
            _ if offset == at.cr3 && value & !at.cr3_modelled == 0 => self.cr3 = value,
            _ => return false,
        }
        true
    }
}
