//! A sensor frame by SPI, byte timer and DMA, on either side.

use super::side::{ANSWERS, BYTE, LEFT, RIGHT, Registers, SIDES, SLOT};
use super::{GPIOA, GPIOB, MS, RCC, Rig, US, why};
use crate::chip::{Fault, Needs};

#[test]
fn eight_bytes_reach_memory_without_the_core() {
    for on in SIDES {
        let mut rig = on.rig(on.divider);
        let (rx, tx) = (on.ended(0), on.ended(1));
        on.begin(&mut rig, SLOT);
        rig.pass(SLOT - 1);
        let latched = |rig: &Rig| rig.sensors[on.side].latched;
        assert_eq!(latched(&rig), 0, "the sensor latches with the first clock");
        rig.pass(1);
        assert_eq!(latched(&rig), 1);
        rig.pass(7 * SLOT + BYTE - 1);
        assert!(!on.is_done(&rig));
        rig.pass(1);
        assert!(on.is_done(&rig));
        assert_eq!(rig.sensors[on.side].heard, [0xFF; 8]);
        assert!(rig.sensors[1 - on.side].heard.is_empty());
        assert_eq!(on.received(&rig), ANSWERS);
        assert_eq!(latched(&rig), 1, "once a frame");
        assert_eq!(rig.sensors[on.side].polled, 0);
        let both = rx | tx;
        assert_eq!(rig.read(on.dma) & both, both, "TCIF of both streams");
        let enabled = rig.read(on.stream(0)) & 1;
        assert_eq!(enabled, 0, "the stream has switched itself off");
        rig.write(on.dma + 8, rx);
        assert!(!on.is_done(&rig));
        assert_eq!(rig.read(on.dma) & both, tx);
    }
}

#[test]
fn a_byte_that_nobody_fetches_is_overrun_by_the_next() {
    for on in SIDES {
        let spi = on.spi;
        let mut rig = on.rig(on.divider);
        on.begin(&mut rig, SLOT);
        rig.write(spi + 4, 0);
        rig.pass(SLOT + BYTE);
        assert_eq!(rig.read(spi + 8), 3, "RXNE and TXE");
        rig.pass(SLOT);
        assert_eq!(rig.read(spi + 8) & 0x40, 0x40, "OVR");
        let byte = rig.read(spi + 0x0C);
        assert_eq!(byte, 0xFF, "the first stays, the second is lost");
        let _ = rig.read(spi + 8);
        assert_eq!(rig.read(spi + 8) & 0x41, 0, "DR, then SR: cleared");
    }
}

#[test]
fn bytes_that_come_too_close_or_too_fast_or_too_early_are_told() {
    for on in SIDES {
        let name = ["left", "right"][on.side];
        let is_reported = |fault, why: &str| {
            let wires = matches!(fault, Err(Fault::Wires { side, .. }) if side == name);
            assert!(wires, "{name}, {why}: {fault:?}");
        };
        let mut close = on.rig(on.divider);
        on.begin(&mut close, 30 * US);
        is_reported(close.try_pass(MS), "a gap of 4.4 us");
        let mut fast = on.rig(on.divider - 1);
        on.begin(&mut fast, SLOT);
        is_reported(fast.try_pass(MS), "625 kHz");
        let mut early = on.rig_after(MS, on.divider);
        on.begin(&mut early, SLOT);
        is_reported(early.try_pass(MS), "start-up");
    }
}

/// With a halved clock, by which the byte timer counts half as fast, too.
#[test]
fn a_slow_sensor_asks_for_more() {
    let begun = |divider, slot| {
        let mut rig = RIGHT.rig(divider);
        rig.write(RCC + 0x08, 2 | 5 << 10 | 4 << 13 | 8 << 4);
        rig.chip.lines[RIGHT.side].needs = Needs::SLOW;
        RIGHT.begin(&mut rig, slot / 2);
        rig.try_pass(MS).map(drop)
    };
    let slow = RIGHT.divider + 1;
    assert_eq!(why(begun(RIGHT.divider, 153 * US)), "the clock is too fast");
    assert_eq!(why(begun(slow, 49 * US)), "a byte too soon after /SS low");
    let close = why(begun(slow, 152 * US));
    assert_eq!(close, "the gap between two bytes is too short");
    assert!(begun(slow, 153 * US).is_ok());
}

