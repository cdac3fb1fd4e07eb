//! A bxCAN with the wires of its transceiver (RM0390, chapter 30): initialisation, three transmit
//! mailboxes, one filter of 32 bits with a mask, and the first receive FIFO. What else it has is
//! not modelled: other filters, the second FIFO, interrupts of status and errors, time stamps,
//! loop-back. A frame is sent, heard or destroyed by whoever joins several chips, as a whole.

use std::collections::VecDeque;

use can::Frame;

use super::can_errors::{BOFF, ErrorCounts, REC, TEC};
use super::fields::{Field, field, whole};
use super::time::Ps;

const MCR: u32 = 0x00;
const MSR: u32 = 0x04;
const TSR: u32 = 0x08;
const RF0R: u32 = 0x0C;
const IER: u32 = 0x14;
const ESR: u32 = 0x18;
const BTR: u32 = 0x1C;
/// The first mailbox: identifier, length, data; the next follows.
const TI0R: u32 = 0x180;
const RI0R: u32 = 0x1B0;
const FMR: u32 = 0x200;
const FM1R: u32 = 0x204;
const FS1R: u32 = 0x20C;
const FFA1R: u32 = 0x214;
const FA1R: u32 = 0x21C;
const F0R1: u32 = 0x240;
const F0R2: u32 = 0x244;

const INRQ: u32 = 1 << 0;
const SLEEP: u32 = 1 << 1;
/// After a reset, with DBF.
const MCR_RESET: u32 = 0x0001_0002;
const INAK: u32 = 1 << 0;
const SLAK: u32 = 1 << 1;
/// RX and its last sample are recessive.
const RECESSIVE: u32 = 3 << 10;

/// Of the first mailbox; the next have theirs eight bits above.
const RQCP: u32 = 1 << 0;
const TXOK: u32 = 1 << 1;
const ABRQ: u32 = 1 << 7;
/// The next have theirs one bit above.
const TME: u32 = 1 << 26;

const FMP: u32 = 3;
const FULL: u32 = 1 << 3;
const FOVR: u32 = 1 << 4;
const RFOM: u32 = 1 << 5;

const TMEIE: u32 = 1 << 0;
const FMPIE0: u32 = 1 << 1;

/// Of an identifier's register.
const TXRQ: u32 = 1 << 0;
const RTR: u32 = 1 << 1;
const IDE: u32 = 1 << 2;
const STID: u32 = 0x7FF << 21;
const DLC: u32 = 15;

/// After a reset: 36 quanta and more, which nothing keeps.
const BTR_RESET: u32 = 0x0123_0000;
const BRP: u32 = 0x3FF;
const TS1: u32 = 15 << 16;
const TS2: u32 = 7 << 20;
const SJW: u32 = 3 << 24;

const FINIT: u32 = 1 << 0;
const FMR_RESET: u32 = 0x2A1C_0E01;

const MAILBOXES: usize = 3;
const DEPTH: usize = 3;

/// What is known of its registers: of mailboxes those of the first.
pub(super) fn fields() -> Vec<Field> {
    vec![
        field("MCR", MCR, "INRQ", INRQ),
        field("MCR", MCR, "SLEEP", SLEEP),
        field("MSR", MSR, "INAK", INAK),
        field("MSR", MSR, "SLAK", SLAK),
        field("TSR", TSR, "RQCP0", RQCP),
        field("TSR", TSR, "TXOK0", TXOK),
        field("TSR", TSR, "ABRQ0", ABRQ),
        field("TSR", TSR, "TME0", TME),
        field("RF0R", RF0R, "FMP0", FMP),
        field("RF0R", RF0R, "FULL0", FULL),
        field("RF0R", RF0R, "FOVR0", FOVR),
        field("RF0R", RF0R, "RFOM0", RFOM),
        field("IER", IER, "TMEIE", TMEIE),
        field("IER", IER, "FMPIE0", FMPIE0),
        field("ESR", ESR, "BOFF", BOFF),
        field("ESR", ESR, "TEC", TEC),
        field("ESR", ESR, "REC", REC),
        field("BTR", BTR, "BRP", BRP),
        field("BTR", BTR, "TS1", TS1),
        field("BTR", BTR, "TS2", TS2),
        field("BTR", BTR, "SJW", SJW),
        field("TI0R", TI0R, "TXRQ", TXRQ),
        field("TI0R", TI0R, "RTR", RTR),
        field("TI0R", TI0R, "IDE", IDE),
        field("TI0R", TI0R, "STID", STID),
        field("TDT0R", TI0R + 4, "DLC", DLC),
        whole("TDL0R", TI0R + 8),
        whole("TDH0R", TI0R + 12),
        field("RI0R", RI0R, "STID", STID),
        field("RDT0R", RI0R + 4, "DLC", DLC),
        whole("RDL0R", RI0R + 8),
        whole("RDH0R", RI0R + 12),
        field("FMR", FMR, "FINIT", FINIT),
        whole("FM1R", FM1R),
        whole("FS1R", FS1R),
        whole("FFA1R", FFA1R),
        whole("FA1R", FA1R),
        whole("F0R1", F0R1),
        whole("F0R2", F0R2),
    ]
}

