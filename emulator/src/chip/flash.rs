//! The flash interface: the wait states, and on the STM32F4 how flash is written (RM0390,
//! chapter 3). Only sectors of 128 KiB are erased, and only words of 32 bits are written.

use std::ops::Range;

use super::fields::{Field, field, whole};
use super::plain::Plain;
use super::time::Ps;

const ACR: u32 = 0x00;
const KEYR: u32 = 0x04;
const SR: u32 = 0x0C;
const CR: u32 = 0x10;

const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];

const OPERR: u32 = 1 << 1;
const WRPERR: u32 = 1 << 4;
const PGAERR: u32 = 1 << 5;
const PGPERR: u32 = 1 << 6;
const PGSERR: u32 = 1 << 7;
const BSY: u32 = 1 << 16;
const ERRORS: u32 = OPERR | WRPERR | PGAERR | PGPERR | PGSERR;

const PG: u32 = 1 << 0;
const SER: u32 = 1 << 1;
const SNB: u32 = 0x1F << 3;
const PSIZE: u32 = 3 << 8;
const STRT: u32 = 1 << 16;
const LOCK: u32 = 1 << 31;
/// PSIZE of words.
const WORDS: u32 = 2 << 8;

/// How long a sector of 128 KiB takes to be erased, and a word to be written, typically
/// (STM32F446xC/E datasheet, flash memory programming, 32 bits at a time).
const ERASE: Ps = 1_000_000_000_000;
const WRITE: Ps = 16_000_000;

/// The size of the sectors that can be erased.
const SECTOR: u32 = 128 * 1024;

const FIELDS: [Field; 14] = [
    whole("ACR", ACR),
    whole("KEYR", KEYR),
    field("SR", SR, "OPERR", OPERR),
    field("SR", SR, "WRPERR", WRPERR),
    field("SR", SR, "PGAERR", PGAERR),
    field("SR", SR, "PGPERR", PGPERR),
    field("SR", SR, "PGSERR", PGSERR),
    field("SR", SR, "BSY", BSY),
    field("CR", CR, "PG", PG),
    field("CR", CR, "SER", SER),
    field("CR", CR, "SNB", SNB),
    field("CR", CR, "PSIZE", PSIZE),
    field("CR", CR, "STRT", STRT),
    field("CR", CR, "LOCK", LOCK),
];

/// What is known of its registers, where it writes and where not.
pub(super) fn fields(writes: bool) -> impl Iterator<Item = Field> {
    FIELDS
        .into_iter()
        .take(if writes { FIELDS.len() } else { 1 })
}

/// The interface.
#[derive(Debug, Clone)]
pub(super) struct Flash {
    waits: Plain,
    writer: Option<Writer>,
}

/// What writes flash.
#[derive(Debug, Clone)]
struct Writer {
    /// KiB of the sectors, from the beginning.
    sectors: &'static [u32],
    /// How many of the keys have come; more than there are: none will do until the next reset.
    keys: usize,
    control: u32,
    errors: u32,
    busy_until: Ps,
    /// Offsets of what is being erased.
    erased: Option<Range<u32>>,
}

impl Flash {
    /// With registers that only keep what is written; `sectors` are those of a chip whose flash
    /// can be written.
    pub(super) fn new(registers: &'static [(u32, u32)], sectors: &'static [u32]) -> Self {
        Self {
            waits: Plain::new(registers),
            writer: (!sectors.is_empty()).then_some(Writer {
                sectors,
                keys: 0,
                control: LOCK,
                errors: 0,
                busy_until: 0,
                erased: None,
            }),
        }
    }

    pub(super) fn reset(&mut self) {
        self.waits.reset();
        if let Some(writer) = &mut self.writer {
            (writer.keys, writer.control, writer.errors) = (0, LOCK, 0);
            (writer.busy_until, writer.erased) = (0, None);
        }
    }

    pub(super) fn read(&self, offset: u32, now: Ps) -> Option<u32> {
        let Some(writer) = self.writer.as_ref().filter(|_| offset != ACR) else {
            return self.waits.read(offset);
        };
        Some(match offset {
            KEYR => 0,
            SR if now < writer.busy_until => BSY | writer.errors,
            SR => writer.errors,
            CR => writer.control,
            _ => return None,
        })
    }

