//! The flash in which a model lies apart from the program, by the memory map.

/// It begins and ends on a sector's or page's boundary. A debugger writes it while the core is
/// halted, and resets the chip; or the program does, once it reads it no more.
pub(crate) fn model_place() -> &'static [u8] {
    #[allow(unsafe_code, reason = "the linker knows where it is")]
    // SAFETY: these are the names of the memory map for both ends of a region of flash, which
    // is there for ever, has nothing else in it, and is written by nobody while this slice is
    // read: the loader does when nothing reads it any more.
    unsafe {
        unsafe extern "C" {
            static _model_start: u8;
            static _model_end: u8;
        }
        let (start, end) = (&raw const _model_start, &raw const _model_end);
        core::slice::from_raw_parts(start, end.addr().wrapping_sub(start.addr()))
    }
}

/// Words that there is room for.
pub(crate) fn words() -> u32 {
    (model_place().len() / size_of::<u32>()) as u32
}