/// A transmit mailbox: identifier, length, data, and what became of its last request.
#[derive(Debug, Clone, Copy, Default)]
struct Mailbox {
    words: [u32; 4],
    is_completed: bool,
    is_sent: bool,
    /// It is to be given up, and is on the bus as far as is known.
    is_aborted: bool,
}

impl Mailbox {
    const fn is_pending(&self) -> bool {
        self.words[0] & TXRQ != 0
    }

    fn frame(&self) -> Frame {
        let [id, length, low, high] = self.words;
        let [low, high] = [low, high].map(u32::to_le_bytes);
        let data = [low, high].concat();
        Frame::new((id >> 21) as u16, &data[..(length & DLC).min(8) as usize])
    }

    const fn complete(&mut self, is_sent: bool) {
        self.words[0] &= !TXRQ;
        (self.is_completed, self.is_sent) = (true, is_sent);
        self.is_aborted = false;
    }
}

/// What the bus brings, and when.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Arrival {
    /// A frame of another chip.
    Heard(Frame),
    /// A frame of this one has come through.
    Sent(Frame),
    /// One was destroyed, or `is_unheard`: no other has acknowledged it.
    Failed { frame: Frame, is_unheard: bool },
    /// One of another chip was destroyed.
    Missed,
    /// A frame of this one was not on the bus as it was to be withdrawn.
    Withdrawn(Frame),
    /// So often eleven recessive bits, for a chip that is off.
    Silent(u32),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Request {
    Send(Frame),
    /// Not to send it, unless it is on the bus.
    Withdraw(Frame),
    /// Not to send it again.
    Drop(Frame),
}

#[derive(Debug, Clone)]
pub(crate) struct BxCan {
    mcr: u32,
    ier: u32,
    btr: u32,
    errors: ErrorCounts,
    mailboxes: [Mailbox; MAILBOXES],
    received: VecDeque<Frame>,
    overrun: bool,
    filter_mode: u32,
    /// FM1R, FS1R, FFA1R, FA1R, F0R1, F0R2.
    filter: [u32; 6],
    arriving: VecDeque<(Ps, Arrival)>,
    requests: Vec<(Ps, Request)>,
}

impl Default for BxCan {
    fn default() -> Self {
        Self {
            mcr: MCR_RESET,
            ier: 0,
            btr: BTR_RESET,
            errors: ErrorCounts::default(),
            mailboxes: [Mailbox::default(); MAILBOXES],
            received: VecDeque::new(),
            overrun: false,
            filter_mode: FMR_RESET,
            filter: [0; 6],
            arriving: VecDeque::new(),
            requests: Vec::new(),
        }
    }
}

const fn transmit(offset: u32) -> Option<(usize, usize)> {
    let place = offset.wrapping_sub(TI0R) as usize / 4;
    if place < 4 * MAILBOXES {
        Some((place / 4, place % 4))
    } else {
        None
    }
}

