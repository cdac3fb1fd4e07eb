//! An SPI as master of eight-bit frames (RM0390, chapter 26).

use super::time::Ps;

const CR1: u32 = 0x00;
const CR2: u32 = 0x04;
const SR: u32 = 0x08;
const DR: u32 = 0x0C;

const CPHA: u32 = 1 << 0;
const CPOL: u32 = 1 << 1;
const MSTR: u32 = 1 << 2;
const SPE: u32 = 1 << 6;
const LSBFIRST: u32 = 1 << 7;
const SSI: u32 = 1 << 8;
const SSM: u32 = 1 << 9;
/// Receive-only, 16 bits, CRC, one line: not modelled.
const OTHERS: u32 = 0xFC00;
const RXDMAEN: u32 = 1 << 0;

const RXNE: u32 = 1 << 0;
const TXE: u32 = 1 << 1;
const OVR: u32 = 1 << 6;
const BSY: u32 = 1 << 7;

/// A byte on its way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shift {
    pub(super) sent: u8,
    pub(super) began: Ps,
    pub(super) ends: Ps,
}

#[derive(Debug, Clone, Default)]
pub(super) struct Spi {
    cr1: u32,
    cr2: u32,
    /// The byte on its way.
    pub(super) shift: Option<Shift>,
    waiting: Option<u8>,
    received: Option<u8>,
    last: u8,
    overrun: bool,
    /// DR has been read since the overrun.
    overrun_seen: bool,
}

impl Spi {
    /// Whether clock polarity, phase and bit order are those of SPI mode 1.
    pub(super) const fn is_mode_1(&self) -> bool {
        self.cr1 & (CPHA | CPOL | LSBFIRST) == CPHA
    }

    /// The period of the SPI's clock, from that of its bus.
    pub(super) fn bit(&self, bus: Ps) -> Ps {
        bus << (((self.cr1 >> 3) & 7) + 1)
    }

    fn begin(&mut self, now: Ps, bus: Ps) {
        if self.shift.is_none()
            && let Some(sent) = self.waiting.take()
        {
            let (began, ends) = (now, now + 8 * self.bit(bus));
            self.shift = Some(Shift { sent, began, ends });
        }
    }

    /// The byte on its way has come to its end: `answer` was on the line.
    pub(super) fn end(&mut self, answer: u8, now: Ps, bus: Ps) {
        self.shift = None;
        if self.received.is_some() {
            self.overrun = true;
            self.overrun_seen = false;
        } else {
            self.received = Some(answer);
        }
        self.begin(now, bus);
    }

    /// Whether a received byte asks the DMA to fetch it.
    pub(super) const fn requests(&self) -> bool {
        self.received.is_some() && self.cr2 & RXDMAEN != 0
    }

    pub(super) fn read(&mut self, offset: u32) -> Option<u32> {
        Some(match offset {
            CR1 => self.cr1,
            CR2 => self.cr2,
            SR => {
                if self.overrun_seen {
                    self.overrun = false;
                    self.overrun_seen = false;
                }
                let flag = |on: bool, bit: u32| if on { bit } else { 0 };
                flag(self.received.is_some(), RXNE)
                    | flag(self.waiting.is_none(), TXE)
                    | flag(self.overrun, OVR)
                    | flag(self.shift.is_some(), BSY)
            }
            DR => {
                self.overrun_seen = self.overrun;
                if let Some(byte) = self.received.take() {
                    self.last = byte;
                }
                u32::from(self.last)
            }
            _ => return None,
        })
    }

    /// Whether register and setting are modelled.
    pub(super) fn write(&mut self, offset: u32, value: u32, now: Ps, bus: Ps) -> bool {
        match offset {
            CR1 => {
                let master = value & (MSTR | SSM | SSI) == MSTR | SSM | SSI;
                if value & OTHERS != 0 || (value & SPE != 0 && !master) {
                    return false;
                }
                self.cr1 = value;
            }
            // Requests for transmission are made by a timer here.
            CR2 if value & !RXDMAEN != 0 => return false,
            CR2 => self.cr2 = value,
            SR => {}
            DR => {
                if self.cr1 & SPE != 0 {
                    self.waiting = Some(value as u8);
                    self.begin(now, bus);
                }
            }
            _ => return false,
        }
        true
    }
}
