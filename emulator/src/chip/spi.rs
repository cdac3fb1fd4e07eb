//! An SPI as master of eight-bit frames (RM0390, chapter 26; RM0008, chapter 25; RM0444,
//! chapter 35).

use std::collections::VecDeque;

use super::Ps;
use super::fields::{Field, field, whole};

const CR1: u32 = 0x00;
const CR2: u32 = 0x04;
const SR: u32 = 0x08;
const DR: u32 = 0x0C;

const CPHA: Field = field("CR1", CR1, "CPHA", 1 << 0);
const CPOL: Field = field("CR1", CR1, "CPOL", 1 << 1);
const MSTR: Field = field("CR1", CR1, "MSTR", 1 << 2);
const BR: Field = field("CR1", CR1, "BR", 7 << 3);
const SPE: Field = field("CR1", CR1, "SPE", 1 << 6);
const LSBFIRST: Field = field("CR1", CR1, "LSBFIRST", 1 << 7);
const SSI: Field = field("CR1", CR1, "SSI", 1 << 8);
const SSM: Field = field("CR1", CR1, "SSM", 1 << 9);
/// Receive-only, 16 bits, CRC, one line: not modelled.
const OTHERS: u32 = 0xFC00;
const RXDMAEN: Field = field("CR2", CR2, "RXDMAEN", 1 << 0);
/// With queues: bits of a frame, less one; and whether a byte received is reported, or a pair.
const DS: Field = field("CR2", CR2, "DS", 15 << 8);
const DS_8: u32 = 7 << 8;
const FRXTH: Field = field("CR2", CR2, "FRXTH", 1 << 12);

const RXNE: Field = field("SR", SR, "RXNE", 1 << 0);
const TXE: Field = field("SR", SR, "TXE", 1 << 1);
const OVR: Field = field("SR", SR, "OVR", 1 << 6);
const BSY: Field = field("SR", SR, "BSY", 1 << 7);

