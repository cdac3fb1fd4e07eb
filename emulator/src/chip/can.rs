//! A bxCAN with the wires of its transceiver (RM0390, chapter 30): initialisation, three transmit
//! mailboxes, one filter of 32 bits with a mask, and the first receive FIFO. What else it has is
//! not modelled: other filters, the second FIFO, interrupts of status and errors, time stamps,
//! loop-back. A frame is sent, heard or destroyed by whoever joins several chips, as a whole.

use std::collections::VecDeque;

use can::Frame;

use super::Ps;
use super::can_errors::{BOFF, ESR, ErrorCounts, REC, TEC};
use super::fields::{Field, field, whole};

const MCR: u32 = 0x00;
const MSR: u32 = 0x04;
const TSR: u32 = 0x08;
const RF0R: u32 = 0x0C;
const IER: u32 = 0x14;
const BTR: u32 = 0x1C;
/// The first mailbox: identifier, length, data; the next follows.
const TI0R: u32 = 0x180;
const RI0R: u32 = 0x1B0;
const FMR: u32 = 0x200;

const INRQ: Field = field("MCR", MCR, "INRQ", 1 << 0);
const SLEEP: Field = field("MCR", MCR, "SLEEP", 1 << 1);
/// After a reset, with DBF.
const MCR_RESET: u32 = 0x0001_0002;
const INAK: Field = field("MSR", MSR, "INAK", 1 << 0);
const SLAK: Field = field("MSR", MSR, "SLAK", 1 << 1);
/// RX and its last sample are recessive.
const RECESSIVE: u32 = 3 << 10;

/// Of the first mailbox; the next have theirs eight bits above.
const RQCP: Field = field("TSR", TSR, "RQCP0", 1 << 0);
const TXOK: Field = field("TSR", TSR, "TXOK0", 1 << 1);
const ABRQ: Field = field("TSR", TSR, "ABRQ0", 1 << 7);
/// The next have theirs one bit above.
const TME: Field = field("TSR", TSR, "TME0", 1 << 26);

const FMP: Field = field("RF0R", RF0R, "FMP0", 3);
const FULL: Field = field("RF0R", RF0R, "FULL0", 1 << 3);
const FOVR: Field = field("RF0R", RF0R, "FOVR0", 1 << 4);
const RFOM: Field = field("RF0R", RF0R, "RFOM0", 1 << 5);

const TMEIE: Field = field("IER", IER, "TMEIE", 1 << 0);
const FMPIE0: Field = field("IER", IER, "FMPIE0", 1 << 1);

const TXRQ: Field = field("TI0R", TI0R, "TXRQ", 1 << 0);
const RTR: Field = field("TI0R", TI0R, "RTR", 1 << 1);
const IDE: Field = field("TI0R", TI0R, "IDE", 1 << 2);
const STID: Field = field("TI0R", TI0R, "STID", 0x7FF << 21);
const DLC: Field = field("TDT0R", TI0R + 4, "DLC", 15);

/// After a reset: 36 quanta and more, which nothing keeps.
const BTR_RESET: u32 = 0x0123_0000;
const BRP: Field = field("BTR", BTR, "BRP", 0x3FF);
const TS1: Field = field("BTR", BTR, "TS1", 15 << 16);
const TS2: Field = field("BTR", BTR, "TS2", 7 << 20);
const SJW: Field = field("BTR", BTR, "SJW", 3 << 24);

const FINIT: Field = field("FMR", FMR, "FINIT", 1 << 0);
const FMR_RESET: u32 = 0x2A1C_0E01;

const MAILBOXES: usize = 3;
const DEPTH: usize = 3;

