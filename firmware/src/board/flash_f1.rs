//! Writing the flash of the STM32F1, by the program that runs from it: the core waits where it
//! reads flash meanwhile (PM0075, "Flash memory programming").
#![allow(clippy::unused_self, reason = "the right to write flash is a value")]

use firmware::boards::Region;
use stm32_metapac::FLASH;
use stm32_metapac::flash::regs::{Ar, Sr};

use crate::board::flash_lock;

/// Bytes that are erased at once, on a medium-density chip.
const PAGE: u32 = 1024;

/// What went wrong: PGERR and WRPRTERR, cleared by writing ones.
const ERRORS: u32 = 0x14;

pub(crate) struct Writer(());

fn is_done() -> bool {
    // BSY is set a cycle after what it is set for.
    cortex_m::asm::dsb();
    while FLASH.sr().read().bsy() {}
    FLASH.sr().read().0 & ERRORS == 0
}

impl Writer {
    pub(crate) fn new() -> Self {
        flash_lock::open();
        FLASH.sr().write_value(Sr(ERRORS));
        Self(())
    }

    pub(crate) fn close(self) {
        FLASH.cr().write(|w| w.set_lock(true));
    }

    /// Erases whole pages, each of which takes up to 40 ms (STM32F103x8/B datasheet, flash
    /// memory); whether all went well. Nothing else may read them any more.
    pub(crate) fn erase(&mut self, region: Region) -> bool {
        (0..region.bytes / PAGE).all(|page| {
            FLASH.cr().write(|w| w.set_per(true));
            FLASH.ar().write_value(Ar(region.start + page * PAGE));
            FLASH.cr().modify(|w| w.set_strt(true));
            is_done()
        })
    }

    /// Writes an erased word, by halves; whether it stands there. Its address must be in a
    /// region that was erased, which nothing else may read any more.
    pub(crate) fn write(&mut self, address: usize, word: u32) -> bool {
        FLASH.cr().write(|w| w.set_pg(true));
        let [low, high] = [word as u16, (word >> 16) as u16];
        [(address, low), (address + 2, high)]
            .into_iter()
            .all(|(address, half)| {
                let to = core::ptr::with_exposed_provenance_mut::<u16>(address);
                #[allow(unsafe_code, reason = "flash is programmed by stores")]
                // SAFETY: half a word of a slot or its model, which the loader sees to; while PG is
                // set the flash takes the store, and the program has no reference to it that is
                // used.
                unsafe {
                    to.write_volatile(half);
                    is_done() && to.read_volatile() == half
                }
            })
    }
}
