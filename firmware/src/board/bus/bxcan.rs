//! The CAN controller bxCAN (RM0390, chapter 30; RM0008, chapter 24).
//!
//! It has three mailboxes for frames to be sent, of which the lowest identifier goes first, and a
//! queue of three that have come, which lasts for 150 µs or more. What waits for a mailbox does so
//! here, in the same order.

use can::{Frame, Letter};
use firmware::boards::CanTiming;
use heapless::Vec;
use stm32_metapac::can::vals::{Ide, Rtr};
use stm32_metapac::can::{Can, regs};

use crate::board::gpio::{Pin, PinName};
use crate::board::pin_config::{Mode, PinConfig};
use crate::here::{BUS, BUS_FUNCTION, clock_bus};

const BOXES: usize = 3;

/// Most frames that wait: more than a tick says, of as many classes as a model can have.
const MOST_WAITING: usize = 16;

/// For how long a frame waits before it is given up, ms: whoever hears it later has no use for it.
const LATE_MS: u32 = 4;

/// After so long a controller that errors have switched off is let onto the bus again, ms.
const OFF_MS: u32 = 100;

pub(super) struct Controller {
    /// What each mailbox has, and for how many ticks it has waited in all.
    boxes: [Option<(Frame, u32)>; BOXES],
    waiting: Vec<(Frame, u32), MOST_WAITING>,
    off: u32,
}

const CAN: Can = BUS;

/// RX and TX.
const PINS: [PinName; 2] = [PinName::new('A', 11), PinName::new('A', 12)];

/// Bits of the first mailbox: its request is completed, its frame was sent, it is given up. Those
/// of the next are eight higher. No panic stands in them, as in the functions that count mailboxes.
const RQCP: u32 = 1 << 0;
const TXOK: u32 = 1 << 1;
const ABRQ: u32 = 1 << 7;

const EMPTY: u32 = 0b111 << 26;

/// Acknowledges what no node waits for.
pub(super) fn ignore() {
    while take().is_some() {}
    let all = (0..BOXES).fold(0, |all, n| all | RQCP << (8 * n));
    CAN.tsr().write_value(regs::Tsr(all));
}

impl Controller {
    /// Sends and receives from now on, as soon as the bus has been silent for eleven bits.
    pub(super) fn start(timing: CanTiming) -> Self {
        let [rx, tx] = PINS;
        clock_bus();
        Pin::new(
            rx,
            PinConfig::new(Mode::AlternateInput(BUS_FUNCTION)).pulled_up(),
        );
        Pin::new(
            tx,
            PinConfig::new(Mode::AlternateOutput(BUS_FUNCTION)).fast(),
        );
        CAN.mcr().write(|w| {
            w.set_inrq(true);
            // Frames are sent again by the controller, and it comes back from errors by itself
            // only as far as `tick` lets it.
            w.set_nart(false);
            w.set_abom(false);
        });
        // It acknowledges as soon as a frame is over that is under way.
        let _ = crate::board::reset::comes(|| CAN.msr().read().inak());
        CAN.btr().write(|w| {
            w.set_brp(timing.prescaler.wrapping_sub(1));
            w.set_ts(0, timing.before.wrapping_sub(1));
            w.set_ts(1, timing.after.wrapping_sub(1));
            w.set_sjw(timing.after.min(4).wrapping_sub(1));
        });
        accept_data();
        CAN.ier().write(|w| {
            w.set_tmeie(true);
            w.set_fmpie(0, true);
        });
        CAN.mcr().modify(|w| w.set_inrq(false));
        Self {
            boxes: [None; BOXES],
            waiting: Vec::new(),
            off: 0,
        }
    }

    /// One for which there is no room is dropped: it would come too late.
    pub(super) fn say(&mut self, frame: Frame) {
        let _ = self.waiting.push((frame, 0));
        self.fill();
    }

    pub(super) fn tick(&mut self, tick_hz: u32) {
        let late = LATE_MS * tick_hz / 1_000;
        for (n, one) in self.boxes.iter_mut().enumerate() {
            if let Some((_, ticks)) = one {
                *ticks = ticks.saturating_add(1);
                if *ticks > late {
                    CAN.tsr().write_value(regs::Tsr(ABRQ << (8 * n)));
                }
            }
        }
        // While the bus carries nothing they would keep out what is said later.
        self.waiting.retain_mut(|(_, ticks)| {
            *ticks = ticks.saturating_add(1);
            *ticks <= late
        });
        let wait = OFF_MS * tick_hz / 1_000;
        if self.off < wait && !CAN.esr().read().boff() {
            self.off = 0;
            return;
        }
        self.off += 1;
        // It recovers once it has gone into its start, which it acknowledges, and out of it again,
        // and the bus has been silent for 128 times eleven bits.
        if self.off == wait {
            CAN.mcr().modify(|w| w.set_inrq(true));
        } else if self.off > wait && CAN.msr().read().inak() {
            self.off = 0;
            CAN.mcr().modify(|w| w.set_inrq(false));
        }
    }

