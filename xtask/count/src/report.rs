//! Runs a kernel over its inputs and prints a line of what that cost.

#[cfg(target_os = "none")]
use semihosting::println;

use crate::machine::instructions;

/// Calls of each kernel, each with another input: a whisk of half a second.
pub const CALLS: u32 = 1000;

/// Counts each of [`CALLS`] calls, one after the other on the same state, and
/// prints `kernel,format,calls,sum,worst`.
#[inline(never)]
pub fn count<I, S, O>(
    name: &str,
    format: &str,
    kernel: extern "C" fn(I, &mut S) -> O,
    input: impl Fn(u32) -> I,
    state: &mut S,
) {
    let (mut sum, mut worst) = (0_u64, 0);
    for call in 0..CALLS {
        let found = instructions(kernel, input(call), state);
        sum += u64::from(found);
        worst = found.max(worst);
    }
    println!("{name},{format},{CALLS},{sum},{worst}");
}

/// Counts a kernel. Its number format, its name, its body with its arguments
/// (input and state), the inputs and the state it starts from stand in one
/// place. The body becomes a function that the compiler calls knowing nothing
/// of it, and that knows nothing of its caller.
///
/// `kernel!(R: "name", …)` for a body in the number format `R`,
/// `kernel!("format": "name", …)` for one that has no choice.
#[macro_export]
macro_rules! kernel {
    (
        $format:ident: $name:literal,
        ($input:tt: $takes:ty, $state:tt: &mut $keeps:ty) $(-> $gives:ty)? $body:block,
        $inputs:expr, $start:expr $(,)?
    ) => {{
        #[inline(never)]
        extern "C" fn body<$format: $crate::format::Format>(
            $input: $takes,
            $state: &mut $keeps,
        ) $(-> $gives)? $body
        $crate::report::count($name, $format::NAME, body::<$format>, $inputs, &mut $start)
    }};
    (
        $format:literal: $name:literal,
        ($input:tt: $takes:ty, $state:tt: &mut $keeps:ty) $(-> $gives:ty)? $body:block,
        $inputs:expr, $start:expr $(,)?
    ) => {{
        #[inline(never)]
        extern "C" fn body($input: $takes, $state: &mut $keeps) $(-> $gives)? $body
        $crate::report::count($name, $format, body, $inputs, &mut $start)
    }};
}
