//! What a counting program does on the emulated machine.

use crate::{check, machine};

/// Starts the timer, makes sure that it counts instructions, counts the
/// kernels, and ends the emulator.
pub fn run(kernels: fn()) -> ! {
    machine::begin();
    check::all();
    kernels();
    semihosting::process::exit(0)
}
