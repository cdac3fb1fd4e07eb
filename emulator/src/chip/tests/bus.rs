//! The controller of a head's bus, as a driver sees it (RM0390, chapter 30).

use can::Frame;

use super::{Rig, US};
use crate::chip::{Arrival, Request};

const CAN: u32 = 0x4000_6400;
const MCR: u32 = CAN;
const MSR: u32 = CAN + 0x04;
const TSR: u32 = CAN + 0x08;
const RF0R: u32 = CAN + 0x0C;
const IER: u32 = CAN + 0x14;
const BTR: u32 = CAN + 0x1C;
const TI0R: u32 = CAN + 0x180;
const RI0R: u32 = CAN + 0x1B0;

/// A million bits a second of 36 MHz, as online calculators have it.
const BITS: u32 = 0x001E_0001;

fn on_bus() -> Rig {
    let mut rig = Rig::clocked();
    rig.write(MCR, 1);
    assert_eq!(rig.read(MSR) & 3, 1, "it initialises and does not sleep");
    rig.write(BTR, BITS);
    rig.write(CAN + 0x200, 1);
    rig.write(CAN + 0x20C, 1);
    rig.write(CAN + 0x244, 0b110);
    rig.write(CAN + 0x21C, 1);
    rig.write(CAN + 0x200, 0);
    rig.write(IER, 0b11);
    rig.write(MCR, 0);
    assert_eq!(rig.read(MSR) & 3, 0);
    rig
}

/// After a reset it sleeps, mailboxes are empty, and bits cannot be set (RM0390, register map).
#[test]
fn it_starts_as_the_manual_says() {
    let mut rig = Rig::clocked();
    assert_eq!(rig.read(MCR), 0x0001_0002);
    assert_eq!(rig.read(MSR), 0x0000_0C02);
    assert_eq!(rig.read(TSR), 0x1C00_0000);
    assert_eq!(rig.read(BTR), 0x0123_0000);
    assert!(rig.try_write(BTR, BITS).is_err());
}

#[test]
fn a_request_that_is_aborted_was_not_sent() {
    let mut rig = on_bus();
    rig.write(TI0R, 0x123 << 21 | 1);
    rig.write(TSR, 1 << 7);
    let asked = rig.chip.can.take_requests();
    assert!(matches!(asked[..], [_, (_, Request::Withdraw(_))]));
    assert_eq!(rig.read(TSR), 0x1C00_0001, "completed, but not sent");
}

/// Three frames wait, the first is at hand; of a fourth the last is overwritten.
#[test]
fn frames_queue_up_and_the_last_is_overwritten() {
    let mut rig = on_bus();
    for n in 0..4_u8 {
        let frame = Frame::new(0x100 + u16::from(n), &[n; 8]);
        rig.chip.can.expect(US, Arrival::Heard(frame));
    }
    rig.chip.can.advance(US);
    assert_eq!(rig.chip.can.interrupts(), [true, false]);
    assert_eq!(rig.read(RF0R), 3 | 1 << 3 | 1 << 4, "full, and overrun");
    let mut found = Vec::new();
    while rig.read(RF0R) & 3 > 0 {
        assert_eq!(rig.read(RI0R + 4), 8);
        let id = rig.read(RI0R) >> 21;
        assert_eq!(rig.read(RI0R + 8), (id - 0x100) * 0x0101_0101);
        found.push(id);
        rig.write(RF0R, 1 << 5);
    }
    assert_eq!(found, [0x100, 0x101, 0x103]);
    assert_eq!(rig.chip.can.interrupts(), [false, false]);
}
