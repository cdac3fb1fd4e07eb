//! Writing the flash of the STM32G0, by the program that runs from it: the core waits where it
//! reads flash meanwhile (RM0444, chapter 3, embedded flash memory).
#![allow(clippy::unused_self, reason = "the right to write flash is a value")]

use firmware::boards::Region;
use stm32_metapac::FLASH;
use stm32_metapac::flash::regs::Sr;

use crate::board::flash_lock;

const PAGE: u32 = 2048;

const FLASH_BASE: u32 = 0x0800_0000;

/// What went wrong: OPERR, PROGERR, WRPERR, PGAERR, SIZERR, PGSERR, MISERR and FASTERR, cleared
/// by writing ones.
const ERRORS: u32 = 0x3FA;

pub(crate) struct Writer {
    /// A word that waits for the other one of its pair.
    waiting: Option<(usize, u32)>,
}

fn is_done() -> bool {
    cortex_m::asm::dsb();
    while FLASH.sr().read().bsy() || FLASH.sr().read().cfgbsy() {}
    FLASH.sr().read().0 & ERRORS == 0
}

impl Writer {
    pub(crate) fn new() -> Self {
        flash_lock::open();
        FLASH.sr().write_value(Sr(ERRORS));
        Self { waiting: None }
    }

    pub(crate) fn close(self) {
        FLASH.cr().write(|w| w.set_lock(true));
    }

    /// Erases whole pages, each of which takes up to 40 ms (STM32G071x8/xB datasheet, flash
    /// memory); whether all went well. Nothing else may read them any more.
    pub(crate) fn erase(&mut self, region: Region) -> bool {
        let first = region.start.wrapping_sub(FLASH_BASE) / PAGE;
        (0..region.bytes / PAGE).all(|page| {
            FLASH.cr().write(|w| {
                w.set_per(true);
                w.set_pnb((first + page) as u8);
            });
            FLASH.cr().modify(|w| w.set_strt(true));
            is_done()
        })
    }

    /// Writes an erased word together with the other one of its pair, which comes before or after
    /// it, nothing in between; whether all that is written stands there. Its address must be in a
    /// region that was erased, which nothing else may read any more.
    pub(crate) fn write(&mut self, address: usize, word: u32) -> bool {
        let pair = |address: usize| address & !7;
        match self.waiting.take() {
            None => {
                self.waiting = Some((address, word));
                true
            }
            Some((first, waited)) if pair(first) == pair(address) => {
                let words = if first < address {
                    [waited, word]
                } else {
                    [word, waited]
                };
                write_pair(pair(address), words)
            }
            // The caller never sends half of a pair.
            Some(_) => false,
        }
    }
}

fn write_pair(address: usize, words: [u32; 2]) -> bool {
    FLASH.cr().write(|w| w.set_pg(true));
    let to = core::ptr::with_exposed_provenance_mut::<u32>(address);
    #[allow(unsafe_code, reason = "flash is programmed by stores")]
    // SAFETY: two words of a slot or its model, which are whole pairs, as the loader sees to; while
    // PG is set the flash takes the stores, and the program has no reference to it that is used.
    unsafe {
        to.write_volatile(words[0]);
        to.add(1).write_volatile(words[1]);
        is_done() && [to.read_volatile(), to.add(1).read_volatile()] == words
    }
}
