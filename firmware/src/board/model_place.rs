//! The flash in which a model lies apart from the program, by the memory map.

use super::scene::AWAITS_MODEL;
use crate::here::flash;

/// It begins and ends on a sector's or page's boundary. A debugger writes it while the core is
/// halted, and resets the chip; or the program does, once it reads it no more.
pub(crate) fn model_place() -> &'static [u8] {
    #[allow(unsafe_code, reason = "the linker knows where it is")]
    // SAFETY: these are the names of the memory map for both ends of a region of flash, which
    // is there for ever, has nothing else in it, and is written by nobody while this slice is
    // read: `write` says when it may be.
    unsafe {
        unsafe extern "C" {
            static _model_start: u8;
            static _model_end: u8;
        }
        let (start, end) = (&raw const _model_start, &raw const _model_end);
        core::slice::from_raw_parts(start, end.addr().wrapping_sub(start.addr()))
    }
}

/// Whether the program can write it itself.
pub(crate) const LOADS: bool = AWAITS_MODEL && flash::WRITES;

/// Words that there is room for.
pub(crate) fn words() -> u32 {
    (model_place().len() / size_of::<u32>()) as u32
}

/// Writes the `at`-th word of the place, which was erased; whether it stands there.
///
/// For the loader, when nothing reads the model any more.
pub(crate) fn write(at: u32, word: u32) -> bool {
    let first = model_place().as_ptr().addr();
    at < words() && flash::write(first + size_of::<u32>() * at as usize, word)
}