    /// Whether the register is modelled, and used as the manual wants it.
    pub(super) fn write(&mut self, offset: u32, value: u32, now: Ps) -> bool {
        match &mut self.writer {
            Some(writer) if offset != ACR => writer.write(offset, value, now),
            _ => self.waits.write(offset, value),
        }
    }

    /// Takes a store of the core, `bytes` long; whether it programs flash.
    pub(super) fn store(&mut self, offset: u32, bytes: usize, now: Ps) -> bool {
        let Some(writer) = &mut self.writer else {
            return false;
        };
        if writer.control & (PG | LOCK) != PG || now < writer.busy_until {
            writer.errors |= PGSERR;
            return false;
        }
        if writer.control & PSIZE != WORDS || bytes != 4 || !offset.is_multiple_of(4) {
            writer.errors |= PGPERR;
            return false;
        }
        writer.busy_until = now + WRITE;
        true
    }

    /// Offsets of what has begun to be erased since the last call.
    pub(super) fn take_erased(&mut self) -> Option<Range<u32>> {
        self.writer.as_mut()?.erased.take()
    }

    /// Until when whoever reads flash waits.
    pub(super) fn busy_until(&self) -> Ps {
        self.writer.as_ref().map_or(0, |writer| writer.busy_until)
    }
}

impl Writer {
    fn write(&mut self, offset: u32, value: u32, now: Ps) -> bool {
        match offset {
            KEYR => {
                let fits = KEYS.get(self.keys) == Some(&value);
                self.keys = if fits { self.keys + 1 } else { usize::MAX };
                if self.keys == KEYS.len() {
                    self.control &= !LOCK;
                }
                fits
            }
            SR => {
                self.errors &= !(value & ERRORS);
                true
            }
            CR if self.control & LOCK == 0 && now >= self.busy_until => self.control(value, now),
            _ => false,
        }
    }

    fn control(&mut self, value: u32, now: Ps) -> bool {
        let known = PG | SER | SNB | PSIZE | STRT | LOCK;
        self.control = value & !STRT;
        if value & STRT == 0 {
            return value & !known == 0;
        }
        let number = (value & SNB) >> SNB.trailing_zeros();
        let sizes = self.sectors.iter().map(|kib| kib * 1024);
        let first: u32 = sizes.clone().take(number as usize).sum();
        let size = sizes.clone().nth(number as usize);
        if size != Some(SECTOR) || value & (PG | SER | PSIZE) != SER | WORDS {
            return false;
        }
        self.erased = Some(first..first + SECTOR);
        self.busy_until = now + ERASE;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::{CR, ERASE, Flash, KEYR, KEYS, LOCK, PG, PGSERR, SER, SR, STRT, WORDS, WRITE};

    const SECTORS: [u32; 8] = [16, 16, 16, 16, 64, 128, 128, 128];

    fn unlocked() -> Flash {
        let mut flash = Flash::new(&[(0, 0)], &SECTORS);
        assert!(KEYS.iter().all(|key| flash.write(KEYR, *key, 0)));
        flash
    }

    #[test]
    fn nothing_is_written_without_both_keys() {
        let mut flash = Flash::new(&[(0, 0)], &SECTORS);
        assert!(!flash.write(CR, PG, 0));
        assert!(!flash.store(0, 4, 0));
        assert_eq!(flash.read(SR, 0), Some(PGSERR));
        // After a wrong one neither will do.
        assert!(!flash.write(KEYR, 1, 0) && !flash.write(KEYR, KEYS[0], 0));
        assert_eq!(flash.read(CR, 0), Some(LOCK));
    }

    #[test]
    fn a_sector_is_erased_where_it_lies_and_takes_its_time() {
        let mut flash = unlocked();
        assert!(flash.write(CR, SER | 7 << 3 | WORDS | STRT, 5));
        assert_eq!(flash.take_erased(), Some(384 * 1024..512 * 1024));
        assert_eq!(flash.busy_until(), 5 + ERASE);
        assert!(!flash.write(CR, PG, ERASE));
        assert!(flash.write(CR, PG | WORDS, ERASE + 5));
        assert!(flash.store(8, 4, ERASE + 5));
        assert_eq!(flash.busy_until(), ERASE + 5 + WRITE);
    }

    #[test]
    fn only_words_are_written() {
        let mut flash = unlocked();
        flash.write(CR, PG | WORDS, 0);
        assert!(!flash.store(2, 2, 0) && !flash.store(2, 4, 0));
        assert_eq!(flash.take_erased(), None);
    }
}
