//! Calls a kernel over its inputs, for the emulator to count.

use core::hint::black_box;

/// Calls of each kernel, each with another input: a whisk of half a second.
const CALLS: u32 = 1000;

/// What the emulator knows of a kernel (`emulator/src/counts.rs` reads it from memory).
#[repr(C)]
pub struct Kernel {
    name: *const u8,
    name_len: usize,
    format: *const u8,
    format_len: usize,
    body: usize,
}

/// From here on the emulator counts the calls of this kernel's body.
#[allow(
    unsafe_code,
    reason = "the emulator finds it by its name, which no other has"
)]
#[unsafe(no_mangle)]
#[inline(never)]
pub extern "C" fn count_calls(kernel: &Kernel) {
    black_box(kernel);
}

/// Calls a kernel [`CALLS`] times, one call after the other on the same state.
#[inline(never)]
pub fn count<I, S, O>(
    name: &str,
    format: &str,
    body: extern "C" fn(I, &mut S) -> O,
    input: impl Fn(u32) -> I,
    state: &mut S,
) {
    count_calls(&Kernel {
        name: name.as_ptr(),
        name_len: name.len(),
        format: format.as_ptr(),
        format_len: format.len(),
        body: body as usize,
    });
    for call in 0..CALLS {
        black_box(black_box(body)(input(call), state));
    }
}

/// Counts a kernel: a number format's name, the kernel's, its body with its arguments (input
/// and state), the inputs and the state it starts from. In brackets the type of numbers, where
/// the body has the choice. The body becomes a function that the compiler calls knowing nothing
/// of it, and that knows nothing of its caller.
#[macro_export]
macro_rules! kernel {
    (
        [$($number:ident)?] $format:expr, $name:expr,
        ($input:tt: $takes:ty, $state:tt: &mut $keeps:ty) $(-> $gives:ty)? $body:block,
        $inputs:expr, $start:expr $(,)?
    ) => {{
        #[inline(never)]
        extern "C" fn body$(<$number: whisking::Number>)?(
            $input: $takes,
            $state: &mut $keeps,
        ) $(-> $gives)? $body
        $crate::calls::count($name, $format, body$(::<$number>)?, $inputs, &mut $start)
    }};
}
