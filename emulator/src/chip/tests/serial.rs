//! The serial port by USART2 and DMA, on every chip.

use super::{RAM, RCC, Rig, SMALL_RCC};
use crate::chip::models::{F103, F446, G071};
use crate::chip::{Fault, Model, Ps};

const USART2: u32 = 0x4000_4400;
const DMA1: u32 = 0x4002_6000;
const SMALL_DMA: u32 = 0x4002_0000;
const DMAMUX: u32 = 0x4002_0800;

/// 115200 baud.
const BAUD: u32 = 115_200;
const BYTE: Ps = 10 * (1_000_000_000_000 / BAUD as Ps);

/// A chip, and what a driver for it writes.
struct Port {
    model: &'static Model,
    /// What divides the clock of the bus: 40, 36 and 64 MHz.
    divider: u32,
    /// The gates of port A, DMA1 and USART2, and the pins' function.
    set_up: &'static [(u32, u32)],
    /// BRR, CR3, CR1 and what switches both ways on.
    registers: [(u32, u32); 2],
    brr: u32,
}

const F1: Port = Port {
    model: &F103,
    divider: 313,
    set_up: &[
        (SMALL_RCC + 0x18, 1 << 2 | 1),
        (SMALL_RCC + 0x14, 1),
        (SMALL_RCC + 0x1C, 1 << 17),
        // PA2 by its peripheral, PA3 an input.
        (0x4001_0800, 0x4444_4A44),
    ],
    registers: [(0x14, 0xC0), (0x0C, 0x200C)],
    brr: 0x08,
};

const F4: Port = Port {
    model: &F446,
    divider: 347,
    set_up: &[
        (RCC + 0x30, 1 << 21 | 1),
        (RCC + 0x40, 1 << 17),
        (0x4002_0020, 0x7700),
        (0x4002_0000, 0xA800_00A0),
    ],
    registers: [(0x14, 0xC0), (0x0C, 0x200C)],
    brr: 0x08,
};

const G0: Port = Port {
    model: &G071,
    divider: 556,
    set_up: &[
        (SMALL_RCC + 0x34, 1),
        (SMALL_RCC + 0x38, 1),
        (SMALL_RCC + 0x3C, 1 << 17),
        (0x5000_0020, 0x1100),
        (0x5000_0000, 0xEBFF_FFAF),
        (DMAMUX + 8, 52),
        (DMAMUX + 12, 53),
    ],
    registers: [(0x08, 0xC0), (0x00, 0x000D)],
    brr: 0x0C,
};

impl Port {
    /// Open, with a divider, somebody at the other end, and a ring of eight bytes that is
    /// filled from where RAM begins.
    fn open(&self, divider: u32) -> Rig {
        let mut rig = Rig::of(self.model);
        rig.run_fast();
        for &(address, value) in self.set_up {
            rig.write(address, value);
        }
        rig.write(USART2 + self.brr, divider);
        for (offset, value) in self.registers {
            rig.write(USART2 + offset, value);
        }
        let [peripheral, memory, count, control] = self.rx();
        rig.write(peripheral, USART2 + self.data(0));
        rig.write(memory, RAM);
        rig.write(count, 8);
        // To successive bytes, round and round.
        let circular = if self.is_streams() {
            4 << 25 | 1 << 10 | 1 << 8 | 1
        } else {
            1 << 7 | 1 << 5 | 1
        };
        rig.write(control, circular);
        rig.chip.attach_serial(BAUD);
        rig
    }

    fn is_streams(&self) -> bool {
        self.model.program == "nucleo_f446re"
    }

    fn data(&self, sent: u32) -> u32 {
        if self.model.program == "nucleo_g071rb" {
            0x24 + 4 * sent
        } else {
            4
        }
    }

    fn dma(&self, stream: u32, channel: u32) -> [u32; 4] {
        if self.is_streams() {
            let at = DMA1 + 0x10 + 0x18 * stream;
            [at + 8, at + 12, at + 4, at]
        } else {
            let at = SMALL_DMA + 8 + 0x14 * channel;
            [at + 8, at + 12, at + 4, at]
        }
    }

