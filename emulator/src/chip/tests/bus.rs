//! The controller of a head's bus, as a driver sees it (RM0390, chapter 30).

use can::Frame;

use super::{Rig, US};
use crate::chip::{Arrival, Request};

const CAN: u32 = 0x4000_6400;
const MCR: u32 = CAN;
const MSR: u32 = CAN + 0x04;
const TSR: u32 = CAN + 0x08;
const RF0R: u32 = CAN + 0x0C;
const ESR: u32 = CAN + 0x18;
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

/// What is aborted before it is on the bus, or fails there, was not sent; what comes through all the
/// same was (RM0390, 30.7.1).
#[test]
fn a_request_that_is_aborted_was_sent_if_it_came_through() {
    let frame = Frame::new(0x123, &[]);
    let failed = Arrival::Failed {
        frame,
        is_unheard: false,
    };
    for (then, status) in [
        (Arrival::Withdrawn(frame), 0x1C00_0001),
        (failed, 0x1C00_0001),
        (Arrival::Sent(frame), 0x1C00_0003),
    ] {
        let mut rig = on_bus();
        rig.write(TI0R, 0x123 << 21 | 1);
        rig.write(TSR, 1 << 7);
        let asked = rig.chip.can.take_requests();
        assert!(matches!(asked[..], [_, (_, Request::Withdraw(_))]));
        assert_eq!(rig.read(TSR), 0x1800_0000, "pending");
        rig.chip.can.expect(US, then);
        rig.chip.can.advance(US);
        assert_eq!(rig.read(TSR), status, "{then:?}");
    }
}

/// Off the bus it hears nothing, and what is aborted is so at once; it is back after 128 silences once the
/// program has set and cleared INRQ.
#[test]
fn errors_switch_it_off_until_the_program_lets_it_back() {
    let mut rig = on_bus();
    let frame = Frame::new(0x123, &[]);
    rig.write(TI0R, 0x123 << 21 | 1);
    let failed = Arrival::Failed {
        frame,
        is_unheard: false,
    };
    (0..32).for_each(|_| rig.chip.can.expect(US, failed));
    rig.chip.can.expect(US, Arrival::Heard(frame));
    rig.chip.can.expect(US, Arrival::Silent(200));
    rig.chip.can.advance(US);
    assert_eq!((rig.read(ESR) & 7, rig.read(RF0R)), (7, 0));
    rig.write(TSR, 1 << 7);
    assert_eq!(rig.read(TSR), 0x1C00_0001);
    for inrq in [1, 0] {
        rig.write(MCR, inrq);
        assert_eq!(rig.read(ESR) & 4, 4);
    }
    for (silences, is_off) in [(127, 4), (1, 0)] {
        rig.chip.can.expect(2 * US, Arrival::Silent(silences));
        rig.chip.can.advance(2 * US);
        assert_eq!(rig.read(ESR) & 4, is_off);
    }
    assert_eq!(rig.read(ESR), 0, "it counts from zero again");
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