const FILTERS: [u32; 6] = [FM1R, FS1R, FFA1R, FA1R, F0R1, F0R2];

impl BxCan {
    pub(super) fn reset(&mut self) {
        *self = Self::default();
    }

    pub(super) const fn is_on(&self) -> bool {
        self.mcr & (INRQ | SLEEP) == 0 && !self.errors.is_off
    }

    pub(crate) const fn errors(&self) -> ErrorCounts {
        self.errors
    }

    pub(crate) const fn has_overrun(&self) -> bool {
        self.overrun
    }

    pub(crate) fn pending(&self) -> Vec<Frame> {
        let pending = self.mailboxes.iter().filter(|one| one.is_pending());
        pending.map(Mailbox::frame).collect()
    }

    fn mailbox(&mut self, frame: Frame) -> Option<&mut Mailbox> {
        let mut all = self.mailboxes.iter_mut();
        all.find(|one| one.is_pending() && one.frame() == frame)
    }

    pub(super) const fn bit(&self, bus: Ps) -> Ps {
        let quanta = 3 + (self.btr >> 16 & 15) + (self.btr >> 20 & 7);
        bus * ((self.btr & BRP) + 1) as Ps * quanta as Ps
    }

    pub(super) fn expect(&mut self, at: Ps, what: Arrival) {
        self.arriving.push_back((at, what));
    }

    pub(super) fn next(&self) -> Option<Ps> {
        self.arriving.front().map(|(at, _)| *at)
    }

    pub(super) fn take_requests(&mut self) -> Vec<(Ps, Request)> {
        std::mem::take(&mut self.requests)
    }

    pub(super) fn advance(&mut self, now: Ps) {
        while let Some((_, what)) = self.arriving.pop_front_if(|(at, _)| *at <= now) {
            if let Arrival::Silent(times) = what
                && self.mcr & INRQ == 0
            {
                self.errors.silent(times);
            }
            if !self.is_on() {
                continue;
            }
            match what {
                Arrival::Heard(frame) => {
                    self.errors.heard();
                    self.receive(frame);
                }
                Arrival::Missed => self.errors.missed(),
                Arrival::Sent(frame) => {
                    self.errors.sent();
                    if let Some(one) = self.mailbox(frame) {
                        one.complete(true);
                    }
                }
                Arrival::Failed { frame, is_unheard } => {
                    self.errors.failed(is_unheard);
                    let is_off = self.errors.is_off;
                    for one in self.mailboxes.iter_mut().filter(|one| one.is_aborted) {
                        if is_off || one.frame() == frame {
                            one.complete(false);
                            let frame = one.frame();
                            self.requests.push((now, Request::Drop(frame)));
                        }
                    }
                }
                Arrival::Withdrawn(frame) => {
                    if let Some(one) = self.mailbox(frame) {
                        one.complete(false);
                    }
                }
                Arrival::Silent(_) => {}
            }
        }
    }

    fn receive(&mut self, frame: Frame) {
        if !self.accepts(&frame) {
            return;
        }
        if self.received.len() == DEPTH {
            // Not locked: the last is overwritten (RFLM).
            self.received.pop_back();
            self.overrun = true;
        }
        self.received.push_back(frame);
    }

    const fn accepts(&self, frame: &Frame) -> bool {
        let [_, _, _, active, id, mask] = self.filter;
        let is_active = self.filter_mode & FINIT == 0 && active & 1 != 0;
        is_active && ((frame.id() as u32) << 21 ^ id) & mask & (STID | IDE | RTR) == 0
    }

