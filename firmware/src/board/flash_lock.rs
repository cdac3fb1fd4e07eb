//! The lock of the flash's control register, alike on all chips.

use stm32_metapac::FLASH;

/// In this order (RM0390, "Unlocking the flash control register"; PM0075, RM0444).
const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];

pub(crate) fn open() {
    if FLASH.cr().read().lock() {
        for key in KEYS {
            FLASH.keyr().write_value(key);
        }
    }
}