    fn rx(&self) -> [u32; 4] {
        self.dma(5, if self.model.has_mux { 2 } else { 5 })
    }

    fn tx(&self) -> [u32; 4] {
        self.dma(6, if self.model.has_mux { 3 } else { 6 })
    }

    fn send(&self, rig: &mut Rig, from: u32, bytes: u32) {
        let [peripheral, memory, count, control] = self.tx();
        rig.write(peripheral, USART2 + self.data(1));
        rig.write(memory, from);
        rig.write(count, bytes);
        let out = if self.is_streams() {
            4 << 25 | 1 << 10 | 1 << 6 | 1
        } else {
            1 << 7 | 1 << 4 | 1
        };
        rig.write(control, out);
    }
}

#[test]
fn bytes_come_round_a_ring_and_leave_by_dma() {
    for port in [F1, F4, G0] {
        let name = port.model.program;
        let mut rig = port.open(port.divider);
        rig.chip.now = rig.now;
        rig.chip.serial_write(b"0123456789");
        rig.pass(BYTE - 1);
        assert_eq!(rig.ram.0.borrow()[0], 0, "{name}: before its last bit");
        rig.pass(1);
        assert_eq!(rig.ram.0.borrow()[0], b'0', "{name}");
        rig.pass(9 * BYTE);
        assert_eq!(rig.ram.0.borrow()[..8], *b"89234567", "{name}");
        assert_eq!(
            rig.read(port.rx()[2]),
            6,
            "{name}: two of the ring's next turn"
        );

        port.send(&mut rig, RAM + 2, 6);
        rig.pass(6 * BYTE + BYTE / 10);
        assert_eq!(rig.chip.serial_read(), b"234567", "{name}");
        assert!(rig.chip.serial_read().is_empty());
    }
}

#[test]
fn bits_of_another_length_are_told() {
    for port in [F1, F4, G0] {
        let off = port.divider / 50;
        for divider in [port.divider - off, port.divider + off, 2 * port.divider] {
            let is_misused = |fault: Result<_, Fault>| {
                let is_refused = matches!(
                    fault,
                    Err(Fault::Misused {
                        peripheral: "USART2",
                        ..
                    })
                );
                assert!(is_refused, "{}, {divider}: {fault:?}", port.model.program);
            };
            let mut sends = port.open(divider);
            port.send(&mut sends, RAM, 1);
            is_misused(sends.try_pass(3 * BYTE));
            let mut hears = port.open(divider);
            hears.chip.serial_write(b"a");
            is_misused(hears.try_pass(3 * BYTE));
        }
        // By a thousandth it may be off.
        let mut near = port.open(port.divider);
        near.chip.serial_write(b"a");
        assert!(near.try_pass(3 * BYTE).is_ok());
    }
}

#[test]
fn pins_of_another_peripheral_carry_nothing() {
    for port in [F1, F4, G0] {
        let mut rig = port.open(port.divider);
        // As the pins are after a reset: PA2 an input, PA3 disconnected.
        let (pins, value) = match port.model.program {
            "nucleo_f446re" => (0x4002_0000, 0xA800_00C0),
            "nucleo_f103rb" => (0x4001_0800, 0x4444_0444),
            _ => (0x5000_0000, 0xEBFF_FFCF),
        };
        rig.write(pins, value);
        rig.chip.serial_write(b"a");
        port.send(&mut rig, RAM, 1);
        rig.pass(3 * BYTE);
        assert!(rig.chip.serial_read().is_empty(), "{}", port.model.program);
        assert_eq!(rig.ram.0.borrow()[0], 0);
    }
}

#[test]
fn a_format_that_is_not_modelled_is_told() {
    for port in [F1, F4, G0] {
        let mut rig = port.open(port.divider);
        let [(cr3, _), (cr1, on)] = port.registers;
        for (offset, value) in [
            (cr1, on | 1 << 10),
            (cr1, on | 1 << 12),
            (cr3, 1),
            (port.brr, 15),
        ] {
            let written = rig.try_write(USART2 + offset, value);
            let is_refused = matches!(written, Err(Fault::Unmodelled { .. }));
            assert!(
                is_refused,
                "{} {offset:#x}: {written:?}",
                port.model.program
            );
        }
    }
}
