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

/// Counts a kernel of [`program!`](crate::program): a number format's name, the
/// kernel's, its body with its arguments (input and state), the inputs and the state
/// it starts from. In brackets the type of numbers, where it has the choice. The body
/// becomes a function that the compiler calls knowing nothing of it, and that knows
/// nothing of its caller.
#[doc(hidden)]
#[macro_export]
macro_rules! kernel {
    (
        [$($number:ident)?] $format:expr, $name:literal,
        ($input:tt: $takes:ty, $state:tt: &mut $keeps:ty) $(-> $gives:ty)? $body:block,
        $inputs:expr, $start:expr $(,)?
    ) => {{
        #[inline(never)]
        extern "C" fn body$(<$number: $crate::format::Format>)?(
            $input: $takes,
            $state: &mut $keeps,
        ) $(-> $gives)? $body
        $crate::report::count($name, $format, body$(::<$number>)?, $inputs, &mut $start)
    }};
}