pub(super) fn fields(version: Version) -> Vec<Field> {
    let mut fields = vec![
        CPHA, CPOL, MSTR, BR, SPE, LSBFIRST, SSI, SSM, RXDMAEN, RXNE, TXE, OVR, BSY,
    ];
    fields.push(whole("DR", DR));
    if version == Version::Queues {
        fields.extend([DS, FRXTH]);
    }
    fields
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Version {
    /// It holds one byte of each direction (STM32F1, STM32F4).
    #[default]
    One,
    /// It has a queue of four bytes for each direction; an access of 16 bits is two of
    /// them (STM32G0).
    Queues,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shift {
    pub(super) sent: u8,
    pub(super) began: Ps,
    pub(super) ends: Ps,
}

#[derive(Debug, Clone, Default)]
pub(super) struct Spi {
    version: Version,
    cr1: u32,
    cr2: u32,
    pub(super) shift: Option<Shift>,
    waiting: VecDeque<u8>,
    received: VecDeque<u8>,
    last: u8,
    overrun: bool,
    /// DR has been read since the overrun.
    overrun_seen: bool,
}

impl Spi {
    pub(super) fn new(version: Version) -> Self {
        Self {
            version,
            cr2: match version {
                Version::One => 0,
                Version::Queues => DS_8,
            },
            ..Self::default()
        }
    }

    pub(super) fn reset(&mut self) {
        *self = Self::new(self.version);
    }

    const fn room(&self) -> usize {
        match self.version {
            Version::One => 1,
            Version::Queues => 4,
        }
    }

    /// The SPI mode, 0 to 3, by clock polarity and phase; `None`: the least bit goes first.
    pub(super) const fn mode(&self) -> Option<u32> {
        if LSBFIRST.is_in(self.cr1) {
            return None;
        }
        Some(self.cr1 & (CPOL.bits | CPHA.bits))
    }

    pub(super) fn bit(&self, bus: Ps) -> Ps {
        bus << (BR.number_in(self.cr1) + 1)
    }

    fn begin(&mut self, now: Ps, bus: Ps) {
        if self.shift.is_none()
            && let Some(sent) = self.waiting.pop_front()
        {
            let (began, ends) = (now, now + 8 * self.bit(bus));
            self.shift = Some(Shift { sent, began, ends });
        }
    }

    pub(super) fn end(&mut self, answer: u8, now: Ps, bus: Ps) {
        self.shift = None;
        if self.received.len() == self.room() {
            self.overrun = true;
            self.overrun_seen = false;
        } else {
            self.received.push_back(answer);
        }
        self.begin(now, bus);
    }

    fn is_received(&self) -> bool {
        let pairs = matches!(self.version, Version::Queues) && !FRXTH.is_in(self.cr2);
        self.received.len() >= if pairs { 2 } else { 1 }
    }

    pub(super) const fn asks_dma(&self) -> bool {
        RXDMAEN.is_in(self.cr2)
    }

    /// Whether a received byte asks the DMA to fetch it.
    pub(super) fn requests(&self) -> bool {
        self.is_received() && self.asks_dma()
    }

    fn moved(&self, bytes: u32) -> u32 {
        match self.version {
            Version::One => 1,
            Version::Queues => bytes.min(2),
        }
    }

    pub(super) fn read(&mut self, offset: u32, bytes: u32) -> Option<u32> {
        Some(match offset {
            CR1 => self.cr1,
            CR2 => self.cr2,
            SR => {
                if self.overrun_seen {
                    self.overrun = false;
                    self.overrun_seen = false;
                }
                RXNE.when(self.is_received())
                    | TXE.when(self.waiting.len() <= self.room() / 2)
                    | OVR.when(self.overrun)
                    | BSY.when(self.shift.is_some())
                    | self.levels()
            }
            DR => {
                self.overrun_seen = self.overrun;
                (0..self.moved(bytes)).fold(0, |word, n| {
                    if let Some(byte) = self.received.pop_front() {
                        self.last = byte;
                    }
                    word | u32::from(self.last) << (8 * n)
                })
            }
            _ => return None,
        })
    }

    /// FRLVL and FTLVL: how full the queues are, in quarters.
    fn levels(&self) -> u32 {
        match self.version {
            Version::One => 0,
            Version::Queues => {
                let quarters = |len: usize| len.min(3) as u32;
                quarters(self.received.len()) << 9 | quarters(self.waiting.len()) << 11
            }
        }
    }

    /// Writes so many bytes of a register; whether register and setting are modelled.
    pub(super) fn write(&mut self, offset: u32, value: u32, bytes: u32, now: Ps, bus: Ps) -> bool {
        match offset {
            CR1 => {
                let is_master = [MSTR, SSM, SSI].iter().all(|field| field.is_in(value));
                if value & OTHERS != 0 || SPE.is_in(value) && !is_master {
                    return false;
                }
                self.cr1 = value;
            }
            CR2 => {
                // Requests for transmission are made by a timer here.
                let other = match self.version {
                    Version::One => value & !RXDMAEN.bits,
                    Version::Queues => {
                        value & !(RXDMAEN.bits | FRXTH.bits | DS.bits) | (value & DS.bits) ^ DS_8
                    }
                };
                if other != 0 {
                    return false;
                }
                self.cr2 = value;
            }
            SR => {}
            DR if !SPE.is_in(self.cr1) => {}
            DR => {
                let mut rest = value;
                for _ in 0..self.moved(bytes) {
                    if self.waiting.len() == self.room() {
                        // The one that waits is written over; a full queue takes no more.
                        match self.version {
                            Version::One => self.waiting.clear(),
                            Version::Queues => return true,
                        }
                    }
                    self.waiting.push_back(rest as u8);
                    rest >>= 8;
                }
                self.begin(now, bus);
            }
            _ => return false,
        }
        true
    }
}
