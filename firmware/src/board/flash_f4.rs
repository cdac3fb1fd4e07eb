//! Writing the flash of the STM32F4, by the program that runs from it: the core waits where it
//! reads flash meanwhile (RM0390, chapter 3, embedded flash memory interface).
#![allow(clippy::unused_self, reason = "the right to write flash is a value")]

use firmware::boards::Region;
use stm32_metapac::FLASH;
use stm32_metapac::flash::regs::Sr;
use stm32_metapac::flash::vals::Psize;

use crate::board::flash_lock;

/// From the fifth on, which has the number 4 and small ones before it, sectors are as if all were
/// of 128 KiB (RM0390, flash module organization).
const SECTOR_BYTES: u32 = 128 * 1024;
const SECTORS_BEFORE: u32 = 4;

const FLASH_BASE: u32 = 0x0800_0000;

/// 32 bits at a time, for which the supply must be 2.7 V (RM0390, "Program and erase parallelism").
const AT_A_TIME: Psize = Psize::PSIZE32;

/// What went wrong: OPERR, WRPERR, PGAERR, PGPERR and PGSERR, cleared by writing ones.
const ERRORS: u32 = 0xF2;

fn is_done() -> bool {
    // What was stored is on its way before BSY is looked at.
    cortex_m::asm::dsb();
    while FLASH.sr().read().bsy() {}
    FLASH.sr().read().0 & ERRORS == 0
}

pub(crate) struct Writer(());

impl Writer {
    pub(crate) fn new() -> Self {
        flash_lock::open();
        FLASH.sr().write_value(Sr(ERRORS));
        Self(())
    }

    pub(crate) fn close(self) {
        FLASH.cr().write(|w| w.set_lock(true));
    }

    /// Erases a sector of 128 KiB, which takes up to 2 s (STM32F446xC/E datasheet, flash
    /// memory programming); whether all went well. Nothing else may read it any more. What the
    /// data cache holds of it is forgotten, and it is off until the next reset.
    pub(crate) fn erase(&mut self, region: Region) -> bool {
        let sector = SECTORS_BEFORE + region.start.wrapping_sub(FLASH_BASE) / SECTOR_BYTES;
        FLASH.acr().modify(|w| w.set_dcen(false));
        FLASH.acr().modify(|w| w.set_dcrst(true));
        FLASH.acr().modify(|w| w.set_dcrst(false));
        FLASH.cr().write(|w| {
            w.set_psize(AT_A_TIME);
            w.set_ser(true);
            w.set_snb(sector as u8);
        });
        FLASH.cr().modify(|w| w.set_strt(true));
        is_done()
    }

    /// Writes an erased word; whether it stands there. Its address must be in a sector that was
    /// erased, which nothing else may read any more.
    pub(crate) fn write(&mut self, address: usize, word: u32) -> bool {
        FLASH.cr().write(|w| {
            w.set_psize(AT_A_TIME);
            w.set_pg(true);
        });
        let to = core::ptr::with_exposed_provenance_mut::<u32>(address);
        #[allow(unsafe_code, reason = "flash is programmed by stores")]
        // SAFETY: a word of a slot or its model, which the loader sees to; while PG is set the
        // flash takes the store, and the program has no reference to it that is used.
        unsafe {
            to.write_volatile(word);
            is_done() && to.read_volatile() == word
        }
    }
}