    pub(super) fn interrupts(&self) -> [bool; 2] {
        let sent = self.mailboxes.iter().any(|one| one.is_completed);
        [
            self.ier & FMPIE0 != 0 && !self.received.is_empty(),
            self.ier & TMEIE != 0 && sent,
        ]
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        let flag = |on: bool, bit: u32| if on { bit } else { 0 };
        Some(match offset {
            MCR => self.mcr,
            // It follows at once.
            MSR => {
                let initialises = self.mcr & INRQ != 0 && self.mcr & SLEEP == 0;
                flag(initialises, INAK) | flag(self.mcr & SLEEP != 0, SLAK) | RECESSIVE
            }
            TSR => (0..).zip(&self.mailboxes).fold(0, |status, (n, one)| {
                let of_request = flag(one.is_completed, RQCP) | flag(one.is_sent, TXOK);
                status | of_request << (8 * n) | flag(!one.is_pending(), TME << n)
            }),
            RF0R => {
                let count = self.received.len();
                count as u32 | flag(count == DEPTH, FULL) | flag(self.overrun, FOVR)
            }
            IER => self.ier,
            ESR => self.errors.status(),
            BTR => self.btr,
            FMR => self.filter_mode,
            _ if FILTERS.contains(&offset) => self.filter[place(offset)],
            _ => {
                if let Some((n, word)) = transmit(offset) {
                    return Some(self.mailboxes[n].words[word]);
                }
                let word = offset.wrapping_sub(RI0R) / 4;
                let frame = self.received.front().copied();
                let frame = frame.unwrap_or_else(|| Frame::new(0, &[]));
                let mut data = [0; 8];
                for (place, byte) in data.iter_mut().zip(frame.bytes()) {
                    *place = *byte;
                }
                let data = u64::from_le_bytes(data);
                match word {
                    0 => u32::from(frame.id()) << 21,
                    1 => frame.bytes().len() as u32,
                    2 => data as u32,
                    3 => (data >> 32) as u32,
                    _ => return None,
                }
            }
        })
    }

    /// Whether register and setting are modelled.
    pub(super) fn write(&mut self, offset: u32, value: u32, now: Ps) -> bool {
        match offset {
            MCR if value & !(INRQ | SLEEP) == 0 => {
                let was_starting = self.mcr & INRQ != 0;
                self.mcr = value;
                if was_starting && value & INRQ == 0 {
                    self.errors.restart();
                }
            }
            TSR => {
                let is_on = self.is_on();
                for (n, one) in (0..).zip(&mut self.mailboxes) {
                    let of_one = value >> (8 * n);
                    if of_one & RQCP != 0 {
                        (one.is_completed, one.is_sent) = (false, false);
                    }
                    // One that is on the bus is given up as it ends, unless it comes through.
                    if of_one & ABRQ != 0 && one.is_pending() && !one.is_aborted {
                        one.is_aborted = is_on;
                        if is_on {
                            self.requests.push((now, Request::Withdraw(one.frame())));
                        } else {
                            one.complete(false);
                        }
                    }
                }
            }
            RF0R => {
                if value & RFOM != 0 {
                    self.received.pop_front();
                }
                self.overrun &= value & FOVR == 0;
            }
            IER if value & !(TMEIE | FMPIE0) == 0 => self.ier = value,
            // Only while it initialises.
            BTR if self.mcr & INRQ != 0 => {
                if value & !(BRP | TS1 | TS2 | SJW) != 0 {
                    return false;
                }
                self.btr = value;
            }
            FMR => self.filter_mode = FMR_RESET & !FINIT | value & FINIT,
            _ if FILTERS.contains(&offset) => {
                // One filter of 32 bits with a mask, to the first FIFO.
                let modelled = match offset {
                    FM1R | FFA1R => 0,
                    FS1R | FA1R => 1,
                    _ => u32::MAX,
                };
                if value & !modelled != 0 {
                    return false;
                }
                self.filter[place(offset)] = value;
            }
            _ => {
                let Some((n, word)) = transmit(offset) else {
                    return false;
                };
                let one = &mut self.mailboxes[n];
                // Nothing is written into one that is pending.
                if one.is_pending() {
                    return false;
                }
                one.words[word] = value;
                if word == 0 && value & TXRQ != 0 {
                    if value & (RTR | IDE) != 0 {
                        return false;
                    }
                    (one.is_completed, one.is_sent) = (false, false);
                    self.requests.push((now, Request::Send(one.frame())));
                }
            }
        }
        true
    }
}

fn place(offset: u32) -> usize {
    let found = FILTERS.iter().position(|of| *of == offset);
    found.unwrap_or_default()
}
