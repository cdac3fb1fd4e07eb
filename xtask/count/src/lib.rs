//! Counts the instructions of every numeric kernel on emulated processors.
//!
//! `cargo xtask count` builds the programs of this package for a Cortex-M4F
//! and a Cortex-M0 (whose instruction set is also that of the Cortex-M0+), runs
//! them in QEMU and makes the table `docs/measured/instructions.csv` of what they print.
//! These are instructions, not cycles: what they take depends on the part, its
//! flash and its caches.
//!
//! # Glossary
//!
//! - *kernel*: a function that a tick calls, or a tick as a whole.
//! - *count*: the instructions of one call of a kernel: call, body and return,
//!   its arguments being in their registers already.
//! - *peer*: what a user would pick instead, counted in the same way.
//!
//! # Where to look
//!
//! [`machine`] counts, `check.rs` proves that it does, [`program!`] enters the
//! kernels of a program of `src/bin`. A number format is measured when it has a
//! line in the build script, one in [`mod@format`] and one in [`each_format`].
//! Configurations lie in memory, as on a board, and are bytes before that, so that the
//! compiler knows nothing of them. Programs of more than two whiskers (`*_2x12`) are
//! built with the feature `array`.
//!
//! Kernels that have a function in common stand in programs apart: the firmware
//! calls each part once and so the compiler takes it in whole, with its
//! constants; called from two kernels it might stay a function of its own.
#![cfg_attr(target_os = "none", no_std)]

pub mod arguments;
#[cfg(target_os = "none")]
pub mod check;
pub mod format;
pub mod listener;
#[cfg(target_os = "none")]
pub mod machine;
#[cfg(not(target_os = "none"))]
#[path = "pc.rs"]
pub mod machine;
pub mod module;
pub mod pipeline;
pub mod report;
pub mod samples;
#[cfg(target_os = "none")]
pub mod start;

/// Makes a program that counts kernels, each with its name, its body, the inputs and
/// the state it starts from: `program!(R, ("name", ...), ...)` in every number format
/// `R`, `program!(R, parts = parts(R::LONE), ...)` where they start from parts of a
/// configuration, `program!(("format": "name", ...), ...)` where there is no choice of a
/// format.
#[macro_export]
macro_rules! program {
    (
        $(#[$only:meta])* $number:ident, $($parts:ident = $made:expr,)?
        $(($($kernel:tt)*)),* $(,)?
    ) => {
        $crate::program!(@ $(#[$only])* {
            #[inline(never)]
            fn each<$number: $crate::format::Format>() {
                $(let $parts = $made;)?
                $($crate::kernel!([$number] $number::NAME, $($kernel)*);)*
            }
            $crate::each_format!(each);
        });
    };
    ($($(#[$only:meta])* ($format:literal: $($kernel:tt)*)),* $(,)?) => {
        $crate::program!(@ { $($(#[$only])* { $crate::kernel!([] $format, $($kernel)*) })* });
    };
    (@ $(#[$only:meta])* $kernels:block) => {
        fn kernels() {
            $(#[$only])*
            $kernels
        }

        /// What the processor does after its start.
        #[cfg(target_os = "none")]
        #[allow(
            unsafe_code,
            reason = "the start finds it by its name, which no other has"
        )]
        #[unsafe(no_mangle)]
        extern "C" fn start() -> ! {
            $crate::start::run(kernels)
        }

        /// On a PC the kernels run, and nothing is counted.
        #[cfg(not(target_os = "none"))]
        fn main() {
            kernels();
        }
    };
}

/// Calls a function once for every number format.
#[macro_export]
macro_rules! each_format {
    ($kernels:ident) => {{
        $kernels::<f32>();
        $kernels::<f64>();
        $kernels::<whisking::Fix>();
    }};
}