/// Neither eight bytes that are no frame, as these answers are none, nor a part of one.
#[test]
fn after_a_bad_frame_the_sensor_asks_for_its_rest() {
    for on in SIDES {
        for bytes in [8, 3] {
            let again_after = |rest| {
                let mut rig = on.rig(on.divider);
                on.begin(&mut rig, SLOT);
                rig.pass(bytes * SLOT + BYTE);
                on.raise_select(&mut rig);
                rig.write(on.timer, 0);
                rig.write(on.stream(0), 0);
                rig.write(on.stream(1), 0);
                rig.write(on.dma + 8, u32::MAX);
                rig.pass(rest);
                on.begin(&mut rig, SLOT);
                rig.try_pass(MS)
            };
            let soon = why(again_after(MS * 3 / 2 - US));
            assert!(soon.contains("too soon"), "{bytes} bytes: {soon}");
            assert!(again_after(MS * 3 / 2).is_ok(), "{bytes} bytes");
        }
    }
}

/// One that is not selected, that is spoken to in another mode, whose lines another peripheral has,
/// or none, and whose open drain a line is driven high against: the chip itself does not see it.
#[test]
fn a_sensor_that_is_not_reached_is_silent() {
    for on in SIDES {
        let (port, functions) = [(GPIOA, 0x20), (GPIOB, 0x24)][on.side];
        let received = |change: &dyn Fn(&mut Rig)| {
            let mut rig = on.rig(on.divider);
            on.begin(&mut rig, SLOT);
            change(&mut rig);
            rig.pass(MS);
            assert!(on.is_done(&rig));
            (on.received(&rig), rig.sensors[on.side].latched)
        };
        let unselected = received(&|rig| on.raise_select(rig));
        assert_eq!(unselected, ([0xFF; 8], 0));
        let (misspoken, _) = received(&|rig| on.set_up_spi(rig, 3, on.divider));
        assert_eq!(misspoken, [0xFF; 8], "wrong mode");
        for (why, address, value) in [
            ("push-pull", port + 0x04, 0),
            ("SCK's function", port + functions, 0x5560_0000),
            ("MISO's function", port + functions, 0x5060_0000),
            ("MOSI's function", port + functions, 0x0550_0000),
        ] {
            let (found, _) = received(&|rig| rig.write(address, value));
            assert_eq!(found, [0xFF; 8], "{why}");
        }
    }
}

#[test]
fn a_stream_that_listens_to_another_request_moves_nothing() {
    for on in SIDES {
        let wrong = Registers {
            channels: [on.channels[0], on.channels[1] - 1],
            ..on
        };
        let mut rig = wrong.rig(wrong.divider);
        wrong.begin(&mut rig, SLOT);
        rig.pass(MS);
        assert!(!wrong.is_done(&rig));
        assert!(rig.sensors[wrong.side].heard.is_empty());
    }
}

#[test]
fn dma1_reaches_no_peripheral_beyond_apb1() {
    let mut rig = RIGHT.rig(RIGHT.divider);
    RIGHT.begin(&mut rig, SLOT);
    let tx = RIGHT.stream(1);
    rig.write(tx, 0);
    rig.write(tx + 0x08, LEFT.spi + 0x0C);
    rig.write(tx + 0x04, 8);
    rig.write(tx, 7 << 25 | 1 << 6 | 1);
    let fault = rig.try_pass(MS);
    assert!(matches!(fault, Err(Fault::Misused { .. })), "{fault:?}");
}

#[test]
fn a_reset_of_the_spi_ends_the_byte_on_its_way() {
    for on in SIDES {
        let mut rig = on.rig(on.divider);
        on.begin(&mut rig, SLOT);
        rig.pass(SLOT + BYTE / 2);
        assert_eq!(rig.read(on.spi + 8) & 0x80, 0x80, "BSY");
        let (register, bit) = on.reset;
        rig.write(register, bit);
        rig.write(register, 0);
        assert_eq!(rig.read(on.spi + 8), 2, "TXE alone");
        assert_eq!(rig.read(on.spi), 0);
    }
}
