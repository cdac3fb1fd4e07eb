//! What a side's frames go by, as the driver sets it up: on the left SPI1, TIM8 and
//! DMA2, on the right SPI2, TIM6 and DMA1.

use super::{GPIOA, GPIOB, MS, RCC, Rig, US};
use crate::chip::Ps;
use crate::memory::RAM;

pub(super) const ANSWERS: [u8; 8] = [0xFF, 1, 2, 3, 4, 5, 6, 7];
/// From the start of a byte to that of the next.
pub(super) const SLOT: Ps = 50 * US;
/// Eight bits at 312.5 kHz.
pub(super) const BYTE: Ps = 25_600_000;

pub(super) struct Registers {
    pub(super) side: usize,
    pub(super) spi: u32,
    pub(super) timer: u32,
    pub(super) count: Ps,
    pub(super) dma: u32,
    /// The streams of rx and tx, and their channels.
    pub(super) streams: [u32; 2],
    pub(super) channels: [u32; 2],
    pub(super) divider: u32,
    /// The pin of /SS, on port B.
    pub(super) select: u32,
    /// Registers of the ports, as the pins want them.
    pub(super) pins: [(u32, u32); 4],
    /// The register that resets the SPI, and its bit.
    pub(super) reset: (u32, u32),
}

pub(super) const LEFT: Registers = Registers {
    side: 0,
    spi: 0x4001_3000,
    timer: 0x4001_0400,
    count: 6_250,
    dma: 0x4002_6400,
    streams: [0, 1],
    channels: [3, 7],
    divider: 7,
    select: 6,
    pins: [
        (GPIOB, 0x280 | 1 << 12),
        (GPIOA, 0xA800_0000 | 2 << 10 | 2 << 12 | 2 << 14),
        (GPIOA + 0x20, 0x5550_0000),
        (GPIOA + 0x04, 1 << 7),
    ],
    reset: (RCC + 0x24, 1 << 12),
};

pub(super) const RIGHT: Registers = Registers {
    side: 1,
    spi: 0x4000_3800,
    timer: 0x4000_1000,
    count: 12_500,
    dma: 0x4002_6000,
    streams: [3, 1],
    channels: [0, 7],
    divider: 6,
    select: 12,
    pins: [
        (GPIOB, 0x280 | 1 << 24 | 2 << 26 | 2 << 28 | 2 << 30),
        (GPIOB + 0x24, 0x5550_0000),
        (GPIOB + 0x04, 1 << 15),
        (GPIOA, 0xA800_0000),
    ],
    reset: (RCC + 0x20, 1 << 14),
};

pub(super) const SIDES: [Registers; 2] = [LEFT, RIGHT];

impl Registers {
    pub(super) fn stream(&self, n: usize) -> u32 {
        self.dma + 0x10 + 0x18 * self.streams[n]
    }

    /// The flag TCIF of a stream in LISR: bits 5, 11, 21 and 27.
    pub(super) fn ended(&self, n: usize) -> u32 {
        1 << (5 + [0, 6, 16, 22][self.streams[n] as usize])
    }

    pub(super) fn raise_select(&self, rig: &mut Rig) {
        rig.write(GPIOB + 0x18, 1 << self.select);
    }

    pub(super) fn set_up_spi(&self, rig: &mut Rig, mode: u32, divider: u32) {
        rig.write(self.spi + 4, 1);
        rig.write(self.spi, mode | 1 << 2 | divider << 3 | 1 << 6 | 3 << 8);
    }

    /// A chip that has been up for 20 ms, the side's pins and SPI set up as the driver does.
    pub(super) fn rig(&self, divider: u32) -> Rig {
        self.rig_after(20 * MS, divider)
    }

    pub(super) fn rig_after(&self, time: Ps, divider: u32) -> Rig {
        let mut rig = Rig::clocked();
        rig.run_fast();
        rig.sensors[self.side].answers = ANSWERS.to_vec();
        rig.pass(time);
        self.raise_select(&mut rig);
        for (address, value) in self.pins {
            rig.write(address, value);
        }
        self.set_up_spi(&mut rig, 1, divider);
        rig
    }

    /// Begins a frame of eight bytes, one in each `slot`; they go to RAM, 16 bytes a side.
    pub(super) fn begin(&self, rig: &mut Rig, slot: Ps) {
        let [rx, tx] = [0, 1].map(|n| self.stream(n));
        let ram = RAM + 16 * self.side as u32;
        rig.write(self.timer + 0x2C, (slot / self.count - 1) as u32);
        rig.write(rx + 0x08, self.spi + 0x0C);
        rig.write(rx + 0x0C, ram + 8);
        rig.write(rx + 0x04, 8);
        rig.write(rx, self.channels[0] << 25 | 3 << 16 | 1 << 10 | 1 << 4 | 1);
        rig.memories.write(ram, &[0xFF]).unwrap();
        rig.write(tx + 0x08, self.spi + 0x0C);
        rig.write(tx + 0x0C, ram);
        rig.write(tx + 0x04, 8);
        rig.write(tx, self.channels[1] << 25 | 1 << 6 | 1);
        rig.write(GPIOB + 0x18, 1 << (16 + self.select));
        rig.write(self.timer + 0x0C, 1 << 8);
        rig.write(self.timer, 1);
    }

    pub(super) fn is_done(&self, rig: &Rig) -> bool {
        let frame = rig.chip.interrupts().nth(1 + self.side);
        frame.is_some_and(|(_, up)| up)
    }

    pub(super) fn received(&self, rig: &Rig) -> [u8; 8] {
        rig.ram(16 * self.side as u32 + 8)
    }
}