    /// Takes what was sent, or given up, out of the mailboxes, and fills them again.
    pub(super) fn go_on(&mut self, said: &mut impl FnMut(&Frame)) {
        let status = CAN.tsr().read().0;
        for (n, one) in self.boxes.iter_mut().enumerate() {
            let of_box = status >> (8 * n);
            if of_box & RQCP == 0 {
                continue;
            }
            CAN.tsr().write_value(regs::Tsr(RQCP << (8 * n)));
            if let Some((frame, _)) = one.take()
                && of_box & TXOK != 0
            {
                said(&frame);
            }
        }
        self.fill();
    }

    /// Of frames with one identifier one is in a mailbox at a time, lest they pass each other.
    fn fill(&mut self) {
        for n in 0..BOXES {
            if self.boxes.get(n).is_none_or(Option::is_some) {
                continue;
            }
            let is_under_way = |frame: &Frame| {
                let mut boxes = self.boxes.iter().flatten();
                boxes.any(|(other, _)| other.id() == frame.id())
            };
            let waiting = self.waiting.iter().enumerate();
            let waiting = waiting.filter(|(_, (frame, _))| !is_under_way(frame));
            let first = waiting.min_by_key(|(_, (frame, _))| frame.id());
            let Some((first, (frame, ticks))) = first.map(|(first, one)| (first, *one)) else {
                return;
            };
            let mut place = 0;
            self.waiting.retain(|_| {
                place += 1;
                place != first + 1
            });
            load(n, &frame);
            if let Some(place) = self.boxes.get_mut(n) {
                *place = Some((frame, ticks));
            }
        }
    }
}

pub(super) fn take() -> Option<Frame> {
    let queue = CAN.rfr(0).read();
    // The place of the last is being freed: the interrupt comes again for the next.
    if queue.fmp() == 0 || queue.rfom() {
        return None;
    }
    let received = CAN.rx(0);
    let id = received.rir().read().stid();
    let length = received.rdtr().read().dlc();
    let [low, high] = [received.rdlr().read().0, received.rdhr().read().0];
    let words = u64::from(high) << 32 | u64::from(low);
    let bytes = words.to_le_bytes();
    // Frees its place.
    CAN.rfr(0).write(|w| w.set_rfom(true));
    let data = bytes.get(..usize::from(length)).unwrap_or(&bytes);
    Some(Frame::new(id, data))
}
fn accept_data() {
    accept([0, 0]);
}

/// Lets none but requests of other boards in, which then are not lost behind what nobody reads.
pub(super) fn accept_requests() {
    accept(Letter::REQUESTS);
}

fn accept([id, mask]: [u16; 2]) {
    CAN.fmr().modify(|w| w.set_finit(true));
    // One of 32 bits, with a mask: bits IDE and RTR of it must be zero.
    CAN.fm1r().write(|w| w.set_fbm(0, false));
    CAN.fs1r().write(|w| w.set_fsc(0, true));
    CAN.ffa1r().write(|w| w.set_ffa(0, false));
    let id = u32::from(id) << STID_AT;
    let mask = u32::from(mask) << STID_AT | IDE_AND_RTR;
    CAN.fb(0).fr1().write_value(regs::Fr1(id));
    CAN.fb(0).fr2().write_value(regs::Fr2(mask));
    CAN.fa1r().write(|w| w.set_fact(0, true));
    CAN.fmr().modify(|w| w.set_finit(false));
}

const IDE_AND_RTR: u32 = 0b110;
const STID_AT: u32 = 21;

/// Has up to three frames go where no tick does, in place of what is in the mailboxes.
pub(super) fn say_alone(frames: &[Frame]) {
    let all = (0..BOXES).fold(0, |all, n| all | ABRQ << (8 * n));
    CAN.tsr().write_value(regs::Tsr(all));
    if crate::board::reset::comes(has_sent) {
        // The first has the lowest identifier, and goes first.
        for (n, frame) in frames.iter().enumerate() {
            load(n, frame);
        }
    }
}

pub(super) fn has_sent() -> bool {
    CAN.tsr().read().0 & EMPTY == EMPTY
}

/// The mailbox must be empty.
fn load(n: usize, frame: &Frame) {
    let mailbox = CAN.tx(n % BOXES);
    let mut bytes = [0; 8];
    for (place, byte) in bytes.iter_mut().zip(frame.bytes()) {
        *place = *byte;
    }
    let words = u64::from_le_bytes(bytes);
    mailbox
        .tdtr()
        .write(|w| w.set_dlc(frame.bytes().len() as u8));
    mailbox.tdlr().write_value(regs::Tdlr(words as u32));
    mailbox.tdhr().write_value(regs::Tdhr((words >> 32) as u32));
    mailbox.tir().write(|w| {
        w.set_stid(frame.id());
        w.set_ide(Ide::STANDARD);
        w.set_rtr(Rtr::DATA);
        w.set_txrq(true);
    });
}
