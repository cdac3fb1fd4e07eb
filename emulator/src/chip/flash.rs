//! The flash interface: the wait states, and how a program writes flash (RM0390 and RM0444,
//! chapters 3; PM0075). What no program here does is refused: other units than the model lies
//! in, and other widths than its driver's.

mod layout;

use std::ops::Range;

use super::Ps;
use crate::memory::FLASH;
use layout::{ACR, WIDTH, WORDS};
pub(super) use layout::{F1, F4, G0, Layout};

const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];

/// Selects writing, and erasing.
const PG: u32 = 1 << 0;
const ERASES: u32 = 1 << 1;

#[derive(Debug, Clone)]
pub(crate) struct Flash {
    /// ACR, which only keeps what is written.
    waits: u32,
    layout: &'static Layout,
    /// How many of the keys have come; more than there are: none will do until the next reset.
    keys: usize,
    control: u32,
    /// The address of a page, where that selects it.
    address: u32,
    errors: u32,
    /// The first of two words, where both are written at once.
    first: Option<u32>,
    busy_until: Ps,
    erased: Option<Range<u32>>,
}

impl Flash {
    pub(super) const fn new(layout: &'static Layout) -> Self {
        Self {
            waits: layout.acr,
            layout,
            keys: 0,
            control: layout.lock,
            address: 0,
            errors: 0,
            first: None,
            busy_until: 0,
            erased: None,
        }
    }

    pub(super) fn reset(&mut self) {
        *self = Self::new(self.layout);
    }

    pub(super) fn read(&self, offset: u32, now: Ps) -> Option<u32> {
        let layout = self.layout;
        Some(match offset {
            ACR => self.waits,
            _ if offset == layout.keyr => 0,
            _ if offset == layout.sr && now < self.busy_until => layout.bsy | self.errors,
            _ if offset == layout.sr => self.errors,
            _ if offset == layout.cr => self.control,
            _ if Some(offset) == layout.ar => self.address,
            _ => return None,
        })
    }

    /// Whether the register is modelled, and used as the manual wants it.
    pub(super) fn write(&mut self, offset: u32, value: u32, now: Ps) -> bool {
        let layout = self.layout;
        let is_ready = self.control & layout.lock == 0 && now >= self.busy_until;
        match offset {
            ACR => {
                self.waits = value;
                true
            }
            _ if offset == layout.keyr => {
                let fits = KEYS.get(self.keys) == Some(&value);
                self.keys = if fits { self.keys + 1 } else { usize::MAX };
                if self.keys == KEYS.len() {
                    self.control &= !layout.lock;
                }
                fits
            }
            _ if offset == layout.sr => {
                self.errors &= !value;
                true
            }
            _ if offset == layout.cr && is_ready => self.control(value, now),
            _ if Some(offset) == layout.ar && is_ready => {
                self.address = value;
                true
            }
            _ => false,
        }
    }

    fn control(&mut self, value: u32, now: Ps) -> bool {
        let layout = self.layout;
        let width = if layout.has_width { WIDTH } else { 0 };
        let known = PG | ERASES | layout.number | width | layout.strt | layout.lock;
        self.control = value & !layout.strt;
        if value & layout.lock != 0 {
            self.keys = 0;
        }
        if value & layout.strt == 0 {
            return value & !known == 0;
        }
        let number = match layout.ar {
            Some(_) => self.address.wrapping_sub(FLASH) / layout.unit,
            None => (value & layout.number) >> layout.number.trailing_zeros(),
        };
        let place = layout.place(number);
        let is_erasing = value & (PG | ERASES) == ERASES && value & width == width & WORDS;
        self.erased = place.filter(|_| is_erasing);
        self.busy_until = now + layout.erases;
        self.erased.is_some()
    }

    /// Takes a store of the core, `bytes` long; whether it programs flash.
    pub(crate) fn store(&mut self, offset: u32, bytes: usize, now: Ps) -> bool {
        let layout = self.layout;
        let width = if layout.has_width { WIDTH } else { 0 };
        let is_set = self.control & (PG | layout.lock | width) == PG | width & WORDS;
        let fits = bytes == layout.bytes && offset.is_multiple_of(layout.bytes as u32);
        let begins = self.first.is_none() && offset.is_multiple_of(8);
        let ends = self.first.take() == offset.checked_sub(4);
        if !is_set || !fits || now < self.busy_until || layout.in_pairs && !begins && !ends {
            self.errors |= layout.refused;
            return false;
        }
        if layout.in_pairs && begins {
            self.first = Some(offset);
        } else {
            self.busy_until = now + layout.writes;
        }
        true
    }

    /// Offsets that have begun to be erased since the last call.
    pub(crate) fn take_erased(&mut self) -> Option<Range<u32>> {
        self.erased.take()
    }

    /// Until when whoever reads flash waits.
    pub(crate) const fn busy_until(&self) -> Ps {
        self.busy_until
    }
}

#[cfg(test)]
mod tests {
    use super::{F1, F4, Flash, G0, KEYS, Layout, PG, WORDS};

    /// One that is unlocked, with this written into CR.
    fn ready(layout: &'static Layout, control: u32) -> Flash {
        let mut flash = Flash::new(layout);
        assert!(KEYS.iter().all(|key| flash.write(layout.keyr, *key, 0)));
        flash.write(layout.cr, control, 0);
        flash
    }

    #[test]
    fn nothing_is_written_without_both_keys() {
        for layout in [&F1, &F4, &G0] {
            let mut flash = Flash::new(layout);
            assert!(!flash.write(layout.cr, PG, 0));
            assert!(!flash.store(0, layout.bytes, 0));
            assert_eq!(flash.read(layout.sr, 0), Some(layout.refused));
            // After a wrong one neither will do.
            assert!(!flash.write(layout.keyr, 1, 0));
            assert!(!flash.write(layout.keyr, KEYS[0], 0));
            assert_eq!(flash.read(layout.cr, 0), Some(layout.lock));
        }
    }

    #[test]
    fn only_what_a_chip_writes_at_once_is_written() {
        let mut flash = ready(&F4, PG | WORDS);
        assert!(!flash.store(2, 2, 0) && !flash.store(2, 4, 0));
        let mut flash = ready(&F1, PG);
        assert!(!flash.store(4, 4, 0) && flash.store(4, 2, 0));
        let mut flash = ready(&G0, PG);
        // The second word of a pair alone, and then both.
        assert!(!flash.store(4, 4, 0));
        assert!(flash.store(8, 4, 0) && flash.store(12, 4, 0));
        assert!(flash.store(16, 4, flash.busy_until()));
        assert!(!flash.store(24, 4, flash.busy_until()));
        assert_eq!(flash.take_erased(), None);
    }
}