/// What is known of its registers: of mailboxes those of the first.
pub(super) fn fields() -> Vec<Field> {
    let mut fields = vec![
        INRQ, SLEEP, INAK, SLAK, RQCP, TXOK, ABRQ, TME, FMP, FULL, FOVR, RFOM, TMEIE, FMPIE0, BOFF,
        TEC, REC, BRP, TS1, TS2, SJW, TXRQ, RTR, IDE, STID, DLC,
    ];
    fields.extend([
        whole("TDL0R", TI0R + 8),
        whole("TDH0R", TI0R + 12),
        field("RI0R", RI0R, "STID", STID.bits),
        field("RDT0R", RI0R + 4, "DLC", DLC.bits),
        whole("RDL0R", RI0R + 8),
        whole("RDH0R", RI0R + 12),
        FINIT,
    ]);
    fields.extend(FILTERS.map(|(name, offset, _)| whole(name, offset)));
    fields
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
        TXRQ.is_in(self.words[0])
    }

    fn frame(&self) -> Frame {
        let [id, length, low, high] = self.words;
        let [low, high] = [low, high].map(u32::to_le_bytes);
        let data = [low, high].concat();
        let length = DLC.number_in(length).min(8) as usize;
        Frame::new((id >> 21) as u16, &data[..length])
    }

    const fn complete(&mut self, is_sent: bool) {
        self.words[0] &= !TXRQ.bits;
        (self.is_completed, self.is_sent) = (true, is_sent);
        self.is_aborted = false;
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Arrival {
    Heard(Frame),
    Sent(Frame),
    /// One was destroyed, or `is_unheard`: no other has acknowledged it.
    Failed {
        frame: Frame,
        is_unheard: bool,
    },
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

#[derive(Debug, Clone, Default)]
pub(crate) struct BxCan {
    mcr: u32,
    ier: u32,
    btr: u32,
    pub(crate) errors: ErrorCounts,
    mailboxes: [Mailbox; MAILBOXES],
    received: VecDeque<Frame>,
    pub(crate) overrun: bool,
    filter_mode: u32,
    /// Those of [`FILTERS`].
    filter: [u32; 6],
    arriving: VecDeque<(Ps, Arrival)>,
    requests: Vec<(Ps, Request)>,
}

fn transmit(offset: u32) -> Option<(usize, usize)> {
    let place = offset.checked_sub(TI0R)? as usize / 4;
    (place < 4 * MAILBOXES).then_some((place / 4, place % 4))
}

/// The registers of a filter, and the bits of each that may be set: it is one of 32 bits with a mask,
/// to the first FIFO.
const FILTERS: [(&str, u32, u32); 6] = [
    ("FM1R", 0x204, 0),
    ("FS1R", 0x20C, 1),
    ("FFA1R", 0x214, 0),
    ("FA1R", 0x21C, 1),
    ("F0R1", 0x240, u32::MAX),
    ("F0R2", 0x244, u32::MAX),
];

fn filter(offset: u32) -> Option<usize> {
    FILTERS.iter().position(|(_, at, _)| *at == offset)
}

impl BxCan {
    pub(super) fn new() -> Self {
        Self {
            mcr: MCR_RESET,
            btr: BTR_RESET,
            filter_mode: FMR_RESET,
            ..Self::default()
        }
    }

    pub(super) fn reset(&mut self) {
        *self = Self::new();
    }

    pub(super) const fn is_on(&self) -> bool {
        !INRQ.is_in(self.mcr) && !SLEEP.is_in(self.mcr) && !self.errors.is_off
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
        let quanta = 3 + TS1.number_in(self.btr) + TS2.number_in(self.btr);
        bus * (BRP.number_in(self.btr) + 1) as Ps * quanta as Ps
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
                && !INRQ.is_in(self.mcr)
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
        let is_active = !FINIT.is_in(self.filter_mode) && active & 1 != 0;
        is_active
            && ((frame.id() as u32) << 21 ^ id) & mask & (STID.bits | IDE.bits | RTR.bits) == 0
    }

    pub(super) fn interrupts(&self) -> [bool; 2] {
        let sent = self.mailboxes.iter().any(|one| one.is_completed);
        [
            FMPIE0.is_in(self.ier) && !self.received.is_empty(),
            TMEIE.is_in(self.ier) && sent,
        ]
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        Some(match offset {
            MCR => self.mcr,
            // It follows at once.
            MSR => {
                let sleeps = SLEEP.is_in(self.mcr);
                INAK.when(INRQ.is_in(self.mcr) && !sleeps) | SLAK.when(sleeps) | RECESSIVE
            }
            TSR => (0..).zip(&self.mailboxes).fold(0, |status, (n, one)| {
                let of_request = RQCP.when(one.is_completed) | TXOK.when(one.is_sent);
                status | of_request << (8 * n) | TME.when(!one.is_pending()) << n
            }),
            RF0R => {
                let count = self.received.len();
                count as u32 | FULL.when(count == DEPTH) | FOVR.when(self.overrun)
            }
            IER => self.ier,
            ESR => self.errors.status(),
            BTR => self.btr,
            FMR => self.filter_mode,
            _ => {
                if let Some(n) = filter(offset) {
                    return Some(self.filter[n]);
                }
                if let Some((n, word)) = transmit(offset) {
                    return Some(self.mailboxes[n].words[word]);
                }
                let word = offset.wrapping_sub(RI0R) / 4;
                let frame = self.received.front().copied();
                let frame = frame.unwrap_or_else(|| Frame::new(0, &[]));
                let bytes = frame.bytes().iter().rev();
                let data = bytes.fold(0, |data, byte| data << 8 | u64::from(*byte));
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
            MCR if value & !(INRQ.bits | SLEEP.bits) == 0 => {
                let was_starting = INRQ.is_in(self.mcr);
                self.mcr = value;
                if was_starting && !INRQ.is_in(value) {
                    self.errors.restart();
                }
            }
            TSR => {
                let is_on = self.is_on();
                for (n, one) in (0..).zip(&mut self.mailboxes) {
                    let of_one = value >> (8 * n);
                    if RQCP.is_in(of_one) {
                        (one.is_completed, one.is_sent) = (false, false);
                    }
                    // One that is on the bus is given up as it ends, unless it comes through.
                    if ABRQ.is_in(of_one) && one.is_pending() && !one.is_aborted {
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
                if RFOM.is_in(value) {
                    self.received.pop_front();
                }
                self.overrun &= !FOVR.is_in(value);
            }
            IER if value & !(TMEIE.bits | FMPIE0.bits) == 0 => self.ier = value,
            // Only while it initialises.
            BTR if INRQ.is_in(self.mcr) => {
                if value & !(BRP.bits | TS1.bits | TS2.bits | SJW.bits) != 0 {
                    return false;
                }
                self.btr = value;
            }
            FMR => self.filter_mode = FMR_RESET & !FINIT.bits | value & FINIT.bits,
            _ => {
                if let Some(n) = filter(offset) {
                    self.filter[n] = value;
                    return value & !FILTERS[n].2 == 0;
                }
                let Some((n, word)) = transmit(offset) else {
                    return false;
                };
                let one = &mut self.mailboxes[n];
                // Nothing is written into one that is pending.
                if one.is_pending() {
                    return false;
                }
                one.words[word] = value;
                if word == 0 && TXRQ.is_in(value) {
                    if RTR.is_in(value) || IDE.is_in(value) {
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
