//! The serial port by USART2 and DMA1, as a driver for the STM32F446 sees it. What the ports of the
//! other chips differ in is where registers stand, which `cargo xtask descriptions` checks.

use super::Rig;
use crate::chip::{Fault, Ps};
use crate::memory::RAM;

const USART2: u32 = 0x4000_4400;
const DR: u32 = USART2 + 0x04;
const BRR: u32 = USART2 + 0x08;
const CR1: u32 = USART2 + 0x0C;
const CR3: u32 = USART2 + 0x14;
/// Its streams for reception and transmission.
const RX: u32 = 0x4002_6000 + 0x10 + 0x18 * 5;
const TX: u32 = 0x4002_6000 + 0x10 + 0x18 * 6;
/// Modes of the pins of port A: PA2 and PA3 are the port's.
const PINS: (u32, u32) = (0x4002_0000, 0xA800_00A0);
const ON: u32 = 0x200C;

/// 115200 baud, by which 40 MHz are divided so.
const BAUD: u32 = 115_200;
const DIVIDER: u32 = 347;
const BYTE: Ps = 10 * (1_000_000_000_000 / BAUD as Ps);

/// Open, with a divider, somebody at the other end, and a ring of eight bytes that is filled from
/// where RAM begins.
fn open(divider: u32) -> Rig {
    let mut rig = Rig::clocked();
    rig.run_fast();
    for (address, value) in [
        (0x4002_0020, 0x7700),
        PINS,
        (BRR, divider),
        (CR3, 0xC0),
        (CR1, ON),
        (RX + 8, DR),
        (RX + 12, RAM),
        (RX + 4, 8),
        // To successive bytes, round and round.
        (RX, 4 << 25 | 1 << 10 | 1 << 8 | 1),
    ] {
        rig.write(address, value);
    }
    rig.chip.attach_serial(Some(BAUD));
    rig
}

fn send(rig: &mut Rig, from: u32, bytes: u32) {
    rig.write(TX + 8, DR);
    rig.write(TX + 12, from);
    rig.write(TX + 4, bytes);
    rig.write(TX, 4 << 25 | 1 << 10 | 1 << 6 | 1);
}

#[test]
fn bytes_come_round_a_ring_and_leave_by_dma() {
    let mut rig = open(DIVIDER);
    rig.chip.now = rig.now;
    rig.chip.serial_write(b"0123456789");
    rig.pass(BYTE - 1);
    assert_eq!(rig.ram(0), [0], "before its last bit");
    rig.pass(1);
    assert_eq!(rig.ram(0), *b"0");
    rig.pass(9 * BYTE);
    assert_eq!(rig.ram(0), *b"89234567");
    assert_eq!(rig.read(RX + 4), 6, "two of the ring's next turn");
    send(&mut rig, RAM + 2, 6);
    rig.pass(6 * BYTE + BYTE / 10);
    assert_eq!(rig.chip.serial_read(), b"234567");
    assert!(rig.chip.serial_read().is_empty());
}

#[test]
fn bits_of_another_length_are_told() {
    let off = DIVIDER / 50;
    let is_misused = |fault: Result<_, Fault>, divider| {
        let Err(Fault::Misused { peripheral, .. }) = fault else {
            panic!("{divider}: {fault:?}");
        };
        assert_eq!(peripheral, "USART2");
    };
    for divider in [DIVIDER - off, DIVIDER + off, 2 * DIVIDER] {
        let mut sends = open(divider);
        send(&mut sends, RAM, 1);
        is_misused(sends.try_pass(3 * BYTE), divider);
        let mut hears = open(divider);
        hears.chip.serial_write(b"a");
        is_misused(hears.try_pass(3 * BYTE), divider);
    }
    // By a thousandth it may be off.
    let mut near = open(DIVIDER);
    near.chip.serial_write(b"a");
    assert!(near.try_pass(3 * BYTE).is_ok());
}

#[test]
fn pins_of_another_peripheral_carry_nothing() {
    let mut rig = open(DIVIDER);
    // As the pins are after a reset: PA2 an input, PA3 disconnected.
    rig.write(PINS.0, 0xA800_00C0);
    rig.chip.serial_write(b"a");
    send(&mut rig, RAM, 1);
    rig.pass(3 * BYTE);
    assert!(rig.chip.serial_read().is_empty());
    assert_eq!(rig.ram(0), [0]);
}

#[test]
fn a_format_that_is_not_modelled_is_told() {
    let mut rig = open(DIVIDER);
    for (register, value) in [
        (CR1, ON | 1 << 10),
        (CR1, ON | 1 << 12),
        (CR3, 1),
        (BRR, 15),
    ] {
        let written = rig.try_write(register, value);
        let is_refused = matches!(written, Err(Fault::Unmodelled { .. }));
        assert!(is_refused, "{register:#x}: {written:?}");
    }
}
