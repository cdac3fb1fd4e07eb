//! The numeric kernels of the module, to be counted one by one on an emulated core.
//!
//! `cargo xtask count` builds these programs for a Cortex-M4F and a Cortex-M0+; the emulator
//! (`emulator/src/counts.rs`) runs them and `docs/measured/instructions.csv` is their table. These
//! are instructions, not cycles: what they take depends on the part, its flash and its caches.
//!
//! # Glossary
//!
//! - *kernel*: a function that a tick calls, or all that a tick computes.
//! - *count*: the instructions of one call of a kernel: call, body and return, its arguments being
//!   in their registers already.
//! - *peer*: what a user would pick instead, counted in the same way.
//!
//! The kernels of a program share no function: the firmware calls each part once and so the
//! compiler takes it in whole; called from two kernels it might stay a function of its own.
#![cfg_attr(target_os = "none", no_std)]

pub mod calls;
pub mod classifier;
pub mod module;
pub mod samples;

/// Makes a program that calls this function. Once all kernels are counted the core sleeps, which
/// the emulator sees. On a PC the kernels run, and nothing is counted.
#[macro_export]
macro_rules! program {
    ($kernels:ident) => {
        #[cfg(target_os = "none")]
        #[cortex_m_rt::entry]
        fn start() -> ! {
            $kernels();
            loop {
                cortex_m::asm::wfi();
            }
        }

        #[cfg(not(target_os = "none"))]
        fn main() {
            $kernels();
        }
    };
}

/// A fault, which the emulator sees too.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    cortex_m::asm::udf()
}
